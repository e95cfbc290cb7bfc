"""The engine's own error."""

from __future__ import annotations

from ..errors import FibletsError

__all__ = ["EngineError"]


class EngineError(FibletsError, RuntimeError):
    """OpenGL cannot do what a scene needs: version, memory, a limit, or a shader that does not compile."""
