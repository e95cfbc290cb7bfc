"""Lines and points with halos for the engine's tests: scenes, pictures read back, and what every pixel must show."""

from typing import NamedTuple

import numpy as np

from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
from pvfiblets.halos import HaloLines, HaloPoints, HaloStyle
from pvfiblets.report.studies.halos.reference import HALO, LINE, NOTHING, picture

from .pictures import EMPTY, unpacked_tangent

SIZE = (120, 90)

EYES = {
    "perspective": {"eye": (3, -62, 14), "near": 10.0, "far": 200.0, "angle": 42.0},
    "parallel": {"eye": (3, -62, 14), "near": 10.0, "far": 200.0, "height": 46.0},
}
"""Cameras that see all that is within 15 mm of 0."""

ABOVE = {
    kind: {**more, "eye": (0, 0, 60), "up": (0, 1, 0)}
    for kind, more in (
        ("perspective", {"near": 10.0, "far": 200.0, "angle": 30.0}),
        ("parallel", {"near": 10.0, "far": 200.0, "height": 32.0}),
    )
}
"""Cameras that look along -z, with y up; z = 0 is as large in both, but for a part in a thousand."""

PLAIN = {"n_tapered": 0, "min_width": 0.0}
"""Square ends, and no line wider than it is."""


def look(**more):
    """A look that suits :func:`wandering`: strips of some pixels, halos that hide some of what is behind them."""
    return HaloStyle(**({"line_width": 1.0, "strip_width": 4.0, "max_displacement": 2.5} | more))


def styled(values=None, **more):
    """The same look with a style around it."""
    return HaloDrawStyle(look=look(**more), values=values)


# ------------------------------------------------------------------------------------------------------------ scenes


def of_lines(*lines, **values):
    """Lines of several vertices each, with values at all of them."""
    points = np.concatenate([np.reshape(line, (-1, 3)) for line in lines]).astype(float)
    return HaloLines(points, np.cumsum([0, *map(len, lines)]), {k: np.asarray(v) for k, v in values.items()})


def wandering(n=8, m=7, seed=0, *, wander=0.05, step=4.0, spread=10.0):
    """Lines of a step of 4 mm about 0, with numbers and colours; few of their bends are sharp up to a wander of 0.1."""
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(n):
        d = rng.normal(0, 1, 3) + np.cumsum(rng.normal(0, wander, (m, 3)), axis=0)
        places = np.cumsum(step * d / np.linalg.norm(d, axis=1)[:, None], axis=0)
        lines.append(places - places.mean(axis=0) + rng.uniform(-spread, spread, 3))
    return of_lines(*lines, **values_at_random(n * m, rng))


def zigzag(n=8, m=9, seed=0, step=4.0):
    """Lines that turn at random."""
    return wandering(n, m, seed, wander=3.0, step=step)


def scattered(n=60, seed=0, spread=14.0):
    """Points within a box, with numbers and colours."""
    rng = np.random.default_rng(seed)
    return HaloPoints(rng.uniform(-spread, spread, (n, 3)), values_at_random(n, rng))


def values_at_random(n, rng):
    return {"number": rng.uniform(0, 1, n), "colour": rng.uniform(0.1, 0.9, (n, 4)).astype(np.float32)}


def with_numbers(drawn, numbers):
    """The same with other numbers, named n."""
    if isinstance(drawn, HaloPoints):
        return HaloPoints(drawn.points, {"n": numbers})
    return HaloLines(drawn.points, drawn.offsets, {"n": numbers})


def moved(drawn, scale=1.0, shift=0.0):
    """The same elsewhere."""
    if isinstance(drawn, HaloPoints):
        return HaloPoints(drawn.points * scale + shift, drawn.values)
    return HaloLines(drawn.points * scale + shift, drawn.offsets, drawn.values)


# ---------------------------------------------------------------------------------------------------------- pictures


class HaloPicture(NamedTuple):
    """What a G-buffer shows, row 0 at the bottom."""

    kind: np.ndarray  # (h, w) NOTHING, LINE, HALO
    depth: np.ndarray  # (h, w) window depth
    owner: np.ndarray  # (h, w) -1 where no line is
    line: np.ndarray
    tangent: np.ndarray  # (h, w, 3)
    place: np.ndarray  # (h, w) within the line
    value: np.ndarray
    ink: np.ndarray
    colour: np.ndarray | None  # (h, w, 4) 0..1

    @property
    def shown(self):
        """(h, w) whether there is anything."""
        return self.kind != NOTHING


