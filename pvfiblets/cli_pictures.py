"""What ``pvfiblets screenshot``, ``show`` and ``demo`` do."""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import Any

from pvfiblets import formats
from pvfiblets.cli_files import print_json
from pvfiblets.formats.registry import UnknownFormatError, suffix_of
from pvfiblets.web.values import plain

# Where a scalar bar covers nothing of a brain.
UPRIGHT = {"vertical": True, "height": 0.5, "position_x": 0.9, "position_y": 0.25}


def screenshot(paths: list[str], *, output: str, size: tuple[int, int], transparent: bool, **looks: Any) -> None:
    """Draw files into a picture file."""
    suffix = Path(output).suffix.lower()
    if suffix not in (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"):
        raise ValueError(f"{output}: pictures are written as .png, .jpg, .bmp or .tif; name the output so")
    plotter = make_plotter(off_screen=True, size=size)
    try:
        fill(plotter, paths, **looks)
        plotter.screenshot(output, transparent_background=transparent, return_img=False)
    finally:
        plotter.close()


def show(paths: list[str], **looks: Any) -> None:
    """Open a window with the files."""
    if sys.platform.startswith("linux") and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise OSError("there is no display to show a window on; use `pvfiblets screenshot`")
    plotter = make_plotter(off_screen=False, size=None)
    fill(plotter, paths, **looks)
    plotter.add_axes()
    plotter.show(title="pvfiblets")


def make_plotter(*, off_screen: bool, size: tuple[int, int] | None) -> Any:
    """Return a plotter; off screen on Linux without X, VTK need not try X first and complain."""
    if off_screen and sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    import pyvista

    return pyvista.Plotter(off_screen=off_screen, window_size=None if size is None else list(size))


def fill(
    plotter: Any,
    paths: list[str],
    *,
    view: str,
    scalars: str | None,
    color: str | None,
    cmap: str | None,
    clim: list[float] | None,
    line_width: float | None,
    opacity: float | None,
    background: str,
    no_lighting: bool,
    look: str | None = None,
    antialias: str | int | None = None,
) -> None:
    """Put files into a plotter's scene and point the camera."""
    from pvfiblets.plotting.viewpoints import point_camera

    if antialias is not None:
        plotter.picture.antialias = antialias
    plotter.set_background(background)
    text = "black" if sum(plotter.background_color.float_rgb) > 1.5 else "white"
    # What is not said is left to the look.
    said = {"look": look, "line_width": line_width, "opacity": opacity, "lighting": False if no_lighting else None}
    said = {name: value for name, value in said.items() if value is not None}
    for path in paths:
        if not Path(path).exists():
            raise FileNotFoundError(2, "No such file or directory", path)
        if is_mesh(path):
            import pyvista

            plotter.add_mesh(pyvista.read(path), color="lightgray")
            continue
        plotter.add_fiblets(
            path,
            scalars=scalars,
            color=color,
            cmap=cmap,
            clim=clim,
            **said,
            scalar_bar_args={"color": text, **UPRIGHT},
            render=False,
            progress=sys.stderr.isatty(),
        )
    point_camera(plotter, view)


def is_mesh(path: str) -> bool:
    """Return whether a file is a surface rather than lines: VTK's formats may be either."""
    try:
        suffix = suffix_of(path)
    except UnknownFormatError:
        return Path(path).suffix.lower() in (".ply", ".stl", ".obj", ".vtu")
    if suffix not in (".vtk", ".vtp"):
        return False
    import pyvista

    data = pyvista.read(path)
    return not (isinstance(data, pyvista.PolyData) and data.n_lines)


def demo(*, output: str, streamlines: int, step: float, seed: int, json: bool) -> None:
    """Make, compress, measure and draw a whole-brain-like tractogram."""
    from pvfiblets.codec.convert import compress_file
    from pvfiblets.synthetic import brain_streamlines

    def say(text: str) -> None:
        if not json:
            print(text, flush=True)

    folder = Path(output)
    folder.mkdir(parents=True, exist_ok=True)
    original, compressed, picture = (folder / f"brain.{end}" for end in ("tck", "fiblets", "png"))

    say(f"Making a whole-brain-like tractogram of {streamlines:,} streamlines ...")
    brain = brain_streamlines(streamlines, step, seed)
    formats.write(original, brain)
    say("Compressing it (the very first time, this compiles the codec) ...")
    result = compress_file(original, compressed, progress=False)

    say("Drawing it ...")
    begin = time.perf_counter()
    plotter = make_plotter(off_screen=True, size=(1600, 1200))  # before PyVista is imported by anything else
    try:
        from pvfiblets.plotting.viewpoints import point_camera

        plotter.set_background("black")
        actor = plotter.add_fiblets(compressed, line_width=1.0, render=False)
        point_camera(plotter, "oblique")
        plotter.screenshot(picture, return_img=False)
        gpu_bytes = actor.explain()["gpu_bytes"]
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
