"""``--max-memory``, the memory limit of a command."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager

from pvfiblets.errors import FibletsError

HALF = "50%"
LEAST_MEMORY = 256 << 20


def add_memory_option(parser: argparse.ArgumentParser) -> None:
    """Give a command the option."""
    parser.add_argument(
        "--max-memory",
        default=HALF,
        metavar="SIZE",
        help="memory limit, such as 4G or 25%% of this machine's (default: 50%%). Files are read in parts; lines of "
             "millions of points are buffered on disk, in TMPDIR",
    )


def bytes_of_file(text: str) -> int:
    """Parse the size of a file, such as ``2G``."""
    from pvfiblets.support import memory

    try:
        if "%" in text:
            raise ValueError
        return memory.parse(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no file size; give one such as 2G or 500M") from None


@contextmanager
def held_to(most: str | None) -> Iterator[None]:
    """Limit the memory of this process to ``--max-memory``."""
    # By default it may take half of the machine's memory beyond its own: a command that runs within a larger program
    # without a limit is not refused for that.
    from pvfiblets.support import memory

    if most is None:
        yield
        return
    chosen = most != HALF
    if not memory.CAN_LIMIT:
        if chosen:
            raise FibletsError("--max-memory works on Linux only; leave it out")
        yield
        return
    has = memory.taken()
    size = memory.parse(most) + (0 if chosen else has) if chosen or memory.of_machine() else None
    if size is not None and size < (least := has + LEAST_MEMORY):
        raise FibletsError(f"--max-memory {most}: {memory.shown(least)} are needed to start; give at least that")
    try:
        with memory.limited(size):
            yield
    except MemoryError as error:
        if size is None:
            raise
        why = f" ({' '.join(str(error).split())})" if str(error) else ""
        raise FibletsError(
            f"this needs more memory than --max-memory, {memory.shown(size)}{why}; give a larger limit, or convert "
            "the file to .trx, .trk or .tck, which are read in parts"
        ) from error
