"""``-`` on the command line: standard input and output in place of files.

Formats need random access to their input, and commands read their output again, so that both lie in temporary
files meanwhile (``TMPDIR`` says where). Output leaves when it is whole, and alone: messages go to standard error then.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from collections.abc import Sequence
from contextlib import ExitStack, redirect_stdout
from pathlib import Path
from typing import IO, Any, Self

from pvfiblets.formats.recognise import suffix_by_content
from pvfiblets.support.addresses import is_url
from pvfiblets.support.nifti_space import MATRICES, UNITS
from pvfiblets.support.whole_files import naming_target

_IN, _OUT = "standard input", "standard output"


def add_format_option(
    parser: argparse.ArgumentParser, *, reads: Sequence[str], writes: str | None = None, usual: str | None = None
) -> None:
    """Add ``--format`` and ``--space``, and allow ``-`` for files."""
    which = "format of -, such as tck: of standard input (default: detected from its first bytes)"
    if writes is not None:
        which += f" or output ({f'default: {usual}' if usual else 'needed'}); of both, the output's comes last"
    parser.add_argument("--format", action="append", default=[], metavar="SUFFIX", help=which)
    add_space_option(parser)
    parser.set_defaults(pipes=(tuple(reads), writes, usual))


def add_space_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--space``."""
    parser.add_argument(
        "--space", choices=("RAS", "LPS"), type=str.upper,
        help="space of points in VTK files that name none (default: RAS); DIPY wrote LPS up to 1.11",
    )  # fmt: skip


def add_image_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--nifti-space`` and ``--nifti-units``."""
    parser.add_argument(
        "--nifti-space", choices=MATRICES,
        help="position of NIfTI images: by a matrix of the header, or by voxel sizes alone with the first axis to "
             "the left (LAS) or right (RAS) (default: sform, then qform, then LAS)",
    )  # fmt: skip
    parser.add_argument(
        "--nifti-units", choices=UNITS, default="mm",
        help="unit of coordinates in NIfTI images: mm, or the header's (xyzt_units) (default: %(default)s)",
    )  # fmt: skip


def add_surface_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--tkras``."""
    parser.add_argument(
        "--tkras", action="store_true",
        help="keep FreeSurfer's surfaces in its surface space (default: moved by c_ras to the space of tracts)",
    )  # fmt: skip


class Pipes:
    """Standard input and output of one command, as files; a context manager."""

    def __init__(self, options: dict[str, Any]) -> None:
        # of the command. Taken out are `pipes` and `format`; in the context, temporary files stand for `-`.
        self._options = options
        self._reads, self._writes, self._usual = options.pop("pipes", ((), None, None))
        self._formats: list[str] = [f".{given.lstrip('.').lower()}" for given in options.pop("format", [])]
        self._names: dict[str, str] = {}
        self._stack = ExitStack()
        self._output: Path | None = None
        self._stdout = sys.stdout

    def __enter__(self) -> Self:
        self._stdout = sys.stdout
        with self._stack:  # only if what follows fails
            self._enter()
            self._stack = self._stack.pop_all()
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        with self._stack:
            if kind is None and self._output is not None:
                with self._output.open("rb") as file:
                    shutil.copyfileobj(file, _binary(self._stdout), 1 << 20)
                self._stdout.flush()

    def renamed(self, text: str) -> str:
        """Return a message with the user's names of temporary files."""
        for path, name in self._names.items():
            text = text.replace(path, name)
        return text

    def _enter(self) -> None:
        target = self._options.get(self._writes or "")
        if isinstance(target, str) and is_url(target):
            raise ValueError(f"{target} is an address, but output must be a local file; give a path")
        sources = [name for name in self._reads if _asks(self._options.get(name))]
        into = self._writes is not None and self._options[self._writes] == "-"
        if len(sources) + sum(_asks(self._options[name]) > 1 for name in sources) > 1:
            raise ValueError("- is given for two files, but there is one standard input; save one of them to a file")
        if len(self._formats) > len(sources) + into:
            raise ValueError(
                f"--format {self._formats[0].lstrip('.')} sets the format of -, but "
                + ("there is only one -; give one" if sources or into else "no file is -; a suffix sets the format "
                                                                           "of a named file")
            )
        if not (sources or into):
            return
        given = list(self._formats)
        written = (given.pop() if given else self._usual) if into else None
        if into and written is None:
            raise ValueError(
                "- is standard output, which has no suffix; add --format, such as --format tck"
            )
        if into and self._options.get("shards") is not None:
            raise ValueError("--shards writes a folder, not to standard output; give the folder's name")
        if into and self._stdout.isatty():
            raise ValueError("- is standard output, a terminal; redirect it to a file or another program (> or |)")
        folder = Path(self._stack.enter_context(tempfile.TemporaryDirectory(prefix="pvfiblets-pipe-")))
        self._names[f"{folder}/"] = ""
        for name in sources:
            path = self._name(_spooled(folder, given[0] if given else None), _IN)
            value = self._options[name]
            self._options[name] = path if value == "-" else [path if one == "-" else one for one in value]
        if into:
            self._output = folder / f"standard-output.{str(written).lstrip('.')}"
            self._options[self._writes] = self._name(self._output, _OUT)
        self._stack.enter_context(redirect_stdout(_Renaming(sys.stderr if into else sys.stdout, self)))

    def _name(self, path: Path, name: str) -> str:
        self._names[path.name] = name
        return str(path)


def _asks(value: Any) -> int:
    """Return how often ``-`` is given for an argument."""
    return (value or []).count("-") if isinstance(value, list) else int(value == "-")


def _spooled(folder: Path, suffix: str | None) -> Path:
    """Put standard input into a file with the suffix of its format."""
    if sys.stdin is None or sys.stdin.isatty():
        raise ValueError("- is standard input, a terminal; redirect a file or a program's output to it (< or |)")
    path = folder / "standard-input"
    with naming_target(folder / _IN), path.open("wb") as file:
        shutil.copyfileobj(_binary(sys.stdin), file, 1 << 20)
        size = file.tell()
    if size == 0:
        raise ValueError("standard input is empty; redirect a file or a program's output to it (< or |)")
    suffix = suffix or suffix_by_content(path)
    if suffix is None:
        raise ValueError("standard input has no known first bytes; add --format, such as --format trk")
    return path.rename(path.with_name(path.name + suffix))


def _binary(stream: Any) -> IO[bytes]:
    binary: IO[bytes] = stream.buffer
    return binary


class _Renaming:
    """A text stream with the user's names of temporary files."""

    def __init__(self, stream: Any, pipes: Pipes) -> None:
        self._stream, self._pipes = stream, pipes

    def write(self, text: str) -> int:
        return int(self._stream.write(self._pipes.renamed(text)))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
