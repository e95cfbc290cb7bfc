"""Why a session's process has ended unexpectedly."""

from __future__ import annotations

import signal
from collections.abc import Iterable

from pvfiblets.support import memory

# What C++, LLVM, Python and VTK write when memory runs out, or a file asks for more than any memory holds. Each of them
# may end the process then.
_SIGNS = (
    "std::bad_alloc",
    "std::length_error",
    "MemoryError",
    "out of memory",
    "Cannot allocate memory",
    "Unable to allocate",
)


def reason(code: int | None, lines: Iterable[str], doing: str, most: int | None) -> str:
    """Return why a process has ended, in one sentence for its user."""
    during = f" while it opened {doing}" if doing else ""
    what = "a smaller file" if doing else "less at once"
    less = f"open {what}, or have the server started with a larger --max-memory"
    if any(sign in line for line in lines for sign in _SIGNS):
        share = "" if most is None else f" (a session may have {memory.shown(most)})"
        return f"its process ran out of memory{share}{during}; {less}"
    if code == -9:  # as Linux does when there is none
        return (
            f"its process ended unexpectedly{during}: the system stopped it, most likely since this machine ran out of "
            "memory; open less at once, or have the server started with a smaller --max-memory or --limit"
        )
    return f"its process ended unexpectedly{during}"


def shown(code: int | None) -> str:
    """Return an exit code as logs say it."""
    try:
        return f"exit code {code}" if code is None or code >= 0 else signal.Signals(-code).name
    except ValueError:
        return f"signal {-(code or 0)}"
