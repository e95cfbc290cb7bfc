"""The ``batch`` command."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from pvfiblets.cli.file_arguments import (
    add_coding_options,
    add_grid_options,
    add_matrix_options,
    add_sampling_options,
)
from pvfiblets.cli.files import print_json, show_progress, which_per_point
from pvfiblets.cli.pipes import add_image_options, add_space_option, add_surface_option
from pvfiblets.cli.values import angle, count
from pvfiblets.codec.parameters import DEFAULT_ANGLE

_ABOUT = {
    "convert": "compress each file, or write it in another format",
    "verify": "check .fiblets files against their checksums, and against their originals",
    "density": "write a density map of each file: streamlines, lengths, directions or means per voxel",
    "select": "write the streamlines of each file that pass, end or stay in regions",
    "profile": "write a table of mean values along the bundles of each file",
    "connectome": "write a table of the connectome matrix of each file",
    "sample": "write the values of an image along the streamlines of each file",
}
_REGION = "a region: sphere:X,Y,Z,R or box:XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX (mm), IMAGE, or IMAGE:LABEL,LABEL; repeatable"


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of ``batch`` to a parser."""
    parser.description = (
        "Apply an operation to each FILE of a cohort, on all cores of this machine or on a dask cluster. Files go "
        "to OUT, numbers to OUT/OPERATION.parquet, and a record of finished files to OUT/OPERATION.jsonl, for "
        "--resume. Paths may contain {subject}, {session}, {stem}, {folder} and other parts of a FILE's BIDS name."
    )
    operations = parser.add_subparsers(
        metavar="OPERATION", required=True, dest="operation", help="the operation for each file"
    )
    made = {name: operations.add_parser(name, help=about, description=f"{about[0].upper()}{about[1:]}.")
            for name, about in _ABOUT.items()}  # fmt: skip
    for name, sub in made.items():
        _common(sub)
        globals()[f"_{name}"](sub)
    parser.set_defaults(run="pvfiblets.cli.batch:batch")


def _common(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("sources", metavar="FILE", nargs="+", help="tractograms, or patterns between quotes: 'sub-*/dwi/*.trk'")
    add("-o", "--output", required=True, metavar="OUT", help="output folder")
    add("--cluster", metavar="ADDRESS", help="dask's scheduler, tcp://HOST:PORT, or its file (default: this machine)")
    add("--workers", type=count, metavar="N", help="worker processes on this machine (default: one a core)")
    add(
        "--max-memory",
        "--memory",
        dest="memory",
        metavar="SIZE",
        help="memory limit of a worker, such as 4G (default: 80%% of this machine's, divided by the workers)",
    )
    old = parser.add_mutually_exclusive_group()
    old.add_argument("--resume", action="store_true", help="skip files that an earlier run has finished")
    old.add_argument("--overwrite", action="store_true", help="repeat everything")
    add_image_options(parser)
    add_space_option(parser)
    add_surface_option(parser)
    add("--quiet", action="store_true", help="no progress bar")
    add("--json", action="store_true", help="print the result as one JSON object")


def _convert(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("--to", default=".fiblets", metavar="SUFFIX", help="format to write, such as .trk (default: %(default)s)")
    add_coding_options(parser)


def _verify(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--original", metavar="PATH", help="the source of each file: 'raw/{folder}/{stem}.trk'")
    parser.add_argument("--max-angle", type=angle, default=DEFAULT_ANGLE, metavar="DEG", help="bound of directions, "
                                                                                              "or none")


def _density(parser: argparse.ArgumentParser) -> None:
    add_grid_options(parser)
    parser.add_argument("--to", default=".nii.gz", metavar="SUFFIX",
                        help=".nii, .nii.gz, .mif, .mif.gz or .vti (default: %(default)s)")  # fmt: skip


def _select(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    for option, what in (
        ("--passes", "streamlines that pass through"), ("--avoids", "streamlines that do not pass through"),
        ("--ends-in", "streamlines with an end in"), ("--both-ends-in", "streamlines with both ends in"),
        ("--stays-in", "streamlines that never leave"),
    ):  # fmt: skip
        add(option, action="append", default=[], metavar="REGION", help=f"{what} {_REGION}")
    add("--sampling", choices=("lines", "points"), default="lines",
        help="points: test the points only, as MRtrix's tckedit does (default: %(default)s)")
    add("--to", default=".fiblets", metavar="SUFFIX", help="format to write (default: %(default)s)")


def _profile(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--values", required=True, metavar="NAME|IMAGE",
                        help="a per-point array, curvature, arc_length, or an image to sample")  # fmt: skip
    parser.add_argument("--positions", type=count, default=100, metavar="N", help="places along a bundle (default: "
                                                                                  "%(default)s)")


def _connectome(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--labels", required=True, metavar="IMAGE",
                        help="label image of parcels: 'atlas/sub-{subject}.nii.gz'")  # fmt: skip
    add_matrix_options(parser)


def _sample(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--image", required=True, metavar="IMAGE", help="one number per voxel: 'fa/sub-{subject}.nii'")
    add_sampling_options(parser)
    parser.add_argument("--to", default=".txt", metavar="SUFFIX", help=".txt, .csv or .npy of numbers, .tsf, or a "
                        "tractogram with them (default: %(default)s)")  # fmt: skip


def batch(
    operation: str,
    sources: list[str],
    output: str,
    *,
    cluster: str | None,
    workers: int | None,
    memory: str | None,
    resume: bool,
    overwrite: bool,
    quiet: bool,
    json: bool,
    **options: Any,
) -> int:
    """Apply an operation to many files; return 1 if any failed."""
    from pvfiblets.cluster import batch as run

    if "per_point" in options:
        options["per_point"] = which_per_point(options["per_point"])
    voxel = options.get("voxel")
    if voxel is not None:
        if len(voxel) not in (1, 3):
            raise ValueError(f"--voxel has {len(voxel)} numbers; give one side in mm, or three")
        options["voxel"] = voxel[0] if len(voxel) == 1 else voxel
    result = run(
        operation, sources, output, cluster=cluster, workers=workers, memory=memory, resume=resume,
        overwrite=overwrite, progress=show_progress(quiet, json), **options,
    )  # fmt: skip
    if json:
        print_json({
            "operation": operation, "folder": str(result.folder), "done": len(result.done),
            "skipped": len(result.skipped), "failed": dict(result.failed),
            "table": None if result.table is None else str(result.table), "seconds": result.seconds,
        })  # fmt: skip
    else:
        parts = [f"{len(result.done):,} done"]
        parts += [f"{len(result.skipped):,} finished before"] * bool(result.skipped)
        parts += [f"{len(result.failed):,} failed"] * bool(result.failed)
        print(f"{result.folder}: {', '.join(parts)}, in {result.seconds:.1f} s")
        if result.table is not None:
            print(f"table    {result.table}")
    for name, why in result.failed.items():
        print(f"pvfiblets: {why if name in why else f'{name}: {why}'}", file=sys.stderr)
    return 0 if result.ok else 1
