"""Spline tubes for the engine's tests: halves and rays at random, sets, and what every pixel must show, in float64."""

from typing import NamedTuple

import numpy as np

from pvfiblets.engine import View
from pvfiblets.engine.tubes import SILHOUETTES, TubeRenderer, TubeStyle
from pvfiblets.report.studies.tubes import reference
from pvfiblets.report.studies.tubes.reference import CAP, EXIT, MISS, surface_distance
from pvfiblets.tubes import NodeValues, SplineTubes
from pvfiblets.tubes.curves import MIDDLE, controls, derivative, evaluate

from .line_tubes import rays
from .pictures import EMPTY, unpacked_tangent

KINDS = {
    "thin": {"r": 0.02, "bend": 0.05},
    "usual": {"r": 0.1, "bend": 0.1},
    "bent": {"r": 0.1, "bend": 0.6},
    "thick": {"r": 2.0, "bend": 0.3},
    "blob": {"r": 20.0, "bend": 0.3, "vary": 0.1},
    "cone": {"r": 0.3, "bend": 0.1, "vary": 1.0},
    "needle": {"r": 0.001, "bend": 0.01},
}
"""Halves 1 mm long; radius and its change, and the sideways pull at the middle control point."""


EYE = {"eye": (3, -62, 14), "near": 20.0, "far": 120.0, "angle": 42.0}
"""A camera that sees all of a :func:`bundle`."""


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def halves(rng, n, *, r, bend, vary=0.3):
    """(n, 3, 4) control points."""
    found = np.zeros((n, 3, 4))
    found[:, 2, :3] = unit(rng.normal(size=(n, 3)))
    found[:, 1, :3] = 0.5 * found[:, 2, :3] + rng.normal(0, bend, (n, 3))
    found[:, :, 3] = r * (1 + vary * rng.uniform(-1, 1, (n, 3)))
    return found


def rays_past(rng, points, away=10.0):
    """Origins and directions of rays that pass near to a place of each half, most of them through it."""
    n = len(points)
    centre = evaluate(points, rng.uniform(0, 1, n))
    d = unit(rng.normal(size=(n, 3)))
    aside = rng.normal(size=(n, 3))
    aside = unit(aside - (aside * d).sum(1, keepdims=True) * d)
    o = centre[:, :3] + aside * centre[:, 3:] * np.sqrt(rng.uniform(0, 1.3, n))[:, None] - away * d
    return o, d


def grazing(points, o, d, part=1e-4, **limits):
    """Whether a ray is met or not by how thick the tube is to that part."""
    kinds = []
    for scale in (1 - part, 1 + part):
        changed = points.copy()
        changed[..., 3] *= scale
        kinds.append(reference.hits(changed, o, d, **limits).kind)
    return kinds[0] != kinds[1]


# -------------------------------------------------------------------------------------------------------------- sets


def bundle(n=6, m=6, seed=0, radius=1.8, spread=8.0, step=5.0, **more):
    """Wandering tubes of varying radius through nodes of a step of 5 mm, with numbers and colours at the nodes."""
    rng = np.random.default_rng(seed)
    d = unit(rng.normal(0, 1, (n, 1, 3)) + np.cumsum(rng.normal(0, 0.4, (n, m, 3)), axis=1))
    places = np.cumsum(step * d, axis=1)
    places += rng.uniform(-spread, spread, (n, 1, 3)) - places.mean(axis=1, keepdims=True)
    radii = radius * (1 + 0.5 * np.sin(np.arange(n * m)).reshape(n, m))
    numbers, colours = rng.normal(size=(n, m)), rng.uniform(0.2, 0.8, (n, m, 4))
    index = np.arange(n * m).reshape(n, m)
    return SplineTubes(
        places.reshape(-1, 3), np.stack([index[:, :-1], index[:, 1:]], -1).reshape(-1, 2), radii.ravel(),
        np.gradient(places, axis=1).reshape(-1, 3), np.gradient(radii, axis=1).ravel(), False,
        np.repeat(np.arange(n), m - 1), n,
        {"number": NodeValues(numbers.ravel(), np.gradient(numbers, axis=1).ravel()),
         "colour": NodeValues(colours.reshape(-1, 4), np.gradient(colours, axis=1).reshape(-1, 4))},
        **more,
    )  # fmt: skip


def many():
    """A set with segments enough for culling."""
    return bundle(60, 51, seed=5, radius=0.5, step=1.2)


def tube_through(points, radius, **more):
    """One tube through nodes, with derivatives by the parameter."""
    points = np.asarray(points, float)
    m = len(points)
    radius = np.broadcast_to(np.asarray(radius, float), m)
    return SplineTubes(
        points, np.stack([np.arange(m - 1), np.arange(1, m)], 1), radius, np.gradient(points, axis=0),
        np.gradient(radius), False, np.zeros(m - 1, int), 1, **more,
    )  # fmt: skip


