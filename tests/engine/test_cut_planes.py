"""What of a region is planes: the same part of space in NumPy, and the same picture but for the pixels at the cut."""

import numpy as np
import pytest

from pvfiblets import regions
from pvfiblets.engine import FibletStyle, View
from pvfiblets.engine.regions.clip_planes import planes_of

from .pictures import SIZE, draw, near

PLANE = regions.Plane((0.3, 1.0, 0.1), (0.0, 5.0, 0.0))
OTHER = regions.Plane((-1.0, 0.2, 0.5), (12.0, 0.0, -3.0))
SLAB = regions.Slab((0.3, 1.0, 0.1), (0.0, 5.0, 0.0), 8.0)
BOX = regions.Box((-25.0, 25.0, -20.0, 25.0, -25.0, 25.0))
TURNED = BOX.moved(np.array([[0.8, -0.6, 0, 4], [0.6, 0.8, 0, -2], [0, 0, 1.5, 1], [0, 0, 0, 1.0]]))
BALL = regions.Sphere((5.0, -3.0, 2.0), 28.0)

# region, planes that there are, whether anything is left
CUTS = {
    "plane": (PLANE, 1, False),
    "other side": (~PLANE, 1, False),
    "slab": (SLAB, 2, False),
    "box": (BOX, 6, False),
    "box turned and stretched": (TURNED, 6, False),
    "two planes": (PLANE & OTHER, 2, False),
    "neither of two": (~(PLANE | OTHER), 2, False),
    "not without a plane": (~(~PLANE | ~SLAB), 3, False),
    "box and slab": (BOX & SLAB, 8, False),
    "box, plane and slab": (BOX & PLANE & SLAB, 7, True),
    "two boxes": (BOX & TURNED, 6, True),
    "plane and ball": (PLANE & BALL, 1, True),
    "slab without a ball": (SLAB - BALL, 2, True),
    "ball": (BALL, 0, True),
    "outside a slab": (~SLAB, 0, True),
    "outside a box": (~BOX, 0, True),
    "either of two planes": (PLANE | OTHER, 0, True),
    "plane and one of two": (PLANE & (BALL | OTHER), 1, True),
}


@pytest.mark.parametrize("far", [0.0, 1e6])
@pytest.mark.parametrize("name", CUTS)
def test_planes_and_rest_hold_what_the_region_holds(name, far):
    region, count, more = CUTS[name]
    shift = np.eye(4)
    shift[:3, 3] = far, -far, 2.0 * far
    planes, rest = planes_of(region.moved(shift), 8)
    assert (len(planes), rest is not None) == (count, more)
    points = np.random.default_rng(1).uniform(-45.0, 45.0, (4000, 3))
    heights = (points + shift[:3, 3]) @ planes[:, :3].T + planes[:, 3]
    kept = (heights >= 0.0).all(axis=1)
    if rest is not None:
        kept &= rest.contains(points + shift[:3, 3])
    assert 0 < kept.sum() < len(kept)
    np.testing.assert_array_equal(kept, region.contains(points))


def test_as_many_planes_as_there_is_room_for():
    assert planes_of(None, 8)[1] is None
    assert planes_of(None, 8)[0].shape == (0, 4)
    for room, (count, left) in {0: (0, 2), 1: (1, 1), 5: (1, 1), 6: (1, 1), 7: (7, 0)}.items():
        planes, rest = planes_of(PLANE & BOX, room)
        assert (len(planes), 0 if rest is None else len(rest.leaves)) == (count, left)
    planes, rest = planes_of(BOX & PLANE, 3)
    assert (len(planes), rest) == (1, BOX), "what does not fit leaves its place to what does"


STYLES = {"thin": FibletStyle(), "wide": FibletStyle(5.0), "tubes": FibletStyle(radius=0.8)}


@pytest.mark.few(2)
@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("name", ["plane", "box turned and stretched", "slab without a ball"])
def test_pictures_are_those_of_regions_but_at_the_cut(gl, fabricate, random_lines, camera, name, style):
    """Thin and wide lines end a pixel sooner or later; tubes have closed ends, and are open in a region."""
    fiblets = fabricate(random_lines(150, seed=2), kind=2)
    matrix = camera(SIZE, eye=(120, -200, 110), target=(0, 0, 0), far=700.0)
    region = CUTS[name][0]
    by_region = draw(gl, fiblets, View(SIZE, matrix, (), region), STYLES[style], culling=None)
    by_planes = draw(gl, fiblets, View(SIZE, matrix, *planes_of(region, 8)), STYLES[style], culling=None)
    both = by_region.drawn & by_planes.drawn
    assert both.sum() > 500
    # Where the picture without planes differs, a plane's cut is within two pixels, or a closed end is in front.
    differ = by_region.drawn != by_planes.drawn
    differ |= both & (by_region.ids[..., 0] != by_planes.ids[..., 0])
    depth = np.where(by_planes.drawn, by_planes.window_depth, 1.0)
    x, y = np.meshgrid((np.arange(SIZE[0]) + 0.5) / SIZE[0] * 2 - 1, (np.arange(SIZE[1]) + 0.5) / SIZE[1] * 2 - 1)
    at_cut = np.zeros(SIZE[::-1], bool)
    planes, _ = planes_of(region, 8)
    for shown in (depth, np.where(by_region.drawn, by_region.window_depth, 1.0)):
        clip = np.stack([x, y, 2 * shown - 1, np.ones_like(x)], -1) @ np.linalg.inv(matrix).T
        heights = (clip[..., :3] / clip[..., 3:]) @ planes[:, :3].T + planes[:, 3]
        at_cut |= (np.abs(heights / np.linalg.norm(planes[:, :3], axis=1)) < 1.5).any(-1) & (shown < 1.0)
    assert (near(at_cut, 2) >= differ).all()
    assert differ.sum() < 0.1 * both.sum()
    same = both & ~near(at_cut, 3)
    assert same.sum() > 300
    np.testing.assert_array_equal(by_region.ids[same], by_planes.ids[same])
    apart = by_region.depth[same].astype(np.int64) - by_planes.depth[same]
    assert np.abs(apart).max() <= 256, "a step of depth: what is left of a segment is rounded anew"
    assert (apart == 0).mean() > 0.99
