"""What ``pvfiblets gl`` does: say what this machine's OpenGL can draw with."""

from __future__ import annotations

import sys
from typing import Any

from pvfiblets.cli_files import print_json
from pvfiblets.engine.capabilities import Capabilities, PipelineTable, pipelines
from pvfiblets.engine.errors import EngineError

# 3.3 is the least that any pipeline needs; 3.2, which VTK itself needs, is tried so as to be able to say so.
VERSIONS = (330, 320)


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


def bare_context() -> Any:
    """Return a moderngl context without a window: through EGL where there is one, else as the system has it.

    Raises
    ------
    EngineError
        If there is no OpenGL.
    """
    import moderngl

    problems = []
    headless: list[dict[str, Any]] = [{"backend": "egl"}] if sys.platform.startswith("linux") else []
    for settings in [*headless, {}]:
        for version in VERSIONS:
            try:
                return moderngl.create_standalone_context(require=version, **settings)
            except Exception as error:  # noqa: BLE001  the back ends raise bare Exceptions
                problems.append(f"{settings.get('backend', 'default')}: {error}")
    tried = "; ".join(dict.fromkeys(problems))
    raise EngineError(
        f"no OpenGL {VERSIONS[-1] / 100:.1f} or later could be started on this machine ({tried}). Install a graphics "
        "driver, or Mesa's software OpenGL (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri)"
    )


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
