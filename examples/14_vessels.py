"""
Vessels
=======

A tree of vessels as spline tubes: radii by Murray's law, branches that share their nodes, a cut, a look inside.

Run it as ``python examples/14_vessels.py [FOLDER]``. The tree is made up; a centre line of VMTK with its
``MaximumInscribedSphereRadius`` is drawn just so.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

NODES = 4  # of each branch, beside the one at which it begins
# Directions are unit vectors: derivatives by length. As they are given, branches share a node and its direction.
SHAPE = {"tangents": "direction", "scaled": True}
COLOURS = {"cmap": "autumn_r", "log_scale": True}


def unit(vector: np.ndarray) -> np.ndarray:
    """Return the vector at length 1."""
    return vector / np.linalg.norm(vector)


def vessel_tree(radius: float = 6.0, least: float = 0.45, seed: int = 3) -> pv.PolyData:
    """Grow branches until they are thinner than ``least`` (mm); each is a line that begins at its parent's last node.

    Murray's law (1926): r^3 = r1^3 + r2^3, so that flow costs least; by it, radii say how far the two turn away, too.
    """
    rng = np.random.default_rng(seed)
    points, tangents, radii, ways, lines = [np.zeros(3)], [np.array([0.0, 0.0, 1.0])], [radius], [0.0], []
    sideways = np.array([1.0, 0.0, 0.0])
    growing = [(0, radius, tangents[0], sideways)]  # first node, radius, where it wants to go, normal of its last bend
    while growing:
        node, r, aim, across = growing.pop(0)
        line, place, way = [node], points[node], tangents[node]
        length = r * rng.uniform(8.0, 13.0) * (1.0 if lines else 1.6)
        for _ in range(NODES):
            before, way = way, unit(way + 0.9 * aim + rng.normal(0.0, 0.10, 3))
            place = place + length / NODES * unit(before + way)
            line.append(len(points))
            points.append(place)
            tangents.append(way)
            radii.append(r)
            ways.append(ways[line[-2]] + length / NODES)
        lines.append(line)
        share = rng.uniform(0.28, 0.5)  # of the blood that goes to the thinner one
        thin, thick = r * share ** (1 / 3), r * (1.0 - share) ** (1 / 3)
        if thick < least:
            continue
        # From one bifurcation to the next, the plane turns by about a right angle.
        across = unit(np.cross(way, across) + rng.normal(0.0, 0.35, 3))
        side = unit(np.cross(across, way))
        for own, other, sign in ((thick, thin, 1.0), (thin, thick, -1.0)):
            turn = np.arccos((r**4 + own**4 - other**4) / (2.0 * r**2 * own**2))
            growing.append((line[-1], own, np.cos(turn) * way + sign * np.sin(turn) * side, across))
    cells = np.concatenate([[len(line), *line] for line in lines])
    tree = pv.PolyData(np.array(points), lines=cells)
    tree["radius"], tree["direction"], tree["way"] = np.array(radii), np.array(tangents), np.array(ways)
    return tree


def draw_whole(plotter: pv.Plotter, tree: pv.PolyData) -> None:
    """Colour by radius; ambient occlusion shows depth."""
    bar = {"title": "radius (mm)", "color": "white", "vertical": True, "position_x": 0.05, "position_y": 0.05}
    bar |= {"height": 0.3, "width": 0.06}
    actor = plotter.add_spline_tubes(tree, **SHAPE, scalars="radius", **COLOURS, scalar_bar_args=bar)
    actor.prop.specular, actor.prop.specular_power = 0.4, 30
    actor.ambient_occlusion = {"radius": 10.0}
    plotter.view_vector((0.25, -1.0, 0.12), viewup=(0, 0, 1))
    plotter.camera.zoom(1.4)


def draw_cut(plotter: pv.Plotter, tree: pv.PolyData, fork: np.ndarray) -> None:
    """Cut by VTK's own clipping planes: tubes are solid, and show where they are cut through."""
    actor = plotter.add_spline_tubes(tree, **SHAPE, scalars="radius", **COLOURS, show_scalar_bar=False)
    plane = vtkPlane()
    plane.SetOrigin(*(fork + (0.0, 0.0, 100.0)))
    plane.SetNormal(0.0, 0.3, -1.0)  # what it points to stays
    actor.mapper.AddClippingPlane(plane)
    plotter.camera_position = [fork + (-60.0, -230.0, 230.0), fork + (-10.0, 0.0, 65.0), (0, 0, 1)]


def draw_inside(plotter: pv.Plotter, tree: pv.PolyData, nodes: np.ndarray) -> None:
    """Stand in a branch with a lamp; a ring is 4 mm of the way from the root."""
    rings = {"cmap": ["#8c1a1a", "#e8695a"] * 40, "n_colors": 80, "clim": (0.0, 320.0), "show_scalar_bar": False}
    actor = plotter.add_spline_tubes(tree, **SHAPE, scalars="way", **rings)
    start, radius, ahead = tree.points[nodes[0]], tree["radius"][nodes[0]], tree["direction"][nodes[0]]
    up = unit(np.cross(ahead, (1.0, 0.0, 0.0)))
    eye = start + 0.5 * radius * ahead + 0.3 * radius * up
    plotter.camera_position = [eye, tree.points[nodes[1]], up]
    plotter.camera.view_angle = 85.0
    plotter.camera.clipping_range = (0.2, 500.0)
    plotter.remove_all_lights(only_active=True)
    lamp = pv.Light(position=tuple(eye + 0.3 * radius * up), positional=True, cone_angle=180.0)
    plotter.add_light(lamp, only_active=True)
    actor.depth_cue = {"color": "black", "range": (2.0 * radius, 14.0 * radius), "strength": 1.0}
    actor.prop.ambient = 0.15


def main(folder: Path) -> None:
    """Write one picture of the whole, of a cut and from inside."""
    folder.mkdir(parents=True, exist_ok=True)
    tree = vessel_tree()
    branches = tree.lines.reshape(-1, NODES + 2)[:, 1:]
    print(f"{len(branches):,} branches, {tree['radius'].min():.2f} to {tree['radius'].max():.2f} mm")
    window = {"window_size": (1350, 900), "shape": (2, 3), "groups": [(slice(0, 2), slice(0, 2))], "border": False}
    plotter = pv.Plotter(off_screen=True, **window)
    plotter.set_background("black", all_renderers=True)
    plotter.subplot(0, 0)
    draw_whole(plotter, tree)
    plotter.subplot(0, 2)
    draw_cut(plotter, tree, tree.points[branches[0, -1]])
    plotter.subplot(1, 2)
    draw_inside(plotter, tree, branches[1, 1:])
    plotter.scalar_bars["radius (mm)"].SetVerticalTitleSeparation(12)  # off the first number
    plotter.screenshot(folder / "vessels.png")
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
