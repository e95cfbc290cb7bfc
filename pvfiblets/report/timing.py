"""How everything is timed: clocks, calls that take turns, and variants of one data set for as long as there is time.

Software OpenGL draws on threads of this process: the processor time of all of them is what a picture costs, and other
programs disturb it little. What a card does shows in no processor time, so there the clock on the wall is read.
"""

from __future__ import annotations

import gc
import re
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from .record import FRAME, Record, Timing
from .study import LATE, Options

if TYPE_CHECKING:
    import moderngl

SOFTWARE = re.compile("llvmpipe|softpipe|swrast|swiftshader|software", re.IGNORECASE)

_GRAIN = 2e-3  # s: shorter calls are put together until they take about as long
_LONG = 0.5  # s


def clock_of(ctx: moderngl.Context) -> tuple[Callable[[], float], str]:
    """Return the clock that measures what a context's frames cost, and its name as in :class:`.Timing`."""
    if SOFTWARE.search(str(ctx.info["GL_RENDERER"])):
        return time.process_time, "cpu"
    return time.perf_counter, "wall"


def turns_of(ctx: moderngl.Context) -> Turns:
    """Return turns that are timed by a context's clock; their calls must end with ``ctx.finish()``."""
    return Turns(*clock_of(ctx))


def timing(seconds: list[float], items: float, item: str, clock: str) -> Timing:
    """Return what repeats of one call took, which handles so many items."""
    return Timing(float(np.median(seconds)), min(seconds), max(seconds), len(seconds), float(items), item, clock)


class Turns:
    """Times of several calls that take turns, so that what else the machine does meets all of them alike.

    Calls that are much shorter than the clock's grain are put together; of calls longer than half a second three are
    enough.
    """

    def __init__(self, clock: Callable[[], float] = time.process_time, clock_name: str = "cpu") -> None:
        self._clock = clock
        self._name = clock_name
        self._calls: list[tuple[Callable[[], object], int]] = []
        self._seconds: list[list[float]] = []

    def add(self, function: Callable[[], object]) -> int:
        """Take in a call that has been made before (so that it is compiled and warm), time it once, and number it."""
        once = self._once(function, 1)
        inner = 1 if once >= _GRAIN else int(min(np.ceil(_GRAIN / max(once, 1e-6)), 1000))
        self._calls.append((function, inner))
        self._seconds.append([once])
        return len(self._calls) - 1

    def run(self, repeats: int, go_on: Callable[[], bool] = lambda: True) -> None:
        """Time all calls until each has run ``repeats`` times; stop early once ``go_on()`` returns False."""
        for turn in range(1, repeats):
            for (function, inner), seconds in zip(self._calls, self._seconds, strict=True):
                if turn >= 3 and seconds[0] > _LONG:
                    continue
                if not go_on():
                    return
                if turn == 1 and inner > 1:
                    seconds.clear()  # the first was too short to be measured
                seconds.append(self._once(function, inner))

    def timing(self, number: int, items: float, item: str = "point") -> Timing:
        """Return the timing of one call, which handles so many items."""
        return timing(self._seconds[number], items, item, self._name)

    def _once(self, function: Callable[[], object], inner: int) -> float:
        collecting = gc.isenabled()
        gc.disable()  # a collection that falls into one call is not that call's cost
        try:
            begun = self._clock()
            for _ in range(inner):
                function()
            return (self._clock() - begun) / inner
        finally:
            if collecting:
                gc.enable()


class Comparison:
    """Variants of one data set: each is measured while there is time, then all are timed by turns.

    ``items`` and ``item`` are what one call handles.
    """

    def __init__(
        self, data: str, options: Options, turns: Turns, items: float = 1.0, item: str = FRAME
    ) -> None:
        self._data, self._options = data, options
        self._turns, self._items, self._item = turns, items, item
        self._done: list[tuple[Record, dict[str, int]]] = []
        self._late: list[str] = []

    def allows(self, label: str) -> bool:
        """Return whether there is time for one more variant; if not, it is left out and named."""
        if self._options.budget.allows():
            return True
        self._late.append(label)
        return False

    def refuse(self, label: str, reason: object) -> None:
        """Leave a variant out."""
        self._options.leave_out(f"{self._data}: {label}", reason)

    def add(self, record: Record, **calls: Callable[[], object]) -> None:
        """Take in a record, and calls to be timed under their names; each has been made before."""
        self._done.append((record, {name: self._turns.add(call) for name, call in calls.items()}))

    def finish(self) -> Iterator[Record]:
        """Time all calls, and yield the records."""
        self._turns.run(self._options.repeats, self._options.budget.allows)
        for record, numbers in self._done:
            record.times |= {name: self._turns.timing(n, self._items, self._item) for name, n in numbers.items()}
            yield record
        if self._late:
            what = ", ".join(self._late) if self._done else "everything"
            self._options.leave_out(f"{self._data}: {what}", LATE)
        self._options.log(f"{self._data}: {len(self._done)} variants")