def winding(m=12, radius=2.0, vary=0.3):
    """A tube that one can be inside of, and see through for a while."""
    t = np.linspace(0, 1, m)
    return tube_through(
        np.stack([40 * t, 10 * np.sin(4 * t), 6 * np.cos(3 * t)], 1), radius * (1 + vary * np.sin(9 * t))
    )


def changed(tubes, /, **fields):
    """The same set with other arrays."""
    names = ("points", "segments", "radius", "tangents", "radius_slopes", "scaled", "tubes", "n_tubes", "values")
    return SplineTubes(**({name: getattr(tubes, name) for name in names} | fields))


def moved(tubes, matrix):
    """A set whose places and derivatives a matrix moves; one that keeps lengths, or radii would not be round."""
    matrix = np.asarray(matrix, float)
    scale = np.cbrt(abs(np.linalg.det(matrix[:3, :3])))
    return SplineTubes(
        tubes.points @ matrix[:3, :3].T + matrix[:3, 3], tubes.segments, tubes.radius * scale,
        tubes.tangents @ matrix[:3, :3].T, tubes.radius_slopes * scale, tubes.scaled, tubes.tubes, tubes.n_tubes,
        tubes.values,
    )  # fmt: skip


# ---------------------------------------------------------------------------------------------------------- pictures


class TubeTarget(NamedTuple):
    """What a G-buffer shows, row 0 at the bottom."""

    drawn: np.ndarray  # (h, w)
    z: np.ndarray  # (h, w) window depth
    owner: np.ndarray  # (h, w) segment, -1 where nothing is
    tube: np.ndarray
    t: np.ndarray  # (h, w) of the segment
    value: np.ndarray
    tangent: np.ndarray  # (h, w, 3)
    normal: np.ndarray  # (h, w, 3)
    colour: np.ndarray | None  # (h, w, 4) 0..1


def read_splines(gbuffer):
    """Read all textures."""
    w, h = gbuffer.size
    get = lambda texture, dtype: np.frombuffer(texture.read(), dtype).reshape(h, w, -1)  # noqa: E731
    key, owner = get(gbuffer.depth, "<u4")[..., 0], get(gbuffer.owner, "<u4")[..., 0]
    drawn = key != EMPTY
    ids = get(gbuffer.ids, "<u4")
    # What is not drawn is undefined: on some drivers no number.
    position = np.where(drawn[..., None], get(gbuffer.position, "<f4"), 0.0).astype(float)
    assert (owner[~drawn] == EMPTY).all()
    assert np.isfinite(position[drawn][:, 0]).all()
    colour = None if gbuffer.colours is None else get(gbuffer.colours, "u1") / 255.0
    return TubeTarget(
        drawn, key / 4294967296.0, np.where(drawn, owner.astype(np.int64), -1), ids[..., 0], position[..., 0],
        position[..., 1], unpacked_tangent(ids[..., 1]), unpacked_tangent(get(gbuffer.across, "<u4")[..., 0]), colour,
    )  # fmt: skip


def draw_splines(gl, tubes, view, values=None, min_width=1.0, **options):
    """Draw one picture with a renderer of its own."""
    renderer = TubeRenderer(gl, tubes, **options)
    try:
        return read_splines(renderer.render(view, TubeStyle(values=values, min_width=min_width)))
    finally:
        renderer.release()


def scenes(camera):
    """Views and styles that a process of its own can draw again."""
    size, inside = (96, 72), {**EYE, "near": 59.0}
    return [
        (View(size, camera(size, **EYE)), TubeStyle(values="number")),
        (
            View(size, camera(size, **EYE, height=40.0), [[0.4, 1.0, 0, 2.0], [1.0, 0, 0, 8.0]]),
            TubeStyle(values="colour"),
        ),
        (View(size, camera(size, **inside)), TubeStyle()),
    ]


def pictures_of(ctx, camera, silhouettes, **options):
    found = []
    for some in (bundle(), many()):
        renderer = TubeRenderer(ctx, some, silhouettes=silhouettes, **options)
        for view, style in scenes(camera):
            found.append(read_splines(renderer.render(view, style)))
        renderer.release()
    return found


def widened(points, view, min_width):
    """(n, 2, 3, 4) halves with radii grown to half of some pixels at the depth of each node and inner control point."""
    w, h = view.size
    matrix = view.model_view_projection
    window = np.array([w / 2 * (matrix[0] + matrix[3]), h / 2 * (matrix[1] + matrix[3]), matrix[3]])
    along = matrix[3, :3] if matrix[3, :3].any() else matrix[2, :3]
    across = np.linalg.inv(np.array([window[0, :3], window[1, :3], along]))
    pixel = max(np.linalg.norm(across[:, 0]), np.linalg.norm(across[:, 1]))
    found = points.copy()
    at = np.maximum(found[..., :3] @ matrix[3, :3] + matrix[3, 3], 0.0)
    found[..., 3] = np.maximum(found[..., 3], 0.5 * min_width * pixel * at)
    found[:, 0, 2] = found[:, 1, 0] = 0.5 * (found[:, 0, 1] + found[:, 1, 1])
    return found


