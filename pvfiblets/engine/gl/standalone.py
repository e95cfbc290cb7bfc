"""An OpenGL context without a window, for what draws on its own: the command line and reports."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from ..errors import EngineError

if TYPE_CHECKING:
    import moderngl

# Some drivers give exactly the requested version. Every pipeline needs 3.3 at least; 3.2, which VTK itself needs, is
# tried for the sake of a clear error.
VERSIONS = (460, 450, 430, 410, 330, 320)


def bare_context() -> moderngl.Context:
    """Return a moderngl context without a window: through EGL where there is one, else as the system has it."""
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
