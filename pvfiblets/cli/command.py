"""The ``pvfiblets`` command.

Exit codes: 0 on success; 1 on failure, with one sentence on standard error; 2 for wrong usage. With ``--json`` standard
output is one JSON object.
"""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from pvfiblets.cli import file_arguments as files
from pvfiblets.cli import scene_arguments as scenes
from pvfiblets.cli.batch import add_options as add_batch_options
from pvfiblets.cli.memory import held_to
from pvfiblets.cli.parser import Commands, Parser
from pvfiblets.cli.pipes import Pipes
from pvfiblets.cli.values import count, positive
from pvfiblets.errors import EXPECTED, sentence
from pvfiblets.support.nifti_space import nifti_space
from pvfiblets.support.surface_space import as_stored
from pvfiblets.support.vtk_space import unnamed_as


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    options = vars(make_parser().parse_args(arguments))
    debug = options.pop("debug")
    module, function = options.pop("run").split(":")
    pipes, space = Pipes(options), options.pop("space", None)
    images = nifti_space(options.pop("nifti_space", None), units=options.pop("nifti_units", "mm"))
    surfaces = as_stored(options.pop("tkras", False))
    try:
        with (
            _plain_warnings(pipes),
            held_to(options.pop("max_memory", None)),
            unnamed_as(space),
            images,
            surfaces,
            pipes,
        ):
            code = getattr(import_module(module), function)(**options) or 0
        sys.stdout.flush()  # here, where a reader that has gone is no error
        return code
    except BrokenPipeError:  # the reader of our output, such as `head`, has gone: not an error
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("pvfiblets: interrupted", file=sys.stderr)
        return 1
    except EXPECTED as error:
        if debug:
            raise
        print(f"pvfiblets: {pipes.renamed(sentence(error))}", file=sys.stderr)
        return 1


@contextmanager
def _plain_warnings(pipes: Pipes) -> Iterator[None]:
    """Print user warnings as one sentence each, without the source location."""

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if category is UserWarning:
            print(f"pvfiblets: {pipes.renamed(' '.join(str(message).split()))}", file=sys.stderr)
        else:
            usual(message, category, *place, **more)

    usual = warnings.showwarning
    warnings.showwarning = show
    try:
        yield
    finally:
        warnings.showwarning = usual


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = Parser(prog="pvfiblets", description="Compress, check and render tractograms of any size.")
    parser.add_argument("--version", action=_Version)
    parser.add_argument("--debug", action="store_true", help="show the traceback of an error")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)

    files.add_convert(commands)
    files.add_info(commands)
    files.add_verify(commands)
    files.add_density(commands)
    files.add_connectome(commands)
    files.add_table(commands)
    files.add_profile(commands)
    files.add_sample(commands)
    batch = commands.add_parser("batch", help="apply one of these to each file of a cohort, on all cores or on a "
                                              "cluster")
    add_batch_options(batch)
    scenes.add_screenshot(commands)
    scenes.add_show(commands)
    scenes.add_page(commands)
    scenes.add_serve(commands)
    _add_gl(commands)
    _add_demo(commands)
    _add_report(commands)
    return parser


def _add_gl(commands: Commands) -> None:
    gl = commands.add_parser(
        "gl",
        help="print this machine's OpenGL and its pipelines, and check their output",
        description="List the driver, its limits, and every pipeline: available, or the reason why not. With "
                    "--check, render with all of them, compare with the CPU, time frames, and write one file to "
                    "attach to a bug report; the exit code is 1 if anything differs or fails.",
    )
    gl.add_argument("--check", action="store_true", help="render with every pipeline and effect, and compare")
    gl.add_argument(
        "-o", "--output", default="pvfiblets-check.zip", metavar="FILE", help="output of --check (default: %(default)s)"
    )
    gl.add_argument(
        "--segments", type=positive, nargs="*", metavar="N", help="numbers of segments to time (default: 1e6 1e7 1e8)"
    )
    gl.add_argument(
        "--only", action="append", default=[], metavar="PART", help="run only the checks whose names begin with PART"
    )
    files.json_option(gl)
    gl.set_defaults(run="pvfiblets.cli.gl:gl")


def _add_demo(commands: Commands) -> None:
    demo = commands.add_parser(
        "demo",
        help="make, compress and render a tractogram like a whole brain's, and print size and error",
        description="Make a tractogram like a whole brain's, compress and render it, and print its size and error.",
    )
    demo.add_argument("--output", default="pvfiblets-demo", metavar="FOLDER", help="output folder (default: "
                                                                                   "%(default)s)")
    demo.add_argument("--streamlines", type=count, default=50_000, metavar="N", help="number of streamlines "
                                                                                     "(default: %(default)s)")
    demo.add_argument("--step", type=positive, default=0.5, metavar="MM", help="distance of points (default: "
                                                                               "%(default)s)")
    demo.add_argument("--seed", type=int, default=0, metavar="N", help="seed of the random numbers (default: "
                                                                       "%(default)s)")
    files.json_option(demo)
    demo.set_defaults(run="pvfiblets.cli.pictures:demo")


def _add_report(commands: Commands) -> None:
    from pvfiblets.report.studies import ONLY_NAMED, chosen_names

    report = commands.add_parser(
        "report",
        help="measure error against run time of every approximation and of other methods",
        description="Write report.json, a Markdown page and plots into DIR. Default: all studies.",
    )
    report.add_argument(
        "--only", nargs="+", metavar="STUDY",
        help=f"{', '.join(chosen_names())}; only by name, speed alone: {', '.join(ONLY_NAMED)}",
    )  # fmt: skip
    report.add_argument(
        "--data", nargs="+", default=[], metavar="FILE",
        help="tractograms to measure, or folders of tractograms (default: the folder in PVFIBLETS_DATA)",
    )  # fmt: skip
    report.add_argument("--quick", action="store_true", help="a small part of each study, in at most two minutes on "
                                                             "two cores")
    report.add_argument(
        "--minutes", type=float, metavar="M", help="time limit, shared among the studies (default: none)"
    )
    report.add_argument("--seed", type=int, default=0, metavar="N", help="seed of synthetic data (default: 0)")
    report.add_argument("--from", dest="source", metavar="JSON", help="make page and plots again, without measuring")
    report.add_argument("-o", "--output", required=True, metavar="DIR", help="output folder")
    report.set_defaults(run="pvfiblets.cli.report:report")


class _Version(argparse.Action):
    """Print the versions for a bug report."""

    def __init__(self, option_strings: Sequence[str], **_: object) -> None:
        super().__init__(option_strings, dest=argparse.SUPPRESS, nargs=0, help="print the version")

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from importlib.metadata import version

        print(f"pvfiblets {version('pvfiblets')} (pyvista {version('pyvista')}, vtk {version('vtk')})")
        parser.exit()


if __name__ == "__main__":
    sys.exit(main())
