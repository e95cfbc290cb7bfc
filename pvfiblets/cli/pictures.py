"""The commands ``pvfiblets screenshot``, ``show`` and ``demo``."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets import formats
from pvfiblets.cli.files import print_json
from pvfiblets.formats.registry import READ_BY_VTK, UnknownFormatError, suffix_of
from pvfiblets.formats.vtk_files.by_vtk import read_dataset
from pvfiblets.support.addresses import is_url, path_of
from pvfiblets.support.whole_files import made_folder, replacing
from pvfiblets.volumes.freesurfer_files import VALUES
from pvfiblets.volumes.gifti_files import VALUES as OF_GIFTI
from pvfiblets.web.values import plain

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.streamlines import Streamlines

OF_VERTICES = (*OF_GIFTI, *VALUES)
VTK = (".vtk", ".vtp")
LINE_CELLS = (3, 4)  # VTK_LINE, VTK_POLY_LINE

# Where a scalar bar covers nothing of a brain.
NOTHING: dict[str, Any] = {"color_along": [], "clip": [], "clip_away": [], "include": [], "exclude": [],
                           "criterion": [], "groups": None, "subset": None}  # fmt: skip
UPRIGHT = {"vertical": True, "height": 0.5, "position_x": 0.9, "position_y": 0.25}


def screenshot(paths: list[str], *, output: str, size: tuple[int, int], transparent: bool, **looks: Any) -> None:
    """Draw files into a picture file."""
    suffix = Path(output).suffix.lower()
    if suffix not in (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"):
        raise ValueError(f"{output}: pictures are written as .png, .jpg, .bmp or .tif; name the output so")
    plotter, scene = make_plotter(off_screen=True, size=size), None
    try:
        scene = fill(plotter, paths, **looks)
        with replacing(output) as file:
            made = file.name + suffix
            try:
                if transparent:
                    from pvfiblets.plotting.plotter_methods.transparent import screenshot as without_background

                    without_background(plotter, made, return_img=False)
                elif scene is None:
                    plotter.screenshot(made, return_img=False)
                else:
                    scene.cameras.screenshot(made)
                file.write(Path(made).read_bytes())
            finally:
                Path(made).unlink(missing_ok=True)
    finally:
        if scene is not None:
            scene.close()
        plotter.close()


def page(paths: list[str], *, output: str, title: str | None, **looks: Any) -> None:
    """Write files as a page that draws them by itself."""
    from pvfiblets.page.writing import check_name
    from pvfiblets.plotting.page.page_scene import export_page

    check_name(output)
    plotter, scene = make_plotter(off_screen=True, size=None), None
    try:
        scene = fill(plotter, paths, **looks)
        if scene is None and looks["view"] is None:
            plotter.camera_set = False  # the page fits its first view to the reader's window
        for path in export_page(plotter, output, title=title or PurePosixPath(paths[0]).name):
            print(f"{path}: {path.stat().st_size:,} bytes")
    finally:
        if scene is not None:
            scene.close()
        plotter.close()


def show(paths: list[str], **looks: Any) -> None:
    """Open a window with the files."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise OSError("there is no display to show a window on; use `pvfiblets screenshot`")
    plotter = make_plotter(off_screen=False, size=None)
    scene = fill(plotter, paths, **looks)
    plotter.add_axes()
    try:
        plotter.show(title="pvfiblets")
    finally:
        if scene is not None:
            scene.close()


def make_plotter(*, off_screen: bool, size: tuple[int, int] | None, **panels: Any) -> Any:
    """Return a plotter; off screen on Linux without X, VTK need not try X first and complain."""
    if off_screen and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    import pyvista

    return pyvista.Plotter(off_screen=off_screen, window_size=None if size is None else list(size), **panels)


