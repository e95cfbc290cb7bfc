"""Arguments of the commands that render."""

from __future__ import annotations

import argparse

from pvfiblets.cli.parser import Commands
from pvfiblets.cli.pipes import add_format_option, add_image_options, add_space_option, add_surface_option
from pvfiblets.cli.scene import add_options
from pvfiblets.cli.values import antialias, count, positive, size

# Those of pvfiblets.plotting.fiblets.looks, without loading it.
LOOKS = ("plain", "illuminated", "tubes", "glass", "density", "ink", "studio")
VIEWS = ("axial", "coronal", "sagittal", "inferior", "posterior", "right", "oblique")


def add_screenshot(commands: Commands) -> None:
    """``screenshot``."""
    screenshot = commands.add_parser(
        "screenshot",
        help="render files to a PNG, without a display",
        description="Render FILEs off screen, as one scene, and write the image.",
    )
    _scene(screenshot)
    screenshot.add_argument("-o", "--output", required=True, metavar="PNG", help="output file, or -")
    screenshot.add_argument("--size", type=size, default=(1200, 900), metavar="WxH", help="pixels (default: 1200x900)")
    screenshot.add_argument("--transparent", action="store_true", help="transparent background")
    add_format_option(screenshot, reads=["paths"], writes="output", usual="png")
    add_image_options(screenshot)
    add_surface_option(screenshot)
    screenshot.set_defaults(run="pvfiblets.cli.pictures:screenshot")


def add_show(commands: Commands) -> None:
    """``show``."""
    show = commands.add_parser(
        "show",
        help="open files in a window",
        description="Show FILEs in a window, as one scene: the left button turns it, the wheel zooms, q closes it.",
    )
    _scene(show)
    add_format_option(show, reads=["paths"])
    add_image_options(show)
    add_surface_option(show)
    show.set_defaults(run="pvfiblets.cli.pictures:show")


def add_page(commands: Commands) -> None:
    """``page``."""
    page = commands.add_parser(
        "page",
        help="write files as an HTML page that renders in any browser",
        description="Write FILEs, as one scene, as an HTML page that renders offline, without a server, and "
                    "contains the compressed streamlines. More than 64 MB of data go to a folder beside it, which "
                    "then needs a web server.",
    )
    _scene(page)
    page.add_argument("-o", "--output", required=True, metavar="HTML", help="output file or folder")
    page.add_argument("--title", help="title of the page (default: the name of the first FILE)")
    add_format_option(page, reads=["paths"])
    add_image_options(page)
    add_surface_option(page)
    page.set_defaults(run="pvfiblets.cli.pictures:page")


