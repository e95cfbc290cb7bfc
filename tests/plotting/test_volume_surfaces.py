"""Several translucent surfaces, the logarithm of values, blocks, voxels that have colours, and shaded light."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from scipy.interpolate import RegularGridInterpolator

from pvfiblets.volumes import as_raycast_volume

N = 32
LOOK = {"show_scalar_bar": False}


def ball(dtype=np.float32):
    """Distance from the middle, of which surfaces are spheres."""
    image = pv.ImageData(dimensions=(N, N, N), origin=[-(N - 1) / 2] * 3)
    image["far"] = np.linalg.norm(image.points, axis=1).astype(dtype)
    return image


@pytest.fixture
def shot():
    def draw(add, background="black", size=(96, 96), view="xy", peel=False):
        plotter = pv.Plotter(off_screen=True, window_size=size)
        plotter.set_background(background)
        if peel:
            plotter.disable_anti_aliasing()
            plotter.enable_depth_peeling(16)
        add(plotter)
        plotter.camera_position = view
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = 18
        picture = np.array(plotter.screenshot(return_img=True))[..., :3].astype(int)
        plotter.close()
        return picture

    return draw


def over(layers, behind=(0.0, 0.0, 0.0)):
    """What (colour, opacity) of layers from the eye on add up to."""
    light, left = np.zeros(3), 1.0
    for colour, alpha in layers:
        light, left = light + left * alpha * np.array(colour), left * (1 - alpha)
    return 255 * (light + left * np.array(behind))


RED, GREEN, BLUE = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def test_each_ray_passes_through_all_surfaces_in_order(shot):
    picture = shot(
        lambda p: p.add_raycast_volume(
            ball(), mode="isosurface", values=[5, 10, 14], surface_opacities=[0.5, 0.3, 0.2],
            surface_colors=["red", (0.0, 1.0, 0.0), "blue"], lighting=False, **LOOK,
        )
    )  # fmt: skip
    pixel = 96 / 36  # a mm
    for far, layers in (
        (0, [(BLUE, 0.2), (GREEN, 0.3), (RED, 0.5), (RED, 0.5), (GREEN, 0.3), (BLUE, 0.2)]),
        (7.5, [(BLUE, 0.2), (GREEN, 0.3), (GREEN, 0.3), (BLUE, 0.2)]),
        (12, [(BLUE, 0.2), (BLUE, 0.2)]),
        (16, []),
    ):
        assert np.abs(picture[48, 48 + round(far * pixel)] - over(layers)).max() <= 2


def test_they_look_as_contours_with_depth_peeling(shot):
    look = {"smooth_shading": True, "show_scalar_bar": False, "clim": (0, 20), "cmap": "coolwarm"}

    def contours(plotter):
        for value, opacity in ((6, 0.6), (12, 0.35)):
            surface = ball().contour([value])
            surface = surface.compute_normals(point_normals=True)
            plotter.add_mesh(surface, scalars="far", opacity=opacity, **look)

    def ours(plotter):
        plotter.add_raycast_volume(
            ball(),
            mode="isosurface",
            values=[6, 12],
            surface_opacities=[0.6, 0.35],
            cmap="coolwarm",
            clim=(0, 20),
            **LOOK,
        )

    right, found = shot(contours, peel=True), shot(ours)
    inside = right.sum(axis=-1) > 0
    off = np.abs(right - found).max(axis=-1)[inside]
    assert inside.sum() > 1500
    assert np.median(off) <= 3
    assert np.quantile(off, 0.95) <= 16  # normals of contours are those of triangles


def test_opaque_things_end_rays_and_cuts_open_surfaces(shot):
    def add(plotter, cut=False):
        actor = plotter.add_raycast_volume(
            ball(), mode="isosurface", values=[5, 12], surface_opacities=[0.5, 0.25], surface_colors=["red", "blue"],
            lighting=False, **LOOK,
        )  # fmt: skip
        plotter.add_mesh(pv.Plane(i_size=60, j_size=60), color="white", lighting=False)
        if cut:
            actor.clip(pv.Box((-20, 20, -20, 20, -20, 8)))

    white = (1.0, 1.0, 1.0)
    assert np.abs(shot(add)[48, 48] - over([(BLUE, 0.25), (RED, 0.5)], white)).max() <= 2
    assert np.abs(shot(lambda p: add(p, cut=True))[48, 48] - over([(RED, 0.5)], white)).max() <= 2


def test_picks_sparse_rays_and_copies(plotter):
    plotter.enable_parallel_projection()
    actor = plotter.add_raycast_volume(
        ball(), mode="isosurface", values=[5, 12], surface_opacities=[0.5, 0.0], surface_colors=["red", "blue"],
        lighting=False, **LOOK,
    )  # fmt: skip
    plotter.camera_position = "xy"
    plotter.show(auto_close=False)
    whole, hit = plotter.screenshot(None).astype(int), actor.pick_at(100, 100)
    assert actor.casting.layered
    assert hit.value == 5
    assert abs(np.linalg.norm(hit.position) - 5) < 0.6
    actor.sparse = 2
    plotter.render()
    assert np.mean(np.abs(plotter.screenshot(None) - whole) > 4) < 0.05
    actor.sparse = 1
    twin = actor.copy()
    plotter.remove_actor(actor)
    plotter.add_actor(twin, reset_camera=False)
    plotter.render()
    assert np.array_equal(plotter.screenshot(None), whole)


# Logarithm -----------------------------------------------------------------------------------------


def powers():
    image = pv.ImageData(dimensions=(N, 8, 8))
    values = np.broadcast_to(10.0 ** np.linspace(0, 4, N)[:, None, None], (N, 8, 8)).astype(np.float32)
    image["value"] = values.ravel(order="F")
    return image


@pytest.mark.few(1)
@pytest.mark.parametrize("blending", ["composite", "maximum"])
def test_log_scale_looks_as_in_add_volume(shot, blending):
    look = {"opacity": [0.3, 1.0], "opacity_unit_distance": 3.0, "blending": blending, "cmap": "viridis", **LOOK}

    def theirs(plotter):
        shown = plotter.add_volume(powers(), mapper="gpu", log_scale=True, **look)
        shown.prop.interpolation_type = "linear"

    def ours(plotter):
        plotter.add_raycast_volume(powers(), log_scale=True, **look)

    right, found = shot(theirs), shot(ours)
    there = (right.sum(axis=-1) > 30) & (found.sum(axis=-1) > 30)
    assert there.mean() > 0.1
    off = np.abs(right - found).max(axis=-1)[there]
    assert np.median(off) <= 6
    assert np.quantile(off, 0.9) <= 24
    linear = shot(lambda p: p.add_raycast_volume(powers(), **look))
    assert np.median(np.abs(right - linear).max(axis=-1)[there]) > 40


def test_log_scale_begins_above_zero_and_shows_in_the_bar():
    image = powers()
    image["value"] = np.where(image["value"] < 5, 0, image["value"]).astype(np.float32)
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_raycast_volume(image, log_scale=True)
    low, high = actor.clim
    assert low == image["value"][image["value"] > 0].min()
    assert high == pytest.approx(1e4)
    assert plotter.scalar_bar.GetLookupTable().GetScale() == 1  # VTK_SCALE_LOG10
    with pytest.raises(ValueError, match="logarithmic scale needs values above zero"):
        actor.clim = (0, 1)
    actor.log_scale = False
    assert plotter.scalar_bar.GetLookupTable().GetScale() == 0
    plotter.close()


# Blocks --------------------------------------------------------------------------------------------


def test_blocks_are_added_as_by_add_volume(shot):
    left, right = ball(), ball()
    right.origin = (30.0, 0.0, 0.0)
    blocks = pv.MultiBlock([left, None, pv.MultiBlock([right])])
    plotter = pv.Plotter(off_screen=True)
    actors = plotter.add_raycast_volume(blocks, name="both", multi_colors=True, **LOOK)
    assert [actor.name for actor in actors] == ["both-0", "both-1-0"]
    assert [actor.cmap for actor in actors] == ["Reds", "Greens"]
    assert list(plotter.raycast_volumes) == actors
    with pytest.raises(TypeError, match="rays cannot be cast through a PolyData"):  # and leaves none behind
        plotter.add_raycast_volume(pv.MultiBlock([ball(), pv.Sphere()]))
    with pytest.raises(ValueError, match="no blocks"):
        plotter.add_raycast_volume(pv.MultiBlock())
    assert list(plotter.raycast_volumes) == actors
    plotter.close()
    picture = shot(lambda p: p.add_raycast_volume(blocks, cmap="gray", **LOOK))
    assert (picture.sum(axis=-1) > 0).mean() > 0.3


# RGBA ----------------------------------------------------------------------------------------------


def rgba():
    image = pv.ImageData(dimensions=(N, N, N), origin=[-(N - 1) / 2] * 3)
    far = np.linalg.norm(image.points, axis=1)
    colours = np.clip(128 + 8 * image.points, 0, 255)
    image["rgba"] = np.column_stack([colours, np.where(far < 13, 12 * (13 - far), 0)]).astype(np.uint8)
    return image


def light_of_rgba(x, y, unit):
    """What a ray along z sees of `rgba`, by a sum of short steps.

    In VTK's picture the unit distance is always 1, and thin alpha twice as dense.
    """
    image, far = rgba(), np.arange((N - 1) / 2, -(N - 1) / 2, -0.02)
    axis = np.arange(N) - (N - 1) / 2
    colours = image["rgba"].reshape(N, N, N, 4).transpose(2, 1, 0, 3) / 255.0
    field = RegularGridInterpolator((axis,) * 3, colours)
    found = field(np.column_stack([np.full_like(far, x), np.full_like(far, y), far]))
    depth = -np.log1p(-found[:, 3]) * 0.02 / unit
    left = np.exp(-(np.cumsum(depth) - depth))
    return 255 * ((left * -np.expm1(-depth))[:, None] * found[:, :3]).sum(axis=0)


@pytest.mark.parametrize("unit", [2.0, 8.0])
def test_rgba_shows_its_own_colours_and_alpha(shot, unit):
    values = rgba()["rgba"].reshape(N, N, N, 4).transpose(2, 1, 0, 3)
    for source in (rgba(), (values, np.array(rgba().index_to_physical_matrix))):
        found = shot(lambda p, source=source: p.add_raycast_volume(source, opacity_unit_distance=unit))
        for column, row in ((48, 48), (70, 40), (30, 60), (60, 25)):
            x, y = (np.array([column, 95 - row]) + 0.5 - 48) * 36 / 96
            assert np.abs(found[row, column] - light_of_rgba(x, y, unit)).max() <= 4


def test_rgba_is_light_and_nothing_else():
    image = rgba()
    image["rgba"] = image["rgba"].astype(np.float32)
    with pytest.raises(ValueError, match="four of type uint8, RGBA"):
        as_raycast_volume(image, scalars="rgba")
    with pytest.raises(ValueError, match="RGBA of type uint8 is drawn as it is"):
        as_raycast_volume(np.zeros((4, 4, 4, 4)))
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.add_raycast_volume(rgba())
    assert actor.volume.colours.shape == (N, N, N, 3)
    assert actor.clim == (0, 255)
    assert len(plotter.scalar_bars) == 0
    with pytest.raises(ValueError, match="voxels are RGBA: show them as mode 'composite'"):
        actor.mode = "mip"
    assert actor.mode == "composite"
    plotter.close()


N_BULGE = 40
OPACITY = np.clip((np.linspace(0, 1, 256) - 0.25) * 3, 0, 0.6)
SHADED = {
    "cmap": "viridis", "clim": (0, 1), "opacity_unit_distance": 1.0, "shade": True, "show_scalar_bar": False,
    "specular_power": 10.0,
}  # fmt: skip

LIGHTS = {
    "beside": {"position": (1000, 200, 500), "focal_point": (20, 20, 20)},
    "behind": {"position": (-1000, -200, -500), "focal_point": (20, 20, 20)},
    "near": {"position": (75, 40, 60), "focal_point": (20, 20, 20), "positional": True, "cone_angle": 90},
    "the eye's": {"light_type": "headlight"},
    "a spot": {"position": (75, 40, 60), "focal_point": (20, 25, 20), "positional": True, "cone_angle": 12},
}


def bulge():
    x = np.linspace(-1, 1, N_BULGE)
    at = np.stack(np.meshgrid(x, x, x, indexing="ij"), axis=-1)
    ball = np.clip(1.15 - np.linalg.norm(at, axis=-1) / 0.8, 0, 1)
    field = ball + 0.6 * np.exp(-(((at - [0.3, -0.5, 0.3]) ** 2).sum(axis=-1)) * 40)
    image = pv.ImageData(dimensions=field.shape)
    image["values"] = (field / field.max()).astype(np.float32).ravel(order="F")
    return image


def lit_shot(add, lights, azimuth=30.0):
    plotter = pv.Plotter(off_screen=True, window_size=(120, 120), lighting="none")
    plotter.set_background("black")
    for light in lights:
        plotter.add_light(pv.Light(**{"light_type": "scene light", **LIGHTS[light]}))
    add(plotter)
    plotter.camera_position = "xy"
    plotter.camera.azimuth, plotter.camera.elevation = azimuth, 20.0
    plotter.camera.zoom(1.8)
    picture = np.array(plotter.screenshot(return_img=True)).astype(float)
    plotter.close()
    return picture


def ours(image, **look):
    return lambda plotter: plotter.add_raycast_volume(image, **{**SHADED, "opacity": OPACITY, **look})


def vtks(image, **look):
    def add(plotter):
        volume = plotter.add_volume(image.copy(), mapper="gpu", **{**SHADED, "opacity": 255 * OPACITY, **look})
        volume.mapper.SetAutoAdjustSampleDistances(0)
        volume.mapper.SetSampleDistance(0.25)
        volume.mapper.SetUseJittering(0)

    return add


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("lights", "reflection"),
    [
        (["beside"], (0.0, 1.0, 0.0)),
        (["behind"], (0.0, 0.7, 0.0)),
        (["near"], (0.0, 1.0, 0.0)),
        (["a spot", "behind"], (0.0, 0.8, 0.0)),
        (["beside", "near"], (0.0, 0.3, 0.3)),
        (["the eye's"], (0.5, 0.0, 0.0)),  # of other lights VTK takes an ambient colour, which they lack
    ],
)
def test_light_is_shaded_as_vtk_shades_it(lights, reflection):
    look = dict(zip(("ambient", "diffuse", "specular"), reflection, strict=True))
    image = bulge()
    found, right = lit_shot(ours(image, **look), lights), lit_shot(vtks(image, **look), lights)
    there = right.max(axis=-1) > 3
    assert there.mean() > 0.2
    assert np.abs(found - right)[there].mean() < (5.0 if reflection[2] else 2.5)
    assert np.quantile(np.abs(found - right)[there], 0.99) < (32 if reflection[2] else 16)
    plain = lit_shot(ours(image, shade=False), lights)
    assert np.abs(plain - right)[there].mean() > 15


def test_without_a_gradient_light_has_its_own_colours():
    """VTK leaves such parts black but for the ambient share; noise of a thousandth casts no shadows either."""
    image = bulge()
    for level, noise in ((0.6, 0.0), (0.6, 1e-3)):
        values = level + noise * np.random.default_rng(0).random(N_BULGE**3)
        image["values"] = values.astype(np.float32)
        lit, plain = (lit_shot(ours(image, shade=shade), ["beside"]) for shade in (True, False))
        assert plain.max() > 60
        assert np.abs(lit - plain).max() <= (1 if noise == 0.0 else 6)


def test_a_matrix_of_the_actor_turns_the_gradients():
    """A volume and its mirror image show the same where the matrix takes one to the other."""
    image = bulge()
    flipped = image.copy()
    flipped["values"] = image["values"].reshape(N_BULGE, N_BULGE, N_BULGE)[:, :, ::-1].ravel()
    matrix = np.diag([-1.0, 1.0, 1.0, 1.0])
    matrix[0, 3] = N_BULGE - 1.0
    found = lit_shot(ours(flipped, user_matrix=matrix, specular=0.3), ["beside", "near"])
    assert np.abs(found - lit_shot(ours(image, specular=0.3), ["beside", "near"])).max() <= 4


def test_it_is_a_live_setting():
    plotter = pv.Plotter(off_screen=True, window_size=(60, 60))
    with pytest.warns(UserWarning, match=r"ambient=0\.1 changes nothing in mode 'composite': set actor\.shade"):
        actor = plotter.add_raycast_volume(bulge(), ambient=0.1)
    assert not actor.shade
    before = np.array(plotter.screenshot(return_img=True)).astype(int)
    actor.shade = True
    actor.specular, actor.specular_power = 0.4, 20.0
    assert (actor.prop.ambient, actor.prop.specular) == (0.1, 0.4)
    plotter.render()
    assert np.abs(np.array(plotter.screenshot(return_img=True)).astype(int) - before).max() > 10
    assert actor.copy().shade
    assert "VOLUME_SHADED" in actor.explain()["features"]
    with pytest.raises(ValueError, match="specular"):
        actor.specular = -1.0
    plotter.close()


@pytest.mark.parametrize("box", [None, (0, N - 1, 0, N - 1, 9, N - 1)])
def test_a_closed_surface_looks_like_vtks_contour_of_a_volume_in_low_voxels(shot, box):
    image = ball()
    field = 14.0 - np.roll(image["far"].reshape((N, N, N), order="F"), (9, -11), (0, 1))
    image["near"] = field.ravel(order="F")
    low = 0 if box is None else box[4]
    padded = pv.ImageData(dimensions=(N + 2, N + 2, N + 2 - low), origin=np.array(image.origin) + [-1, -1, low - 1])
    padded["near"] = np.pad(field[:, :, low:], 1, constant_values=-1e5).ravel(order="F")
    style = {"color": "tan", "ambient": 0.1, "diffuse": 0.8, "specular": 0.0}

    def add_ours(plotter):
        where = {"scalars": "near", "values": 0.0, "closed": True, "box": box}
        plotter.add_raycast_volume(image, mode="isosurface", **where, **style)

    def add_contour(plotter):
        contour = padded.contour([0.0], scalars="near")
        plotter.add_mesh(contour.compute_normals(feature_angle=30, split_vertices=True), scalars=None, **style)

    view = [(-20.0, 35.0, -60.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    ours, theirs = shot(add_ours, view=view), shot(add_contour, view=view)
    apart = np.abs(ours - theirs).max(axis=-1)
    assert (theirs.max(axis=-1) > 0).sum() > 1000
    assert (apart > 24).mean() < 0.03, "edges"
    assert np.median(apart[theirs.max(axis=-1) > 0]) <= 3
