"""Compiles all kernels: ``python -m pvfiblets.precompile``.

Otherwise the kernels that code streamlines are compiled when a set is first large enough for them, and the kernels of
painted regions at the first stroke. Several processes compile, side by side, as numba compiles one
kernel at a time in a process.
"""

from __future__ import annotations

import logging
import subprocess
import sys

from .codec import precompile as codec
from .codec.kernel_cache import is_filled, mark_filled
from .query.painting import kernels as painting

PARTS = {**codec.PARTS, "painting": painting.compile_all}


def main(arguments: list[str]) -> int:
    """Compile the missing kernels, or the named part; return the exit status."""
    if arguments:
        if len(arguments) > 1 or arguments[0] not in PARTS:
            raise SystemExit(f"there is no part {arguments} to compile; give one of {', '.join(PARTS)}, or nothing")
        logging.getLogger("pvfiblets.codec").setLevel(logging.ERROR)  # that kernels are compiled is known
        PARTS[arguments[0]]()
        return 0
    coded = is_filled("coding") and is_filled("decoding")
    wanted = [*([] if coded else codec.PARTS), *([] if painting.are_compiled() else ["painting"])]
    running = [subprocess.Popen([sys.executable, "-m", "pvfiblets.precompile", name]) for name in wanted]
    codes = {one.wait() for one in running}
    failed = bool(codes - {0})
    if not (coded or failed):
        mark_filled("coding")
        mark_filled("decoding")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
