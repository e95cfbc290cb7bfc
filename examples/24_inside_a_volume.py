"""
Inside a volume
===============

A head with a part bitten out by a mesh, a box of voxels around a bend of a vessel, and a camera inside that vessel.

Run it as ``python examples/24_inside_a_volume.py [FOLDER]``. The data are made up.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pvfiblets import regions
from pvfiblets.synthetic.vessels import brain_like, vessel_tree
from pvfiblets.volumes import RaycastVolume, smoothed

LUMEN = 90  # brightness at the wall of a vessel
REACH = 24.0  # mm, half the side of the box


def draw_bite(plotter: pv.Plotter, head: RaycastVolume) -> None:
    """A head without what a mesh encloses: its skin in light and shade, and its values on the face of the cut."""
    centre = (45.0, 48.0, 42.0)
    bite = pv.Sphere(radius=62.0, center=centre, theta_resolution=90, phi_resolution=90)
    skin = plotter.add_raycast_volume(
        head, mode="isosurface", values=90, color="#f0cdb2", smooth=1.0, show_scalar_bar=False
    )
    skin.clip(bite, inside=False)
    face = plotter.add_raycast_volume(
        head, cmap="gray", clim=(0, 250), opacity=[0, 0] + [1] * 30, opacity_unit_distance=0.3, show_scalar_bar=False
    )
    face.clip(regions.Sphere(centre, 63.5))
    face.clip(bite, inside=False)  # cuts add up: a shell is left
    plotter.view_vector((1.0, 0.9, 0.8), viewup=(0, 0, 1))
    plotter.camera.zoom(1.9)


def middle_of_vessel(tree: RaycastVolume) -> np.ndarray:
    """Return points along the middle of the brightest vessel that enters from below, mm.

    It climbs slice by slice to where a smoothed picture is brightest, near where the last two slices expect it.
    """
    soft = smoothed(tree, 2.5).values
    nx, ny, nz = soft.shape
    ix, iy = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    at = np.array(np.unravel_index(soft[:, :, 6].argmax(), (nx, ny)), float)
    points, step = [], np.zeros(2)
    for k in range(6, nz // 2):
        away = np.hypot(ix - at[0] - step[0], iy - at[1] - step[1])
        weight = np.where(away < 5.0, soft[:, :, k].astype(float) ** 4, 0.0)
        if weight.max() < (0.35 * soft.max()) ** 4:
            break
        now = np.array([(ix * weight).sum(), (iy * weight).sum()]) / weight.sum()
        step, at = (0.7 * step + 0.3 * (now - at) if points else step), now
        points.append((*at, k))
    return np.array(points) @ tree.affine[:3, :3].T + tree.affine[:3, 3]


def draw_box(plotter: pv.Plotter, tree: RaycastVolume, path: np.ndarray) -> None:
    """What a box of voxels holds, and the way of the camera in it."""
    centre = (path[len(path) // 2] - tree.affine[:3, 3]) / tree.spacing
    sides = np.stack([centre - REACH / tree.spacing, centre + REACH / tree.spacing], axis=1).ravel()
    actor = plotter.add_raycast_volume(
        tree, mode="isosurface", values=LUMEN, color="#ffc4b4", opacity=0.6, box=sides, step=0.25, show_scalar_bar=False
    )
    actor.prop.specular, actor.prop.specular_power = 0.5, 30
    middle = path[len(path) // 2]
    inside = path[np.abs(path - middle).max(axis=1) < REACH]
    plotter.add_spline_tubes(inside[::6], radius=0.5, color="white")
    bounds = (middle[:, None] + (-REACH, REACH)).ravel()
    plotter.add_mesh(pv.Box(bounds), style="wireframe", color="gray")
    plotter.view_vector((0.3, -1.0, 0.3), viewup=(0, 0, 1), bounds=bounds)
    plotter.camera.zoom(1.15)


def draw_inside(plotter: pv.Plotter, tree: RaycastVolume, path: np.ndarray, start: int) -> None:
    """Stand in the vessel with a lamp; distant parts fade."""
    actor = plotter.add_raycast_volume(
        tree, mode="isosurface", values=LUMEN, color="#e8897a", smooth=0.8, step=0.25, show_scalar_bar=False
    )
    actor.prop.specular, actor.prop.specular_power, actor.prop.ambient = 0.35, 20, 0.1
    plotter.camera_position = [path[start], path[start + 14], (0, 1, 0)]
    plotter.camera.view_angle = 60.0
    plotter.camera.clipping_range = (0.1, 300.0)
    plotter.remove_all_lights(only_active=True)
    plotter.add_light(pv.Light(position=tuple(path[start]), positional=True, cone_angle=180.0), only_active=True)
    actor.depth_cue = {"color": "black", "range": (4.0, 45.0), "strength": 1.0}


def main(folder: Path) -> None:
    """Write one picture of the three."""
    folder.mkdir(parents=True, exist_ok=True)
    head, tree = brain_like(192), vessel_tree(256)
    path = middle_of_vessel(tree)
    print(f"the vessel is followed over {np.linalg.norm(np.diff(path, axis=0), axis=1).sum():.0f} mm")
    window = {"window_size": (1350, 900), "shape": (2, 3), "groups": [(slice(0, 2), slice(0, 2))], "border": False}
    plotter = pv.Plotter(off_screen=True, **window)
    plotter.set_background("black", all_renderers=True)
    plotter.subplot(0, 0)
    draw_bite(plotter, head)
    plotter.subplot(0, 2)
    draw_box(plotter, tree, path)
    plotter.subplot(1, 2)
    draw_inside(plotter, tree, path, 2 * len(path) // 3)
    plotter.screenshot(folder / "inside_a_volume.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
