"""The ``pvfiblets`` command.

Exit codes: 0 when it did what was asked, 1 when it could not, with one plain sentence on standard
error, 2 when it was called wrongly. With ``--json`` the result is one JSON object on standard
output and nothing else.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from pvfiblets.cli_batch import add_options as add_batch_options
from pvfiblets.cli_memory import add_memory_option, held_to
from pvfiblets.cli_scene import add_options
from pvfiblets.codec.parameters import DEFAULT_ANGLE
from pvfiblets.errors import EXPECTED, sentence

# Those of pvfiblets.plotting.fiblets.looks, without loading it.
LOOKS = ("plain", "illuminated", "tubes", "glass", "density", "ink", "studio")
VIEWS = ("axial", "coronal", "sagittal", "inferior", "posterior", "right", "oblique")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    arguments : sequence of str, optional
        Instead of the command line.

    Returns
    -------
    int
        The exit code.
    """
    options = vars(make_parser().parse_args(arguments))
    debug = options.pop("debug")
    module, function = options.pop("run").split(":")
    try:
        with held_to(options.pop("max_memory", None)):
            return getattr(import_module(module), function)(**options) or 0
    except BrokenPipeError:  # the reader of our output, such as `head`, has gone: not an error
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("pvfiblets: interrupted", file=sys.stderr)
        return 1
    except EXPECTED as error:
        if debug:
            raise
        print(f"pvfiblets: {sentence(error)}", file=sys.stderr)
        return 1


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = argparse.ArgumentParser(prog="pvfiblets", description="Compress, check and draw tractograms of any size.")
    parser.add_argument("--version", action=_Version)
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)

    convert = commands.add_parser(
        "convert",
        help="compress a tractogram, or write it in another format",
        description="Compress IN to a .fiblets file, or convert between any two formats; the suffixes say which.",
    )
    convert.add_argument("source", metavar="IN", help="a tractogram of any format")
    convert.add_argument("target", metavar="OUT", help="what to write: .fiblets, .tck, .trk, .trx, .vtk or .vtp")
    convert.add_argument(
        "--step", type=positive, metavar="MM", help="resample to this distance, and keep corners (default: keep points)"
    )
    convert.add_argument(
        "--max-error",
        type=positive,
        metavar="MM",
        help="greatest error of any point (default: a tenth of a step; of uneven or coarse lines 1/4000 of the extent "
        "if that is less)",
    )
    convert.add_argument(
        "--max-angle",
        type=angle,
        default=DEFAULT_ANGLE,
        metavar="DEG",
        help="greatest angle between true and drawn directions, at segments longer than a pixel of a full-screen view "
        f"(default: {DEFAULT_ANGLE:g}); none: any, for smaller files where --max-error is coarse",
    )
    convert.add_argument(
        "--effort", choices=("fast", "high"), default="fast", help="high: slower, less mean error, same size"
    )
    convert.add_argument(
        "--per-point",
        action="append",
        default=[],
        metavar="all|none|NAME",
        help="per-point arrays to keep; a name may be given several times (default: in the order of IN, each that "
        "still fits into 16 bytes a point); those that stay behind are printed, and listed by info",
    )
    convert.add_argument(
        "--per-point-bits", type=int, choices=(8, 16), default=8, help="for each value kept (default: 8)"
    )
    convert.add_argument(
        "--exact",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="keep every bit of the points, or code them in any case (default: exact if less than a megabyte, unless "
        "an option of coding is given, or if coding would take more bytes)",
    )
    _quiet_and_json(convert)
    add_memory_option(convert)
    convert.set_defaults(run="pvfiblets.cli_files:convert")

    info = commands.add_parser(
        "info",
        help="say what a file holds",
        description="Print size, counts, arrays, groups and affine of FILE; of a .fiblets file, step and promise too.",
    )
    info.add_argument("path", metavar="FILE", help="a tractogram of any format")
    _json(info)
    add_memory_option(info)
    info.set_defaults(run="pvfiblets.cli_files:info")

    verify = commands.add_parser(
        "verify",
        help="check a .fiblets file against its checksums and against its original",
        description="Check FILE's checksums, and measure how far its points are from those of ORIGINAL, "
        "and its directions from theirs. Fails if the file is damaged or an error is greater than the file promises.",
    )
    verify.add_argument("path", metavar="FILE", help="a .fiblets file")
    verify.add_argument(
        "original", metavar="ORIGINAL", nargs="?", help="what it was made from; without it, only checksums"
    )
    verify.add_argument(
        "--max-angle",
        type=angle,
        default=DEFAULT_ANGLE,
        metavar="DEG",
        help=f"say whether directions are within this angle (default: {DEFAULT_ANGLE:g})",
    )
    _quiet_and_json(verify)
    add_memory_option(verify)
    verify.set_defaults(run="pvfiblets.cli_files:verify")

    _density(commands.add_parser("density", help="write a volume of how many streamlines pass each voxel, or of more"))

    matrix = commands.add_parser(
        "connectome",
        help="write a matrix of how strongly the parcels of an atlas are connected",
        description="Write a symmetric matrix of parcels by parcels: streamlines of IN whose ends lie in both, or the "
        "mean of their numbers. It holds the labels that LABELS has, rising.",
    )
    matrix.add_argument("source", metavar="IN", help="a tractogram of any format")
    matrix.add_argument("labels", metavar="LABELS", help="a NIfTI image of whole numbers, 0 for no parcel")
    matrix.add_argument("target", metavar="OUT", help="a .csv, .tsv, .txt or .npy file")
    matrix.add_argument("--weights", metavar="NAME|FILE", help="of streamlines, such as SIFT2's")
    matrix.add_argument(
        "--contrast", default="count", metavar="NAME|FILE",
        help="'count' (default), 'length', or numbers by the name of an array or a file",
    )  # fmt: skip
    matrix.add_argument(
        "--radius", type=float, default=4.0, metavar="MM",
        help="about an end in which its parcel is looked for; 0: the voxel it lies in (default: %(default)s)",
    )  # fmt: skip
    matrix.add_argument(
        "--statistic",
        choices=("sum", "mean", "min", "max"),
        help="of a pair's numbers (default: sum of counts, else mean)",
    )
    _json(matrix)
    add_memory_option(matrix)
    matrix.set_defaults(run="pvfiblets.cli_connectome:connectome")

    table = commands.add_parser(
        "table",
        help="write a row for each streamline: length, ends, groups, values",
        description="Write comma-separated values, a row for each streamline of IN: points, length, curvature, ends "
        "(mm), groups, per-streamline values, and means of per-point values.",
    )
    table.add_argument("source", metavar="IN", help="a tractogram of any format")
    table.add_argument("target", metavar="OUT", nargs="?", default="-", help="a .csv file (default: standard output)")
    table.add_argument("--group", metavar="NAME", help="only streamlines of this group")
    add_memory_option(table)
    table.set_defaults(run="pvfiblets.cli_files:table")

    batch = commands.add_parser("batch", help="do one of these to each file of a cohort, on all cores or on a cluster")
    add_batch_options(batch, positive, angle, count)

    screenshot = commands.add_parser(
        "screenshot",
        help="draw files into a PNG, without a display",
        description="Draw FILEs off screen, as one scene, and write the picture.",
    )
    _scene(screenshot)
    screenshot.add_argument("-o", "--output", required=True, metavar="PNG", help="the picture to write")
    screenshot.add_argument("--size", type=size, default=(1200, 900), metavar="WxH", help="pixels (default: 1200x900)")
    screenshot.add_argument("--transparent", action="store_true", help="leave the background out")
    screenshot.set_defaults(run="pvfiblets.cli_pictures:screenshot")

    show = commands.add_parser(
        "show",
        help="open files in a window",
        description="Draw FILEs in a window, as one scene: the left button turns it, the wheel zooms, q closes it.",
    )
    _scene(show)
    show.set_defaults(run="pvfiblets.cli_pictures:show")

    _serve(commands.add_parser("serve", help="explore files in a browser; this machine draws"))

    gl = commands.add_parser(
        "gl",
        help="say what this machine's OpenGL is, which pipelines can draw with it, and whether they draw right",
        description="List the driver, its limits, and every pipeline: available, or why not. With --check, draw with "
        "all of them, compare with the CPU, measure, and write one file to attach to a report of a bug; it ends with 1 "
        "if anything differs or fails.",
    )
    gl.add_argument("--check", action="store_true", help="draw with everything that there is, and compare")
    gl.add_argument(
        "-o", "--output", default="pvfiblets-check.zip", metavar="FILE", help="of --check (default: %(default)s)"
    )
    gl.add_argument(
        "--segments", type=positive, nargs="*", metavar="N", help="sizes to measure speed at (default: 1e6 1e7 1e8)"
    )
    gl.add_argument(
        "--only", action="append", default=[], metavar="PART", help="parts of the check whose names begin like that"
    )
    _json(gl)
    gl.set_defaults(run="pvfiblets.cli_gl:gl")

    demo = commands.add_parser(
        "demo",
        help="make, compress and draw a whole-brain-like tractogram, and print size and error",
        description="Make a tractogram like a whole brain's, compress it, draw it, and print its size and error.",
    )
    demo.add_argument("--output", default="pvfiblets-demo", metavar="FOLDER", help="for files (default: %(default)s)")
    demo.add_argument("--streamlines", type=count, default=50_000, metavar="N", help="how many (default: %(default)s)")
    demo.add_argument("--step", type=positive, default=0.5, metavar="MM", help="between points (default: %(default)s)")
    demo.add_argument("--seed", type=int, default=0, metavar="N", help="another, another brain (default: %(default)s)")
    _json(demo)
    demo.set_defaults(run="pvfiblets.cli_pictures:demo")

    report = commands.add_parser(
        "report",
        help="measure error against run time of every approximation in the program, beside its rivals",
        description="Write report.json, a Markdown page and plots into DIR. All studies, unless --only names some.",
    )
    report.add_argument(
        "--only", nargs="+", metavar="STUDY",
        help="codec, decode, culling, tubes, volumes, halos, features, antialias, translucency, stability",
    )  # fmt: skip
    report.add_argument(
        "--data", nargs="+", default=[], metavar="FILE",
        help="tractograms to measure with, or folders of such (default: the folder that PVFIBLETS_DATA names)",
    )  # fmt: skip
    report.add_argument("--quick", action="store_true", help="a little of each, in at most two minutes on two cores")
    report.add_argument(
        "--minutes", type=float, metavar="M", help="for measuring, shared among the studies (default: no limit)"
    )
    report.add_argument("--seed", type=int, default=0, metavar="N", help="of all made-up data (default: 0)")
    report.add_argument("--from", dest="source", metavar="JSON", help="make page and plots again, without measuring")
    report.add_argument("-o", "--output", required=True, metavar="DIR", help="the folder to write into")
    report.set_defaults(run="pvfiblets.cli_report:report")
    return parser


