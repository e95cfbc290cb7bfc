"""The study of translucent lines: the error and the cost of each way of blending."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ...record import FRAME, Axes, Figure, Record
from ...study import LATE, Options, Study, Unavailable
from ...timing import timing
from ..antialias.study import OURS, PictureWindow, Subject, differences

SIZE, QUICK_SIZE = (800, 600), (320, 240)
SEGMENTS, QUICK_SEGMENTS = 1_000_000, 60_000  # of a synthetic brain
STEP = 0.5  # mm, of its points
OPACITIES, QUICK_OPACITIES = (0.02, 0.05, 0.2, 0.5), (0.05, 0.5)
LAYERS = 64  # of the reference
WAYS: tuple[tuple[str, Any], ...] = (
    ("all", "all"), ("4 layers", "layers"), ("16 layers", 16), ("the nearest", None),
)  # fmt: skip


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every opacity and way of blending."""
    try:
        import pyvista as pv
    except ImportError as error:
        raise Unavailable(f"{error.name} is not installed") from error
    for subject in _subjects(options, pv):
        if not options.allows(subject.name):
            continue
        yield from _measured(subject, options)

def _subjects(options: Options, pv: Any) -> list[Subject]:
    from pvfiblets.report.studies.codec.coded import compress
    from pvfiblets.synthetic import brain_streamlines, streamline_count

    n = streamline_count(QUICK_SEGMENTS if options.quick else SEGMENTS, STEP)
    fiblets = compress(brain_streamlines(n, step=STEP, seed=options.seed))

    def whole(plotter: pv.BasePlotter) -> None:
        plotter.add_fiblets(fiblets, name="lines", show_scalar_bar=False)
        plotter.view_vector((1.0, 0.8, 0.5), (0.0, 0.0, 1.0))
        plotter.camera.zoom(1.4)

    def beside(plotter: pv.BasePlotter) -> None:
        whole(plotter)
        middle = np.reshape(fiblets.bounds, (3, 2)).mean(axis=1)
        plotter.add_mesh(pv.Sphere(radius=30.0, center=middle), color="white", opacity=0.3)
        plotter.enable_depth_peeling(number_of_peels=80, occlusion_ratio=0.0)

    return [Subject("whole brain", whole), Subject("brain and a surface", beside)]


def _lines_of_pixels(actor: Any) -> npt.NDArray[np.float64]:
    """Return (rows, columns) how many lines each pixel of the last picture holds, the lowest row first."""
    from pvfiblets.mappers.frames.windows import contexts_with

    (context,) = contexts_with(actor.mapper)
    slot = context.slots[actor.mapper.GetAddressAsString("")]
    drawn = list(slot.drawn.values())[-1]
    context.window.MakeCurrent()
    with context.foreign():
        counted: npt.NDArray[np.float64] = slot.renderer.gather(drawn.view, drawn.style).read()[0, ..., 3]
        slot.renderer.drop_gathered()
    return counted


def _measured(subject: Subject, options: Options) -> Iterator[Record]:
    quick, begun, late = options.quick, time.perf_counter(), []
    window = PictureWindow(subject, QUICK_SIZE if quick else SIZE)
    try:
        options.driver = window.driver
        actor = window.plotter.actors["lines"]
        window.look_back()
        counted = _lines_of_pixels(actor)
        fair = (counted > 0.0) & (counted <= LAYERS)
        opaque = [window.frame() for _ in range(options.repeats + 1)][1:]
        for opacity in QUICK_OPACITIES if quick else OPACITIES:
            if not options.budget.allows():
                late.append(f"opacity {opacity:g}")
                continue
            actor.opacity = opacity
            actor.transparency = LAYERS
            window.look_back()
            reference = window.pixels()[fair][None]
            for setting, transparency in WAYS:
                actor.transparency = transparency
                window.look_back()
                found = differences(window.pixels()[fair][None], reference)
                frames = [window.frame() for _ in range(options.repeats)]
                yield Record(
                    data=f"{subject.name}, opacity {opacity:g}",
                    group=f"{subject.name.replace(' ', '-')}-{opacity:g}",
                    approximation="all lines of a pixel, sorted",
                    method=OURS,
                    setting=setting,
                    errors={name: Figure(value, "levels") for name, value in found.items()},
                    costs={
                        "times opaque": Figure(min(frames) / min(opaque), "frames"),
                        "counted": Figure(float(fair.sum() / max((counted > 0.0).sum(), 1)), "of pixels"),
                    },
                    times={"frame": timing(frames, 1.0, FRAME, window.clock_name)},
                    ours=True,
                    default=transparency == "all",
                )
    finally:
        window.release()
    if late:
        options.leave_out(f"{subject.name}: {', '.join(late)}", LATE)
    options.log(f"translucency: {subject.name}: {time.perf_counter() - begun:.0f} s")


STUDY = Study(
    name="translucency",
    title="Lines seen through each other",
    approximates="All lines of a pixel, sorted by depth and blended one by one.",
    axes=(Axes("opacity", "times/frame", "errors/rms", "ms per frame", "rms error, levels of 255"),),
    notes=(
        "PyVista windows, all of VTK's work included; the camera turns by 1.14° between frames. *all*: the nearest "
        "line as it is, the others in slices by how far behind it they are. *layers*: so many of the nearest lines, "
        "sorted. "
        "*times opaque*: beside a frame of the same window with opacity 1.",
        "The reference are 64 layers, sorted exactly. Errors are root mean squares over the pixels that hold 64 lines "
        "or fewer, so that it leaves none out; *counted* is their share of the pixels that show anything.",
    ),
    run=run,
)
