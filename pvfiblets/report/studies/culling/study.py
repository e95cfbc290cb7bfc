"""The study of culling: fiblets culled because they are hidden or small, and the time saved."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.codec.editing.restrict import restrict
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.errors import EngineError

from ...drawing import drawing_context
from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, turns_of
from ..codec.data_sets import file_sets
from .flights import Flight
from .pictures import Singles, Visible, averaged, colours, difference, errors, views, visible

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet


SEGMENTS = 12_000_000  # of the synthetic brain
QUICK_SEGMENTS = 500_000
STEP = 0.1  # mm
FILE_POINTS = 4_000_000  # to which files are cut
QUICK_FILE_POINTS = 500_000
FILES = 3  # the largest
SIZE, QUICK_SIZE = (1280, 720), (640, 360)
FRAMES, QUICK_FRAMES = 4, 2  # of a flight
STILL = 0.001  # degrees: if nothing moved at all, nothing would be drawn again
SLOW = 1.14  # degrees a frame: Schertzer et al. 2022, section 4.5, 90 degrees a second at 80 frames
FLIGHTS = (("far", STILL), ("far", SLOW), ("far", 10.0), ("far", 60.0), ("close", SLOW), ("inside", SLOW))
QUICK_FLIGHTS = (("far", SLOW), ("inside", SLOW))
TOLERANCES = (0.25, 1.0, 2.0, 4.0)  # pixels, besides 0 and the default
QUICK_TOLERANCES = (2.0,)
HALF = 0.5  # pixels, as in the paper; the default draws every point
SHARES = (2, 4)  # every second, every fourth streamline
FINE = 3  # samples along a pixel's side of the finely sampled picture


@dataclass(frozen=True)
class Variant:
    """One variant of drawing less: a kind of culling, pixels of tolerance, and how many streamlines one is drawn of."""

    culling: str | None
    tolerance: float
    of: int = 1

    @property
    def name(self) -> str:
        """The method."""
        return "fewer streamlines" if self.of > 1 else self.culling or "none"

    @property
    def setting(self) -> str:
        """With what."""
        return f"1 of {self.of}" if self.of > 1 else detail(self.tolerance)

    @property
    def default(self) -> bool:
        """Whether it is what the program does unasked."""
        return self.of == 1 and self.culling == "auto" and self.tolerance == FibletStyle.tolerance


def detail(tolerance: float) -> str:
    """Return the pixels of error within which points are left out, in words."""
    return f"{tolerance:g} px" if tolerance else "every point"


def variants(quick: bool) -> list[Variant]:
    """Return all variants, the most important first: where time runs out, the last are left out."""
    found = [Variant(culling, 0.0) for culling in ("auto", None, "two-phase", "coverage")]
    found += [Variant(culling, HALF) for culling in (None, "two-phase", "coverage")]
    found += [Variant("two-phase", HALF, of) for of in (SHARES[:1] if quick else SHARES)]
    return found + [Variant("two-phase", tolerance) for tolerance in (QUICK_TOLERANCES if quick else TOLERANCES)]


@dataclass(frozen=True)
class Scene:
    """Fiblets and a flight around them; ``group`` as in :class:`.Record`."""

    name: str
    group: str
    fiblets: FibletSet
    path: list[View]


class _Basis:
    """Reference pictures, each drawn once: right ones, and means of several samples a pixel."""

    def __init__(self, ctx: moderngl.Context, scene: Scene) -> None:
        self._ctx, self._scene = ctx, scene
        self._plain: dict[float, list[Visible]] = {}
        self.coloured = [colours(picture) for picture in self.plain(0.0)]
        self.fine = [self._fine(view) for view in scene.path[1:]]

    def plain(self, tolerance: float) -> list[Visible]:
        """Return the pictures without culling, at some level of detail."""
        if tolerance not in self._plain:
            renderer = FibletRenderer(self._ctx, self._scene.fiblets, culling=None)
            try:
                flight = Flight(self._ctx, renderer, self._scene.path, FibletStyle(tolerance=tolerance))
                self._plain[tolerance] = flight.pictures(visible)
            finally:
                renderer.release()
        return self._plain[tolerance]

    def _fine(self, view: View) -> Singles:
        renderer = FibletRenderer(self._ctx, self._scene.fiblets, culling=None)
        size = (FINE * view.size[0], FINE * view.size[1])
        try:
            style = FibletStyle(tolerance=0.0, line_width=float(FINE))
            picture = visible(renderer.render(View(size, view.model_view_projection), style))
        finally:
            renderer.release()
        return averaged(colours(picture), FINE)


def _measured(ctx: moderngl.Context, scene: Scene, options: Options) -> Iterator[Record]:
    compared = Comparison(scene.name, options, turns_of(ctx), len(scene.path) - 1)
    with ExitStack() as stack:
        basis: _Basis | None = None
        for variant in variants(options.quick):
            label = f"{variant.name} ({variant.setting})"
            if not compared.allows(label):
                continue
            try:
                basis = basis or _Basis(ctx, scene)
                record, flight = measured(ctx, scene, variant, basis, stack)
                compared.add(record, draw=flight)
            except EngineError as error:
                compared.refuse(label, error)
        yield from compared.finish()


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every scene and variant."""
    with drawing_context(options) as ctx:
        for scene in scenes(options):
            yield from _measured(ctx, scene, options)