def _json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")


def _quiet_and_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    _json(parser)


def _density(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Add the streamlines of IN up in the voxels of a grid, with every segment cut at the voxels' faces, and write "
        "the volume to OUT."
    )
    parser.add_argument("source", metavar="IN", help="a tractogram of any format; it is read in parts")
    parser.add_argument("target", metavar="OUT", help="what to write: .nii or .nii.gz")
    grid = parser.add_mutually_exclusive_group(required=True)
    grid.add_argument("--voxel", type=positive, nargs="+", metavar="MM", help="side of the voxels, or three")
    grid.add_argument("--like", metavar="IMAGE", help="an image whose grid it is: NIfTI, MGH, NRRD, MetaImage or .vti")
    parser.add_argument(
        "--contrast",
        default="count",
        metavar="WHAT",
        help="count: streamlines that visit a voxel; length: mm in it; direction: mean |x|, |y|, |z| of the tangent; "
        "or the mean of values: the name of an array, or a file with a number per streamline or point (default: count)",
    )
    parser.add_argument(
        "--weights",
        metavar="WHAT",
        help="of the streamlines, such as SIFT2's: a file of numbers, or the name of an array",
    )
    parser.add_argument("--ends-only", action="store_true", help="count end points instead")
    _quiet_and_json(parser)
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli_density:density")


