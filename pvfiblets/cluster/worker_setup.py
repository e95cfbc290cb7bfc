"""What a process started by a batch does before its first task; dask calls it by its name."""

from __future__ import annotations

import signal
from typing import Any


def dask_setup(worker: Any) -> None:
    """Leave interrupts to the batch: a terminal sends Ctrl-C to all processes, and one of them says what came of it."""
    del worker
    signal.signal(signal.SIGINT, signal.SIG_IGN)