def fill(
    plotter: pv.BasePlotter,
    paths: list[str],
    *,
    view: str | None,
    scalars: str | None,
    color: str | None,
    cmap: str | None,
    clim: list[float] | None,
    line_width: float | None,
    opacity: float | None,
    background: str | None,
    no_lighting: bool,
    look: str | None = None,
    antialias: str | int | None = None,
    **wishes: Any,
) -> Any:
    """Put files into a plotter's scene and point the camera; of a session, return the scene that keeps it."""
    from pvfiblets.cli.scene import cut_and_filter, open_session, options_of
    from pvfiblets.plotting.viewpoints import point_camera

    if antialias is not None:
        plotter.picture.antialias = antialias
    for path in paths:
        of_shards = is_url(path) and path.lower().endswith(".fiblets")
        if not of_shards and not path_of(path).exists():
            raise FileNotFoundError(2, "No such file or directory", path)
    if any(path.lower().endswith(".json") for path in paths):
        said = {"scalars": scalars, "color": color, "cmap": cmap, "clim": clim, "line_width": line_width,
                "opacity": opacity, "background": background, "no_lighting": no_lighting, "look": look,
                **wishes}  # fmt: skip
        if len(paths) > 1:
            raise ValueError(f"{' '.join(paths)}: a session names all of its files; give the session alone")
        if named := [name for name, value in said.items() if value not in (None, False, [])]:
            raise ValueError(f"{paths[0]} is a session with its own settings: leave --{named[0].replace('_', '-')} out")
        scene = open_session(plotter, paths[0])
        if view is not None:
            point_camera(plotter, view)
        return scene
    plotter.set_background("black" if background is None else background)
    text = "black" if sum(plotter.background_color.float_rgb) > 1.5 else "white"
    # What is not said is left to the look.
    said = {"look": look, "line_width": line_width, "opacity": opacity, "lighting": False if no_lighting else None}
    said = {name: value for name, value in said.items() if value is not None}
    said |= {"scalars": scalars, "color": color, "cmap": cmap, "clim": clim}
    bars = {"color": text, **UPRIGHT}
    of = {kind: options_of(wishes.get(kind, []), f"--{kind}") for kind in ("lines", "volumes", "meshes")}
    actors: dict[str, list[Any]] = {kind: [] for kind in of}
    for path, values in with_their_values(paths):
        kind = kind_of(path)
        if kind == "meshes":
            mesh, colours = coloured_mesh(path, values, bars)
            added = plotter.add_mesh(mesh, **{**colours, **of[kind]})
        elif kind == "volumes":
            usual = {"cmap": "gray", "show_scalar_bar": False, "render": False}
            added = plotter.add_raycast_volume(read_volume(path), **{**usual, **of[kind]})
        else:
            usual = {**said, "scalar_bar_args": bars, "render": False, "progress": sys.stderr.isatty()}
            added = plotter.add_fiblets(path, **{**usual, **of[kind]})
        actors[kind].append(added)
    for kind, given in of.items():
        if given and not actors[kind]:
            raise ValueError(f"--{kind} applies to {kind}, but no FILE has any")
    cut_and_filter(actors, {**NOTHING, **wishes})
    point_camera(plotter, view or "oblique")
    return None


def kind_of(path: str) -> str:
    """Return whether a file is of lines, a volume or a mesh: VTK's formats may be any of them."""
    from pvfiblets.images.files import SUFFIXES as IMAGES
    from pvfiblets.plotting.meshes import SUFFIXES as MESHES

    lower = path.lower()
    if lower.endswith(IMAGES):
        return "volumes"
    try:
        suffix = suffix_of(path)
    except UnknownFormatError:
        if lower.endswith(MESHES):
            return "meshes"
        raise
    if suffix not in (*VTK, *READ_BY_VTK):
        return "lines"
    import pyvista

    data = read_dataset(path) if suffix in READ_BY_VTK else pyvista.read(path)
    if isinstance(data, (pyvista.ImageData, pyvista.RectilinearGrid)):
        return "volumes"
    return "lines" if _has_lines(data) else "meshes"


def _has_lines(data: Any) -> bool:
    """Return True if a dataset of VTK's, or a block of it, has cells that are lines."""
    import pyvista

    if isinstance(data, pyvista.MultiBlock):
        return any(block is not None and _has_lines(block) for block in data)
    if isinstance(data, pyvista.UnstructuredGrid):
        return bool(np.isin(data.celltypes, LINE_CELLS).any())
    return bool(isinstance(data, pyvista.PolyData) and data.n_lines)


def with_their_values(paths: Sequence[str]) -> list[tuple[str, list[str]]]:
    """Return files, each surface with the files of values for its vertices that follow it."""
    found: list[tuple[str, list[str]]] = []
    for path in paths:
        if not path.lower().endswith(OF_VERTICES):
            found.append((path, []))
        elif found and kind_of(found[-1][0]) == "meshes":
            found[-1][1].append(path)
        else:
            raise ValueError(
                f"{path} holds values for the vertices of a surface, and follows none; give the surface before it: "
                f"lh.pial {Path(path).name}"
            )
    return found


