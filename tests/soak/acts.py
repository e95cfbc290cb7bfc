"""What a user may do to a scene, as short acts that a random walk draws from: each says what it did."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pyvista as pv

from pvfiblets import compress, regions
from pvfiblets.streamlines import Streamlines

Act = Callable[[Any, np.random.Generator], str | None]
"""Does something to a :class:`.walk.Soak` and says what; None where there is nothing to do it to."""

REACH = 40.0  # mm from the middle to the farthest of the data


class Data:
    """What is added again and again: made once, so that it is not what memory grows by."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.lines = [_lines(rng, 60, 90), _lines(rng, 25, 40)]
        self.fiblets = [compress(lines, per_point=("fa",), exact=False) for lines in self.lines]
        self.few = _lines(rng, 4, 12)
        grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, n) for n in (14, 12, 10)], indexing="ij"))
        self.values = (100.0 * np.exp(-3.0 * (grid**2).sum(0)) + rng.normal(size=grid.shape[1:])).astype(np.float32)
        self.affine = np.diag([6.0, 7.0, 8.0, 1.0])
        self.affine[:3, 3] = -39.0
        self.points = pv.PolyData(rng.uniform(-REACH, REACH, (80, 3)))
        self.points["size"] = rng.random(80)
        self.meshes = [pv.Sphere(radius=12.0), pv.Cube(x_length=30.0, y_length=20.0, z_length=15.0)]
        # Loads compiled kernels: whenever an act first needs them, their 70 MB would be taken for growth.
        self.fiblets[0].select(regions.passes(regions.Labels((self.values > 30.0).astype(np.uint8), self.affine)))
        self.torus = pv.ParametricTorus(ringradius=20, crosssectionradius=9, u_res=12, v_res=8, w_res=8)


def _lines(rng: np.random.Generator, count: int, points: int) -> Streamlines:
    directions = np.cumsum(rng.normal(size=(count, points, 3)) * 0.15 + rng.normal(size=(count, 1, 3)), axis=1)
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    walks = np.cumsum(0.8 * directions, axis=1) + rng.uniform(-20.0, 20.0, (count, 1, 3))
    n = count * points
    return Streamlines(
        np.clip(walks.reshape(-1, 3), -REACH, REACH),
        np.arange(0, n + 1, points),
        per_point={"fa": rng.random(n).astype(np.float32)},
        per_streamline={"weight": rng.random(count).astype(np.float32)},
        groups={"left": np.arange(0, count, 2), "right": np.arange(1, count, 2)},
    )


# What is added and removed ---------------------------------------------------------------------------


def add_fiblets(soak: Any, rng: np.random.Generator) -> str | None:
    which = int(rng.integers(0, 2))
    pipeline = str(rng.choice(["auto", "compute", "tessellation", "geometry"]))
    culling = _one(rng, ["two-phase", "coverage", None])
    scalars = _one(rng, [None, "fa", "weight", "length", "orientation"])
    return soak.add(
        "add_fiblets", soak.data.fiblets[which], scalars=scalars, pipeline=pipeline, culling=culling,
        line_width=_one(rng, [None, 3.0]), opacity=_one(rng, [1.0, 1.0, 0.5]),
    )  # fmt: skip


def add_tubes(soak: Any, rng: np.random.Generator) -> str | None:
    return soak.add(
        "add_spline_tubes", soak.data.few, radius=float(rng.uniform(0.2, 3.0)), scalars=_one(rng, [None, "fa"]),
        silhouettes=_one(rng, ["auto", "rectangles", "boxes"]), culling=_one(rng, ["two-phase", None]),
    )  # fmt: skip


def add_halo_lines(soak: Any, rng: np.random.Generator) -> str | None:
    return soak.add(
        "add_halo_lines", soak.data.lines[1], scalars=_one(rng, [None, "fa"]), tapering=bool(rng.integers(0, 2)),
        light_on_dark=bool(rng.integers(0, 2)), culling=_one(rng, ["two-phase", None]),
    )  # fmt: skip


def add_halo_points(soak: Any, rng: np.random.Generator) -> str | None:
    return soak.add(
        "add_halo_points", soak.data.points, scalars=_one(rng, [None, "size"]), filter_by="size",
        culling=_one(rng, ["two-phase", None]),
    )  # fmt: skip


