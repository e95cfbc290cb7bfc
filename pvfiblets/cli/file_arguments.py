"""Arguments of the commands that take files and write files."""

from __future__ import annotations

import argparse

from pvfiblets.cli.memory import add_memory_option, bytes_of_file
from pvfiblets.cli.parser import Commands
from pvfiblets.cli.pipes import add_format_option, add_image_options, add_surface_option
from pvfiblets.cli.values import angle, count, positive
from pvfiblets.codec.parameters import DEFAULT_ANGLE


def add_convert(commands: Commands) -> None:
    """``convert``."""
    convert = commands.add_parser(
        "convert",
        help="compress a tractogram, or write it in another format",
        description="Compress IN to a .fiblets file, or convert between any two formats, by their suffixes.",
    )
    convert.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    convert.add_argument("target", metavar="OUT", help="output file: .fiblets, .tck, .trk, .trx, .vtk or .vtp; or -")
    add_coding_options(convert)
    convert.add_argument(
        "--max-value-error", type=float, metavar="NUMBER",
        help="error bound of kept values, in their unit (default: 1/255 of the range from the 1st to the 99th "
             "percentile)",
    )  # fmt: skip
    convert.add_argument(
        "--shards",
        type=bytes_of_file,
        metavar="SIZE",
        help="write a folder of .fiblets files of at most this size (such as 2G), each of neighbouring streamlines; "
             "it is read like one file, or in parts",
    )
    convert.add_argument(
        "--small", action="store_true",
        help="write 0.55 to 0.75 times the bytes; opening such a file decodes it into memory. A .fiblets file is "
             "packed as it is",
    )  # fmt: skip
    convert.add_argument(
        "--index",
        action="store_true",
        help="store a spatial index for painted regions in the .fiblets file, a third of its size (default: made "
             "when a region is first painted); info prints its size",
    )
    convert.add_argument(
        "--double",
        action="store_true",
        help="write the points of a .tck or .vtk file as float64 (default: float32). MRtrix cannot read a .vtk file "
             "with float64, and nibabel, DIPY and scilpy cannot read a .tck file with it",
    )
    convert.add_argument(
        "--verify",
        choices=("all", "sample"),
        default="all",
        help="compare the finished file with IN, all of it or about a million points (default: %(default)s)",
    )
    add_format_option(convert, reads=["source"], writes="target")
    _quiet_and_json(convert)
    add_memory_option(convert)
    convert.set_defaults(run="pvfiblets.cli.files:convert")


