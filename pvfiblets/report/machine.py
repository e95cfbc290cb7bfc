"""The machine and versions of a report."""

from __future__ import annotations

import os
import platform
import re
import subprocess
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

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


CARD_STATE = {
    "clocks.sm": "MHz", "clocks.mem": "MHz", "power.draw": "W", "temperature.gpu": "°C",
    "clocks_throttle_reasons.active": "",
}  # fmt: skip
"""What nvidia-smi is asked for, and units."""


def card_state() -> dict[str, float]:
    """Return clocks, power and temperature of the first NVIDIA card; nothing where there is none."""
    command = ["nvidia-smi", f"--query-gpu={','.join(CARD_STATE)}", "--format=csv,noheader,nounits", "--id=0"]
    try:
        told = subprocess.run(command, capture_output=True, text=True, timeout=5.0, check=True).stdout
    except (OSError, subprocess.SubprocessError):
        return {}
    found = {}
    for name, word in zip(CARD_STATE, told.strip().split(","), strict=False):
        try:
            found[name] = float(int(word, 0)) if "0x" in word else float(word)
        except ValueError:  # such as [N/A]
            continue
    return found


def slug(name: str) -> str:
    """Return a name as part of a file's name."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or "unknown"


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
