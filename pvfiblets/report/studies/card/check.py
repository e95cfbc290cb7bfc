"""Whether this machine's OpenGL draws right, and how fast: every part in a process of its own, so that one may crash.

A driver that dies takes its process along, not the check: what it was at is noted, and another process goes on with
what comes after. Neither VTK nor a display is needed.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

from ...process import CellProcess, ended
from .findings import FAILS, MISSING, Finding

PATIENCE = 300.0
"""Seconds without a word after which a part counts as hanging: some drivers compile for a minute."""

MODULE = "pvfiblets.report.studies.card.part"

COMPUTES = {
    "GL_ARB_compute_shader", "GL_ARB_shader_storage_buffer_object", "GL_ARB_shader_image_load_store",
}  # fmt: skip
"""Extensions of a driver that has compute shaders, whatever version its context tells."""


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
            hidden = name == "compute" and COMPUTES.issubset(asked["extensions"])
            note = f"{why}, although the driver has compute shaders: nothing that users get was checked"
            check.findings.append(
                Finding(f"fiblets {name}", "pipeline", FAILS if hidden else MISSING, note if hidden else why or "")
            )
    wanted = [part for part in parts_of([name for name, there, _ in table if there])
              if not only or part.startswith(tuple(only))]  # fmt: skip
    if segments and any(part.startswith(SPEED) for part in wanted):
        log("making synthetic brains")
        make_brains(tuple(segments), folder)
    for part in wanted:
        if segments or not part.startswith(SPEED):
            log(part)
            for finding, pictures in findings_of(part, folder, CellProcess(command), patience):
                check.findings.append(finding)
                if pictures:
                    check.pictures[f"{part}: {finding.feature}"] = pictures
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


def findings_of(
    part: str, folder: Path, process: CellProcess, patience: float = PATIENCE
) -> Iterator[tuple[Finding, list[Path]]]:
    """Run a part to its end, by as many processes as die of it; yield what is found, and files of pictures."""
    try:
        for number in count():
            begun = process.measure({"part": part, "folder": str(folder), "number": number}, patience)
            if "unmeasured" in begun:
                yield Finding(part, "beginning", FAILS, begun["unmeasured"]), []
                return
            feature = begun["feature"]
            if not feature:
                return
            found = process.measure({"feature": feature}, patience)
            if "unmeasured" in found:
                yield Finding(part, feature, FAILS, found["unmeasured"]), []
            else:
                yield Finding(**found["finding"]), [folder / name for name in found["pictures"]]
    finally:
        process.close()