def add_coding_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of compression."""
    parser.add_argument(
        "--step", type=positive, metavar="MM", help="resample to this distance, keeping corners (default: keep the "
                                                    "points)"
    )
    parser.add_argument(
        "--max-error",
        type=positive,
        metavar="MM",
        help="error bound of every point (default: a tenth of a step, or 1/4000 of the extent for uneven or coarse "
             "lines if that is less)",
    )
    parser.add_argument(
        "--max-angle",
        type=angle,
        default=DEFAULT_ANGLE,
        metavar="DEG",
        help="error bound of directions at segments longer than a pixel of a full-screen view "
        f"(default: {DEFAULT_ANGLE:g}); none: no bound, for smaller files with a coarse --max-error",
    )
    parser.add_argument(
        "--effort", choices=("fast", "high", "small"), default="fast", help="high: slower, with a smaller mean error "
        "at the same size; small: splines, for fewer bytes with a larger mean error"
    )  # fmt: skip
    parser.add_argument(
        "--per-point",
        action="append",
        default=[],
        metavar="all|none|NAME",
        help="per-point arrays to keep; repeat for several names (default: the arrays that fit into 16 bytes a "
             "point, in the order of IN). convert and info list the other arrays",
    )
    parser.add_argument(
        "--per-point-bits", type=int, choices=(8, 16), default=8,
        help="bits of each kept value, or more if its error bound needs them (default: 8)",
    )  # fmt: skip
    parser.add_argument(
        "--exact",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="keep every bit of the points, or compress them in any case (default: exact below a megabyte without "
             "options of compression, and where compression would take more bytes)",
    )


def add_info(commands: Commands) -> None:
    """``info``."""
    info = commands.add_parser(
        "info",
        help="print the contents of a file",
        description="Read FILE, and print size, counts, arrays, groups, affine and dropped data; also step and "
                    "error bound of a .fiblets file, and bounds and space of a surface.",
    )
    info.add_argument("path", metavar="FILE", help="a tractogram or a surface of any format, or -")
    add_format_option(info, reads=["path"])
    add_surface_option(info)
    json_option(info)
    add_memory_option(info)
    info.set_defaults(run="pvfiblets.cli.files:info")


def add_verify(commands: Commands) -> None:
    """``verify``."""
    verify = commands.add_parser(
        "verify",
        help="check a .fiblets file against its checksums and against its original",
        description="Check FILE's checksums, and measure the errors of its points and directions against ORIGINAL. "
                    "Fails if the file is damaged or an error exceeds the file's error bound.",
    )
    verify.add_argument("path", metavar="FILE", help="a .fiblets file, or -")
    verify.add_argument(
        "original", metavar="ORIGINAL", nargs="?", help="its source; without it, only checksums are checked"
    )
    verify.add_argument(
        "--max-angle",
        type=angle,
        default=DEFAULT_ANGLE,
        metavar="DEG",
        help=f"report whether directions are within this angle (default: {DEFAULT_ANGLE:g})",
    )
    add_format_option(verify, reads=["path", "original"])
    _quiet_and_json(verify)
    add_memory_option(verify)
    verify.set_defaults(run="pvfiblets.cli.files:verify")


def add_density(commands: Commands) -> None:
    """``density``."""
    parser = commands.add_parser("density", help="write a density map: streamlines, lengths, directions or means "
                                                 "per voxel")
    parser.description = (
        "Add up the streamlines of IN in the voxels of a grid, with every segment cut at the voxels' faces, and "
        "write the volume to OUT."
    )
    parser.add_argument("source", metavar="IN", help="a tractogram of any format, or -; it is read in parts")
    parser.add_argument("target", metavar="OUT", help="output file: .nii, .nii.gz, .mif, .mif.gz or .vti; or -")
    add_grid_options(parser)
    add_format_option(parser, reads=["source"], writes="target", usual="nii")
    add_image_options(parser)
    _quiet_and_json(parser)
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli.density:density")


def add_grid_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a density map."""
    grid = parser.add_mutually_exclusive_group(required=True)
    grid.add_argument("--voxel", type=positive, nargs="+", metavar="MM", help="side length of the voxels, or three")
    grid.add_argument("--like", metavar="IMAGE", help="an image with the grid to use (NIfTI, MGH, MIF, NRRD ...)")
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
        help="weights of streamlines, such as SIFT2's: a file of numbers, or the name of an array",
    )
    parser.add_argument("--ends-only", action="store_true", help="count end points instead")


def add_connectome(commands: Commands) -> None:
    """``connectome``."""
    matrix = commands.add_parser(
        "connectome",
        help="write the connectome matrix of an atlas",
        description="Write a symmetric matrix of parcels by parcels: the number of streamlines of IN between both, "
                    "or the mean of their values. Rows and columns are the labels of LABELS, rising.",
    )
    matrix.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    matrix.add_argument("labels", metavar="LABELS", help="an image of whole numbers, 0 for no parcel")
    matrix.add_argument("target", metavar="OUT", help="a .csv, .tsv, .txt or .npy file; or -")
    add_matrix_options(matrix)
    add_format_option(matrix, reads=["source"], writes="target", usual="csv")
    add_image_options(matrix)
    json_option(matrix)
    add_memory_option(matrix)
    matrix.set_defaults(run="pvfiblets.cli.connectome:connectome")


