"""Memory limit of this process, remaining memory, and checks before allocations.

The limit is on what Linux calls data: private memory that can be written to. Address space (``RLIMIT_AS``) is no
measure here: mapped files, compilers of shaders and stacks of threads reserve far more of it than they ever use.
"""

from __future__ import annotations

import ctypes
import gc
import math
import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from pvfiblets.errors import FibletsError

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

MEBIBYTE = 1 << 20
CAN_LIMIT = resource is not None and sys.platform.startswith("linux")
"""Whether :func:`limit` is possible: other systems have no such limit, or do not keep to it."""
ENVIRONMENT = {"MALLOC_ARENA_MAX": "1"}
"""For a process that :func:`limit` is for: when memory runs out, glibc tries its other arenas one by one, and keeps
what each of them got, though all of it is free."""
_MEMORY = Path("/proc/meminfo")
_GROUP = Path("/sys/fs/cgroup")
RESERVE = 48 * MEBIBYTE  # bytes that must remain after something was loaded, so that the rest of the program goes on
_UNITS = {"K": 1 << 10, "M": 1 << 20, "G": 1 << 30, "T": 1 << 40}

Result = TypeVar("Result")


class TooLargeError(FibletsError, MemoryError):
    """Something needs more memory than there is: ``needed`` bytes of which ``left`` were left, if known."""

    def __init__(self, needed: int | None = None, left: int | None = None) -> None:
        self.needed, self.left = needed, left
        super().__init__(needed, left)

    def __str__(self) -> str:
        if self.needed is None or self.left is None:
            return "it needs more memory than is left"
        return f"it says that it takes {shown(self.needed)}, and {shown(self.left)} of memory are left for it"


def of_machine() -> int:
    """Return how much memory the machine has, or the group of processes that this one is in; 0 where none says it."""
    try:
        found = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return 0
    for name in ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"):
        try:
            text = Path(name).read_text(encoding="ascii").strip()
        except (OSError, UnicodeDecodeError):
            continue
        if text.isdecimal() and int(text) > 0:
            found = min(found, int(text))
    return found


def free_host_memory() -> int | None:
    """Bytes of memory that a process can still take, where Linux tells: of the machine, and of its control group."""
    if not _MEMORY.is_file():
        return None
    machine = re.search(r"^MemAvailable:\s+(\d+) kB", _MEMORY.read_text(encoding="ascii"), re.MULTILINE)
    found = [] if machine is None else [1024 * int(machine[1])]
    try:
        limit = (_GROUP / "memory.max").read_text(encoding="ascii").strip()
        if limit != "max":
            used = int((_GROUP / "memory.current").read_text(encoding="ascii"))
            # Cached files count as used but are released on demand.
            files = re.search(r"^file (\d+)$", (_GROUP / "memory.stat").read_text(encoding="ascii"), re.MULTILINE)
            found.append(max(int(limit) - used + (0 if files is None else int(files[1])), 0))
    except (OSError, ValueError):
        pass  # no such group, or an older kernel
    return min(found, default=None)


def parse(text: str, machine: int | None = None) -> int:
    """Return the bytes that a text means: ``4G``, ``800M``, or ``25%`` of the machine's memory."""
    match = re.fullmatch(r"\s*(\d{1,9}(?:\.\d{1,9})?)\s*(?:([KMGT])(?:i?B)?|(%))\s*", text, re.IGNORECASE | re.ASCII)
    if match is None or not float(match[1]) > 0.0:
        raise ValueError(f"{text!r} is no size of memory; give one such as 4G, 800M, or 25% of this machine's")
    if match[3] is None:
        return int(float(match[1]) * _UNITS[match[2].upper()])
    whole = of_machine() if machine is None else machine
    if float(match[1]) > 100.0:
        raise ValueError(f"{text!r} is more than this machine has; give 100% at most")
    if not whole:
        raise ValueError(f"{text!r}: this system does not say how much memory it has; give a size such as 4G")
    return int(whole * float(match[1]) / 100.0)


def shown(size: float) -> str:
    """Return a number of bytes as people read it."""
    size = max(size, 0) / MEBIBYTE
    return f"{size / 1024:,.1f} GB" if size >= 1024 else f"{math.ceil(size):,} MB"


def limit(size: int) -> None:
    """Limit this process to some bytes of memory from now on."""
    assert resource is not None
    hardest = resource.getrlimit(resource.RLIMIT_DATA)[1]
    if hardest != resource.RLIM_INFINITY:
        size = min(size, hardest)
    resource.setrlimit(resource.RLIMIT_DATA, (size, hardest))


@contextmanager
def limited(size: int | None) -> Iterator[None]:
    """Limit this process to some bytes of memory in this scope, where the system can limit it."""
    # A limit that it has already stays, if it is lower.
    before = resource.getrlimit(resource.RLIMIT_DATA) if CAN_LIMIT and resource is not None else None
    if size is None or before is None or (before[0] != resource.RLIM_INFINITY and before[0] <= size):
        yield
        return
    limit(size)
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, before)


def limited_to() -> int | None:
    """Return how many bytes this process may have; ``None`` without a limit."""
    if not CAN_LIMIT:
        return None
    most = resource.getrlimit(resource.RLIMIT_DATA)[0]
    return None if most == resource.RLIM_INFINITY else most


def taken() -> int:
    """Return the bytes that this process has allocated, which the limit counts."""
    text = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
    match = re.search(r"^VmData:\s+(\d+) kB$", text, re.MULTILINE)
    return 0 if match is None else 1024 * int(match[1])


def resident() -> int:
    """Return the memory of this process in bytes: allocated, and of files."""
    text = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
    match = re.search(r"^VmRSS:\s+(\d+) kB$", text, re.MULTILINE)
    return 0 if match is None else 1024 * int(match[1])


def room() -> int | None:
    """Return how many bytes are left to this process; ``None`` without a limit."""
    most = limited_to()
    return None if most is None else max(most - taken(), 0)


def check_room(needed: int) -> None:
    """Refuse what says that it takes more memory than is left; what says less may be lying."""
    # Small allocations are not checked: the check costs more.
    if needed > RESERVE // 4 and (left := room()) is not None and needed + RESERVE > left:
        raise TooLargeError(needed, max(left - RESERVE, 0))


def fits(needed: int) -> bool:
    """Whether so many bytes are left; without a limit they are."""
    left = room() if needed > RESERVE // 4 else None
    return left is None or needed + RESERVE <= left


def within(work: Callable[[], Result], reserve: int = RESERVE) -> Result:
    """Do what may take more memory than there is; where it does, nothing of it stays."""
    needed = left = None
    try:
        result = work()
        if not reserve or (now := room()) is None or now >= reserve:
            return result
        del result
    except MemoryError as error:
        if isinstance(error, TooLargeError):
            needed, left = error.needed, error.left
    # Outside of the clause, where the error and all that its frames held are gone.
    gc.collect()
    _give_back()
    raise TooLargeError(needed, left)


def _give_back() -> None:
    """Return freed memory to the system, where the library for it can."""
    try:
        ctypes.CDLL(None).malloc_trim(0)
    except (AttributeError, OSError, TypeError):
        return
