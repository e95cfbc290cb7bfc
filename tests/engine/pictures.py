"""Pictures of the engine: drawn, read back and held against what every picture keeps to."""

from typing import NamedTuple

import numpy as np

from pvfiblets import Streamlines, compress
from pvfiblets.engine import FibletRenderer, FibletStyle
from pvfiblets.synthetic import brain_streamlines

SIZE = (320, 240)
EMPTY = 0xFFFFFFFF
LARGEST_KEY = 0xFFFFFEFF
EVERY_POINT = FibletStyle(tolerance=0.0)


class Picture(NamedTuple):
    """Arrays of a G-buffer, row 0 at the bottom."""

    depth: np.ndarray  # (h, w) keys
    ids: np.ndarray  # (h, w, 2) streamline, tangent
    position: np.ndarray  # (h, w, 2) place along the streamline, per-point value
    owner: np.ndarray  # (h, w) fiblet

    @property
    def drawn(self):
        """(h, w) bool."""
        return self.depth != EMPTY

    @property
    def window_depth(self):
        """(h, w) in 0..1."""
        return self.depth / 4294967295.0


def read(gbuffer):
    """Read all textures."""
    w, h = gbuffer.size
    get = lambda texture, dtype: np.frombuffer(texture.read(), dtype).reshape(h, w, -1)  # noqa: E731
    picture = Picture(
        get(gbuffer.depth, "<u4")[..., 0],
        get(gbuffer.ids, "<u4"),
        np.where((get(gbuffer.depth, "<u4") != EMPTY), get(gbuffer.position, "<f4"), np.float32(0.0)),
        get(gbuffer.owner, "<u4")[..., 0],
    )
    drawn = picture.drawn
    assert (picture.depth[drawn] <= LARGEST_KEY).all()
    assert (picture.owner[drawn] != EMPTY).all(), "a pixel has a depth but no owner"
    assert (picture.owner[~drawn] == EMPTY).all()
    assert np.isfinite(picture.position[drawn][:, 0]).all()
    return picture


def draw(gl, fiblets, view, style=EVERY_POINT, **options):
    """Draw one picture with a renderer of its own; every point unless the style says otherwise."""
    renderer = FibletRenderer(gl, fiblets, **options)
    try:
        return read(renderer.render(view, style))
    finally:
        renderer.release()


def differences(a, b):
    """Number of pixels in which two pictures are not the same, bit by bit, by the name of what differs."""
    drawn = a.drawn & b.drawn  # elsewhere ids and position mean nothing
    found = {"depth": int((a.depth != b.depth).sum()), "owner": int((a.owner != b.owner).sum())}
    found["ids"] = int((a.ids != b.ids).any(-1)[drawn].sum())
    found["position"] = int((a.position.view("<u4") != b.position.view("<u4")).any(-1)[drawn].sum())
    return {name: count for name, count in found.items() if count}


def assert_same(a, b):
    """Every bit of two pictures."""
    assert not differences(a, b)


def assert_alike(parts, whole):
    """Every bit but for the owners, which are parts."""
    assert {name for name in differences(parts, whole) if name != "owner"} == set()


def near(mask, radius=1):
    """Pixels at most that many pixels away from the mask."""
    h, w = mask.shape
    padded, span = np.pad(mask, radius), range(2 * radius + 1)
    return np.any([padded[y : y + h, x : x + w] for y in span for x in span], axis=0)


def unpacked_tangent(word):
    """Unit vectors of the second word of ``ids``."""
    u, v = (word & 0xFFFF).astype(np.uint16).view(np.int16), (word >> 16).astype(np.uint16).view(np.int16)
    u, v = u / 32767.0, v / 32767.0
    x = 1 - abs(u) - abs(v)
    sign = lambda s: np.where(s < 0, -1.0, 1.0)  # noqa: E731
    y = np.where(x >= 0, u, (1 - abs(v)) * sign(u))
    z = np.where(x >= 0, v, (1 - abs(u)) * sign(v))
    d = np.stack([x, y, z], axis=-1)
    return d / np.linalg.norm(d, axis=-1, keepdims=True)


def brain_with_gaps(n, step):
    """Return the fiblets of a made-up brain with a value per point, `height`, and three streamlines without points."""
    lines = brain_streamlines(n, step=step, seed=2)
    offsets = np.concatenate([[0], np.cumsum(np.insert(np.asarray(lines.counts), [0, 100, n], 0))])
    values = {"height": np.asarray(lines.points[:, 2])}
    return compress(Streamlines(lines.points, offsets, per_point=values), per_point=["height"])
