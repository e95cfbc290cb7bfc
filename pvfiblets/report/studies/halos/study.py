"""The study of halos: the errors and costs of samples, smooth edges and halos of finished pictures."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.errors import EngineError
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.halos.style import TABLE_SIZE

from ...drawing import run_parts
from ...record import FRAME, Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, clock_of, timing, turns_of
from ..codec.data_sets import DataSet, file_sets, synthetic_tracking
from ..culling.flights import Flight
from .drawing import Drawing, FibletHalos, Strips
from .exact import Crossings, crossings, gaps, pixel_errors
from .pictures import Singles, differences, helices, look_of, orbit, picture
from .windows import beside_plain

if TYPE_CHECKING:
    import moderngl

    from ...cameras import Camera

SETS = ("fibres-subset", "office", "shape-small")  # of the paper's sizes; not in quick runs
STEP = 0.5  # mm, of the synthetic brain
SMALLEST = 1000  # points of a file
QUICK_POINTS = 20_000
FILES = 3  # the largest
SIZE, QUICK_SIZE = (812, 600), (320, 240)
EXACT_SIZE, QUICK_EXACT_SIZE = (320, 240), (120, 90)
HELICES, QUICK_HELICES = 30, 6
FRAMES, QUICK_FRAMES = 3, 1  # of a flight
REFERENCE = 8  # samples along a pixel's side
GRIDS, QUICK_GRIDS = (2, 3, 4), (2,)  # samples along a pixel's side, besides one
SMOOTH, HARD, UNCULLED, FIBLETS = "smooth edges", "black or white", "smooth, not culled", "halos of fiblets"


@dataclass(frozen=True)
class Variant:
    """A variant of drawing halos, with so many samples along a pixel's side."""

    name: str
    times: int

    @property
    def setting(self) -> str:
        """Number of samples of a pixel."""
        return samples(self.times)

    @property
    def default(self) -> bool:
        """Whether it is what the program does unasked."""
        return self.name == SMOOTH and self.times == 1

    def look(self, look: HaloStyle) -> HaloStyle:
        """Return a look as this variant has it."""
        return replace(look, smooth=self.name != HARD)

    def drawing(self, ctx: moderngl.Context, scene: Scene) -> Drawing:
        """Make what draws."""
        if self.name == FIBLETS:
            from pvfiblets.report.studies.codec.coded import compress

            assert scene.tractogram is not None
            return FibletHalos(ctx, compress(scene.tractogram.streamlines), self.times)
        return Strips(ctx, scene.drawn, self.times, None if self.name == UNCULLED else "two-phase")


def samples(times: int) -> str:
    """Return how many samples a pixel has."""
    return "1 sample" if times == 1 else f"{times**2} samples"


def variants(quick: bool, tractogram: bool) -> list[Variant]:
    """Return all variants, the most important first: where time runs out, the last are left out."""
    grids = QUICK_GRIDS if quick else GRIDS
    found = [Variant(SMOOTH, 1), Variant(HARD, 1)]
    found += [Variant(FIBLETS, times) for times in ((1,) if quick else (1, 2)) if tractogram]
    return found + [Variant(UNCULLED, 1)] + [Variant(name, times) for times in grids for name in (SMOOTH, HARD)]