class Seen(NamedTuple):
    """What every pixel must show."""

    drawn: np.ndarray
    z: np.ndarray
    l: np.ndarray  # noqa: E741 - (h, w) mm from the near plane
    half: np.ndarray
    t: np.ndarray  # of the half
    kind: np.ndarray
    radius: np.ndarray
    normal: np.ndarray
    tangent: np.ndarray
    facing: np.ndarray  # (h, w) cosine between ray and normal, 0 on a silhouette
    plane: np.ndarray  # (h, w) of a cap: its plane

    @property
    def owner(self):
        return np.where(self.drawn, self.half // 2, -1)


def seen(tubes, view, *, min_width=0.0, inside=False, grow=1.0, middle=MIDDLE):
    """Meet the ray of every pixel with every half.

    From the near plane on, or the last plane of the caller's to let it in, and to the far plane or the first that ends
    it. Where the near plane begins inside of a tube, `inside` shows the wall that the ray leaves by: of all the tube's
    halves that it is in at a place it follows the farthest, until it is in none. Another tube that is met before shows.
    """
    points = widened(controls(tubes, middle=middle), view, min_width).reshape(-1, 3, 4)
    points[..., 3] *= grow
    shape = view.size[::-1]
    o, d = (a.reshape(-1, 3) for a in rays(view.model_view_projection, view.size))
    far = far_ends(view).reshape(-1)
    start, end, plane = np.zeros(len(o)), far.copy(), np.full(len(o), -1)
    planes = np.asarray(view.clip_planes, float).reshape(-1, 4)
    planes = planes / np.linalg.norm(planes[:, :3], axis=1, keepdims=True)
    for k, p in enumerate(planes):
        height, rise = o @ p[:3] + p[3], d @ p[:3]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = -height / rise
        later = (rise > 0) & (at > start)
        start[later], plane[later] = at[later], k
        end = np.where(rise < 0, np.minimum(end, at), end)
        end = np.where((rise == 0) & (height < 0), -np.inf, end)
    end = np.where(end < start, -np.inf, end)
    n = len(o)
    l, t, kind, half = np.full(n, np.nan), np.zeros(n), np.zeros(n, int), np.full(n, -1)  # noqa: E741
    for capped in (False, True):
        rows = np.flatnonzero((plane >= 0) == capped)
        if len(rows):
            met = reference.nearest_hits(points, o[rows], d[rows], start=start[rows], end=end[rows], capped=capped)
            l[rows], t[rows], kind[rows], half[rows] = met.l, met.t, met.kind, met.half
    if inside:
        rows = np.flatnonzero(plane < 0)
        kind[rows], l[rows] = MISS, np.inf
        for number in np.unique(tubes.tubes):
            some = np.flatnonzero(np.repeat(tubes.tubes, 2) == number)
            met = _seen_from(points[some], o[rows], d[rows], start[rows], end[rows])
            nearer = (met.kind != MISS) & (met.l < l[rows])
            at = rows[nearer]
            l[at], t[at], kind[at], half[at] = met.l[nearer], met.t[nearer], met.kind[nearer], some[met.half[nearer]]
    else:
        assert not (kind == EXIT).any(), "the near plane opens a tube: say inside=True"
    drawn = kind != MISS
    ball, slope = np.zeros((n, 4)), np.zeros((n, 4))
    ball[drawn], slope[drawn] = evaluate(points[half[drawn]], t[drawn]), derivative(points[half[drawn]], t[drawn])
    at = o + np.where(drawn, l, 0.0)[:, None] * d
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = np.nan_to_num((at - ball[:, :3]) / ball[:, 3:], posinf=0.0, neginf=0.0)
        tangent = np.nan_to_num(unit(slope[:, :3]))
    normal = np.where((kind == EXIT)[:, None], -normal, normal)
    cap = kind == CAP
    if cap.any():
        normal[cap] = -planes[plane[cap], :3]
    clip = np.concatenate([at, np.ones((n, 1))], 1) @ view.model_view_projection.T
    z = np.where(drawn, (clip[:, 2] / clip[:, 3] + 1) / 2, 1.0)
    facing = -(normal * d).sum(1)
    parts = (drawn, z, l, half, t, kind, ball[:, 3], normal, tangent, facing, np.where(cap, plane, -1))
    return Seen(*(a.reshape(*shape, *a.shape[1:]) for a in parts))


def far_ends(view):
    """(h, w) mm from the near to the far plane along each pixel's ray."""
    near, _ = rays(view.model_view_projection, view.size)
    flipped = view.model_view_projection.copy()
    flipped[2] *= -1.0
    far, _ = rays(flipped, view.size)
    return np.linalg.norm(far - near, axis=-1)


def _seen_from(points, o, d, start, end):
    """Of one tube: the wall by which rays leave it that begin inside, the nearest entry of the others."""
    met = reference.nearest_hits(points, o, d, start=start, end=end)
    place, t, half = start.copy(), np.zeros(len(o)), np.full(len(o), -1)
    left = np.arange(len(o))
    while len(left):
        before = place[left]
        for number, one in enumerate(points):
            found = reference.hits(one, o[left], d[left], start=before)
            farther = (found.kind == EXIT) & (found.l > place[left] * (1 + 1e-9) + 1e-9)
            at = left[farther]
            place[at], t[at], half[at] = found.l[farther], found.t[farther], number
        left = left[place[left] > before]
    within = half >= 0
    hidden = within & (place > end)
    met.l[within], met.t[within], met.half[within] = place[within], t[within], half[within]
    met.kind[within] = EXIT
    met.kind[hidden] = MISS
    return met


# ---------------------------------------------------------------------------------------------------- comparisons


def distances(picture, view):
    """(h, w) mm from the near plane to what the window depth says."""
    w, h = view.size
    y, x = np.mgrid[:h, :w] + 0.5
    clip = np.stack([2 * x / w - 1, 2 * y / h - 1, 2 * picture.z - 1, np.ones_like(x)], -1)
    at = clip @ np.linalg.inv(view.model_view_projection).T
    o, d = rays(view.model_view_projection, view.size)
    return ((at[..., :3] / at[..., 3:] - o) * d).sum(-1)


def degrees(a, b):
    """Angles between unit vectors, right for small ones too."""
    return np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(a - b, axis=-1) / 2, 0, 1)))