def add_volume(soak: Any, rng: np.random.Generator) -> str | None:
    return soak.add(
        "add_raycast_volume", soak.data.values, affine=soak.data.affine, mode=_one(rng, MODES),
        integrator=_one(rng, INTEGRATORS), octree=bool(rng.integers(0, 2)),
    )  # fmt: skip


def add_mesh(soak: Any, rng: np.random.Generator) -> str | None:
    mesh = soak.data.meshes[int(rng.integers(0, 2))]
    return soak.add("add_mesh", mesh, opacity=_one(rng, [1.0, 0.4]), color="wheat")


def remove(soak: Any, rng: np.random.Generator) -> str | None:
    window = soak.window(rng)
    if not window.actors:
        return None
    kind, actor = window.actors.pop(int(rng.integers(0, len(window.actors))))
    window.plotter.remove_actor(actor)
    return f"remove {kind}"


def clear(soak: Any, rng: np.random.Generator) -> str | None:
    window = soak.window(rng)
    window.clear()
    return "clear the plotter"


# Windows and cameras ---------------------------------------------------------------------------------


def resize(soak: Any, rng: np.random.Generator) -> str:
    size = tuple(int(n) for n in rng.integers(soak.size // 2, soak.size + 1, 2))
    soak.window(rng).plotter.window_size = size
    return f"resize to {size}"


def second_window(soak: Any, rng: np.random.Generator) -> str:
    if len(soak.windows) > 1:
        soak.windows.pop().close()
        return "close the second window"
    soak.open((1, 2) if rng.integers(0, 2) else (1, 1))
    return "open a second window"


def turn(soak: Any, rng: np.random.Generator) -> str:
    camera = soak.window(rng).plotter.camera
    camera.azimuth += float(rng.uniform(-90, 90))
    camera.elevation = float(rng.uniform(-60, 60))
    return f"turn to {camera.azimuth:.1f}, {camera.elevation:.1f}"


def zoom(soak: Any, rng: np.random.Generator) -> str:
    plotter = soak.window(rng).plotter
    match rng.integers(0, 4):
        case 0:
            plotter.camera.zoom(factor := float(rng.uniform(0.5, 2.5)))
            return f"zoom by {factor:.2f}"
        case 1:
            plotter.camera.position = tuple(rng.uniform(-REACH, REACH, 3).tolist())
            plotter.renderer.ResetCameraClippingRange()
            return f"look from {plotter.camera.position}, within the data"
        case 2:
            plotter.camera.parallel_projection = not plotter.camera.parallel_projection
            return "toggle parallel projection"
        case _:
            plotter.reset_camera()
            return "reset the camera"


def picture(soak: Any, rng: np.random.Generator) -> str:
    effects = soak.window(rng).plotter.picture
    match rng.integers(0, 6):
        case 0:
            effects.depth_of_field = wanted = _one(rng, [True, False, {"focal_distance": "center", "max_blur": 5}])
            return f"depth of field {wanted}"
        case 1:
            effects.tone = wanted = _one(rng, [True, False, {"operator": "hable"}, {"operator": "reinhard"}])
            return f"tone {wanted}"
        case 2:
            effects.brightness = value = float(rng.uniform(-0.3, 0.3))
            return f"brightness {value:.2f}"
        case 3:
            effects.contrast = value = float(rng.uniform(0.5, 1.5))
            return f"contrast {value:.2f}"
        case 4:
            effects.gamma = value = float(rng.uniform(0.5, 2.0))
            return f"gamma {value:.2f}"
        case _:
            effects.reset()
            return "reset the picture"


def passes(soak: Any, rng: np.random.Generator) -> str:
    plotter = soak.window(rng).plotter
    name = str(rng.choice(
        ["enable_ssao", "disable_ssao", "enable_depth_peeling", "disable_depth_peeling", "enable_eye_dome_lighting",
         "disable_eye_dome_lighting", "ssaa", "disable_anti_aliasing"]
    ))  # fmt: skip
    if name == "ssaa":  # PyVista warns of the other, FXAA, where VTK draws by EGL, and takes this
        plotter.enable_anti_aliasing(name)
    elif name == "enable_ssao":
        plotter.enable_ssao(radius=10.0, kernel_size=8)
    elif name == "enable_depth_peeling":
        plotter.disable_anti_aliasing()  # in a multi-sampled window it is VTK itself that makes errors of OpenGL
        plotter.enable_depth_peeling()
    else:
        getattr(plotter, name)()
    return f"VTK's {name}"


def background(soak: Any, rng: np.random.Generator) -> str:
    colour = str(rng.choice(["black", "white", "navy"]))
    soak.window(rng).plotter.set_background(colour)
    return f"background {colour}"


def screenshot(soak: Any, rng: np.random.Generator) -> str:
    window = soak.window(rng)
    image = window.plotter.screenshot(return_img=True, scale=int(rng.integers(1, 3)))
    return f"screenshot {image.shape}"


def antialias(soak: Any, rng: np.random.Generator) -> str:
    value = [4, "coverage", "off"][int(rng.integers(0, 3))]
    soak.window(rng).plotter.picture.antialias = value
    return f"antialias {value}"


def widget(soak: Any, rng: np.random.Generator) -> str | None:
    window = soak.window(rng)
    found = window.of("add_fiblets")
    fiblets = window.plotter.fiblets
    if not found:
        return None
    match rng.integers(0, 5):
        case 0:
            fiblets.add_clip_plane_widget(found[0], normal=str(rng.choice(["x", "-y", "z"])))
            return "clip plane widget"
        case 1:
            fiblets.add_clip_box_widget(found[0], bounds=(-15, 20, -25, 25, -20, 20))
            return "clip box widget"
        case 2:
            fiblets.add_clip_mesh_widget(soak.data.meshes[0], found[0])
            return "clip mesh widget"
        case 3:
            fiblets.add_slab(found[0], normal="z", thickness=float(rng.uniform(3.0, 20.0)), render=False)
            return "slab"
        case _:
            fiblets.clear_widgets()
            return "clear widgets"


# What is set on one actor -----------------------------------------------------------------------------

MODES = ("isosurface", "composite", "mip", "local-mip")
INTEGRATORS = ("adaptive", "preintegrated", "exponential", "riemann", "simpson", "romberg", "rk4")

SHADES: dict[str, list[Any]] = {
    "color": ["orange", None, "#3060a0"],
    "cmap": ["viridis", "coolwarm", "gray"],
    "clim": [(0.1, 0.9), None],
    "n_colors": [8, 256],
    "visibility": [True, True, False],
    "lighting": [True, False],
    "user_matrix": [np.eye(4), np.diag([1.2, 0.8, 1.0, 1.0])],
}
ON_SURFACES: dict[str, list[Any]] = {
    "ambient_occlusion": [True, False, {"radius": 6.0, "samples": 8}],
    "depth_cue": [True, False, {"strength": 0.4, "color": "red"}],
}
TABLES: dict[str, dict[str, list[Any]]] = {
    "add_fiblets": SHADES | ON_SURFACES | {
        "scalars": ["fa", "weight", "length", "curvature", "arc_length", "orientation", None],
        "categories": [True, False],
        "opacity": [1.0, 0.6, 0.2],
        "transparency": [None, "layers", 2, 6],
        "line_width": [1.0, 2.0, 6.0],
        "tube_radius": [None, 0.5, 2.0],
        "tube_shading": [True, False],
        "illuminated": [True, False],
        "halos": [True, False, {"width": 2.0, "depth": 3.0}],
        "style": ["surface", "halo"],
        "pipeline": ["auto", "compute", "tessellation", "geometry"],
        "culling": ["two-phase", "coverage", None],
        "groups_shown": [None, ["left"], ["left", "right"]],
    },
    "add_spline_tubes": SHADES | ON_SURFACES | {
        "scalars": [None, "fa"],
        "opacity": [1.0, 0.5],
        "silhouettes": ["auto", "rectangles", "boxes", "pulled-boxes"],
        "solver": ["auto", "bisection", "illinois", "itp", "newton"],
        "iterations": [None, 4, 12],
        "min_width": [0.0, 1.0, 3.0],
        "silhouette": [False, True, "red"],
        "culling": ["two-phase", None],
    },
    "add_halo_lines": SHADES | {
        "scalars": [None, "fa"],
        "filter_by": ["length", "arc_length"],
        "threshold": [None, 0.4, (0.2, 0.8)],
        "displacement": ["linear", "square", "square root"],
        "strip_width": [None, 2.0, 6.0],
        "line_width": [None, 1.0],
        "max_displacement": [None, 4.0],
        "tapering": [True, False],
        "light_on_dark": [True, False],
        "width_cue": [0.0, 0.5, 1.0],
        "smooth": [True, False],
        "min_width": [0.0, 1.0, 2.0],
        "opacity": [1.0, 0.5],
        "culling": ["two-phase", None],
    },
    "add_halo_points": SHADES | {
        "scalars": [None, "size"],
        "filter_by": ["size"],
        "threshold": [None, 0.4],
        "halo_size": [None, 4.0],
        "point_size": [None, 2.0],
        "light_on_dark": [True, False],
        "smooth": [True, False],
        "opacity": [1.0, 0.5],
        "culling": ["two-phase", None],
    },
    "add_raycast_volume": ON_SURFACES | {
        "color": ["orange", None],
        "cmap": ["viridis", "gray"],
        "clim": [(10.0, 90.0), None],
        "visibility": [True, True, False],
        "lighting": [True, False],
        "mode": list(MODES),
        "values": [None, 40.0, (20.0, 60.0)],
        "thresholds": [None, (20.0, None), (5.0, 80.0)],
        "peak": [None, 50.0],
        "opacity": ["linear", "sigmoid", 0.4, [0.0, 0.2, 0.9]],
        "opacity_unit_distance": [None, 3.0],
        "step": [0.25, 0.5, 1.0],
        "filter": ["nearest", "trilinear", "tricubic"],
        "refine": ["exact", "regula-falsi", "newton", "none"],
        "integrator": list(INTEGRATORS),
        "jitter": [True, False],
        "octree": [True, False],
        "homogeneous": [0.0, 5.0],
        "recon": [True, False],
        "sparse": [1, 2, 4],
        "stop": [0.95, 1.0],
        "box": [None, (2, 9, 1, 9, 0, 8)],
        "smooth": [None, 0.8],
        "ray_occlusion": [False, True, {"samples": 5}],
    },
}  # fmt: skip


def style(soak: Any, rng: np.random.Generator) -> str | None:
    """Set one property of one actor to one of its values."""
    window = soak.window(rng)
    ours = [(kind, actor) for kind, actor in window.actors if kind in TABLES]
    if not ours:
        return None
    kind, actor = ours[int(rng.integers(0, len(ours)))]
    table = TABLES[kind]
    name = str(rng.choice(list(table)))
    value = _one(rng, table[name])
    if name == "threshold" and actor.filter_by is None:
        actor.filter_by = table["filter_by"][0]
    setattr(actor, name, value)
    return f"{kind[4:]}.{name} = {value if not isinstance(value, np.ndarray) else value.tolist()}"


def clip(soak: Any, rng: np.random.Generator) -> str | None:
    found = soak.window(rng).of("add_fiblets", "add_raycast_volume")
    if not found:
        return None
    actor = found[int(rng.integers(0, len(found)))]
    inside = bool(rng.integers(0, 2))
    match rng.integers(0, 6):
        case 0:
            actor.clip(soak.data.torus, inside)
            return f"clip by a torus, inside={inside}"
        case 1:
            actor.clip(regions.Sphere(tuple(rng.uniform(-10, 10, 3).tolist()), float(rng.uniform(5, 30))), inside)
            return f"clip by a sphere, inside={inside}"
        case 2:
            actor.clip((-15.0, 20.0, -25.0, 25.0, -20.0, 20.0), inside)
            return f"clip by a box, inside={inside}"
        case 3:
            actor.clip(("x", (0.0, 0.0, 0.0)) if rng.integers(0, 2) else ((1.0, 1.0, 0.0), (0.0, 0.0, 5.0)), inside)
            return f"clip by a plane, inside={inside}"
        case 4:
            actor.clip_slab("z", (0.0, 0.0, 0.0), float(rng.uniform(2.0, 15.0)))
            return "clip by a slab"
        case _:
            actor.unclip()
            return "unclip"


def choose(soak: Any, rng: np.random.Generator) -> str | None:
    found = soak.window(rng).of("add_fiblets")
    if not found:
        return None
    actor = found[int(rng.integers(0, len(found)))]
    n = actor.fiblets.n_streamlines
    sphere = regions.Sphere(tuple(rng.uniform(-10, 10, 3).tolist()), float(rng.uniform(5, 25)))
    match rng.integers(0, 11):
        case 0:
            actor.criterion("fa", (float(rng.uniform(0.0, 0.4)), 1.0))
            return "criterion of fa"
        case 1:
            actor.criterion("length", (float(rng.uniform(0.0, 40.0)), 100.0))
            return "criterion of length"
        case 2:
            actor.remove_criterion()
            return "remove criteria"
        case 3:
            actor.include(sphere)
            return "include a sphere"
        case 4:
            actor.exclude(sphere)
            return "exclude a sphere"
        case 10:
            labels = (soak.data.values > float(rng.uniform(5.0, 60.0))).astype(np.uint8)
            actor.include(regions.Labels(labels, soak.data.affine))
            return "include labels"
        case 5:
            actor.remove_condition()
            return "remove conditions"
        case 6:
            actor.subset(float(rng.uniform(0.0, 1.0)))
            return "subset"
        case 7:
            actor.show_only(rng.permutation(n)[: int(rng.integers(0, n))])
            return "show only some"
        case 8:
            soak.data.fiblets.reverse()
            actor.scalars, actor.groups_shown = None, None
            actor.show_all()
            actor.fiblets = soak.data.fiblets[0]
            return "other fiblets"
        case _:
            actor.show_all()
            return "show all"


def select(soak: Any, rng: np.random.Generator) -> str | None:
    found = soak.window(rng).of("add_fiblets")
    if not found:
        return None
    actor = found[int(rng.integers(0, len(found)))]
    n = actor.fiblets.n_streamlines
    match rng.integers(0, 7):
        case 0 | 1:
            mode = str(rng.choice(["replace", "add", "remove", "toggle"]))
            actor.select(rng.permutation(n)[: int(rng.integers(0, n // 2))], mode=mode)
            return f"select, {mode}"
        case 2:
            actor.selection_style(
                as_tubes=bool(rng.integers(0, 2)), radius=float(rng.uniform(0.3, 2.0)),
                color=_one(rng, [None, "red"]), silhouette=_one(rng, [True, False]), dim=float(rng.random()),
                width=_one(rng, [None, 4.0]),
            )  # fmt: skip
            return "style of the selection"
        case 3:
            actor.invert_selection()
            return "invert the selection"
        case 4:
            actor.grow_selection(3.0)
            return "grow the selection"
        case 5:
            actor.select(actor.streamlines_where(regions.Sphere((0.0, 0.0, 0.0), 15.0)))
            return "select in a sphere"
        case _:
            actor.deselect()
            return "deselect"


def pick(soak: Any, rng: np.random.Generator) -> str | None:
    window = soak.window(rng)
    ours = [actor for kind, actor in window.actors if kind in TABLES]
    if not ours or not window.drawn:
        return None
    width, height = window.plotter.window_size
    if rng.integers(0, 3) == 0 and (fibres := window.of("add_fiblets")):
        fibres[0].pick_box((0, 0, width // 2, height // 2), through=bool(rng.integers(0, 2)))
        return "pick in a box"
    found = ours[int(rng.integers(0, len(ours)))].pick_at(width // 2, height // 2)
    return f"pick {found}"


def explain(soak: Any, rng: np.random.Generator) -> str:
    plotter = soak.window(rng).plotter
    for part in (plotter.fiblets, plotter.spline_tubes, plotter.halo_lines, plotter.raycast_volumes):
        part.explain()
    return "explain"


def _one(rng: np.random.Generator, values: Any) -> Any:
    return values[int(rng.integers(0, len(values)))]


WEIGHTS: dict[Act, float] = {
    add_fiblets: 1.5, add_tubes: 1, add_halo_lines: 1, add_halo_points: 0.7, add_volume: 1, add_mesh: 0.7,
    remove: 4, clear: 0.3, resize: 2, second_window: 0.8, turn: 3, zoom: 2, picture: 1.5, passes: 1.2,
    background: 0.3, screenshot: 0.5, antialias: 0.4, widget: 0.8, style: 9, clip: 2, choose: 2,
    select: 2, pick: 1, explain: 0.4,
}  # fmt: skip
