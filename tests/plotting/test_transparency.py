"""``transparency`` of an actor: what may be given, and that layers and volumes work on old OpenGL."""

from __future__ import annotations

import subprocess
import sys
import warnings

import numpy as np
import pytest
import pyvista as pv

FLAT = {"lighting": False, "line_width": 6.0, "color": "white"}


@pytest.fixture
def lines():
    """Three lines along x, one behind the other for who looks along -z."""
    x = np.linspace(-10, 10, 61)
    return [np.c_[x, 0 * x, 0 * x + z] for z in (0.0, -5.0, -10.0)]


def middle(plotter):
    plotter.view_xy()
    picture = plotter.screenshot(None)
    return picture[picture.shape[0] // 2, picture.shape[1] // 2].astype(float)


@pytest.mark.parametrize(("transparency", "layers"), [(None, 1), ("layers", 3), (2, 2), (3, 3), (16, 3), ("all", 3)])
def test_layers_show_through_each_other(plotter, lines, transparency, layers):
    actor = plotter.add_fiblets(lines, opacity=0.5, transparency=transparency, **FLAT)
    assert actor.transparency == transparency
    assert np.abs(middle(plotter) - 255 * (1 - 0.5**layers)).max() <= 3


def test_it_can_be_changed_at_any_time_and_is_copied(plotter, lines):
    actor = plotter.add_fiblets(lines, opacity=0.5, **FLAT)
    assert actor.transparency == "all"
    assert np.abs(middle(plotter) - 223).max() <= 3
    assert any(entry["name"] == "gathered" for entry in actor.explain()["buffers"])
    actor.transparency = "layers"
    assert np.abs(middle(plotter) - 223).max() <= 3
    assert not any(entry["name"] == "gathered" for entry in actor.explain()["buffers"])
    assert actor.copy().transparency == "layers"
    actor.opacity = 0.25
    assert np.abs(middle(plotter) - 255 * (1 - 0.75**3)).max() <= 3
    assert any(entry["name"] == "layers" for entry in actor.explain()["buffers"])
    actor.transparency = "all"
    assert np.abs(middle(plotter) - 255 * (1 - 0.75**3)).max() <= 3
    actor.opacity = 1.0
    assert np.abs(middle(plotter) - 255).max() <= 1
    assert not any(entry["name"] == "gathered" for entry in actor.explain()["buffers"])
    actor.opacity, actor.transparency = 0.25, None
    assert np.abs(middle(plotter) - 64).max() <= 3
    assert not any(entry["name"] == "layers" for entry in actor.explain()["buffers"])


@pytest.mark.parametrize("transparency", ["peeling", 1, 0, -2, 65, 2.5, True, [4]])
def test_nonsense_is_refused_in_words(plotter, lines, transparency):
    with pytest.raises(ValueError, match="give 'all', 'layers', a number of layers from 2 to 64, or None"):
        plotter.add_fiblets(lines, transparency=transparency)
    assert not plotter.actors


SCENE = """
import sys
import numpy as np
import pyvista as pv
plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
plotter.set_background("black")
plotter.disable_anti_aliasing()
x = np.linspace(-10, 10, 61)
lines = [np.c_[x, 0 * x, 0 * x + z] for z in (0.0, -5.0, -10.0)]
volume = np.fromfunction(lambda i, j, k: 1.0 + 0.0 * i + 0.0 * j - k / 40, (5, 5, 41))
affine = np.array([[10.0, 0, 0, -20], [0, 10, 0, -20], [0, 0, -0.5, 5], [0, 0, 0, 1]])
actor = plotter.add_fiblets(
    lines, scalars=(volume, affine), clim=(0, 1), cmap="gray", lighting=False, line_width=6, opacity=0.5,
    transparency="layers", pipeline=sys.argv[1], show_scalar_bar=False,
)
plotter.view_xy()
plotter.show(auto_close=False)
found = plotter.screenshot(None)[100, 100].astype(float)
# z = 0, -5, -10 are voxels 10, 20 and 30: values 3/4, 1/2 and 1/4
expected = 255 * (0.5 * 0.75 + 0.25 * 0.5 + 0.125 * 0.25)
assert abs(found - expected).max() < 4, (found, expected)
print("drawn")
"""


@pytest.mark.more
@pytest.mark.parametrize(
    ("version", "pipeline"), [(None, "auto"), ("4.1", "tessellation"), ("4.1", "geometry"), ("3.3", "geometry")]
)
def test_layers_of_a_volumes_values_by_older_opengl(older_opengl, version, pipeline):
    command = [sys.executable, "-c", SCENE, pipeline]
    environment = older_opengl(version) if version else None
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, timeout=280)
    assert result.stdout.split()[-1:] == ["drawn"], result.stderr[-3000:]