def _serve(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Serve FILEs to browsers. This machine draws and sends pictures; browsers need nothing installed. By default "
        "only this machine can connect, and must show a token that is printed to the terminal."
    )
    add = parser.add_argument
    add("paths", metavar="FILE", nargs="*", help="tractograms of any format; a .tsf file colours the one before it")
    add("--volume", action="append", default=[], metavar="F", help="a volume beside them; may be given several times")
    add("--mesh", action="append", default=[], metavar="F", help="a mesh beside them; may be given several times")
    add("--demo", action="store_true", help="open a made-up tractogram")
    add("--host", default="127.0.0.1", help="where to listen (default: %(default)s, this machine only)")
    add("--port", type=int, default=8080, metavar="N", help="0: any that is free (default: %(default)s)")
    add("--root", default=".", metavar="DIR", help="the folder that browsers may open files from (default: this one)")
    add(
        "--token",
        default="auto",
        metavar="auto|none",
        help="what a browser must show (default: auto, made anew; or the environment variable PVFIBLETS_TOKEN); none "
        "only where nobody else can connect",
    )
    add("--token-file", metavar="FILE", help="a file with the token, which others cannot read; made if there is none")
    add("--shared", action="store_true", help="all browsers see and steer the same view")
    add("--limit", type=count, default=8, metavar="N", help="sessions at once (default: %(default)s)")
    add(
        "--timeout",
        type=positive,
        default=300.0,
        metavar="SECONDS",
        help="how long a session waits for its browser to come back (default: 300)",
    )
    add("--upload", type=int, default=2048, metavar="MB", help="most in one upload (default: %(default)s)")
    add(
        "--memory",
        default="auto",
        metavar="SIZE",
        help="most that a session may have, such as 4G or 25%% of this machine's (default: 80%% divided by --limit, at "
        "least 20%%)",
    )
    _look(parser)
    _antialias(parser)
    add("--codec", choices=("jpeg", "png", "webp"), default="jpeg", help="how pictures travel (default: %(default)s)")
    add("--rendering", choices=("server", "client"), default="server", help="who draws: only the server can")
    add("--origin", action="append", default=[], metavar="URL", help="an address by which a proxy serves this server")
    add(
        "--proxy",
        action="append",
        default=[],
        metavar="ADDRESS",
        help="a proxy that is believed when it says (X-Forwarded-For) for whom it asks; may be given several times",
    )
    add("--connections", type=count, default=1000, metavar="N", help="connections at once (default: %(default)s)")
    add(
        "--connections-by-address",
        type=count,
        default=100,
        metavar="N",
        help="connections at once from one address (default: %(default)s)",
    )
    parser.set_defaults(run="pvfiblets.cli_serve:serve")


