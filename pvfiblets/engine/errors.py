"""The engine's own errors."""

from __future__ import annotations

from ..errors import FibletsError


class EngineError(FibletsError, RuntimeError):
    """OpenGL cannot do what a scene needs: version, memory, a limit, or a shader that does not compile."""


class GPUMemoryError(EngineError):
    """Memory that shaders read does not suffice."""
