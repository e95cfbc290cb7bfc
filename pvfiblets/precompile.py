"""Compiles all kernels: ``python -m pvfiblets.precompile``.

Otherwise the kernels that code streamlines are compiled when a set is first large enough for them, and the kernels of
painted regions at the first stroke. Several processes compile, side by side, as numba compiles one
kernel at a time in a process.
"""

from __future__ import annotations

import logging
import subprocess
import sys

from .codec import precompile as coding
from .query.painting import kernels as painting

__all__ = ["main"]

PAINTING = "painting"


def main(arguments: list[str]) -> int:
    """Compile the missing kernels, or the named part; return the exit status."""
    if arguments == [PAINTING]:
        logging.getLogger("pvfiblets.codec").setLevel(logging.ERROR)  # that kernels are compiled is known
        painting.compile_all()
        return 0
    if arguments:
        raise SystemExit(f"there is no part {arguments[0]!r} to compile; give {PAINTING}, or nothing for all")
    command = [sys.executable, "-m", "pvfiblets.precompile", PAINTING]
    own = [] if painting.are_compiled() else [subprocess.Popen(command)]
    coding.main([])
    return max((one.wait() for one in own), default=0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
