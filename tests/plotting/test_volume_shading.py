"""Effects on surfaces of volumes: occlusion by rays and in screen space, and fading with distance."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

from pvfiblets.volumes import RaycastVolume

WINDOW = (120, 120)
MODES = ("composite", "mip", "local-mip")


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=WINDOW)
    plotter.background_color = "black"
    plotter.ren_win.SetMultiSamples(0)
    yield plotter
    plotter.close()


def shot(plotter):
    """Render and return the picture as floats; row 0 is the highest."""
    plotter.render()
    for actor in plotter.actors.values():
        if hasattr(actor, "raise_pending"):
            actor.raise_pending()
    return np.asarray(plotter.screenshot(return_img=True), np.float64)


def box(field, affine=None):
    """A volume of a field of x, y and z, in mm around the middle, on a grid of 1 mm."""
    x = np.arange(41) - 20.0
    values = field(*np.meshgrid(x, x, x, indexing="ij")).astype(np.float32)
    place = np.eye(4)
    place[:3, 3] = -20.0
    return RaycastVolume(values, place if affine is None else affine @ place)


def plane():
    """A half space that leans 50 degrees away from a viewer along y."""
    return box(lambda x, y, z: -(0.3 * x + 0.55 * z + 0.78 * y))


def corner():
    """A floor and a wall behind it, at right angles."""
    return box(lambda x, y, z: np.minimum(z + 8.3, 8.3 - y))


def shown(plotter, volume, *, parallel=False, eye=(0, -120, 60), target=(0, 0, 0), **settings):
    settings = {"mode": "isosurface", "values": 0.0, "color": "white", "lighting": False} | settings
    actor = plotter.add_raycast_volume(volume, **settings)
    plotter.camera.position, plotter.camera.focal_point, plotter.camera.up = eye, target, (0, 0, 1)
    plotter.camera.view_angle = 12
    if parallel:
        plotter.enable_parallel_projection()
        plotter.camera.parallel_scale = 13
    plotter.reset_camera_clipping_range()
    return actor


SPARSE = (1, 2, 4)
STRETCHED = np.diag([1.0, 1.0, 2.2, 1.0])


@pytest.mark.few(2)
@pytest.mark.every("pair")
@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
@pytest.mark.parametrize("sparse", SPARSE)
@pytest.mark.parametrize("matrix", [None, STRETCHED], ids=["plain", "stretched"])
def test_nothing_darkens_a_plane(plotter, parallel, sparse, matrix):
    actor = shown(plotter, plane(), parallel=parallel, user_matrix=matrix)
    actor._cast({"sparse": sparse})
    plain = shot(plotter)
    assert (plain.max(axis=-1) > 0).mean() > 0.8
    actor.ambient_occlusion = {"radius": 8.0, "samples": 32}
    darker = plain - shot(plotter)
    # Pixels beyond the outermost sparse rays lie where those lie, and not on the plane.
    assert darker.max() <= (2.0 if sparse == 4 else 0.0)
    actor.ambient_occlusion = False
    actor.ray_occlusion = {"radius": 8.0}
    darker = plain - shot(plotter)
    assert darker.max() <= 8.0  # one ray of 32 may be flat to float32's last digit
    assert (darker == 0.0).mean() > 0.99


def brightness_by_height(picture):
    """Mean of each row of the middle of a picture of the corner, seen level: from the floor up the wall."""
    return picture[::-1, 40:80, 0].mean(axis=1) / 255.0


def level(plotter, **settings):
    """The wall of the corner straight ahead, in parallel projection: 120 pixels are 26 mm."""
    return shown(plotter, corner(), parallel=True, eye=(0, -120, 0), **settings)


def test_a_corner_is_darker_by_the_closed_form(plotter):
    """A floor takes half of the hemisphere's cosine weight of a wall's foot."""
    actor = level(plotter, ray_occlusion={"radius": 9.0, "samples": 256})
    open_ = brightness_by_height(shot(plotter))
    height = (np.arange(120) + 0.5) * 26 / 120 - 13 + 8.3  # mm over the floor
    wall = height > 2.0  # below, the field rounds the edge
    share = np.clip(height / 9.0, 0.0, 1.0)
    right = 1.0 - (np.arccos(share) - share * np.sqrt(1.0 - share**2)) / np.pi
    assert np.abs(open_ - right)[wall].max() < 0.02
    actor.ray_occlusion = {"radius": 9.0, "samples": 256, "strength": 0.5}
    assert brightness_by_height(shot(plotter))[wall] == pytest.approx(0.5 + 0.5 * open_[wall], abs=0.01)
    actor.ray_occlusion = False
    actor.ambient_occlusion = {"radius": 9.0, "samples": 64}
    assert (brightness_by_height(shot(plotter)) == 1.0)[wall].all()  # level, the floor is not in the picture


def test_hidden_bodies_darken(plotter):
    """A slab that the picture does not show, behind the viewer's back: screen space knows nothing of it."""
    actor = shown(plotter, box(lambda x, y, z: np.minimum(y + 0.3, 6.3 - y) + 0 * (x + z)))
    actor.values = 0.0
    plotter.camera.position, plotter.camera.focal_point = (0, 3, 0), (0, -20, 0)
    plotter.camera.clipping_range = 0.5, 60
    plotter.camera.view_angle = 60
    plain = shot(plotter)
    assert (plain == 255).mean() > 0.9
    actor.ambient_occlusion = {"radius": 8.0}
    assert (shot(plotter) == plain).all()
    actor.ambient_occlusion = False
    actor.ray_occlusion = {"radius": 8.0, "samples": 128}
    # Of a slab at a distance h all is hidden below the angle with cosine h / R: a share 1 - (h / R)^2 of the weight.
    gap = 6.6 - 0.25  # rays start a quarter of a voxel above the surface
    assert shot(plotter)[40:80, 40:80].mean() / 255 == pytest.approx((gap / 8.0) ** 2, abs=0.01)


