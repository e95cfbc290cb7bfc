"""How the codec's kernels are compiled and kept.

numba keeps compiled kernels beside their source and looks at that one file to see whether they are still good. A kernel
that calls another module's kernel, or takes its constants, would be used on after that module changed, and might then
read beyond arrays whose layout is another by now. So the kept kernels are keyed by all the codec's sources as well, and
those of a folder of the codec by that folder's besides.

A process that was forked after numba had begun its threads has none of them, and GNU's OpenMP ends it, or waits for
ever. There the loops of parallel kernels run one after the other, on the one core that such a process is meant to use.

They are kept in the user's folder for such things, by that key: another clone or installation of the same sources finds
them compiled, and a package folder that nobody may write to is none the worse.
"""

from __future__ import annotations

import hashlib
import logging
import os
import shutil
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.misc.appdirs import AppDirs
from numba.np.ufunc import parallel

__all__ = ["compilation_noticed", "kernel", "parallel_kernel", "sources_digest"]

logger = logging.getLogger("pvfiblets.codec")
NOTICED = 1.0  # seconds, after which one wonders
FORGOTTEN = 30 * 86400.0  # seconds, after which kernels of other sources are not kept any more
_DISPATCHERS: list[Any] = []
HOME = Path(__file__).resolve().parent


@cache
def sources_digest(folder: Path = HOME) -> str:
    """Digest of every source file of the codec, and of those in a folder of it."""
    digest = hashlib.sha256()
    for home in sorted({HOME, folder}):
        for path in sorted(home.glob("*.py")):
            digest.update(path.name.encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


@cache
def kept_folder(digest: str) -> Path:
    """Return the folder of the kernels of sources of some digest; of others, what nobody has used for a month goes."""
    home = Path(AppDirs("pvfiblets", appauthor=False).user_cache_dir) / "kernels"
    folder = home / digest[:16]
    folder.mkdir(parents=True, exist_ok=True)
    os.utime(folder)
    for other in home.iterdir():
        if other.stat().st_mtime < time.time() - FORGOTTEN:
            shutil.rmtree(other, ignore_errors=True)
    return folder


class _KeyedBySources(FunctionCache):
    def __init__(self, function: Any, threaded: bool) -> None:
        super().__init__(function)
        self._threaded = threaded
        if numba.config.CACHE_DIR:  # the user's own choice, NUMBA_CACHE_DIR
            return
        digest = sources_digest(Path(function.__code__.co_filename).resolve().parent)
        try:
            folder = str(kept_folder(digest))
        except OSError as error:
            logger.debug("kernels are kept beside their sources: %s", error)
            return
        self._cache_path = folder
        self._cache_file = IndexDataCacheFile(
            cache_path=folder, filename_base=self._impl.filename_base, source_stamp=digest
        )

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        folder = Path(self._py_func.__code__.co_filename).resolve().parent
        return (*super()._index_key(sig, codegen), sources_digest(folder), self._threaded)


def _compiled(function: Any, threaded: bool) -> Any:
    # The numpy error model: a division by zero gives inf or NaN, which later checks see, instead of an exception that
    # would have to be raised out of a parallel loop.
    dispatcher = numba.njit(function, error_model="numpy", parallel=threaded)
    dispatcher._cache = _KeyedBySources(function, threaded)  # noqa: SLF001 - numba offers no public way to key its cache
    _DISPATCHERS.append(dispatcher)
    return dispatcher


def kernel(function: Any) -> Any:
    """Compile a function when first called, and keep the result on disk."""
    return _compiled(function, threaded=False)


class _ParallelKernel:
    """A kernel whose loops run on all cores, or one after the other where a fork left numba's threads behind."""

    def __init__(self, function: Any) -> None:
        self._threaded = _compiled(function, threaded=True)
        self._serial = _compiled(function, threaded=False)
        self.py_func = function
        self.__doc__ = function.__doc__

    def __call__(self, *arguments: Any) -> Any:
        return (self._serial if _threads_left_behind else self._threaded)(*arguments)


def parallel_kernel(function: Any) -> Any:
    """The same for one whose ``numba.prange`` loops run on all cores; other kernels cannot call it."""
    return _ParallelKernel(function)


_threads_left_behind = False


def _forked() -> None:
    global _threads_left_behind
    # TBB and numba's own work queue begin anew in a child.
    if parallel._is_initialized and parallel._threading_layer == "omp":  # noqa: SLF001 - numba does not tell otherwise
        _threads_left_behind = True
        logger.info("this process was forked after kernels had run: its own run on one core")


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forked)


@contextmanager
def compilation_noticed(what: str) -> Iterator[None]:
    """Log a warning if kernels are compiled within, which takes more than a second: nobody has used them here before.

    Parameters
    ----------
    what : str
        Which kernels, for people.
    """
    done, before = threading.Event(), _compilations()

    def watch() -> None:
        while not done.wait(NOTICED):
            if _compilations() > before:
                logger.warning("compiling %s for this machine; this happens once, and takes up to a minute", what)
                return

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        done.set()
        watcher.join()


def _compilations() -> int:
    """How many kernels were not found compiled on disk so far."""
    return sum(sum(dispatcher.stats.cache_misses.values()) for dispatcher in _DISPATCHERS)
