"""Arguments of the commands that take files and write files."""

from __future__ import annotations

import argparse
from typing import Any

from pvfiblets.cli.memory import add_memory_option, bytes_of_file
from pvfiblets.cli.pipes import add_format_option, add_image_options, add_surface_option
from pvfiblets.cli.values import angle, count, positive
from pvfiblets.codec.parameters import DEFAULT_ANGLE

__all__ = [
    "add_connectome",
    "add_convert",
    "add_density",
    "add_info",
    "add_profile",
    "add_table",
    "add_verify",
    "json_option",
]


def add_convert(commands: Any) -> None:
    """``convert``."""
    convert = commands.add_parser(
        "convert",
        help="compress a tractogram, or write it in another format",
        description="Compress IN to a .fiblets file, or convert between any two formats; the suffixes say which.",
    )
    convert.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    convert.add_argument("target", metavar="OUT", help="what to write: .fiblets, .tck, .trk, .trx, .vtk or .vtp; or -")
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
        "--per-point-bits", type=int, choices=(8, 16), default=8,
        help="for each value kept, or more where the bound needs them (default: 8)",
    )  # fmt: skip
    convert.add_argument(
        "--max-value-error", type=float, metavar="NUMBER",
        help="largest difference of a value kept to the original, in its unit (default: 1/255 of what lies between its "
        "1st and 99th percentile)",
    )  # fmt: skip
    convert.add_argument(
        "--exact",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="keep every bit of the points, or code them in any case (default: exact if less than a megabyte, unless "
        "an option of coding is given, or if coding would take more bytes)",
    )
    convert.add_argument(
        "--shards",
        type=bytes_of_file,
        metavar="SIZE",
        help="write a folder of .fiblets files of at most this size each (such as 2G), of streamlines that lie near "
        "each other; it is read like one file, or in parts",
    )
    convert.add_argument(
        "--index",
        action="store_true",
        help="keep a spatial index in the .fiblets file, of a third of its size, by which painted regions tell their "
        "streamlines at once (without it, it is made when a region is first painted); info says its size",
    )
    convert.add_argument(
        "--double",
        action="store_true",
        help="write the points of a .tck or .vtk file as float64 (default: float32); of such files MRtrix reads .tck "
        "and not .vtk, nibabel, DIPY and scilpy do not read .tck",
    )
    convert.add_argument(
        "--verify",
        choices=("all", "sample"),
        default="all",
        help="compare all of the finished file with IN, or about a million points of it (default: %(default)s)",
    )
    add_format_option(convert, reads=["source"], writes="target")
    _quiet_and_json(convert)
    add_memory_option(convert)
    convert.set_defaults(run="pvfiblets.cli.files:convert")


def add_info(commands: Any) -> None:
    """``info``."""
    info = commands.add_parser(
        "info",
        help="say what a file holds",
        description="Read FILE, and print size, counts, arrays, groups, affine and what reading leaves out; of a "
        ".fiblets file, step and promise too; of a surface, bounds and how it is moved to the scanner's space.",
    )
    info.add_argument("path", metavar="FILE", help="a tractogram or a surface of any format, or -")
    add_format_option(info, reads=["path"])
    add_surface_option(info)
    json_option(info)
    add_memory_option(info)
    info.set_defaults(run="pvfiblets.cli.files:info")


def add_verify(commands: Any) -> None:
    """``verify``."""
    verify = commands.add_parser(
        "verify",
        help="check a .fiblets file against its checksums and against its original",
        description="Check FILE's checksums, and measure how far its points are from those of ORIGINAL, "
        "and its directions from theirs. Fails if the file is damaged or an error is greater than the file promises.",
    )
    verify.add_argument("path", metavar="FILE", help="a .fiblets file, or -")
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
    add_format_option(verify, reads=["path", "original"])
    _quiet_and_json(verify)
    add_memory_option(verify)
    verify.set_defaults(run="pvfiblets.cli.files:verify")


def add_density(commands: Any) -> None:
    """``density``."""
    parser = commands.add_parser("density", help="write a volume of how many streamlines pass each voxel, or of more")
    parser.description = (
        "Add the streamlines of IN up in the voxels of a grid, with every segment cut at the voxels' faces, and write "
        "the volume to OUT."
    )
    parser.add_argument("source", metavar="IN", help="a tractogram of any format, or -; it is read in parts")
    parser.add_argument("target", metavar="OUT", help="what to write: .nii, .nii.gz, .mif, .mif.gz or .vti; or -")
    grid = parser.add_mutually_exclusive_group(required=True)
    grid.add_argument("--voxel", type=positive, nargs="+", metavar="MM", help="side of the voxels, or three")
    grid.add_argument("--like", metavar="IMAGE", help="an image whose grid it is (NIfTI, MGH, MIF, NRRD ...)")
    parser.add_argument(
        "--contrast",
        default="count",
        metavar="WHAT",
        help="count: streamlines that visit a voxel; length: mm in it; direction: mean |x|, |y|, |z| of the tangent; "
        "or the mean of values: an array, a file with a number per streamline or point, or an image (default: count)",
    )
    parser.add_argument(
        "--weights",
        metavar="WHAT",
        help="of the streamlines, such as SIFT2's: a file of numbers, or the name of an array",
    )
    parser.add_argument("--ends-only", action="store_true", help="count end points instead")
    add_format_option(parser, reads=["source"], writes="target", usual="nii")
    add_image_options(parser)
    _quiet_and_json(parser)
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli.density:density")


