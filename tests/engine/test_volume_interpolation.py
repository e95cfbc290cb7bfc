"""What shaders weigh themselves, where graphics cards do it too coarsely, are pictures of exact hardware."""

import numpy as np
import pytest

from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.volumes import interpolation
from pvfiblets.engine.volumes import renderer as volume_renderer
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.transfer import Transfer
from pvfiblets.volumes.volume import RaycastVolume

from .test_volume_bricks import ONE, SMALL, assert_alike, drawn, look_at, smooth

RAMP = np.column_stack([np.linspace(0.0, 1.0, 256)] * 3 + [np.linspace(0.0, 0.9, 256)])
PEAKS = np.column_stack([np.ones((256, 3)), np.where(np.arange(256) % 16 == 8, 0.9, 0.0)])
CASTINGS = {
    "surface": RaycastOptions(values=(0.4,), step=0.4, refine="newton"),
    "light": RaycastOptions("composite", transfer=Transfer(RAMP, (0.0, 1.0), 2.0), step=0.5),
    "steep": RaycastOptions("composite", transfer=Transfer(PEAKS, (0.0, 1.0), 0.3), step=0.5),
    "mip": RaycastOptions("mip", step=0.5),
    "tricubic": RaycastOptions(values=(0.4,), step=0.5, filter="tricubic"),
}


def on_a_coarse_card(monkeypatch):
    monkeypatch.setattr(volume_renderer, "interpolates_finely", lambda *_: False)


@pytest.mark.few(1)
@pytest.mark.parametrize("limits", [ONE, SMALL["bricks"], SMALL["pages"]], ids=["one", "bricks", "pages"])
@pytest.mark.parametrize("mode", CASTINGS)
def test_weighing_in_the_shader_shows_the_same(gl, camera, monkeypatch, mode, limits):
    volume = RaycastVolume(smooth((27, 22, 19)))
    matrix = look_at(camera, volume)
    right, _ = drawn(gl, monkeypatch, volume, CASTINGS[mode], matrix, limits)
    on_a_coarse_card(monkeypatch)
    found, _ = drawn(gl, monkeypatch, volume, CASTINGS[mode], matrix, limits)
    assert_alike(found, right, atol=4e-3, few=1e-2)  # at outlines rounding decides which part of a surface is met


@pytest.mark.parametrize("shape", [(2, 9, 8), (9, 2, 8), (9, 8, 2), (2, 2, 2)])
@pytest.mark.parametrize("limits", [ONE, SMALL["bricks"]], ids=["one", "bricks"])
def test_volumes_of_two_slices(gl, camera, monkeypatch, shape, limits):
    volume = RaycastVolume(smooth(shape))
    matrix = look_at(camera, volume)
    right, _ = drawn(gl, monkeypatch, volume, CASTINGS["mip"], matrix, limits)
    on_a_coarse_card(monkeypatch)
    found, _ = drawn(gl, monkeypatch, volume, CASTINGS["mip"], matrix, limits)
    assert_alike(found, right, atol=1e-4)


@pytest.mark.parametrize("kind", interpolation.TEXELS)
def test_a_driver_is_judged_by_what_it_reads(gl, monkeypatch, kind):
    library = GLExtras(gl)
    texels, scale = interpolation.TEXELS[kind]
    low, high = (float(one) / scale for one in texels)
    read = "textureLod(voxels, vec3(0.5 * place, 0.5, 0.5), 0.0).x"
    assert read in interpolation.SOURCE
    for share, fine in (("place - 0.5", True), ("floor((place - 0.5) * 256.0 + 0.5) / 256.0", False)):
        stand_in = f"mix({low!r}, {high!r}, {share}) + 1e-30 * {read}"
        monkeypatch.setattr(interpolation, "_known", {})
        with monkeypatch.context() as patch:
            patch.setattr(interpolation, "SOURCE", interpolation.SOURCE.replace(read, stand_in))
            assert interpolation.interpolates_finely(gl, library, kind) is fine
        assert interpolation.interpolates_finely(gl, library, kind) is fine  # it is not tried again
