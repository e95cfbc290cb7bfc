"""A process that measures cells one after the other, so that a driver that dies takes one cell along, not the study."""

from __future__ import annotations

import contextlib
import json
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Sequence
from typing import IO, Any

Row = dict[str, Any]


def serve(measure: Callable[[Row], Row]) -> None:
    """Read a cell in JSON from each line of standard input, and print its row."""
    for line in sys.stdin:
        print(json.dumps(measure(json.loads(line))), flush=True)


class CellProcess:
    """A process that runs :func:`serve`: its libraries and kernels are ready after the first cell."""

    def __init__(self, command: Sequence[str]) -> None:
        self._command = command
        self._process: subprocess.Popen[str] | None = None
        self._errors: IO[str] | None = None

    @classmethod
    def for_module(cls, module: str) -> CellProcess:
        """Return one that runs a module."""
        return cls([sys.executable, "-m", module])

    def measure(self, cell: Row, seconds: float) -> Row:
        """Return a cell's row, or ``unmeasured``: it took too long, or what the process died of."""
        # The next cell then has a new process.
        if self._process is None:
            self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 - closed with the process
            self._process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True
            )
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        late = threading.Event()

        def stop() -> None:
            late.set()
            process.kill()

        timer = threading.Timer(seconds, stop)
        timer.start()
        try:
            process.stdin.write(json.dumps(cell) + "\n")
            process.stdin.flush()
            line = process.stdout.readline()
            while line and not (line.startswith("{") and line.endswith("}\n")):  # skip what drivers print
                line = process.stdout.readline()
        except BrokenPipeError:
            line = ""
        finally:
            timer.cancel()
        if line:
            row: Row = json.loads(line)
            return row
        reason = self.close()
        return {"unmeasured": f"takes more than {seconds:.3g} s here" if late.is_set() else reason}

    def close(self) -> str:
        """End the process; return the cause if it had died."""
        process, errors = self._process, self._errors
        if process is None or errors is None:
            return ""
        self._process = None
        if process.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # of unread input
                process.stdin.close()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stdout is not None:
            process.stdout.close()
        errors.seek(0)
        last = next((line.strip() for line in reversed(errors.read().splitlines()) if line.strip()), "")
        errors.close()
        return f"{ended(process.returncode)}{': ' * bool(last)}{last}"


def ended(code: int) -> str:
    """Return how a process ended, in words."""
    if code >= 0:
        return f"ended with {code}"
    try:
        return f"ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"ended by signal {-code}"