def test_a_cut_ends_the_rays(plotter):
    actor = level(plotter, ray_occlusion={"radius": 9.0, "samples": 64})
    dark = brightness_by_height(shot(plotter))
    assert dark[35:50].max() < 0.95
    actor.box = (0, 40, 0, 40, 13, 40)  # 1.3 mm above the floor
    cut = shot(plotter)[..., 0]
    assert (cut[cut > 0] == 255).all()
    actor.box = None
    above = vtkPlane()
    above.SetOrigin(0, 0, -7)
    above.SetNormal(0, 0, 1)
    actor.mapper.AddClippingPlane(above)
    cut = shot(plotter)[..., 0]
    assert (cut > 0).sum() > 1000
    assert (cut[cut > 0] == 255).all()


def test_both_effects_together_are_their_product(plotter):
    actor = level(plotter)
    pictures = {}
    for name, wanted in (("rays", {"ray_occlusion": True}), ("screen", {"ambient_occlusion": True})):
        for effect, value in wanted.items():
            setattr(actor, effect, value)
            pictures[name] = shot(plotter) / 255.0
            setattr(actor, effect, False)
    actor.ray_occlusion = actor.ambient_occlusion = True
    both = shot(plotter) / 255.0
    assert both.min() < 0.7
    assert np.abs(both - pictures["rays"] * pictures["screen"]).max() < 0.01
    actor.depth_cue = {"strength": 0.5, "color": "black", "range": (0.0, 1e-3)}
    assert np.abs(shot(plotter) / 255.0 - 0.5 * both).max() < 0.01
    assert {"ray_occlusion", "ambient_occlusion", "depth_cue"} <= set(actor.explain()["features"])


@pytest.mark.parametrize("parallel", [False, True], ids=["perspective", "parallel"])
def test_surfaces_fade_with_their_distance(plotter, parallel):
    actor = shown(plotter, box(lambda x, y, z: y), parallel=parallel, eye=(0, -100, 0))
    for depth, right in ((90.0, 0.0), (95.0, 0.25), (100.0, 0.5), (110.0, 1.0)):
        actor.values = depth - 100.0  # on the plane y = value
        actor.depth_cue = {"strength": 1.0, "color": "black", "range": (90.0, 110.0)}
        assert shot(plotter)[60, 60, 0] == pytest.approx(255 * (1.0 - right), abs=1.5)


def test_as_a_mesh_of_the_same_scene(plotter):
    """VTK's own occlusion in screen space reads depths and normals: those of a mesh darken as much."""
    volume = corner()
    pictures = []
    for kind in ("volume", "mesh"):
        if kind == "volume":
            shown(plotter, volume, eye=(50, -120, 70), lighting=True)
        else:
            plotter.clear_actors()
            image = pv.ImageData(dimensions=volume.shape, origin=(-20, -20, -20))
            image["values"] = volume.values.ravel(order="F")
            mesh = image.contour([0.0], scalars="values", compute_normals=True)
            plotter.add_mesh(mesh, color="white", smooth_shading=True, reset_camera=False)
        plain = shot(plotter)
        plotter.enable_ssao(radius=5, kernel_size=64)
        pictures.append((plain, shot(plotter)))
        plotter.disable_ssao()
    for one, other in zip(*pictures, strict=True):
        assert np.abs(one - other).mean() < 0.5
        assert np.quantile(np.abs(one - other), 0.98) <= 6.0
    assert (pictures[0][0] - pictures[0][1]).mean() > 5.0


@pytest.mark.parametrize("mode", MODES)
def test_other_modes_keep_it_for_surfaces(plotter, mode):
    actor = level(plotter)
    surface = shot(plotter)
    actor.mode = mode
    plain = shot(plotter)
    actor.ray_occlusion = actor.ambient_occlusion = True
    assert (shot(plotter) == plain).all()
    assert not {"ray_occlusion", "ambient_occlusion"} & set(actor.explain()["features"])
    assert "occlusion" not in str(actor.explain()["buffers"])
    actor.mode = "isosurface"
    assert (shot(plotter) < surface).any()
    assert actor.ray_occlusion == {"samples": 32, "radius": None, "strength": 1.0, "seed": 0, "smooth": True}


def test_off_it_leaves_nothing(plotter):
    actor = level(plotter)
    plain, before = shot(plotter), actor.explain()
    assert "occlusion" not in str(before)
    actor.ray_occlusion = True
    assert (shot(plotter) != plain).any()
    told = actor.explain()
    assert "ray_occlusion" in told["features"]
    assert {"name": "ray occlusion (effect)", "bytes": 2 * 120 * 120} in told["buffers"]
    assert {"ray occlusion (effect)", "mean ray occlusion (effect)"} <= {step["name"] for step in told["passes"]}
    actor.ray_occlusion = {"smooth": False}
    rough = shot(plotter)
    assert "mean ray" not in str(actor.explain())
    twin = actor.copy()
    assert twin.ray_occlusion == {"samples": 32, "radius": None, "strength": 1.0, "seed": 0, "smooth": False}
    actor.ray_occlusion = {"smooth": False, "seed": 6}
    assert (shot(plotter) != rough).any()
    actor.ray_occlusion = {"smooth": False, "radius": float(np.sqrt(3) * 40 / 20)}
    assert (shot(plotter) == rough).all()  # a 20th of the diagonal
    actor.ray_occlusion = None
    assert (shot(plotter) == plain).all()
    after = actor.explain()
    assert (after["features"], after["buffers"]) == (before["features"], before["buffers"])
