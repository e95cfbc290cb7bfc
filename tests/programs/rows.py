"""What other programs do, as rows of docs/reference/programs.md: each stands beside the test that runs both."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import NO_PROGRAM

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "reference" / "programs.md"
COMMANDS = {"MRtrix3": "tckinfo", "ParaView": "pvpython"}
PACKAGES = {"DIPY": "dipy", "trx-python": "trx-python", "SimpleITK": "SimpleITK", "nibabel": "nibabel"}
HEAD = """# Beside other programs

Behaviour of other programs that may surprise, and what pvfiblets does. Each row is a test that runs both programs
(`make test-programs`), last with the named versions.

| what | program | what it does | what pvfiblets does | test |
|---|---|---|---|---|
"""


ROWS: list[tuple[str, Any]] = []


def beside(program: str) -> Callable[[Any], Any]:
    """Make a test one of a program, which is left out where there is none, and its docstring a row of the page.

    Of the docstring, what comes before the first ": " is the format or command, then comes what the program does, and
    in a second paragraph, behind "Here: ", what is done here.
    """

    def kept(test: Any) -> Any:
        ROWS.append((program, test))
        missing = release(program) is None
        return pytest.mark.programs(pytest.mark.skipif(missing, reason=f"{program} {NO_PROGRAM}")(test))

    return kept


def cells(program: str, test: Any) -> list[str]:
    """Return a row of the page without the program's version: what, program, theirs, ours, test."""
    theirs, ours = (" ".join(part.split()) for part in test.__doc__.split("\n\n"))
    what, _, theirs = theirs.partition(": ")
    assert ours.startswith("Here: "), test
    return [
        what,
        program,
        theirs,
        ours.removeprefix("Here: "),
        f"`{Path(test.__code__.co_filename).name}::{test.__name__}`",
    ]


def release(program: str) -> str | None:
    """Return the version of a program that is installed; None if it is not."""
    if program in PACKAGES:
        try:
            return version(PACKAGES[program])
        except PackageNotFoundError:
            return None
    command = shutil.which(COMMANDS[program])
    if command is None:
        return None
    told = subprocess.run([command, "--version"], capture_output=True, text=True, timeout=120, check=False)
    found = re.search(r"\d+(\.\d+)+", told.stdout + told.stderr)
    return found[0] if found else "?"


def written() -> str:
    """Return the page, of all rows that were declared."""
    rows = [cells(f"{program} {release(program) or ''}".strip(), test) for program, test in ROWS]
    return HEAD + "".join(f"| {' | '.join(row)} |\n" for row in rows)
