"""The card's check of fiblets: all features of one pipeline, beside float64."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from pvfiblets.engine.view import View

from ..culling.pictures import views
from .findings import EMPTY
from .lines import LineSamples, Shown, shown
from .scenes import SIZE, SMALL, Judged, Scene, share

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource
    from pvfiblets.engine.fiblets.renderer import FibletRenderer
    from pvfiblets.engine.gbuffer import GBuffer

STREAMLINES, STEP = 400, 1.0  # of the synthetic brain, mm
DEGREES = 3.0  # from picture to picture
PICTURES = 4
WRONG = 0.004  # of the pixels that show lines: rounding may move an end into another pixel
LOST_FOR_A_FRAME = 0.02  # what the paper's culling may lose while the camera turns
BENT = 0.02  # pixels at bends, where wide lines show the next segment
COUNTED = 0.02  # pixels whose number of lines differs by one
WIDTH, RADIUS = 5.0, 1.5  # pixels, mm
PLANE = np.array([[0.6, 0.0, 0.8, 3.0]])
LAYERS = 4

Array = npt.NDArray[np.float64]


class Brain(NamedTuple):
    """The drawn fiblets, and their points as decoded on the CPU."""

    fiblets: FibletSet
    lines: list[Array]
    arc_length: list[Array]
    height: list[Array]
    z: list[Array]


@cache
def brain() -> Brain:
    """Make a small synthetic brain with a per-point array ``'height'``."""
    from pvfiblets.codec.encoding.compress import compress
    from pvfiblets.synthetic import brain_streamlines

    made = brain_streamlines(STREAMLINES, step=STEP, seed=7)
    made.per_point = {"height": made.points[:, 2].copy()}
    fiblets = compress(made, per_point=("height",))
    decoded = fiblets.decompress(dtype=np.float64)
    lines = [np.asarray(line, np.float64) for line in decoded]
    arcs = [np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))] for line in lines]
    stored = np.split(np.asarray(decoded.per_point["height"], np.float64).ravel(), np.asarray(decoded.offsets)[1:-1])
    return Brain(fiblets, lines, arcs, stored, [line[:, 2] for line in lines])


def fiblets_part(ctx: moderngl.Context, pipeline: str) -> Iterator[tuple[str, Callable[[], Scene]]]:
    """Yield every feature of a pipeline."""
    scene = partial(_lines, ctx, pipeline)
    for culling in ("none", "two-phase", "coverage"):
        limits = {"lost": LOST_FOR_A_FRAME} if culling == "coverage" else {}
        yield f"thin lines, culling {culling}", partial(scene, culling=culling, limits=limits)
    yield "thin lines, from inside", partial(scene, kind="inside")
    yield f"wide lines, {WIDTH:g} pixels", partial(scene, style={"line_width": WIDTH}, width=WIDTH)
    yield "level of detail of half a pixel", partial(scene, style={"tolerance": 0.5}, width=2.0)
    yield "cut by a plane", partial(scene, view={"clip_planes": PLANE}, keep=_above)
    yield "cut by a sphere", partial(scene, region=True, keep=_in_sphere)
    yield "half of the streamlines", partial(scene, half=True)
    yield "values: arc length", partial(scene, style={"values": "arc_length"}, values="arc_length")
    yield "values: stored", partial(scene, style={"values": "height"}, values="height")
    yield "values: a volume's", partial(scene, volume=True, values="z")
    yield f"tubes of {RADIUS:g} mm", partial(_tubes, ctx, pipeline)
    yield "lines counted", partial(_counted, ctx, pipeline)
    yield f"{LAYERS} layers", partial(_layers, ctx, pipeline)
    yield "streamlines in a sphere", partial(_query, ctx, pipeline)


def _renderer(ctx: moderngl.Context, pipeline: str, culling: str = "two-phase") -> FibletRenderer:
    from pvfiblets.engine.fiblets.renderer import FibletRenderer

    return FibletRenderer(ctx, brain().fiblets, pipeline=pipeline, culling=None if culling == "none" else culling)


def _middle() -> tuple[Array, float]:
    box = np.array(brain().fiblets.bounds, np.float64).reshape(3, 2)
    return box.mean(axis=1), 0.3 * float(np.ptp(box, axis=1).min())


def _in_sphere(points: Array) -> npt.NDArray[np.bool_]:
    middle, radius = _middle()
    return np.asarray(np.linalg.norm(points - middle, axis=1) <= radius)


def _above(points: Array) -> npt.NDArray[np.bool_]:
    return np.asarray(points @ PLANE[0, :3] + PLANE[0, 3] >= 0.0)


def _height_volume() -> VolumeSource:
    """Return a volume whose value is z everywhere in the brain."""
    from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource

    box = np.array(brain().fiblets.bounds, np.float64).reshape(3, 2)
    low, side, n = box[:, 0] - 1.0, box[:, 1] - box[:, 0] + 2.0, 24
    affine = np.diag([*(side / (n - 1)), 1.0])
    affine[:3, 3] = low
    heights = np.broadcast_to(low[2] + side[2] * np.linspace(0.0, 1.0, n), (n, n, n))
    return VolumeSource(np.ascontiguousarray(heights, np.float32), affine)


def _lines(
    ctx: moderngl.Context, pipeline: str, *, culling: str = "two-phase", kind: str = "far",
    style: dict[str, Any] | None = None,
    view: dict[str, Any] | None = None, width: float = 1.0, values: str | None = None, half: bool = False,
    volume: bool = False, region: bool = False, keep: Callable[[Array], Any] | None = None,
    limits: dict[str, float] | None = None,
) -> Scene:  # fmt: skip
    from pvfiblets import regions
    from pvfiblets.engine.fiblets.data.filter_textures import Filter
    from pvfiblets.engine.fiblets.style import FibletStyle

    about = brain()
    wanted = {"tolerance": 0.0, **(style or {}), **({"values": _height_volume()} if volume else {})}
    more = {**(view or {}), **({"region": regions.Sphere(*_middle())} if region else {})}
    path = [replace(one, **more) for one in views(about.fiblets.bounds, kind, DEGREES, PICTURES, SIZE)]
    renderer = _renderer(ctx, pipeline, culling)
    chosen = np.arange(len(about.lines)) % 2 == 0
    if half:
        renderer.filtering = Filter(streamlines=chosen)

    def draw(number: int) -> Any:
        return renderer.render(path[number], FibletStyle(**wanted))

    def judge(last: Any) -> Judged:
        numbers = np.flatnonzero(chosen) if half else np.arange(len(about.lines))
        along = getattr(about, values or "arc_length")
        samples = LineSamples.from_lines([about.lines[i] for i in numbers], [along[i] for i in numbers],
                                 path[PICTURES - 1].model_view_projection, SIZE, keep)  # fmt: skip
        samples = replace(samples, streamline=numbers[samples.streamline])
        picture = shown(last)
        return _judged(picture, samples.wrong(picture, width, values=values is not None), limits or {}, values)

    return Scene(draw, judge, renderer.release)


def _judged(picture: Shown, wrong: dict[str, Any], limits: dict[str, float], values: str | None) -> Judged:
    """Return shares of wrong pixels, and what to look at."""
    names = ["line", "lost", "direction", *(["value"] if values else [])]
    figures = {EMPTY: float(not picture.there.any()), **{name: share(wrong[name], picture.there) for name in names}}
    bad = np.any([wrong[name] for name in names], axis=0)
    colours = np.where(picture.there[..., None], np.abs(picture.direction), 0.0)
    pictures = {"drawn": (255.0 * colours).astype(np.uint8), "wrong": bad}
    return Judged(figures, {EMPTY: 0.0, **dict.fromkeys(names, WRONG), "direction": BENT, **limits}, pictures)


def _tubes(ctx: moderngl.Context, pipeline: str) -> Scene:
    """Few lines as tubes; a ray meets the capsules of their segments."""
    from pvfiblets.codec.editing.restrict import restrict
    from pvfiblets.engine.fiblets.renderer import FibletRenderer
    from pvfiblets.engine.fiblets.style import FibletStyle

    from ...cameras import orbit
    from .others import capsules_of, judge_depths

    few = np.arange(0, STREAMLINES, STREAMLINES // 4)
    fiblets = restrict(brain().fiblets, few)
    lines = [brain().lines[i] for i in few]
    tubes = capsules_of(lines, RADIUS)
    path = orbit(tubes, "far", 90, SMALL)[:PICTURES]
    renderer = FibletRenderer(ctx, fiblets, pipeline=pipeline)

    def draw(number: int) -> GBuffer:
        camera = path[number]
        style = FibletStyle(radius=RADIUS, tolerance=0.0, exact=True)
        return renderer.render(View(camera.size, camera.model_view_projection), style)

    return Scene(draw, lambda last: judge_depths(last, tubes, path[PICTURES - 1]), renderer.release)


def _counted(ctx: moderngl.Context, pipeline: str) -> Scene:
    from pvfiblets.engine.fiblets.style import FibletStyle

    from .counts import counted

    path = views(brain().fiblets.bounds, "far", DEGREES, PICTURES, SIZE)
    renderer = _renderer(ctx, pipeline)

    def draw(number: int) -> Any:
        return renderer.gather(path[number], FibletStyle(tolerance=0.0))

    def judge(last: Any) -> Judged:
        found = last.read()[0, ..., 3]
        right = counted(brain().lines, path[PICTURES - 1].model_view_projection, SIZE)
        there = right > 0
        figures = {EMPTY: float(not found.any()), "other number": share(found != right, there),
                   "by more than one": share(np.abs(found - right) > 1.0, there),
                   "of all": abs(float(found.sum() / max(right.sum(), 1.0)) - 1.0)}  # fmt: skip
        limits = {EMPTY: 0.0, "other number": COUNTED, "by more than one": 0.002, "of all": 0.002}
        return Judged(figures, limits, {"drawn": _grey(found), "right": _grey(right), "wrong": found != right})

    return Scene(draw, judge, renderer.release)


def _grey(numbers: Array) -> npt.NDArray[np.uint8]:
    scaled = 255.0 * numbers / max(float(numbers.max()), 1.0)
    return np.repeat(scaled.astype(np.uint8)[..., None], 3, axis=2)


def _layers(ctx: moderngl.Context, pipeline: str) -> Scene:
    """Each layer shows existing lines, behind the layer before."""
    from pvfiblets.engine.fiblets.style import FibletStyle
    from pvfiblets.engine.gbuffer import EMPTY as NO_KEY

    path = views(brain().fiblets.bounds, "far", DEGREES, PICTURES, SIZE)
    renderer = _renderer(ctx, pipeline)

    def draw(number: int) -> Any:
        return renderer.render_layers(path[number], FibletStyle(tolerance=0.0), LAYERS)

    def judge(last: Any) -> Judged:
        about, width, height = brain(), *SIZE
        samples = LineSamples.from_lines(about.lines, about.arc_length, path[PICTURES - 1].model_view_projection, SIZE)
        keys = np.frombuffer(last.depth.read(), np.uint32).reshape(LAYERS, height, width)
        ids = np.frombuffer(last.ids.read(), np.uint32).reshape(LAYERS, height, width, 2)
        wrong = np.zeros((height, width), bool)
        order = np.any(keys[1:] < keys[:-1], axis=0)
        for key, number in zip(keys, ids[..., 0], strict=True):
            there = key != NO_KEY
            blank = np.zeros((height, width))
            ways = np.broadcast_to([1.0, 0.0, 0.0], (height, width, 3))
            layer = Shown(there, key / float(NO_KEY), np.where(there, number, 0).astype(np.int64), ways, blank)
            wrong |= samples.wrong(layer)["line"]
        there = keys[0] != NO_KEY
        figures = {EMPTY: float(not (keys[-1] != NO_KEY).any()), "line": share(wrong, there),
                   "order": share(order, there)}  # fmt: skip
        return Judged(figures, {EMPTY: 0.0, "line": LAYERS * WRONG, "order": 0.0}, {"wrong": wrong | order})

    return Scene(draw, judge, renderer.release)


def _query(ctx: moderngl.Context, pipeline: str) -> Scene:
    """Compare streamlines that pass a sphere, or end in it, with the CPU's."""
    from pvfiblets import regions
    from pvfiblets.query.selection.passing import region_flags

    renderer, region = _renderer(ctx, pipeline), regions.Sphere(*_middle())

    def draw(_number: int) -> Any:
        return renderer.query(region)

    def judge(last: Any) -> Judged:
        other = np.asarray(last) != np.asarray(region_flags(brain().fiblets, region))
        return Judged({"streamlines": float(other.mean())}, {"streamlines": 0.0})

    return Scene(draw, judge, renderer.release)
