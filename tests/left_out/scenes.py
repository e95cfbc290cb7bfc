"""Scenes of one feature each, drawn in a process of their own: ``scenes.py FOLDER NAME`` prints what one is made of.

PyVista is imported first and the process forked, so that what a scene imports is what it adds to PyVista.
"""

import hashlib
import json
import os
import sys
import traceback
from contextlib import nullcontext
from functools import partial
from pathlib import Path

import numpy as np

SIZE = (96, 80)
BRAIN, NODES, VOLUME = "brain.fiblets", "nodes.vtp", "volume.npy"


def prepare(folder: Path) -> None:
    """Write the data of all scenes."""
    import pyvista as pv

    from pvfiblets import compress
    from pvfiblets.synthetic import brain_streamlines

    streamlines = brain_streamlines(40, seed=1)
    streamlines.per_point = {"fa": np.linspace(0.0, 1.0, streamlines.n_points, dtype=np.float32)}
    streamlines.per_streamline = {"weight": np.arange(40, dtype=np.float32)}
    compress(streamlines, per_point=("fa",)).save(folder / BRAIN)
    angle = np.linspace(0.0, 6.0, 30)
    helix = pv.lines_from_points(np.stack([20 * np.cos(angle), 20 * np.sin(angle), 10 * angle], 1).astype("f4"))
    helix["radius"] = np.linspace(1.0, 3.0, 30).astype("f4")
    helix["flow"] = np.linspace(0.0, 1.0, 30).astype("f4")
    helix["rgb"] = np.linspace(0, 255, 90).astype("u1").reshape(30, 3)
    helix.save(folder / NODES)
    axes = np.linspace(-1.0, 1.0, 12, dtype=np.float32)
    ball = 1.5 - np.sqrt(axes[:, None, None] ** 2 + axes[:, None] ** 2 + axes**2)
    np.save(folder / VOLUME, ball.astype(np.float32))


class Scene:
    """What scenes are made of."""

    def __init__(self, folder: Path) -> None:
        import pyvista as pv

        self.folder = folder
        self.plotter = pv.Plotter(off_screen=True, window_size=SIZE)

    def brain(self, **arguments):
        self.actor = self.plotter.add_fiblets(self.folder / BRAIN, show_scalar_bar=False, **arguments)
        return self.actor

    def tubes(self, **arguments):
        given = {"radius": "radius", "show_scalar_bar": False} | arguments
        self.actor = self.plotter.add_spline_tubes(self._helix(), **given)
        return self.actor

    def lines(self, **arguments):
        given = {"show_scalar_bar": False, "tapering": False, "width_cue": 0.0} | arguments
        self.actor = self.plotter.add_halo_lines(self._helix(), **given)
        return self.actor

    def points(self, **arguments):
        given = {"show_scalar_bar": False, "width_cue": 0.0} | arguments
        self.actor = self.plotter.add_halo_points(self._helix(), **given)
        return self.actor

    def volume(self, **arguments):
        given = {"show_scalar_bar": False, "mode": "mip"} | arguments
        self.actor = self.plotter.add_raycast_volume(np.load(self.folder / VOLUME), **given)
        return self.actor

    def _helix(self):
        import pyvista as pv

        helix = pv.read(self.folder / NODES)
        helix.set_active_scalars(None)  # which would colour it
        return helix


def box(scene):
    x = np.reshape(scene.actor.bounds, (3, 2))
    return np.stack([x[:, 0], x.mean(1)], 1).ravel()


def middle(scene):
    return tuple(np.reshape(scene.actor.bounds, (3, 2)).mean(1))


def ball(scene):
    import pyvista as pv

    return pv.Sphere(radius=30.0, center=middle(scene))


def grid():
    affine = np.diag([9.0, 9.0, 9.0, 1.0])
    affine[:3, 3] = -85.0
    return np.indices((20, 20, 20)).sum(0).astype(np.float32), affine


def near_ball(scene):
    from pvfiblets import regions

    return regions.Sphere(middle(scene), 30.0)