def assert_shows(picture, tubes, view, *, expected=None, wrong=0.002, depth=2e-3, least=300, **options):
    """Compare all that a picture has; return what was expected.

    `wrong` is the share of pixels that may show something else: on edges, where a sliver of the radius decides, and
    where two segments are met at the same place. `depth` is over the radius.
    """
    expected = expected or seen(tubes, view, **options)
    assert expected.drawn.sum() >= least
    count = expected.drawn.sum()
    assert (picture.drawn != expected.drawn).sum() <= wrong * count
    both = picture.drawn & expected.drawn
    # Beyond this slope float32 rounds along the surface.
    clear = both & (np.abs(expected.facing) > 0.05)
    step = np.spacing(picture.z.astype(np.float32)).astype(float) + 2.0**-31
    o, d = rays(view.model_view_projection, view.size)
    l = distances(picture, view)  # noqa: E741
    finer = np.abs(distances(picture._replace(z=picture.z - 4 * step), view) - l)
    off = np.abs(l - expected.l) / (depth * np.maximum(expected.radius, 1e-30) + finer)
    assert (off > 1)[clear].sum() <= wrong * count
    same = clear & (picture.owner == expected.owner)
    # A hit at a node belongs to either segment.
    t = 0.5 * (expected.t + (expected.half % 2))
    at_node = np.minimum(t, 1 - t) < 2e-3
    cap = expected.kind == CAP
    assert (clear & ~same & ~at_node & ~cap).sum() <= wrong * count
    if (cap & both).any():  # where several segments are cut at once, any that is cut there will do
        cut = cap & both
        second = (picture.t[cut] >= 0.5).astype(int)
        half = controls(tubes)[picture.owner[cut], second]
        inside = surface_distance(half, (o + l[..., None] * d)[cut]) < depth * half[:, :, 3].max(axis=1)
        assert (~inside).sum() <= wrong * count
    assert (np.abs(picture.t - t) > 0.01)[same & ~cap].sum() <= wrong * count
    assert np.median(np.abs(picture.t - t)[same & ~cap]) < 1e-3 if (same & ~cap).any() else True
    assert (degrees(picture.normal, expected.normal) > 1.0)[same].sum() <= wrong * count
    assert (degrees(picture.tangent, expected.tangent) > 1.5)[same].sum() <= wrong * count
    assert (picture.tube == tubes.tubes[np.maximum(picture.owner, 0)])[picture.drawn].all()
    return expected


def assert_all_show(gl, tubes, view, *, solver="auto", inside=False, **bounds):
    """Draw with every kind of silhouettes; return what was expected and the last picture."""
    expected = seen(tubes, view, inside=inside)
    for silhouettes in SILHOUETTES:
        picture = draw_splines(gl, tubes, view, silhouettes=silhouettes, solver=solver, min_width=0.0)
        assert_shows(picture, tubes, view, expected=expected, **bounds)
    return expected, picture
