"""The command ``pvfiblets gl``: reports this machine's pipelines, and checks that they draw right."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

from pvfiblets.cli.files import print_json
from pvfiblets.engine.gl.capabilities import Capabilities, PipelineTable, pipelines
from pvfiblets.engine.gl.standalone import bare_context


def gl(*, check: bool, output: str, segments: list[float] | None, only: list[str], json: bool) -> int:
    """Print the driver, its limits and every pipeline, or check that all of them draw right."""
    if check:
        return _check(output=output, segments=segments, only=only, json=json)
    ctx = bare_context()
    try:
        with ctx:
            found, table = Capabilities.from_context(ctx), pipelines(ctx)
    finally:
        ctx.release()
    if json:
        print_json(as_json(found, table))
    else:
        print(as_text(found, table))
    return 0


def _check(*, output: str, segments: list[float] | None, only: list[str], json: bool) -> int:
    """Try everything, print a table, write one file, and return 1 if anything differs or fails."""
    from pvfiblets.report.studies.card import report_file as card_file
    from pvfiblets.report.studies.card.check import run_check
    from pvfiblets.report.studies.card.speed import SEGMENTS

    def log(what: str) -> None:
        print(f"{what} ...", file=sys.stderr, flush=True)

    with tempfile.TemporaryDirectory(prefix="pvfiblets-check-", ignore_cleanup_errors=True) as folder:
        found = run_check(Path(folder), SEGMENTS if segments is None else segments, log, only)
        card_file.write(found, output)
    if json:
        print_json({"good": found.good, "opengl": found.opengl, "findings": [one.as_dict() for one in found.findings]})
    else:
        print(card_file.summary(found))
        print(f"Wrote {output}; attach it to a report of a bug.")
    return 0 if found.good else 1


def as_json(found: Capabilities, table: PipelineTable) -> dict[str, Any]:
    """Return the result as plain values."""
    return {**found.as_dict(), "auto": table.auto, "pipelines": [vars(info) for info in table]}


def as_text(found: Capabilities, table: PipelineTable) -> str:
    """Return the result as a person reads it."""
    facts = {
        "OpenGL": found.version,
        "renderer": found.renderer + (" (on the CPU)" if found.software else ""),
        "vendor": found.vendor,
        "driver": found.driver,
        "64-bit atomics": found.atomics64 or "none",
    }
    lines = [f"{name:<16}{value}" for name, value in facts.items()]
    lines += ["", repr(table), ""]
    lines += [f"{name:<46}{value:>16,}" for name, value in found.limits.items()]
    return "\n".join(lines)
