"""The process that draws the cells of ``benchmarks/card.py``."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import IO, Any

from common import too_long, why_it_failed

__all__ = ["Drawer"]

Row = dict[str, Any]


class Drawer:
    """A process that draws cells one after the other: its libraries and kernels are ready after the first.

    Parameters
    ----------
    script : str
        That reads a cell in JSON from each line, and answers with a row.
    folder : Path
        Where brains are.
    """

    def __init__(self, script: str, folder: Path) -> None:
        self._command = [sys.executable, script, "--draw-cells", "--folder", str(folder)]
        self._process: subprocess.Popen[str] | None = None
        self._said: IO[str] | None = None

    def draw(self, cell: Row, seconds: float) -> Row:
        """Draw a cell; return its row, or why there is none: it takes too long, or what the process died of.

        The next cell then has a new process.
        """
        if self._process is None:
            self._said = tempfile.TemporaryFile("w+")  # noqa: SIM115 - closed with the process
            self._process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._said, text=True
            )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        late = threading.Event()
        timer = threading.Timer(seconds, lambda: (late.set(), self._process and self._process.kill()))
        timer.start()
        try:
            self._process.stdin.write(json.dumps(cell) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        finally:
            timer.cancel()
        if line.endswith("}\n"):
            row: Row = json.loads(line)
            return row
        reason = self.close()
        return {"unmeasured": too_long(seconds) if late.is_set() else reason}

    def close(self) -> str:
        """End the process; return what it died of, if it had."""
        process, said = self._process, self._said
        if process is None or said is None:
            return ""
        self._process = None
        if process.stdin is not None:
            with contextlib.suppress(BrokenPipeError):  # of what it has not read
                process.stdin.close()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stdout is not None:
            process.stdout.close()
        said.seek(0)
        reason = why_it_failed(said.read(), process.returncode)
        said.close()
        return reason
