"""Whether this machine's OpenGL draws right, and how fast: every part in a process of its own, so that one may crash.

A driver that dies takes its process along, not the check: what it was at is noted, and another process goes on with
what comes after. Neither VTK nor a display is needed.
"""

from __future__ import annotations

import json
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .findings import FAILS, MISSING, Finding

__all__ = ["CardCheck", "run_check"]

PATIENCE = 300.0
"""Seconds without a word after which a part counts as hanging: some drivers compile for a minute."""

MODULE = "pvfiblets.report.studies.card.part"


@dataclass
class CardCheck:
    """What a check found."""

    # Driver, limits and extensions, as `pvfiblets gl --json` has them; empty where OpenGL could not be asked
    opengl: dict[str, Any] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    # Files of what differs, `.npy`, by the feature's `part: feature`
    pictures: dict[str, list[Path]] = field(default_factory=dict)

    @property
    def good(self) -> bool:
        """Whether nothing differs or fails."""
        return not any(one.bad for one in self.findings)


def run_check(
    folder: Path,
    segments: Sequence[float],
    log: Callable[[str], object],
    only: Sequence[str] = (),
    patience: float = PATIENCE,
    command: Sequence[str] = (sys.executable, "-m", MODULE),
) -> CardCheck:
    """Try everything that this machine has."""
    from .part import SPEED, parts_of
    from .speed import make_brains

    check = CardCheck()
    asked = _ask(patience)
    if isinstance(asked, str):
        check.findings.append(Finding("OpenGL", "a context without a window", FAILS, asked))
        return check
    check.opengl = asked
    table = [(row["name"], row["available"], row["why_not"]) for row in asked["pipelines"]]
    for name, there, why in table:
        if not there:
            check.findings.append(Finding(f"fiblets {name}", "pipeline", MISSING, why or ""))
    wanted = [part for part in parts_of([name for name, there, _ in table if there])
              if not only or part.startswith(tuple(only))]  # fmt: skip
    if segments and any(part.startswith(SPEED) for part in wanted):
        log("making synthetic brains")
        make_brains(tuple(segments), folder)
    for part in wanted:
        if segments or not part.startswith(SPEED):
            log(part)
            _run_part(check, part, folder, patience, command)
    return check


def _ask(patience: float) -> dict[str, Any] | str:
    """Return what ``pvfiblets gl --json`` prints, or why it does not: asked elsewhere, as it may crash."""
    command = [sys.executable, "-m", "pvfiblets", "gl", "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=patience, check=False)
    except subprocess.TimeoutExpired:
        return f"no answer within {patience:g} s"
    if done.returncode != 0:
        return done.stderr.strip().removeprefix("pvfiblets: ") or ended(done.returncode)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def _run_part(check: CardCheck, part: str, folder: Path, patience: float, command: Sequence[str]) -> None:
    """Run a part to its end, by as many processes as die of it."""
    after = ""
    while True:
        process = subprocess.Popen(
            [*command, part, str(folder), *([after] if after else [])],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        with process:  # closes its pipes
            begun, why = _listen(check, process, folder, patience)
        if not begun and not why:
            return
        check.findings.append(Finding(part, begun or "beginning", FAILS, why))
        if not begun:
            return
        after = begun


def _listen(check: CardCheck, process: subprocess.Popen[str], folder: Path, patience: float) -> tuple[str, str]:
    """Take down what a process says; return the feature that it died of, and how; both empty if it ended well."""
    lines: queue.Queue[str | None] = queue.Queue()
    said: list[str] = []

    def read() -> None:
        assert process.stdout is not None
        for line in process.stdout:
            lines.put(line)
        lines.put(None)

    def hear() -> None:
        assert process.stderr is not None
        said.extend(process.stderr)

    readers = [threading.Thread(target=target, daemon=True) for target in (read, hear)]
    for reader in readers:
        reader.start()
    begun = ""
    try:
        while True:
            line = lines.get(timeout=patience)
            if line is None:
                break
            told = json.loads(line) if line.startswith("{") else {}  # drivers print what they like
            begun = told.get("begin", begun)
            if "finding" in told:
                finding = Finding(**told["finding"])
                check.findings.append(finding)
                if told["pictures"]:
                    check.pictures[f"{finding.part}: {finding.feature}"] = [folder / name for name in told["pictures"]]
                begun = ""
        process.wait()
        readers[1].join()
        if process.returncode == 0:
            return "", ""
        last = next((line.strip() for line in reversed(said) if line.strip()), "")
        return begun, f"{ended(process.returncode)}{': ' * bool(last)}{last}"
    except queue.Empty:
        return begun, f"no answer within {patience:g} s"
    finally:
        process.kill()
        process.wait()
        for reader in readers:
            reader.join()


def ended(code: int) -> str:
    """Say how a process ended."""
    if code >= 0:
        return f"ended with {code}"
    try:
        return f"ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"ended by signal {-code}"