def scenes(options: Options) -> Iterator[Scene]:
    """Make or read one set after the other, and fly around each."""
    from pvfiblets.synthetic import brain as synthetic_brain
    from pvfiblets.synthetic import streamline_count

    size = QUICK_SIZE if options.quick else SIZE
    frames = QUICK_FRAMES if options.quick else FRAMES
    count = streamline_count(QUICK_SEGMENTS if options.quick else SEGMENTS, STEP)
    brain = synthetic_brain(count, STEP, options.seed)
    for kind, degrees in QUICK_FLIGHTS if options.quick else FLIGHTS:
        turn = "still" if degrees == STILL else f"{degrees:g}° a frame"
        path = views(brain.bounds, kind, degrees, frames + 1, size)
        yield Scene(f"brain, {kind}, {turn}", "brain", brain, path)
    del brain
    from pvfiblets.report.studies.codec.coded import compress

    limit = QUICK_FILE_POINTS if options.quick else FILE_POINTS
    for number, data in enumerate(file_sets(options, limit)):
        if number == (1 if options.quick else FILES):
            options.leave_out("smaller files", "the largest are enough to see what culling does")
            return
        try:
            fiblets = compress(data.streamlines)
        except ValueError as error:
            options.leave_out(data.name, str(error))
            continue
        path = views(fiblets.bounds, "far", SLOW, frames + 1, size)
        yield Scene(data.name, data.group, fiblets, path)


def measured(
    ctx: moderngl.Context, scene: Scene, variant: Variant, basis: _Basis, stack: ExitStack
) -> tuple[Record, Flight]:
    """Draw by one variant; return a record of errors, and the flight that is to be timed."""
    fiblets = scene.fiblets
    if variant.of > 1:
        fiblets = restrict(fiblets, np.arange(0, fiblets.n_streamlines, variant.of))
    renderer = FibletRenderer(ctx, fiblets, culling=variant.culling)
    stack.callback(renderer.release)
    flight = Flight(ctx, renderer, scene.path, FibletStyle(tolerance=variant.tolerance))
    pictures = flight.pictures(visible)
    report: dict[str, Any] = renderer.explain()
    found = errors(pictures, basis.plain(0.0))
    coloured = [colours(picture) for picture in pictures]
    found |= {"colour": difference(coloured, basis.coloured), "fine": difference(coloured, basis.fine)}
    if variant.of == 1:
        found["wrong by culling"] = errors(pictures, basis.plain(variant.tolerance))["wrong"]
    costs = {"memory": Figure(sum(buffer["bytes"] for buffer in report["buffers"]) / 1e6, "MB")}
    drawn = report["fiblets"]["drawn"]
    if drawn is not None:
        costs["drawn"] = Figure(100.0 * drawn / max(scene.fiblets.n_fiblets, 1), "%")
    record = Record(
        data=scene.name,
        group=scene.group,
        approximation="pictures of fiblets",
        method=variant.name,
        setting=variant.setting,
        errors=found,
        costs=costs,
        ours=variant.of == 1,
        default=variant.default,
    )
    return record, flight


STUDY = Study(
    name="culling",
    title="Culling and level of detail",
    approximates=(
        "Pictures of all fiblets and all their points, by drawing less: fiblets that others hide are left out, far "
        "ones are drawn as one segment; beside it, what many viewers do, which is to draw fewer streamlines."
    ),
    axes=(
        Axes("wrong", "times/draw", "errors/wrong", "ms per frame", "pixels of another streamline, %"),
        Axes("colour", "times/draw", "errors/colour", "ms per frame", "mean difference of colours, %"),
        Axes("fine", "times/draw", "errors/fine", "ms per frame", "difference to a fine picture, %"),
        Axes("culled", "times/draw", "errors/wrong by culling", "ms per frame", "pixels changed by culling, %"),
    ),
    notes=(
        "The right picture draws every point of every fiblet in the view volume. *wrong*: pixels that show another "
        "streamline than the right picture, a line where it has none, or none where it has one, as a share of its "
        "covered pixels; *coverage*: only the latter two; *colour*: the difference of the colours of directions, with "
        "black where nothing is; *fine*: the same from a picture of 3×3 samples a pixel, averaged: lines are thinner "
        "than the space between them, so chance decides which line a pixel shows; this is the error of the right "
        "picture itself. *wrong by culling*: as *wrong*, from the picture of the same level of detail without "
        "culling, which isolates the effect of culling.",
        "*none*: only fiblets outside the view volume are left out. *two-phase*: fiblets hidden in the same picture "
        "are left out, which changes no pixel. *coverage*: fiblets hidden in the last picture, as in Schertzer et al. "
        "2022, section 3.4. *auto*, the default: two-phase while it is the faster one. The setting is the level of "
        "detail: a fiblet whose points all lie so near to the segment between its ends is drawn as that segment "
        "(section 3.4.4); *every point* turns it off. *fewer streamlines*: one of two or four, two-phase.",
        "Names of data say where the eye is and how far it turns between frames: *far*, from where the whole set fits "
        "the picture; *close*, a third of that; *inside*, near the middle. Every frame is one step from the one "
        "before. Files are seen from far, by 1.14° a frame. Pictures are of the engine without VTK, each waited for. "
        "Where OpenGL is software, times are the processor time of all its threads; on a graphics card they are "
        "elapsed. *memory*: all buffers and textures on the GPU, those of the picture included; *drawn*: fiblets that "
        "neither the view volume nor culling leaves out, of all.",
    ),
    run=run,
)
