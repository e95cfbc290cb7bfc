"""Compilation of the codec's kernels, and their cache.

numba keeps compiled kernels beside their source and looks at that one file to see whether they are still good. A kernel
that calls another module's kernel, or takes its constants, would be used on after that module changed, and might then
read beyond arrays whose layout is another by now. So the kept kernels are keyed by the codec's sources as well, and
kernels of another room by all of that room's besides.

A process that was forked after numba had begun its threads has no threads, and GNU's OpenMP ends it, or waits for
ever. There the loops of parallel kernels run one after the other, on the one core that such a process is meant to use.

They are kept in the user's folder for such things, by that key: another clone or installation of the same sources finds
them compiled, and a read-only package folder does no harm.
"""

from __future__ import annotations

import logging
import os
import threading
import time
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.np.ufunc import parallel

from .kernel_cache import kernel_folder, sources_digest

logger = logging.getLogger("pvfiblets.codec")
NOTICED = 1.0  # seconds, after which one wonders


class _Notice:
    """Reports a waiting compiler once, after more than a second in all."""

    def __init__(self) -> None:
        self._begun: list[float] = []  # of kernels that are being compiled, one for another
        self._taken = 0.0
        self._timer: threading.Timer | None = None
        self._told = False

    def begin(self) -> None:
        self._begun.append(time.perf_counter())
        if len(self._begun) == 1 and not self._told:
            self._timer = threading.Timer(max(NOTICED - self._taken, 0.0), self._tell)
            self._timer.daemon = True
            self._timer.start()

    def end(self) -> None:
        begun = self._begun.pop() if self._begun else time.perf_counter()
        if not self._begun:
            self._taken += time.perf_counter() - begun
            if self._timer is not None:
                self._timer.cancel()

    def _tell(self) -> None:
        if self._begun and not self._told:
            self._told = True
            logger.warning("compiling kernels with numba: once per machine, up to a minute")


NOTICE = _Notice()


class _KeyedBySources(FunctionCache):
    def __init__(self, function: Any, threaded: bool) -> None:
        super().__init__(function)
        self._threaded = threaded
        if numba.config.CACHE_DIR:  # the user's own choice, NUMBA_CACHE_DIR
            return
        digest = sources_digest(Path(function.__code__.co_filename).resolve().parent)
        try:
            folder = str(kernel_folder(digest))
        except OSError as error:
            logger.debug("kernels are kept beside their sources: %s", error)
            return
        self._cache_path = folder
        self._cache_file = IndexDataCacheFile(
            cache_path=folder, filename_base=self._impl.filename_base, source_stamp=digest
        )

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        found = super().load_overload(sig, target_context)
        if found is None:
            NOTICE.begin()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        NOTICE.end()
        super().save_overload(sig, data)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        folder = Path(self._py_func.__code__.co_filename).resolve().parent
        return (*super()._index_key(sig, codegen), sources_digest(folder), self._threaded)


def _compiled(function: Any, threaded: bool) -> Any:
    # The numpy error model: a division by zero gives inf or NaN, which later checks see, instead of an exception that
    # would have to be raised out of a parallel loop.
    dispatcher = numba.njit(function, error_model="numpy", parallel=threaded)
    dispatcher._cache = _KeyedBySources(function, threaded)  # noqa: SLF001 - numba offers no public way to key its cache
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


def parallel_kernel(function: Any) -> _ParallelKernel:
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
