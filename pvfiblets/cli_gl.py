"""What ``pvfiblets gl`` does: say what this machine's OpenGL can draw with."""

from __future__ import annotations

from typing import Any

from pvfiblets.cli_files import print_json
from pvfiblets.engine.capabilities import Capabilities, PipelineTable, pipelines
from pvfiblets.engine.standalone import bare_context


def gl(*, json: bool) -> None:
    """Print the driver, its limits and every pipeline."""
    ctx = bare_context()
    try:
        with ctx:
            found, table = Capabilities.of(ctx), pipelines(ctx)
    finally:
        ctx.release()
    if json:
        print_json(as_json(found, table))
    else:
        print(as_text(found, table))


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
