"""Which OpenGL the tests run on: ``PVFIBLETS_DRIVER`` is set by ``make drivers`` (scripts/drivers.sh)."""

from __future__ import annotations

import os

DRIVER = os.environ.get("PVFIBLETS_DRIVER", "system")
"""``'system'``: this machine's own; ``'newer'``: Mesa's newest llvmpipe, with mesh shaders; ``'zink'``: OpenGL by
Vulkan."""

MESH = ["mesh", "mesh-serial"] if DRIVER == "newer" else []
"""Pipelines that this OpenGL has beside those of every other."""
