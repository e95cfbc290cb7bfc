"""Whether a set is small enough to be coded by NumPy alone, sooner than numba would have loaded its kernels.

Loading kernels that were compiled before takes most of a second of every process, compiling them a quarter of a minute
of every new environment. NumPy takes microseconds a point. So a process first works without kernels, adds up what that
costs, and loads them as soon as the sum would be more than loading costs: whatever comes, it spends at most twice the
least time. Compiling is paid once and serves later processes too, so that less than its whole price is waited for.

In a new environment the first set of 110,000 to 940,000 points is so coded in 0.5 to 4 s of CPU time, by kernels in 16
to 21 s; where they are compiled already, 110,000 points take 0.6 s and 1.2 s.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal

from .kernel_cache import is_filled, mark_filled

Work = Literal["coding", "decoding"]

SECONDS_A_POINT: dict[Work, float] = {"coding": 4e-6, "decoding": 0.2e-6}
"""On one core; coding takes 2 microseconds for even steps, 5 to 10 for uneven ones."""


LOADING = 0.8  # seconds, of compiled kernels from disk
COMPILING = 4.0  # seconds; work below that does not wait for uncompiled kernels


@dataclass
class State:
    """Seconds of a core that a process has spent on a task without kernels, and whether it has loaded them."""

    spent: float = 0.0
    loaded: bool = False


STATES: dict[Work, State] = {"coding": State(), "decoding": State()}


@contextmanager
def without_kernels(work: Work, points: int) -> Iterator[bool]:
    """Return whether to do without kernels, and count the time that this takes."""
    state = STATES[work]
    expected = state.spent + points * SECONDS_A_POINT[work]
    small = not state.loaded and (expected <= LOADING or (expected <= COMPILING and not is_filled(work)))
    begin = time.thread_time()
    try:
        yield small
    finally:
        if small:
            state.spent += time.thread_time() - begin
        elif not state.loaded:
            state.loaded = True
            mark_filled(work)


def prefer_kernels(work: Work) -> None:
    """Use compiled kernels from now on, if they exist: numba is loaded already."""
    if is_filled(work):
        STATES[work].loaded = True
