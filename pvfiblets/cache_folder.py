"""Where this user's machine keeps what can be made or fetched again."""

from __future__ import annotations

import os
from pathlib import Path

__all__ = ["cache_folder"]


def cache_folder() -> Path:
    """Return the folder of this program's caches, as the system has it; it may not be there yet."""
    try:
        import platformdirs
    except ImportError:  # a bare machine whose graphics card is measured (benchmarks/card.sh); the same place on Linux
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "pvfiblets"
    return Path(platformdirs.user_cache_dir("pvfiblets", appauthor=False))
