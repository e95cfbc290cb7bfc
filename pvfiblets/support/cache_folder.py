"""The folder of this user's machine for data that can be made or fetched again."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path


def cache_folder() -> Path:
    """Return the folder of this program's caches, as the system has it; it may not be there yet."""
    try:
        import platformdirs
    except ImportError:  # a bare machine whose graphics card is measured (scripts/card.sh); the same place on Linux
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "pvfiblets"
    return Path(platformdirs.user_cache_dir("pvfiblets", appauthor=False))


def is_first_time(what: str) -> bool:
    """Whether something happens here for the first time, and remember it; False where no folder can be written to."""
    mark = cache_folder() / "happened" / hashlib.sha256(what.encode()).hexdigest()[:16]
    try:
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch(exist_ok=False)
    except OSError:  # it is there, or cannot be
        return False
    return True