def add_connectome(commands: Any) -> None:
    """``connectome``."""
    matrix = commands.add_parser(
        "connectome",
        help="write a matrix of how strongly the parcels of an atlas are connected",
        description="Write a symmetric matrix of parcels by parcels: streamlines of IN whose ends lie in both, or the "
        "mean of their numbers. It holds the labels that LABELS has, rising.",
    )
    matrix.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    matrix.add_argument("labels", metavar="LABELS", help="an image of whole numbers, 0 for no parcel")
    matrix.add_argument("target", metavar="OUT", help="a .csv, .tsv, .txt or .npy file; or -")
    matrix.add_argument("--weights", metavar="NAME|FILE", help="of streamlines, such as SIFT2's")
    matrix.add_argument(
        "--contrast", default="count", metavar="NAME|FILE|IMAGE",
        help="'count' (default), 'length', or numbers: an array, a file of values, or the mean of an image along each",
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
    add_format_option(matrix, reads=["source"], writes="target", usual="csv")
    add_image_options(matrix)
    json_option(matrix)
    add_memory_option(matrix)
    matrix.set_defaults(run="pvfiblets.cli.connectome:connectome")


def add_table(commands: Any) -> None:
    """``table``."""
    table = commands.add_parser(
        "table",
        help="write a row for each streamline, or each bundle: length, ends, groups, values",
        description="Write a table, a row for each streamline of IN: points, length, curvature, ends (mm), groups, "
        "per-streamline values, and means of per-point values and of images. With --by bundle, a row for each group: "
        "count, lengths, volume, and the same means.",
    )
    table.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    table.add_argument(
        "target", metavar="OUT", nargs="?", default="-", help="a .csv, .tsv or .parquet file (default: standard output)"
    )
    table.add_argument("--by", choices=("streamline", "bundle"), default="streamline",
                       help="what has a row (default: %(default)s); a file without groups is one bundle")  # fmt: skip
    table.add_argument(
        "--group", action="append", default=[], metavar="NAME", help="only this group; may repeat by bundle"
    )
    table.add_argument("--image", action="append", default=[], metavar="[NAME=]IMAGE",
                       help="an image whose mean along each streamline or bundle is a column; may repeat")  # fmt: skip
    _add_point_weights(table)
    add_format_option(table, reads=["source"])
    add_image_options(table)
    add_memory_option(table)
    table.set_defaults(run="pvfiblets.cli.bundles:table")


def add_profile(commands: Any) -> None:
    """``profile``."""
    parser = commands.add_parser(
        "profile",
        help="average values along bundles, from one end to the other",
        description="Write a row for each place along each bundle: mean, standard deviation, and the band in which the "
        "mean lies. Groups of the files are bundles; a file without groups is one. Streamlines near the core of a "
        "bundle count more, as AFQ has it.",
    )
    parser.add_argument("sources", metavar="IN", nargs="+", help="tractograms of any format, or -")
    parser.add_argument("-o", "--output", action="append", default=[], metavar="OUT",
                        help="a .csv, .tsv or .parquet table, or a .png, .svg or .pdf plot; may repeat (default: the "
                        "table, to standard output)")  # fmt: skip
    parser.add_argument("--values", required=True, action="append", metavar="NAME|IMAGE",
                        help="an array of points, curvature, arc_length, or an image that is sampled; may repeat",
                        )  # fmt: skip
    parser.add_argument("--positions", type=count, default=100, metavar="N", help="along it (default: %(default)s)")
    parser.add_argument("--group", action="append", default=[], metavar="NAME", help="only this group; may repeat")
    parser.add_argument("--weights", choices=("core", "equal"), default="core",
                        help="whether streamlines near the core count more (default: %(default)s)")  # fmt: skip
    parser.add_argument("--confidence", type=float, default=0.95, metavar="SHARE", help="of the band (default: 0.95)")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    add_format_option(parser, reads=["sources"])
    add_image_options(parser)
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli.bundles:profile")


def _add_point_weights(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--weights", choices=("length", "points"), default="length",
                        help="whether points count by the length they stand for in means, as in tcksample -stat_tck "
                        "mean, or all the same (default: %(default)s)")  # fmt: skip


def add_sample(commands: Any) -> None:
    """``sample``."""
    parser = commands.add_parser(
        "sample",
        help="take the values of an image along streamlines, at each point or as a statistic of each streamline",
        description="Take the values of IMAGE at the points of IN, linear between the centres of voxels, and write "
        "them to OUT, one for each point. With --statistic, one for each streamline. Points outside of the image have "
        "no value and count in no statistic (tcksample takes 0 there).",
    )
    parser.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    parser.add_argument("image", metavar="IMAGE", help="an image with one number per voxel (NIfTI, MGH, MIF, NRRD ...)")
    parser.add_argument("target", metavar="OUT", help="a .tsf, .txt, .csv or .npy file of numbers, one a row; a "
                        "tractogram to write IN with them to; or -")  # fmt: skip
    add_sampling_options(parser)
    add_format_option(parser, reads=["source"], writes="target", usual="txt")
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli.samples:sample")


def add_sampling_options(parser: argparse.ArgumentParser) -> None:
    """Let a command be told which values of an image it takes along streamlines."""
    parser.add_argument("--statistic", choices=("mean", "median", "min", "max"), help="of each streamline")
    _add_point_weights(parser)
    parser.add_argument("--nearest", action="store_true", help="take the nearest voxel's value, as labels need it")
    parser.add_argument("--name", help="of the array in a tractogram (default: IMAGE without its suffix)")


def json_option(parser: argparse.ArgumentParser) -> None:
    """``--json``."""
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")


def _quiet_and_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    json_option(parser)