def _scene(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "paths", metavar="FILE", nargs="+", help="tractograms, images (NIfTI, MGH, NRRD, MetaImage, .vti) and meshes "
        "(.vtp, .ply, .stl, .obj, .gii) of any format; or a session that `serve` saved, .json"
    )  # fmt: skip
    parser.add_argument(
        "--view", choices=VIEWS, help="from where (default: oblique, or as a session says; coronal is from the front)"
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
    parser.add_argument("--line-width", type=positive, metavar="PIXELS", help="of lines (default: 1)")
    parser.add_argument("--opacity", type=float, metavar="SHARE", help="0 to 1 (default: 1)")
    parser.add_argument("--background", metavar="COLOR", help="behind it all (default: black)")
    parser.add_argument("--no-lighting", action="store_true", help="show pure colours")
    _antialias(parser)
    add_options(parser)


def _look(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--look",
        choices=LOOKS,
        help="of lines: widths, light and shading that give a finished picture together; other options go before it",
    )


def _antialias(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--antialias",
        type=antialias,
        metavar="HOW",
        help="of edges: off, coverage, refined (16 samples a pixel where nothing moves) or a number of samples "
        "(default: refined, or what the environment variable PVFIBLETS_ANTIALIAS says)",
    )


def antialias(text: str) -> str | int:
    """Parse how edges are smoothed."""
    from pvfiblets.antialias import check_antialias

    try:
        return check_antialias("it", int(text) if text.isdecimal() else text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def positive(text: str) -> float:
    """Parse a finite number above zero."""
    value = float(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return value


def angle(text: str) -> float | None:
    """Parse degrees above zero and up to 90, or ``none``."""
    if text == "none":
        return None
    value = float(text)
    if not 0.0 < value <= 90.0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and up to 90 degrees, or none")
    return value


def count(text: str) -> int:
    """Parse a whole number above zero."""
    if (value := int(text)) < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return value


def size(text: str) -> tuple[int, int]:
    """Parse ``WIDTHxHEIGHT`` in pixels."""
    width, by, height = text.lower().partition("x")
    if not (by and width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, such as 1200x900")
    pixels = int(width), int(height)
    if not all(1 <= side <= 16384 for side in pixels):
        raise argparse.ArgumentTypeError(f"{text}: each side must be from 1 to 16384 pixels")
    return pixels


class _Version(argparse.Action):
    """Print the versions that a report of a problem needs."""

    def __init__(self, option_strings: Sequence[str], **_: object) -> None:
        super().__init__(option_strings, dest=argparse.SUPPRESS, nargs=0, help="print the version")

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        print(f"pvfiblets {version('pvfiblets')} (pyvista {version('pyvista')}, vtk {version('vtk')})")
        parser.exit()


if __name__ == "__main__":
    sys.exit(main())
