"""The machine and versions of a report."""

from __future__ import annotations

import os
import platform
import re
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

__all__ = ["about", "processor", "slug"]

PACKAGES = ("pvfiblets", "numpy", "numba", "moderngl", "vtk", "pyvista", "dipy", "zstandard", "matplotlib")


def about(seed: int, quick: bool, driver: str = "") -> dict[str, Any]:
    """Describe this machine."""
    found: dict[str, Any] = {
        "name": slug(processor()),
        "processor": processor(),
        "cores": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "driver": driver or "not asked for: nothing was drawn",
        "versions": {name: _version(name) for name in PACKAGES},
        "seed": seed,
        "quick": quick,
        "date": time.strftime("%Y-%m-%d"),
    }
    if hasattr(os, "getloadavg"):
        found["load"] = round(os.getloadavg()[0], 1)
    return found


def processor() -> str:
    """Return the processor's name, as well as the system tells it."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            name, _, value = line.partition(":")
            if name.strip() == "model name":
                return value.strip()
    except OSError:
        pass
    return platform.processor() or platform.machine() or "unknown processor"


def slug(name: str) -> str:
    """Return a name as part of a file's name."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or "unknown"


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
