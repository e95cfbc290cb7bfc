"""Wide lines: all pixels of a round brush drawn along the line, and no others, however long a loop that takes."""

import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletStyle, View

from .pictures import SIZE, assert_same, draw, near
from .polylines import feet, to_clip, to_window


@pytest.mark.parametrize("width", [1.5, 3.0, 8.0])
def test_wide_lines(gl, fabricate, camera, width):
    """All pixels whose centre is at most half the width away, and no others."""
    rng = np.random.default_rng(4)
    line = np.cumsum(rng.normal(0, 1, (40, 3)) * [9, 1, 6], axis=0)
    fiblets = fabricate([line - line.mean(0)], kind=3)
    matrix = camera(SIZE)
    drawn = draw(gl, fiblets, View(SIZE, matrix), FibletStyle(width, tolerance=0.0)).drawn
    nearest = feet(to_window(to_clip(fiblets.lines[0], matrix), SIZE)[:, :2], SIZE)[0]
    assert drawn[nearest < width / 2 - 0.01].all()
    assert not drawn[nearest > width / 2 + 0.01].any()


@pytest.mark.few(1)
@pytest.mark.every("value")
@pytest.mark.parametrize("tolerance", [0.0, 0.5])
@pytest.mark.parametrize("width", [2.0, 12.0, 25.0, 60.0])
def test_no_width_loses_pieces(gl, fabricate, random_lines, camera, width, tolerance):
    """Software OpenGL leaves loops that run long: what a thin line shows, a wide one must."""
    fiblets = fabricate(random_lines(150, seed=6), kind=2)
    view = View(SIZE, camera(SIZE))
    thin = draw(gl, fiblets, view, FibletStyle(tolerance=tolerance))
    wide = draw(gl, fiblets, view, FibletStyle(width, tolerance=tolerance))
    assert near(wide.drawn)[thin.drawn].all()
    assert_same(draw(gl, fiblets, view, FibletStyle(width, tolerance=tolerance)), wide)


def test_wide_lines_in_a_close_view(gl, fabricate, camera):
    """Segments of a hundred pixels, in all fiblets of one group."""
    rng = np.random.default_rng(2)
    lines = [np.cumsum(rng.normal(0, 1, (60, 3)), axis=0) for _ in range(200)]
    fiblets = fabricate([line - line.mean(0) for line in lines], kind=2)
    view = View(SIZE, camera(SIZE, eye=(0, -8, 0), near=0.5, far=60.0))
    thin = draw(gl, fiblets, view).drawn
    assert near(draw(gl, fiblets, view, FibletStyle(9.0, tolerance=0.0)).drawn)[thin].all()


def test_a_width_beyond_software_opengl_is_reported(gl, fabricate, random_lines, camera):
    if "llvmpipe" not in gl.info["GL_RENDERER"]:
        pytest.skip("hardware draws any width")
    with pytest.raises(EngineError, match="at most 100"):
        draw(gl, fabricate(random_lines(5), kind=2), View(SIZE, camera(SIZE)), FibletStyle(400.0))


def test_wide_lines_reach_in_from_outside_and_the_nearest_wins(gl, fabricate, camera):
    """A wide line just off the screen shows its edge."""
    size, matrix = (200, 100), camera((200, 100), height=100.0)
    x = 102.2  # window x = 202.2, and the last pixel's centre is at 199.5
    fiblets = fabricate([np.array([[x, 0.0, -30.0], [x, 0.0, 30.0]])], kind=3)
    assert not draw(gl, fiblets, View(size, matrix)).drawn.any()
    drawn = draw(gl, fiblets, View(size, matrix), FibletStyle(line_width=6.0)).drawn
    assert drawn[50].tolist() == [False] * 199 + [True]
    lines = [np.array([[-50.0, y, 1e-3 * i], [50.0, y, 1e-3 * i]]) for i, y in enumerate((5.0, -20.0, 30.0))]
    fiblets = fabricate(lines, kind=3)
    picture = draw(gl, fiblets, View(SIZE, camera(SIZE, eye=(0, -260, 0))), FibletStyle(line_width=3.0))
    middle = np.nonzero(picture.drawn[:, SIZE[0] // 2])[0]
    assert (picture.ids[middle[1:-1], SIZE[0] // 2, 0] == 1).all()  # at the edges another may stand out