def add_matrix_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a connectome."""
    parser.add_argument("--weights", metavar="NAME|FILE", help="weights of streamlines, such as SIFT2's")
    parser.add_argument(
        "--contrast", default="count", metavar="NAME|FILE|IMAGE",
        help="'count' (default), 'length', or numbers: an array, a file of values, or the mean of an image along each",
    )  # fmt: skip
    parser.add_argument(
        "--radius", type=float, default=4.0, metavar="MM",
        help="search radius for the parcel of an end; 0: the end's own voxel (default: %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--statistic",
        choices=("sum", "mean", "min", "max"),
        help="statistic of a pair's values (default: sum of counts, otherwise mean)",
    )


def add_table(commands: Commands) -> None:
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
                       help="unit of a row (default: %(default)s); a file without groups is one bundle")  # fmt: skip
    table.add_argument(
        "--group", action="append", default=[], metavar="NAME", help="only this group; repeatable with --by bundle"
    )
    table.add_argument("--image", action="append", default=[], metavar="[NAME=]IMAGE",
                       help="an image, for a column of means along each streamline or bundle; repeatable")  # fmt: skip
    _add_point_weights(table)
    add_format_option(table, reads=["source"])
    add_image_options(table)
    add_memory_option(table)
    table.set_defaults(run="pvfiblets.cli.bundles:table")


def add_profile(commands: Commands) -> None:
    """``profile``."""
    parser = commands.add_parser(
        "profile",
        help="average values along bundles, from one end to the other",
        description="Write a row for each place along each bundle: mean, standard deviation, and confidence band of "
                    "the mean. Groups of the files are bundles; a file without groups is one bundle. Streamlines "
                    "near the core of a bundle have larger weights, as in AFQ.",
    )
    parser.add_argument("sources", metavar="IN", nargs="+", help="tractograms of any format, or -")
    parser.add_argument("-o", "--output", action="append", default=[], metavar="OUT",
                        help="a .csv, .tsv or .parquet table, or a .png, .svg or .pdf plot; repeatable (default: "
                             "the table on standard output)")  # fmt: skip
    parser.add_argument("--values", required=True, action="append", metavar="NAME|IMAGE",
                        help="a per-point array, curvature, arc_length, or an image to sample; repeatable",
                        )  # fmt: skip
    parser.add_argument("--positions", type=count, default=100, metavar="N", help="places along a bundle (default: "
                                                                                  "%(default)s)")
    parser.add_argument("--group", action="append", default=[], metavar="NAME", help="only this group; repeatable")
    parser.add_argument("--weights", choices=("core", "equal"), default="core",
                        help="core: larger weights near the core (default: %(default)s)")  # fmt: skip
    parser.add_argument("--confidence", type=float, default=0.95, metavar="SHARE", help="confidence level of the "
                                                                                        "band (default: 0.95)")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    add_format_option(parser, reads=["sources"])
    add_image_options(parser)
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli.bundles:profile")


def _add_point_weights(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--weights", choices=("length", "points"), default="length",
                        help="weights of points in means: their length, as in tcksample -stat_tck mean, or equal "
                             "(default: %(default)s)")  # fmt: skip


def add_sample(commands: Commands) -> None:
    """``sample``."""
    parser = commands.add_parser(
        "sample",
        help="sample an image along streamlines, at each point or as a statistic of each streamline",
        description="Sample IMAGE at the points of IN, linearly between the centres of voxels, and write a value "
                    "for each point to OUT, or with --statistic a value for each streamline. Points outside the "
                    "image have no value and are left out of statistics (tcksample uses 0 there).",
    )
    parser.add_argument("source", metavar="IN", help="a tractogram of any format, or -")
    parser.add_argument("image", metavar="IMAGE", help="an image with one number per voxel (NIfTI, MGH, MIF, NRRD ...)")
    parser.add_argument("target", metavar="OUT", help="a .tsf, .txt, .csv or .npy file of numbers, one a row; a "
                                                      "tractogram, which gets the points of IN and the values; or "
                                                      "-")  # fmt: skip
    add_sampling_options(parser)
    add_format_option(parser, reads=["source"], writes="target", usual="txt")
    add_image_options(parser)
    add_memory_option(parser)
    parser.set_defaults(run="pvfiblets.cli.samples:sample")


def add_sampling_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of sampling an image."""
    parser.add_argument("--statistic", choices=("mean", "median", "min", "max"), help="statistic of each streamline")
    _add_point_weights(parser)
    parser.add_argument("--nearest", action="store_true", help="use the nearest voxel's value, for labels")
    parser.add_argument("--name", help="name of the array in a tractogram (default: IMAGE without its suffix)")


def json_option(parser: argparse.ArgumentParser) -> None:
    """``--json``."""
    parser.add_argument("--json", action="store_true", help="print the result as one JSON object")


def _quiet_and_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    json_option(parser)