def coloured_mesh(path: str, values: Sequence[str], bars: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Return a surface, and what colours it: the last of its files of values, or light gray."""
    from pvfiblets.plotting.gifti import shown_array, with_vertex_values
    from pvfiblets.plotting.meshes import read_mesh

    mesh = read_mesh(path)
    colours: dict[str, Any] = {"color": "lightgray"}
    for one in values:
        mesh = with_vertex_values(mesh, one)
        name = shown_array(mesh, one)
        colours = {"scalars": name, "rgb": name.endswith("_rgb"), "scalar_bar_args": bars}
    return mesh, colours


def read_volume(path: str) -> Any:
    """Return what ``add_raycast_volume`` takes of a file: its path, but of VTK's own format the image."""
    if not path.lower().endswith(".vtk"):
        return path
    import pyvista

    return pyvista.read(path)


def demo(*, output: str, streamlines: int, step: float, seed: int, json: bool) -> None:
    """Make, compress, measure and draw a whole-brain-like tractogram."""
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.codec.files.convert import compress_file
    from pvfiblets.streamlines import Streamlines
    from pvfiblets.synthetic import brain_streamlines

    def say(text: str) -> None:
        if not json:
            print(text, flush=True)

    folder = made_folder(output)
    original, compressed, picture = (folder / f"brain.{end}" for end in ("tck", "fiblets", "png"))

    say(f"Making a whole-brain-like tractogram of {streamlines:,} streamlines ...")
    brain = brain_streamlines(streamlines, step, seed, fa=True)
    formats.write(original, Streamlines(brain.points, brain.offsets))
    say("Compressing it ...")
    result = compress_file(original, compressed, progress=not json)

    say("Drawing it ...")
    begin = time.perf_counter()
    # Before PyVista is imported by anything else.
    plotter = make_plotter(
        off_screen=True, size=(1600, 600), shape=(2, 4), groups=[(slice(None), slice(0, 2))], border=False
    )
    try:
        gpu_bytes = _show_colourings(plotter, FibletSet.open(compressed), brain)
        plotter.screenshot(picture, return_img=False)
    finally:
        plotter.close()
    result["original_bytes"] = original.stat().st_size
    result["gpu_bytes"] = gpu_bytes
    result["picture"] = str(picture)
    result["picture_seconds"] = time.perf_counter() - begin
    if json:
        print_json(result)
    else:
        print(demo_table(plain(result), original, compressed))


def _show_colourings(plotter: pv.BasePlotter, fiblets: FibletSet, brain: Streamlines) -> int:
    """Show a brain from the left, large, and beside it in four colourings; return the bytes of the large one."""
    from pvfiblets.codec.encoding.compress import compress
    from pvfiblets.plotting.viewpoints import point_camera
    from pvfiblets.query.bundles.colours import distinct_colours

    bundle = brain.per_streamline["bundle"]
    bar = {"color": "white", "vertical": True, "position_x": 0.86, "position_y": 0.2, "height": 0.6, "fmt": "%.3g"}
    bar |= {"title_font_size": 14, "label_font_size": 14}
    colourings: dict[str, dict[str, Any]] = {
        "": {},
        "orientation": {},
        "length": {"scalars": "length", "cmap": "plasma", "scalar_bar_args": {**bar, "title": "mm"}},
        "FA in each point": {"scalars": "fa", "cmap": "viridis", "clim": (0.1, 0.7),
                             "scalar_bar_args": {**bar, "title": "FA"}},
        "bundles": {"scalars": distinct_colours(int(bundle.max()) + 1)[bundle]},
    }
    with_fa = compress(brain, per_point=["fa"])
    places = [(0, 0), (0, 2), (0, 3), (1, 2), (1, 3)]
    actors = []
    for place, (title, colours) in zip(places, colourings.items(), strict=True):
        plotter.subplot(*place)
        plotter.set_background("black")
        shown = with_fa if title.startswith("FA") else fiblets
        actors.append(plotter.add_fiblets(shown, line_width=1.0, render=False, **colours))
        if title:
            plotter.add_text(title, font_size=9, color="white")
        point_camera(plotter, "sagittal")
    for scalar_bar in plotter.scalar_bars.values():
        scalar_bar.SetVerticalTitleSeparation(10)  # a title does not stand on the first number
    plotter.render()
    nbytes: int = actors[0].explain()["gpu_bytes"]
    return nbytes


def demo_table(result: dict[str, Any], original: Path, compressed: Path) -> str:
    """Return size and error as a table."""
    points = result["points"]

    def row(name: str, size: int) -> str:
        return f"  {name:<28} {size / 1e6:>10.1f} MB {size / points:>8.2f} bytes per point"

    error, steps, angles = result["error_mm"], result["error_steps"], result["error_degrees"]
    return "\n".join(
        [
            "",
            f"  {result['streamlines']:,} streamlines, {points:,} points",
            "",
            row(str(original.name), result["original_bytes"]),
            row(str(compressed.name), result["bytes"]),
            "",
            f"  {'error of the points':<28} {'mm':>10} {'steps':>10}",
            *(
                f"  {name:<28} {error[key]:>10.5f} {steps[key]:>10.4f}"
                for name, key in (("mean", "mean"), ("99.9 % are below", "p999"), ("greatest", "max"))
            ),
            f"  {'error of the directions':<28} {'degrees':>10}",
            *(
                f"  {name:<28} {angles[key]:>10.3f}"
                for name, key in (("mean", "mean"), ("99 % are below", "p99"), ("greatest", "max"))
            ),
            "",
            f"  compressed in {result['seconds']:.1f} s; drawn into {result['picture']} "
            f"in {result['picture_seconds']:.1f} s",
            f"  look closer: pvfiblets show {compressed}",
        ]
    )
