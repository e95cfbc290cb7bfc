"""Features of streamlines in a PyVista window, VTK's own work included: what a frame costs, and what a change does."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...record import FRAME, Figure, Record
from ...study import LATE, Options
from ...timing import timing
from ...window import Window
from .scenes import PLAIN
from .subjects import torus

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

DEGREES = 1.14  # from frame to frame: Schertzer et al. 2022, section 4.5
GROUP = "window"


@dataclass(frozen=True)
class WindowFeature:
    """One feature of an actor."""

    # As of :class:`~.scenes.Feature`
    group: str
    name: str
    # Called with the actor and a number: turns the feature on, or changes it for the n-th time
    change: Callable[[Any, int], object]
    undo: Callable[[Any], object]  # Called with the actor: turns it off
    varies: bool = True  # Whether the n-th time differs from the one before


def window_features(fiblets: FibletSet) -> list[WindowFeature]:
    """Return what can be set on an actor of these fiblets."""
    from pvfiblets import regions

    box = np.array(fiblets.bounds, np.float64).reshape(3, 2)
    middle, sides = box.mean(axis=1), box[:, 1] - box[:, 0]
    x, y, z = middle
    ring = torus(middle, 0.35 * float(sides.min()))
    grid = np.indices((64, 64, 64)).sum(0).astype(np.float32)
    affine = np.diag([*(sides / 63.0), 1.0])
    affine[:3, 3] = box[:, 0]
    found = []

    def add(group: str, name: str, change: Callable[[Any, int], object], undo: Callable[[Any], object]) -> None:
        found.append(WindowFeature(group, name, change, undo))

    def add_values(group: str, name: str, on: dict[str, Any], off: dict[str, Any]) -> None:
        def give(actor: Any, values: dict[str, Any]) -> None:
            for key, value in values.items():
                setattr(actor, key, value)

        found.append(WindowFeature(group, name, lambda a, _: give(a, on), lambda a: give(a, off), varies=False))

    def as_tubes(actor: Any, n: int) -> None:
        if n == 0:
            actor.selection_style(as_tubes=True, radius=0.5)
        actor.select(np.arange(n, fiblets.n_streamlines, 200))

    def no_tubes(actor: Any) -> None:
        actor.deselect()
        actor.selection_style(as_tubes=False)

    def shifted(n: int) -> Any:
        matrix = np.eye(4)
        matrix[0, 3] = n % 20
        return ring.moved(matrix)

    def unclip(actor: Any) -> None:
        actor.unclip()

    def no_criterion(actor: Any) -> None:
        actor.remove_criterion()

    add("cut", "plane", lambda a, n: a.clip(((1, 0, 0), (x + n % 20 - 10, y, z)), name="cut"), unclip)
    add("cut", "box", lambda a, n: a.clip((x - 40 + n % 20, x + 40, y - 40, y + 40, z - 40, z + 40), name="cut"),
        unclip)  # fmt: skip
    add("cut", "slab of 5 mm", lambda a, n: a.clip_slab("y", y + n % 20, 5.0, name="cut"), unclip)
    add("cut", "mesh", lambda a, n: a.clip(shifted(n), name="cut"), unclip)
    add("criterion", "length", lambda a, n: a.criterion("length", (40.0 + n % 20, 100.0)), no_criterion)
    add("criterion", "curvature, per point", lambda a, n: a.criterion("curvature", (0.0, 0.05 + 0.001 * (n % 20))),
        no_criterion)  # fmt: skip
    add("condition", "through a ball",
        lambda a, n: a.include(regions.Sphere((x + 20 + n % 10, y, z), 15.0), name="ball"),
        lambda a: a.remove_condition())  # fmt: skip
    add("selection", "a twentieth, the rest dimmed", lambda a, n: a.select(np.arange(n, fiblets.n_streamlines, 20)),
        lambda a: a.deselect())  # fmt: skip
    add("selection", "0.5 % as tubes", as_tubes, no_tubes)
    for name in ("illuminated", "ambient_occlusion", "depth_cue", "halos"):
        add_values("effects", name.replace("_", " "), {name: True}, {name: False})
    add_values("lines", "3 pixels wide, shaded", {"line_width": 3, "tube_shading": True},
               {"tube_shading": False, "line_width": 1})  # fmt: skip
    add_values("lines", "layers, blended", {"opacity": 0.4, "transparency": "layers"},
               {"transparency": "all", "opacity": 1.0})  # fmt: skip
    add_values("lines", "all, blended, opacity 0.05", {"opacity": 0.05}, {"opacity": 1.0})
    add_values("lines", "density", {"style": "density"}, {"style": "surface"})
    add_values("lines", "density by a map", {"style": "density", "scalars": "density"},
               {"style": "surface", "scalars": None})  # fmt: skip
    add_values("colours", "one", {"color": "red"}, {"color": None})
    add_values("colours", "arc length", {"scalars": "arc_length"}, {"scalars": None})
    add_values("colours", "a volume", {"scalars": (grid, affine)}, {"scalars": None})
    return found


class _FibletWindow(Window):
    """A window with fiblets that turns."""

    def __init__(self, fiblets: FibletSet, size: tuple[int, int]) -> None:
        super().__init__(size, "white", multisampled=True)
        self.actor: Any = self.plotter.add_fiblets(fiblets)
        self.plotter.view_vector((1.0, 0.8, 0.5), (0.0, 0.0, 1.0))
        self.plotter.camera.zoom(1.4)
        self.show()

    def seconds(self, before: Callable[[], object] | None = None) -> float:
        """Draw, after a change or one step on, and return the seconds that both took."""
        if before is None:
            self.plotter.camera.azimuth += DEGREES
        begun = self.clock()
        if before is not None:
            before()
        self.render()
        return self.clock() - begun


def in_window(
    make: Callable[[], Any], size: tuple[int, int], options: Options
) -> Iterator[Record]:
    """Yield a record for every feature, whose frames take turns with frames that have none."""
    data = f"streamlines in a window, {size[0]} x {size[1]}"
    if not options.allows(f"{data}: everything"):
        return
    fiblets = make()
    window = _FibletWindow(fiblets, size)
    actor, late, plain_frames, plain_bytes = window.actor, [], [], 0
    try:
        for _ in range(3):
            window.seconds()
        begun = time.perf_counter()
        for feature in window_features(fiblets):
            if not options.budget.allows():
                late.append(f"{feature.group} {feature.name}")
                continue
            frames: dict[str, list[float]] = {"draw": [], "change": []} if feature.varies else {"draw": []}
            feature.change(actor, 0)
            window.seconds()  # compiles and measures everything that happens once
            for n in range(1, options.repeats + 1):
                change = window.seconds(partial(feature.change, actor, n))
                if feature.varies:
                    frames["change"].append(change)
                frames["draw"].append(window.seconds())
                nbytes = actor.explain()["gpu_bytes"]
                feature.undo(actor)
                window.seconds()
                plain_frames.append(window.seconds())
                plain_bytes = actor.explain()["gpu_bytes"]
            times = {name: timing(seconds, 1.0, FRAME, window.clock_name) for name, seconds in frames.items()}
            base = float(np.median(plain_frames[-options.repeats :]))
            yield _record(data, feature.group, feature.name, nbytes, plain_bytes, times, base)
        if plain_frames:
            times = {"draw": timing(plain_frames, 1.0, FRAME, window.clock_name)}
            yield _record(data, PLAIN, "", plain_bytes, plain_bytes, times, times["draw"].median)
    finally:
        window.release()
    if late:
        options.leave_out(f"{data}: {', '.join(late)}", LATE)
    options.log(f"features: in a window: {time.perf_counter() - begun:.0f} s")


def _record(
    data: str, group: str, name: str, nbytes: int, plain_bytes: int, times: dict[str, Any], base: float,
) -> Record:  # fmt: skip
    return Record(
        data=data,
        group=GROUP,
        approximation="nothing",
        method=group,
        setting=name,
        errors={},
        costs={
            "memory": Figure(nbytes / 1e6, "MB"),
            "more memory": Figure((nbytes - plain_bytes) / 1e6, "MB"),
            "more time": Figure(1e3 * (times["draw"].median - base), "ms per frame"),
        },
        times=times,
        ours=True,
        default=group == PLAIN,
    )