def read_halos(gbuffer):
    """Read all textures."""
    w, h = gbuffer.size
    get = lambda texture, dtype: np.frombuffer(texture.read(), dtype).reshape(h, w, -1)  # noqa: E731
    key, owner = get(gbuffer.depth, "<u4")[..., 0], get(gbuffer.owner, "<u4")[..., 0]
    drawn = key != EMPTY
    ids = get(gbuffer.ids, "<u4")
    # What is not drawn is undefined: on some drivers no number.
    position = np.where(drawn[..., None], get(gbuffer.position, "<f4"), 0.0).astype(float)
    ink = np.where(drawn, get(gbuffer.across, "<f2")[..., 0], 0.0).astype(float)
    assert gbuffer.relief == "ink"
    assert (owner[~drawn] == EMPTY).all()
    assert np.isfinite(position[drawn][:, 0]).all()
    assert ((ink >= 0) & (ink <= 1))[drawn].all()
    kind = np.where(drawn, np.where(owner != EMPTY, LINE, HALO), NOTHING)
    colour = None if gbuffer.colours is None else get(gbuffer.colours, "u1") / 255.0
    return HaloPicture(
        kind, np.where(drawn, key / 4294967296.0, 1.0), np.where(kind == LINE, owner.astype(np.int64), -1),
        ids[..., 0].astype(np.int64), unpacked_tangent(ids[..., 1]), position[..., 0], position[..., 1],
        np.where(drawn, ink, 0.0), colour,
    )  # fmt: skip


def buffers(renderer):
    """Bytes of all buffers, by name."""
    return {buffer["name"]: buffer["bytes"] for buffer in renderer.explain()["buffers"]}


def draw_halos(gl, drawn, view, look, *, values=None, **options):
    """Draw one picture with a renderer of its own."""
    renderer = HaloRenderer(gl, drawn, **options)
    try:
        return read_halos(renderer.render(view, HaloDrawStyle(look=look, values=values)))
    finally:
        renderer.release()


def assert_same(a, b):
    """Every bit of two pictures where anything shows."""
    assert (a.kind == b.kind).all()
    for name in HaloPicture._fields:
        one, other = getattr(a, name), getattr(b, name)
        if one is None or other is None:
            assert one is other
            continue
        where = a.kind == LINE if name in ("owner", "line", "tangent", "place", "value", "colour") else a.shown
        assert np.array_equal(one[where], other[where], equal_nan=True), name


# -------------------------------------------------------------------------------------------------------- comparisons


def assert_shows(found, drawn, view, look, *, near=0.03, depth=1e-6, least=0.6, wrong=0):
    """Hold a picture against the reference, where that is sure of a pixel; return the reference's, and where it is.

    `near` is in pixels and `depth` in window depth: within these of an edge, and of each other, rounding decides. At
    least a share of `least` of what shows must be surer than that, and of that as many pixels as `wrong` may be.
    Without exception, what is farther within a strip than `near` is not empty.
    """
    wanted = picture(drawn, look, view.model_view_projection, view.size, clip_planes=view.clip_planes)
    assert found.shown[wanted.cover > near].all(), f"holes at {np.argwhere(~found.shown & (wanted.cover > near))[:5]}"
    sure = (wanted.margin > near) & (wanted.other > depth)
    shown = (wanted.kind != NOTHING) | found.shown
    assert (sure & shown).sum() >= least * shown.sum()
    different = sure & (found.kind != wanted.kind)
    assert different.sum() <= wrong, f"{different.sum()} of {(sure & shown).sum()}, as {np.argwhere(different)[:5]}"
    both = sure & ~different & shown
    assert (np.abs(found.depth - wanted.depth) > depth)[both].sum() <= wrong
    one = both & (wanted.kind == LINE) & (wanted.gap > depth)
    assert (found.owner != wanted.owner)[one].sum() <= wrong
    return wanted, both


def equation_4(away, look):
    """Width of the halo of a line on another one that crosses so far behind it (appendix A), with its signs set right.

    The paper's second and third case have line and strip the wrong way round.
    """
    least = look.line_width * look.max_displacement / look.strip_width
    among = (look.strip_width * away / look.max_displacement - look.line_width) / 2
    return np.where(away <= least, 0.0, np.minimum(among, (look.strip_width - look.line_width) / 2))
