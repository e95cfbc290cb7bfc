"""The cache of compiled kernels, keyed by their sources; without numba."""

from __future__ import annotations

import hashlib
import os
import shutil
import time
from functools import cache
from pathlib import Path

from ..support.cache_folder import cache_folder

FORGOTTEN = 30 * 86400.0  # seconds, after which kernels of other sources are not kept any more
HOME = Path(__file__).resolve().parent


@cache
def sources_digest(folder: Path = HOME) -> str:
    """Digest of the codec's sources and its kernels', and for a folder of another room of all that room's."""
    digest = hashlib.sha256()
    for path in _sources(folder):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _sources(folder: Path) -> list[Path]:
    own = [path for room in ("", "encoding", "kernels") for path in sorted((HOME / room).glob("*.py"))]
    if folder == HOME or HOME in folder.parents:
        return own
    package = HOME.parent
    room = package / folder.relative_to(package).parts[0] if package in folder.parents else folder
    return own + sorted(room.rglob("*.py"))


@cache
def kernel_folder(digest: str) -> Path:
    """Return the folder of the kernels for a digest of sources; remove other folders unused for a month."""
    home = cache_folder() / "kernels"
    folder = home / digest[:16]
    folder.mkdir(parents=True, exist_ok=True)
    os.utime(folder)
    for other in home.iterdir():
        if other.stat().st_mtime < time.time() - FORGOTTEN:
            shutil.rmtree(other, ignore_errors=True)
    return folder


def _mark(work: str, folder: Path) -> Path:
    digest = sources_digest(folder)
    chosen = os.environ.get("NUMBA_CACHE_DIR")  # the user's own choice
    return Path(chosen) / f"pvfiblets-{digest[:16]}-{work}" if chosen else kernel_folder(digest) / work


def is_filled(work: str, folder: Path = HOME) -> bool:
    """Whether the kernels of some work were compiled here before, from the same sources of the codec and a folder."""
    try:
        return _mark(work, folder).exists()
    except OSError:
        return False


def mark_filled(work: str, folder: Path = HOME) -> None:
    """Remember that they are; a read-only folder is no error."""
    try:
        mark = _mark(work, folder)
        mark.parent.mkdir(parents=True, exist_ok=True)
        mark.touch()
    except OSError:
        return