def add_serve(commands: Commands) -> None:
    """``serve``."""
    parser = commands.add_parser("serve", help="explore files in a browser")
    parser.description = (
        "Serve FILEs to browsers, which need nothing installed. This machine renders and sends images, or the "
        "browser renders. By default only this machine can connect, with the token that is printed to the terminal."
    )
    add = parser.add_argument
    add("paths", metavar="FILE", nargs="*", help="tractograms of any format; a .tsf file colours the one before it")
    add("--volume", action="append", default=[], metavar="F", help="a volume to add; repeatable")
    add("--mesh", action="append", default=[], metavar="F", help="a mesh to add; repeatable")
    add("--demo", action="store_true", help="open a synthetic tractogram")
    add("--host", default="127.0.0.1", help="address to listen at (default: %(default)s, this machine only)")
    add("--port", type=int, default=8080, metavar="N", help="port; 0: any free port (default: %(default)s)")
    add("--root", default=".", metavar="DIR", help="folder of the files that browsers may open (default: the "
                                                   "current one)")
    add(
        "--token",
        default="auto",
        metavar="auto|none",
        help="token that a browser must send (default: auto, a new one, or the environment variable "
             "PVFIBLETS_TOKEN); none only if no other machine can connect",
    )
    add("--token-file", metavar="FILE", help="private file with the token; made if it does not exist")
    add("--shared", action="store_true", help="all browsers share one session")
    add("--limit", type=count, default=8, metavar="N", help="number of sessions at once (default: %(default)s)")
    add(
        "--timeout",
        type=positive,
        default=300.0,
        metavar="SECONDS",
        help="time that a session waits for its browser to return (default: 300)",
    )
    add("--upload", type=int, default=2048, metavar="MB", help="size limit of an upload (default: %(default)s)")
    add(
        "--max-memory",
        "--memory",
        dest="memory",
        default="auto",
        metavar="SIZE",
        help="memory limit of a session, such as 4G or 25%% of this machine's (default: 80%% divided by --limit, at "
             "least 20%%)",
    )
    _look(parser)
    _antialias(parser)
    add("--codec", choices=("jpeg", "png", "webp"), default="jpeg", help="coding of images (default: %(default)s)")
    add(
        "--draw",
        choices=("auto", "here", "there"),
        default="auto",
        help="renderer: here, this machine; there, the browser if possible; auto, the browser if it has a graphics "
             "card and the data fit into 64 MB (default: %(default)s)",
    )
    add("--origin", action="append", default=[], metavar="URL", help="public address of this server behind a proxy; "
                                                                     "repeatable")
    add(
        "--proxy",
        action="append",
        default=[],
        metavar="ADDRESS",
        help="address of a proxy with a trusted X-Forwarded-For header; repeatable",
    )
    add("--cluster", metavar="ADDRESS", help="dask's scheduler, or its file; its workers render fiblets")
    add("--connections", type=count, default=1000, metavar="N", help="number of connections at once (default: "
                                                                     "%(default)s)")
    add(
        "--connections-by-address",
        type=count,
        default=100,
        metavar="N",
        help="number of connections at once from one address (default: %(default)s)",
    )
    add_space_option(parser)
    add_image_options(parser)
    add_surface_option(parser)
    parser.set_defaults(run="pvfiblets.cli.serve:serve")


def _scene(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "paths", metavar="FILE", nargs="+", help="tractograms, images (NIfTI, MGH, MIF, NRRD, MetaImage, .vti) and "
        "meshes (.vtp, .ply, .stl, .obj, .gii, lh.pial) of any format, a surface before its values (.annot, "
        ".label.gii); or a session saved by `serve`, .json; or -"
    )  # fmt: skip
    parser.add_argument(
        "--view", choices=VIEWS, help="view direction (default: oblique, or that of the session; coronal is from "
                                      "the front)"
    )
    parser.add_argument(
        "--scalars",
        metavar="NAME",
        help="orientation, length, curvature, arc_length, an array of the file, or a file "
        "of values beside it: .tsf, .npy, .txt, .csv",
    )
    parser.add_argument("--color", help="one colour for all, such as white or #ff8800")
    parser.add_argument("--cmap", help="colour map, such as viridis")
    parser.add_argument("--clim", type=float, nargs=2, metavar=("LOW", "HIGH"), help="range of the colour map")
    _look(parser)
    parser.add_argument("--line-width", type=positive, metavar="PIXELS", help="width of lines (default: 1)")
    parser.add_argument("--opacity", type=float, metavar="SHARE", help="opacity, 0 to 1 (default: 1)")
    parser.add_argument("--background", metavar="COLOR", help="background colour (default: black)")
    parser.add_argument("--no-lighting", action="store_true", help="show pure colours, without light")
    _antialias(parser)
    add_options(parser)


def _look(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--look",
        choices=LOOKS,
        help="preset of widths, light and shading of lines; other options override it",
    )


def _antialias(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--antialias",
        type=antialias,
        metavar="HOW",
        help="antialiasing: off, coverage, refined (16 samples a pixel when idle) or a number of samples (default: "
             "refined, or the environment variable PVFIBLETS_ANTIALIAS)",
    )