@pytest.mark.parametrize("samples", [0, 4])
def test_depth_peeling_that_fails_under_multi_sampling_warns_once(three_lines, colours_in, samples):
    """The same window loses a translucent mesh."""
    found = {}
    for what in ("mesh", "fiblets"):
        plotter = pv.Plotter(off_screen=True, window_size=(100, 100))
        plotter.set_background("black")
        if samples:
            plotter.enable_anti_aliasing("msaa", multi_samples=samples)
        else:
            plotter.disable_anti_aliasing()
        plotter.enable_depth_peeling()
        if what == "mesh":
            plotter.add_mesh(pv.Sphere(), opacity=0.5)
        else:
            plotter.add_fiblets(three_lines, opacity=0.5)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            shown = colours_in(plotter.screenshot())
            plotter.camera.azimuth += 30.0
            plotter.render()
        found[what] = bool(shown)
        said = [str(one.message) for one in told if "depth peeling fails" in str(one.message)]
        plotter.close()
    assert found["mesh"] == found["fiblets"]
    assert len(said) == int(not found["mesh"])
    assert all("plotter.disable_anti_aliasing()" in one for one in said)


DRAWN = {
    "lines": ("add_fiblets", {"line_width": 3.0}),
    "translucent": ("add_fiblets", {"line_width": 8.0, "opacity": 0.4, "transparency": "all"}),
    "ink": ("add_fiblets", {"line_width": 5.0, "look": "ink", "color": "red"}),
    "tubes": ("add_spline_tubes", {"radius": 0.5}),
    "halos": ("add_halo_lines", {"halo_color": "background"}),
}


@pytest.mark.every("value")
@pytest.mark.parametrize("kind", list(DRAWN))
@pytest.mark.parametrize(("background", "ground"), [("black", (40, 90, 160)), ("white", (200, 250, 180))])
def test_a_picture_without_background_lies_on_any_ground(kind, background, ground):
    """PNG's opacity: laid over a colour it is the picture that is drawn on that colour."""
    add, look = DRAWN[kind]
    x = np.linspace(-10, 10, 61)
    lines = [np.c_[x, 0.3 * x + y, 0 * x + z] for z, y in ((0.0, 0.0), (-5.0, 1.5), (-9.0, -3.0))]
    lines.append(np.c_[0.2 * x, x, 0 * x + 3.0])
    plotter = pv.Plotter(off_screen=True, window_size=(200, 150))
    plotter.set_background(background)
    actor = getattr(plotter, add)(lines, **look)
    if add == "add_fiblets":
        actor.halos = True
    plotter.picture.antialias = 4
    plotter.set_background(background, top="grey" if background == "black" else None)  # no gradient is left of it
    plotter.view_xy()
    found = plotter.screenshot(None, transparent_background=True).astype(float)
    share = found[..., 3:] / 255.0
    assert ((share > 0.05) & (share < 0.95)).any()
    assert (found[0, 0] == 0).all()
    plotter.set_background(np.array(ground) / 255.0)
    plotter.render()
    drawn = plotter.screenshot(None)[..., :3].astype(float)
    off = np.abs(share * found[..., :3] + (1.0 - share) * ground - drawn)
    assert off.max() <= 3.0
    assert plotter.screenshot(None).shape[-1] == 3
    plotter.close()