def plane_and_ball(scene):
    scene.actor.clip(((1, 0, 0), middle(scene)))
    scene.actor.clip(near_ball(scene))


def setting(**wanted):
    """A scene of streamlines whose actor is given these properties."""

    def make(scene):
        scene.brain()
        yield
        for name, value in wanted.items():
            setattr(scene.actor, name, value)

    return make


def made(kind, **arguments):
    """A scene of one thing, added with these arguments."""

    def make(scene):
        getattr(scene, kind)(**arguments)
        yield

    return make


def doing(what, kind="brain"):
    """A scene to whose actor something is done."""

    def make(scene):
        getattr(scene, kind)()
        yield
        what(scene)

    return make


def set_picture(name, value):
    return doing(lambda scene: setattr(scene.plotter.picture, name, value))


def chosen_as_tubes(scene):
    scene.actor.selection_style(as_tubes=True, radius=0.8)
    scene.actor.select([3])


def clustered(scene):
    """A set with clusters, which otherwise only large ones have."""
    from pvfiblets.engine.fiblets.data import chunks

    chunks.CLUSTERED = 0
    scene.brain(culling="two-phase")
    yield


def outlined(scene):
    scene.actor.selection_style(silhouette=True)
    scene.actor.select([3])


SCENES = {
    "plain": made("brain"),
    "one colour": made("brain", color="red"),
    "colours: per streamline": made("brain", scalars="weight"),
    "colours: stored": made("brain", scalars="fa"),
    "colours: arc length": made("brain", scalars="arc_length"),
    "colours: curvature": made("brain", scalars="curvature"),
    "colours: volume": doing(lambda scene: setattr(scene.actor, "scalars", grid())),
    "colours: logarithm": made("brain", scalars="weight", log_scale=True, clim=(1, 40)),
    "wide lines": made("brain", line_width=3),
    "wide lines, shaded": setting(line_width=3, tube_shading=True),
    "ends": made("brain", style="ends"),
    "tubes": setting(tube_radius=0.5),
    "tubes, shaded": setting(tube_radius=0.5, tube_shading=True),
    "opacity": made("brain", opacity=0.5),
    "opacity, the nearest": made("brain", opacity=0.5, transparency=None),
    "density": made("brain", style="density"),
    "density, by a map": made("brain", style="density", scalars="density"),
    "layers": made("brain", opacity=0.5, transparency=3),
    "illuminated": setting(illuminated=True),
    "ambient occlusion": setting(ambient_occlusion=True),
    "depth cue": setting(depth_cue=True),
    "halos": setting(halos=True),
    "ink": setting(style="halo"),
    "clip: plane": doing(lambda s: s.actor.clip(((1, 0, 0), middle(s)))),
    "clip: planes of VTK": doing(lambda s: s.actor.mapper.AddClippingPlane(vtk_plane(middle(s)))),
    "clip: box": doing(lambda s: s.actor.clip(box(s))),
    "clip: plane and ball": doing(plane_and_ball),
    "clip: outside a box": doing(lambda s: s.actor.clip(box(s), inside=False)),
    "clip: mesh": doing(lambda s: s.actor.clip(ball(s))),
    "criterion: per streamline": doing(lambda s: s.actor.criterion("length", (20.0, 90.0))),
    "criterion: per point": doing(lambda s: s.actor.criterion("fa", (0.2, 0.8))),
    "include": doing(lambda s: s.actor.include(near_ball(s))),
    "selection": doing(lambda s: s.actor.select([3])),
    "selection as tubes": doing(chosen_as_tubes),
    "selection outlined": doing(outlined),
    "picking": doing(lambda s: s.actor.pick_at(SIZE[0] // 2, SIZE[1] // 2)),
    "detail": setting(detail=0.5),
    "culling: none": made("brain", culling=None),
    "culling: two-phase": made("brain", culling="two-phase"),
    "culling: two-phase, clusters": clustered,
    "culling: coverage": made("brain", culling="coverage"),
    "pipeline: geometry": made("brain", pipeline="geometry"),
    "pipeline: tessellation": made("brain", pipeline="tessellation"),
    "picture: depth of field": set_picture("depth_of_field", True),
    "picture: refined": set_picture("antialias", 4),
    "picture: refined, moving": set_picture("antialias", 4),
    "picture: tone": set_picture("tone", True),
    "spline tubes": made("tubes"),
    "spline tubes: values": made("tubes", scalars="flow"),
    "spline tubes: colours": made("tubes", scalars="rgb", rgb=True),
    "spline tubes: solver": made("tubes", solver="newton"),
    "spline tubes: planes": doing(lambda s: s.actor.mapper.AddClippingPlane(vtk_plane(middle(s))), "tubes"),
    "spline tubes: region": doing(lambda s: s.actor.clip(box(s), inside=False), "tubes"),
    "spline tubes: some": doing(lambda s: s.actor.subset(0.5), "tubes"),
    "halo lines": made("lines"),
    "halo lines: tapered": made("lines", tapering=True),
    "halo lines: cue": made("lines", width_cue=0.5),
    "halo lines: bent": made("lines", displacement="square"),
    "halo lines: filter": made("lines", filter_by="flow", threshold=(0.2, 0.8)),
    "halo lines: values": made("lines", scalars="flow"),
    "halo lines: colours": made("lines", scalars="rgb", rgb=True),
    "halo lines: region": doing(lambda s: s.actor.clip(box(s), inside=False), "lines"),
    "halo lines: some": doing(lambda s: s.actor.subset(0.5), "lines"),
    "halo points": made("points"),
    "halo points: some": doing(lambda s: s.actor.subset(0.5), "points"),
    "volume: mip": made("volume"),
    "volume: local mip": made("volume", mode="local-mip", peak=0.5),
    "volume: surface": made("volume", mode="isosurface", values=0.7),
    "volume: gentle light": made("volume", mode="composite", opacity=[0, 0.05]),
    "volume: light": made("volume", mode="composite", opacity=[0, 0.5]),
    "volume: dense light": made("volume", mode="composite"),
    "volume: shaded light": made("volume", mode="composite", shade=True),
    "volume: closed surface": made("volume", mode="isosurface", values=0.7, closed=True),
    "volume: translucent surfaces": made("volume", mode="isosurface", values=0.7, surface_opacities=0.5),
    "volume: minimum": made("volume", mode="minimum"),
    "volume: average": made("volume", mode="average"),
    "volume: nearest": made("volume", filter="nearest"),
    "volume: tricubic": made("volume", filter="tricubic"),
    "volume: jitter": made("volume", jitter=True, refine="regula-falsi"),
    "volume: no octree": made("volume", octree=False),
    "volume: sparse": made("volume", sparse=4),
    "volume: cut by planes": doing(lambda s: s.actor.clip(box(s)), "volume"),
    "volume: cut": doing(lambda s: s.actor.clip(box(s), inside=False), "volume"),
    "volume: ray occlusion": made("volume", mode="isosurface", values=0.7, ray_occlusion=True),
}


def vtk_plane(origin):
    from vtkmodules.vtkCommonDataModel import vtkPlane

    plane = vtkPlane()
    plane.SetOrigin(origin)
    plane.SetNormal(1.0, 0.0, 0.0)
    return plane


def frame(plotter, name: str) -> None:
    """Draw a frame of a moving camera; of what is done at rest, look at the picture."""
    plotter.camera.azimuth += 1.0
    plotter.render()
    if name == "picture: refined":
        plotter.screenshot(None)


def keep_shaders(folder: Path, mapper) -> None:
    """Write into a folder what VTK compiles, with the pieces of the resolve in it: a file for each distinct text."""
    from vtkmodules.util.misc import calldata_type
    from vtkmodules.util.vtkConstants import VTK_OBJECT

    @calldata_type(VTK_OBJECT)
    def keep(caller, event, program):
        for kind, shader in (("vert", program.GetVertexShader()), ("frag", program.GetFragmentShader())):
            text = shader.GetSource()
            (folder / f"vtk-{hashlib.sha1(text.encode()).hexdigest()}.{kind}").write_text(text)

    mapper.AddObserver("UpdateShaderEvent", keep)


def describe(folder: Path, name: str, before: set[str]) -> dict[str, object]:
    """Draw a scene and say what it is made of."""
    sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]
    scene = Scene(folder)
    steps = SCENES[name](scene)
    next(steps)
    from gl_calls import possible, recording  # as of the watch
    from watch import Watch  # nothing is drawn yet, and all that it imports is there already

    watch = Watch()
    keep_shaders(folder, scene.actor.mapper)
    with recording() if possible() else nullcontext() as calls:
        return drawn(scene, name, steps, watch, calls, before) | {"left": watch.nbytes}


def drawn(scene: Scene, name: str, steps, watch, calls, before: set[str]) -> dict[str, object]:
    """Draw a scene's frames, say what it is made of, and close it."""
    plotter = scene.plotter
    plotter.show(auto_close=False)
    if (compute := sys.modules.get("pvfiblets.engine.fiblets.pipelines.compute")) is not None:
        compute.READ_LISTS = False  # as on a card
    for _ in steps:
        pass
    for _ in range(3):
        frame(plotter, name)
    watch.forget()
    if calls is not None:
        calls.forget()
    frame(plotter, name)
    waits = {"at rest": sorted(set(calls.waits))} if calls is not None else {}
    loaded = set(sys.modules) - before - {"watch", "gl_calls"}
    found = {
        "modules": sorted(name for name in loaded if name.startswith("pvfiblets")),
        "packages": sorted(
            {name.partition(".")[0] for name in loaded if not name.startswith("_sysconfigdata")}  # Python's own, too
            - sys.stdlib_module_names
            - {"pvfiblets"}
        ),
        "ran": sorted(watch.ran),
        "features": sorted(watch.features),
        "made": watch.made,
        "nbytes": watch.nbytes,
    }
    report = scene.actor.explain()
    buffers = list(report["buffers"])
    if name.startswith("picture"):
        buffers += plotter.picture.explain()["buffers"]
    found |= {
        "told": report["features"],
        "told apart": report.get("selection", {}).get("features", []),
        "passes": sorted({item["name"] for item in report["passes"]}),
        "buffers": {item["name"]: item["bytes"] for item in buffers},
        "selection": report.get("selection", {}).get("gpu_bytes", 0),
    }
    if calls is not None:
        waits["in motion"] = waits_in_motion(plotter, calls)
    plotter.close()
    return found | {"waits": waits}


def waits_in_motion(plotter, calls) -> list[str]:
    """Calls that wait for the GPU in a frame of a camera that a user is turning."""
    plotter.render_window.SetDesiredUpdateRate(15.0)  # as VTK's interactor styles do
    for _ in range(4):
        calls.forget()
        plotter.camera.azimuth += 1.0
        plotter.render()
    return sorted(set(calls.waits))


def forked(work) -> dict[str, object]:
    """Do something in a child of this process and return what it returned."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        os.close(reading)
        try:
            answer = work()
        except Exception:  # noqa: BLE001  whatever it is, the parent tells it
            answer = {"error": traceback.format_exc()}
        with os.fdopen(writing, "w") as pipe:
            json.dump(answer, pipe)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    return json.loads(text) if text else {"error": f"the process ended with status {status}"}


def main() -> None:
    """Print one line of JSON for each scene."""
    folder, *names = sys.argv[1:]
    folder = Path(folder)
    import moderngl  # noqa: F401  every scene needs it
    import pyvista as pv

    # Whatever PyVista loads for a scene of its own is not ours.
    pv.Plotter(off_screen=True, window_size=SIZE).add_mesh(pv.Sphere(), scalars=np.zeros(pv.Sphere().n_points))
    before = set(sys.modules)
    for name in names or SCENES:
        found = forked(partial(describe, folder, name, before))
        print(json.dumps({"name": name, **found}), flush=True)


if __name__ == "__main__":
    main()
