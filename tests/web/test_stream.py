"""The sequence of pictures, without a browser."""

from __future__ import annotations

import pytest
import pyvista as pv

from pvfiblets.web.stream import PictureStream


def test_a_session_is_warm_before_anybody_looks(plotter):
    plotter.add_mesh(pv.Sphere())
    stream = PictureStream(plotter, "view")
    stream.warm()
    assert stream.frames == 1
    stream.warm()
    assert stream.frames == 1
    assert stream.milliseconds > 0.0


def test_what_fails_while_warming_is_told(plotter, monkeypatch):
    told = []
    stream = PictureStream(plotter, "view", failed=told.append)
    error = RuntimeError("no memory")

    def fail():
        raise error

    monkeypatch.setattr(plotter, "render", fail)
    stream.warm()
    assert told == [error]
    assert stream.frames == 0


@pytest.mark.parametrize("codec", ["jpeg", "png", "webp"])
def test_pictures_of_every_codec_are_pictures(plotter, codec):
    import io

    import numpy as np
    from PIL import Image

    from pvfiblets.web.stream import encode

    pixels = np.zeros((40, 60, 3), np.uint8)
    pixels[:20] = 200, 30, 90
    found = np.asarray(Image.open(io.BytesIO(encode(pixels, codec, 92))).convert("RGB")).astype(int)
    assert found.shape == pixels.shape
    assert abs(found - pixels)[2:18].max() <= (0 if codec == "png" else 12)
