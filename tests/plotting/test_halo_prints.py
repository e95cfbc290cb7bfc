"""Pictures for print: as large as asked for, of one bit, averaged, and of the same lines as in the window."""

from __future__ import annotations

import struct
from io import BytesIO

import numpy as np
import pytest
import pyvista as pv
from PIL import Image


@pytest.fixture
def drawing():
    """A plotter with a few wandering lines, black on white."""
    plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
    plotter.set_background("white")
    plotter.disable_anti_aliasing()
    random = np.random.default_rng(5)
    lines = [np.cumsum(random.normal(size=(40, 3)), axis=0) * 2.0 for _ in range(12)]
    plotter.add_halo_lines(lines, line_width=0.5, strip_width=3.0, max_displacement=4.0, name="lines")
    yield plotter
    plotter.close()


def boxed(picture, k):
    """The mean of squares of k x k pixels."""
    height, width = picture.shape[0] // k, picture.shape[1] // k
    return picture.reshape(height, k, width, k, -1).mean(axis=(1, 3)).squeeze()


def test_a_picture_is_what_pyvista_shows(drawing):
    ours = drawing.halo_lines.screenshot()
    assert (ours.shape, ours.dtype) == ((120, 160), np.uint8)
    theirs = drawing.screenshot(None)
    assert (theirs == ours[..., None]).all()
    drawing.actors["lines"].line_width = 2.0
    assert (drawing.halo_lines.screenshot() < 128).sum() > 1.5 * (ours < 128).sum()
    assert drawing.halo_lines.screenshot(scale=2, window_size=(80, 100)).shape == (200, 160)
    assert tuple(drawing.window_size) == (160, 120)
    held = BytesIO()
    assert drawing.halo_lines.screenshot(held, supersampling=2, return_img=False) is None
    assert header(held.getvalue()) == (160, 120, 8, 0)
    drawing.remove_actor("lines")
    drawing.add_halo_points(pv.Sphere())
    assert 0 < (drawing.halo_points.screenshot() < 128).sum() < ours.size / 2


def test_scaled_pictures_show_the_same_lines(drawing):
    plain = drawing.halo_lines.screenshot().astype(float)
    large = drawing.halo_lines.screenshot(scale=4)
    assert large.shape == (480, 640)
    small = boxed(large, 4)
    assert (255 - small).mean() == pytest.approx((255 - plain).mean(), rel=0.03)  # as much ink
    assert np.abs(small - plain).mean() < 6.0
    assert np.corrcoef(small.ravel(), plain.ravel())[0, 1] > 0.95
    assert (drawing.halo_lines.screenshot() == plain).all()


def test_samples_are_averaged(drawing):
    averaged = drawing.halo_lines.screenshot(supersampling=4)
    assert (averaged.shape, averaged.dtype) == ((120, 160), np.uint8)
    assert np.abs(averaged - boxed(drawing.halo_lines.screenshot(scale=4), 4)).max() <= 0.5
    both = drawing.halo_lines.screenshot(scale=2, supersampling=2)
    assert both.shape == (240, 320)
    assert np.abs(boxed(both, 2) - averaged).max() <= 1.0
    assert 0.02 < ((averaged > 5) & (averaged < 250)).mean()
    drawing.actors["lines"].scalars = "orientation"  # coloured pictures keep their colours
    picture = drawing.halo_lines.screenshot(supersampling=2)
    assert picture.shape == (120, 160, 3)
    assert np.abs(picture - boxed(drawing.screenshot(None, scale=2), 2)).max() <= 0.5


def header(data):
    """Width, height, bits and colour type that a PNG file says it has."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert data[12:16] == b"IHDR"
    return struct.unpack(">IIBB", data[16:26])


def test_one_bit_files_have_one_bit(drawing, tmp_path):
    name = tmp_path / "ink.png"
    grey = drawing.halo_lines.screenshot(scale=3)
    bits = drawing.halo_lines.screenshot(name, scale=3, one_bit=True, dpi=600)
    assert (bits.shape, bits.dtype) == ((360, 480), np.bool_)
    assert (bits == (grey >= 128)).all()
    assert header(name.read_bytes()) == (480, 360, 1, 0)
    with Image.open(name) as image:
        assert image.mode == "1"
        assert image.info["dpi"] == pytest.approx((600, 600), rel=1e-4)
        assert (np.asarray(image) == bits).all()
    assert 0 < (~bits).sum() < bits.size / 2
    bits = drawing.halo_lines.screenshot(one_bit=True, supersampling=4)  # by the mean of samples
    assert (bits == (drawing.halo_lines.screenshot(supersampling=4) >= 128)).all()
    for color, white in (("yellow", True), ("blue", False)):
        drawing.actors["lines"].color = color
        found = drawing.halo_lines.screenshot(one_bit=True)
        assert found.all() if white else not found.all()


@pytest.mark.parametrize("suffix", [".png", ".tif", ".bmp", ""])
def test_files_of_other_kinds(drawing, tmp_path, suffix):
    drawing.halo_lines.screenshot(tmp_path / f"a{suffix}", one_bit=True, return_img=False)
    with Image.open(tmp_path / f"a{suffix or '.png'}") as image:
        assert image.mode == "1"
        assert image.size == (160, 120)


def test_subplots_are_enlarged_as_well():
    plotter = pv.Plotter(shape=(1, 3), off_screen=True, window_size=(150, 90), border=False)
    plotter.set_background("white", all_renderers=True)
    plotter.disable_anti_aliasing()
    for column, line_width in enumerate((1.0, 2.0, 0.01)):
        plotter.subplot(0, column)
        plotter.add_halo_lines([[(-10, 0, 0), (10, 0, 0)]], line_width=line_width, strip_width=4, min_width=2)
        plotter.view_xz()
    plain, large = plotter.halo_lines.screenshot(), plotter.halo_lines.screenshot(scale=4)
    assert large.shape == (360, 600)
    assert np.abs(boxed(large, 4) - plain).mean() < 1.0
    for column in (25, 75, 125):
        ink, much = (255.0 - plain[:, column]).sum(), (255.0 - large[:, 4 * column]).sum()
        assert much == pytest.approx(4 * ink, abs=255)
    plotter.close()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [({"scale": 0}, "scale is 0"), ({"scale": 1.5}, r"scale is 1\.5"),
     ({"supersampling": True}, "supersampling is True"), ({"dpi": -1}, "dpi is -1"),
     ({"filename": 7}, "filename is a int"),
     ({"filename": "a.jpg", "one_bit": True}, r"\.jpg files have no pictures of one bit")],
)  # fmt: skip
def test_what_has_no_meaning_is_refused(drawing, arguments, message):
    with pytest.raises((TypeError, ValueError), match=message):
        drawing.halo_lines.screenshot(**arguments)


def test_an_error_in_a_tile_is_raised_and_no_file_is_left(drawing, tmp_path, monkeypatch):
    drawing.show(auto_close=False)
    mapper = type(drawing.actors["lines"].mapper)
    draw = mapper._draw

    def broken(self, program):
        if drawing.render_window.GetTileScale()[0] > 1:
            raise RuntimeError("the engine is on fire")
        draw(self, program)

    monkeypatch.setattr(mapper, "_draw", broken)
    with pytest.raises(RuntimeError, match="on fire"):
        drawing.halo_lines.screenshot(tmp_path / "a.png", scale=2)
    assert not list(tmp_path.iterdir())