@dataclass(frozen=True, eq=False)
class Scene:
    """Something with halos, and a flight around it; ``group`` as in :class:`.Record`."""

    name: str
    group: str
    drawn: HaloLines | HaloPoints
    look: HaloStyle
    path: list[Camera]
    tractogram: DataSet | None = None


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every scene and variant."""
    return run_parts({_exact: 1.0, _gaps: 1.0, _all_pictures: 6.0}, options, {beside_plain: 2.0})

def _all_pictures(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    for scene in scenes(options):
        yield from _pictures(ctx, scene, options)


def scenes(options: Options) -> Iterator[Scene]:
    """Make or read one set after the other, and fly around each."""
    points = min(options.points, QUICK_POINTS) if options.quick else options.points
    streamlines = synthetic_tracking(STEP, False, points, options.seed)
    yield _tractogram(DataSet(f"brain, {STEP:g} mm", "tractograms", streamlines), options)
    if not options.quick:
        from pvfiblets.synthetic.halos import halo_set

        for name in SETS:
            drawn = halo_set(name, options.seed)
            yield Scene(name, "sets", drawn, look_of(drawn), _path(drawn, options))
    for number, data in enumerate(file_sets(options, points)):
        if number == (1 if options.quick else FILES):
            options.leave_out("smaller files", "the largest are enough to see what halos are off by")
            return
        yield _tractogram(replace(data, group=data.group and "tractograms"), options)


def _path(drawn: HaloLines | HaloPoints, options: Options) -> list[Camera]:
    frames, size = (QUICK_FRAMES, QUICK_SIZE) if options.quick else (FRAMES, SIZE)
    return orbit(drawn, 1, frames, size)[0]


def _tractogram(data: DataSet, options: Options) -> Scene:
    lines = HaloLines(data.streamlines.points, data.streamlines.offsets)
    look = look_of(lines, n_tapered=0, width_cue=0.0)
    edge = look.line_width / look.strip_width
    table = np.clip((np.linspace(0.0, 1.0, TABLE_SIZE) - edge) / (1.0 - edge), 0.0, 1.0)
    look = replace(look, displacement=tuple(table.tolist()))
    return Scene(data.name, data.group, lines, look, _path(lines, options), data)


def _record(scene: tuple[str, str], variant: Variant, **more: Any) -> Record:
    return Record(
        data=scene[0],
        group=scene[1],
        approximation="pictures with halos",
        method=variant.name,
        setting=variant.setting,
        **{"ours": True, "default": variant.default, **more},
    )


# ------------------------------------------------------------------------------------- pictures of many lines or points


def _percent(found: dict[str, float]) -> dict[str, Figure]:
    names = {"wrong": "off by 1/4"}
    return {names.get(name, name): Figure(100.0 * value, "%") for name, value in found.items()}


def _pictures(ctx: moderngl.Context, scene: Scene, options: Options) -> Iterator[Record]:
    """Compare pictures with finely sampled ones."""
    compared = Comparison(scene.name, options, turns_of(ctx), len(scene.path) - 1)
    truth: list[Singles] | None = None
    with ExitStack() as stack:
        others = variants(options.quick, scene.tractogram is not None)
        for variant in [Variant(HARD, REFERENCE), *others, Variant(SMOOTH, REFERENCE)]:
            label = f"{variant.name} ({variant.setting})"
            if (truth is None and variant.times != REFERENCE) or not compared.allows(label):
                continue
            try:
                if variant.times == REFERENCE:
                    found, seconds, clock = _finely(ctx, scene, variant)
                    truth = truth or found
                    times = {"draw": timing([seconds], len(found), FRAME, clock)}
                    record = _record((scene.name, scene.group), variant, errors={}, times=times)
                    calls: dict[str, Flight] = {}
                else:
                    found, record, calls = _measured(ctx, scene, variant, stack)
                record.errors = _percent(differences(found, truth or found))
                compared.add(record, **calls)
            except (EngineError, ValueError) as error:
                compared.refuse(label, error)
        yield from compared.finish()


def _finely(ctx: moderngl.Context, scene: Scene, variant: Variant) -> tuple[list[Singles], float, str]:
    """Draw with many samples; return pictures, and how many seconds they took together."""
    clock, name = clock_of(ctx)
    strips = Strips(ctx, scene.drawn)
    try:
        begun = clock()
        found = [picture(strips.renderer, camera, variant.look(scene.look), variant.times) for camera in scene.path[1:]]
        return found, clock() - begun, name
    finally:
        strips.release()


def _measured(
    ctx: moderngl.Context, scene: Scene, variant: Variant, stack: ExitStack
) -> tuple[list[Singles], Record, dict[str, Flight]]:
    """Draw in one variant; return pictures, a record without errors, and the flight that is to be timed."""
    drawing = variant.drawing(ctx, scene)
    stack.callback(drawing.release)
    flight = Flight(ctx, drawing, scene.path, variant.look(scene.look))
    found = flight.pictures(drawing.read)
    costs = {"memory": Figure(drawing.nbytes / max(scene.drawn.n_points, 1), "bytes/point")}
    record = _record((scene.name, scene.group), variant, errors={}, costs=costs)
    return found, record, {"draw": flight}


# ------------------------------------------------------------------------------------------- what pictures should show


def _exact(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Compare pictures of one sample a pixel with the float64 reference."""
    from .reference import picture as reference

    count, size = (QUICK_HELICES, QUICK_EXACT_SIZE) if options.quick else (HELICES, EXACT_SIZE)
    name, drawn = f"{count} helices", helices(count)
    if not options.allows(f"{name}: everything"):
        return
    look, path = look_of(drawn), orbit(drawn, 1, 1, size)[0]
    camera = path[1]
    for variant in (Variant(SMOOTH, 1), Variant(HARD, 1)):  # the reference of one stands for both
        chosen = variant.look(look)
        begun = time.process_time()
        truth = reference(drawn, chosen, camera.model_view_projection, size)
        seconds = time.process_time() - begun
        strips, turns = Strips(ctx, drawn), turns_of(ctx)
        try:
            flight = Flight(ctx, strips, path, chosen)
            flight.pictures(strips.read)
            buffer = strips.render(camera, chosen)
            errors = pixel_errors(buffer, strips.read(buffer), truth, camera)
            turns.add(flight)
            turns.run(options.repeats, options.budget.allows)
        finally:
            strips.release()
        yield _record((name, "helices"), variant, errors=errors, times={"draw": turns.timing(0, 1, FRAME)})
        if variant.name == HARD:
            continue
        yield _record(
            (name, "helices"),
            Variant("float64 reference", 1),
            errors={key: Figure(0.0, figure.unit) for key, figure in errors.items()},
            times={"draw": timing([seconds], 1, FRAME, "cpu")},
            ours=False,
        )
    options.log(f"halos: {name}: 2 variants")


