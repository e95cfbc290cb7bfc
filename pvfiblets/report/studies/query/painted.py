"""Time from a stroke to the streamlines of the painted region, with the spatial index and without."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from pvfiblets import FibletSet, regions
from pvfiblets.query.painting.live import LiveRegion

from ...record import Figure, Record
from ...study import Options
from ...timing import timing

RADII, QUICK_RADII = (2.0, 5.0, 10.0), (5.0,)  # mm, of the brush
STROKES, QUICK_STROKES = 15, 5  # that count: the first does not
DRAGGED = 30  # mm
POINTS_ASKED = 100_000  # streamlines up to which all points are tested


def painted(fiblets: FibletSet, options: Options) -> Iterator[Record]:
    """Yield records of one set."""
    rng = np.random.default_rng(options.seed)
    lines = fiblets.decompress(np.sort(rng.choice(len(fiblets), 40, replace=False)))
    places = lines.points[rng.integers(len(lines.points), size=(QUICK_STROKES if options.quick else STROKES) + 1)]
    longest = lines[int(np.argmax(lines.lengths()))]
    path = longest[:: max(round(1.0 / max(fiblets.step, 1e-9)), 1)][: DRAGGED + 2]
    for radius in QUICK_RADII if options.quick else RADII:
        if not options.budget.allows():
            return
        strokes = _Strokes(fiblets, f"{len(fiblets):,} streamlines, balls of {radius:g} mm")
        painter = strokes.painter
        strokes.do(partial(painter.paint, "a", at, radius) for at in places)
        yield strokes.record("painted", strokes.elsewhere())
        if len(fiblets) <= POINTS_ASKED:
            yield strokes.by_points()
        strokes.do(partial(painter.erase, at, radius) for at in places[::-1])
        yield strokes.record("erased", {})
        painter.paint("a", path[0], radius)
        strokes.do(partial(painter.paint, "a", [a, b], radius) for a, b in pairwise(path))
        yield strokes.record("dragged", {})


class _Strokes:
    """A region on a grid of 1 mm about a set, and how long its answers take."""

    def __init__(self, fiblets: FibletSet, name: str) -> None:
        self._fiblets, self._name = fiblets, name
        low = np.floor(np.array(fiblets.bounds)[::2]) - 1.0
        place = np.eye(4)
        place[:3, 3] = low
        shape = tuple(int(n) for n in np.ceil(np.array(fiblets.bounds)[1::2] - low) + 2)
        self.painter = regions.RegionPainter((shape, place))
        self.painter.add("a")
        self._live = regions.LiveRegions(fiblets, self.painter)
        self._region = self._live.region("a")
        self._seconds: list[float] = []
        self._shares: list[float] = []

    def do(self, strokes: Iterator[Callable[[], Any]]) -> None:
        """Do strokes, and ask after each which streamlines pass."""
        self._seconds, self._shares = [], []
        for stroke in strokes:
            begun = time.process_time()
            stroke()
            self._live.select(include="a")
            self._seconds.append(time.process_time() - begun)
            self._shares.append(self._region.decoded / max(self._region.looked_at, 1))

    def record(self, setting: str, errors: dict[str, Figure]) -> Record:
        """Return the record of the last strokes."""
        index = regions.index_of(self._fiblets).nbytes / self._fiblets.n_fiblets
        costs = {
            "index": Figure(index, "bytes/fiblet"),
            "decoded": Figure(100.0 * float(np.mean(self._shares[1:])), "% of those near"),
        }
        return self._record("index", setting, errors, costs, self._seconds[1:])

    def elsewhere(self) -> dict[str, Figure]:
        """Return for how many streamlines decoding all near fiblets answers otherwise."""
        decoded = LiveRegion(self._fiblets, self.painter.grid)
        there = np.flatnonzero(self.painter.mask("a").ravel())
        decoded.change(there, np.ones(len(there), bool))
        # flags() begins anew, and decodes all that is near.
        return self._compared(decoded.flags() & 1 != 0)

    def by_points(self) -> Record:
        """Return the record of a query of all points."""
        begun = time.process_time()
        points = self._fiblets.select(regions.passes(self.painter.region("a"), sampling="points"))
        return self._record("points", "painted", self._compared(points), {}, [time.process_time() - begun])

    def _compared(self, other: Any) -> dict[str, Figure]:
        return {"elsewhere": Figure(100.0 * float((other != self._live.select(include="a")).mean()), "%")}

    def _record(
        self, method: str, setting: str, errors: dict[str, Figure], costs: dict[str, Figure], seconds: list[float]
    ) -> Record:
        return Record(
            data=self._name,
            group="painted",
            approximation="which streamlines pass a region",
            method=method,
            setting=setting,
            errors=errors,
            costs=costs,
            times={"answer": timing(seconds, len(self._fiblets), "streamline", "cpu")},
            ours=True,
            default=method == "index" and setting == "painted",
        )