def _gaps(ctx: moderngl.Context, options: Options) -> Iterator[Record]:
    """Compare the gaps at crossings with the paper's formula."""
    made: Crossings = crossings()
    # The same picture would not be drawn again: the camera moves to and fro by a thousandth of a pixel.
    aside = replace(made, model_view_projection=_moved(made, 1e-3))
    compared = Comparison("crossings", options, turns_of(ctx))
    with ExitStack() as stack:
        for variant in (variant for variant in variants(options.quick, False) if variant.name != UNCULLED):
            if not compared.allows(f"{variant.name} ({variant.setting})"):
                continue
            strips = Strips(ctx, made.lines, variant.times)
            stack.callback(strips.release)
            flight = Flight(ctx, strips, [aside, made], variant.look(made.look))
            (found,) = flight.pictures(strips.read)
            record = _record(("crossings", "crossings"), variant, errors=gaps(found, made))
            compared.add(record, draw=flight)
        yield from compared.finish()


def _moved(made: Crossings, pixels: float) -> Any:
    matrix = made.model_view_projection.copy()
    matrix[0, 3] += 2.0 * pixels / made.size[0]
    return matrix


STUDY = Study(
    name="halos",
    title="Depth-dependent halos",
    approximates=(
        "Pictures of lines and points with halos, by finite samples: edges that are as jagged as pixels, or blended "
        "over one; beside it, halos that finished pictures of fiblets are given, and a float64 reference of each pixel."
    ),
    axes=(
        Axes("mean", "times/draw", "errors/mean", "ms per frame", "mean difference of pixels, %"),
        Axes("wrong", "times/draw", "errors/off by 1/4", "ms per frame", "pixels off by more than 1/4, %"),
        Axes("kind", "times/draw", "errors/kind", "ms per frame", "line, halo or nothing mistaken, %"),
        Axes("depth", "times/draw", "errors/depth", "ms per frame", "depth, 99th percentile, mm"),
        Axes("gap", "times/draw", "errors/gap", "ms per frame", "width of a gap, mean error, px"),
    ),
    notes=(
        "Black lines and points in white halos. *mean*, *rms*, *p99*, *max*: differences of pixels from a picture of "
        "64 samples a pixel, all black or white, in percent of the difference between both; *off by 1/4*: share of "
        "pixels that are farther off. It is among the variants, with errors of 0 and the time of one drawing, "
        "averages included; what *smooth edges* of 64 samples are off by is how far it may be off itself.",
        "*smooth edges*: a line turns into its own halo over a pixel, the default; *black or white*: without. A line "
        "that ends at another's halo ends at a pixel in both. *not culled*: as Everts et al. 2009 have it; culling "
        "begins at 16,000 segments and changes no pixel. *halos of fiblets*: compressed streamlines, each a tube a "
        "pixel wide at least, whose finished picture is given halos at each pixel; ends are round, and of what cannot "
        "be seen there are none. On tractograms lines have the look that both have: no tapered ends, one width, "
        "and halos that begin to go back at the line's edge.",
        "*helices*: compared with the float64 reference of what each pixel shows, one sample a pixel, which is among "
        "the variants with its time on the CPU. *kind*: pixels that show line, halo or nothing where it is another of "
        "these, percent of all; *depth*: the 99th percentile, mm along the view axis, where both show the same kind. "
        "*crossings*: lines in front of others that lie 1 to 9 mm behind; *gap*: how far the white on either side of "
        "a crossing is from appendix A's width, pixels, mean and greatest.",
        "The camera turns by 1.14° between frames. Pictures are of the engine without VTK, each waited for. Where "
        "OpenGL is software, times are the processor time of all its threads; on a graphics card they are elapsed. "
        "*memory*: the part that grows with the data. "
        "*fibres-subset*, *office* and *shape-small* (points) are synthetic, of "
        "sizes in the paper's table 1; tractograms are cut by leaving streamlines out evenly, which their names say.",
        "*in a window*: all sets of the paper's table 1 in PyVista windows, seen from six places, beside VTK's plain "
        "lines of one pixel, or plain points of the same size.",
    ),
    run=run,
)
