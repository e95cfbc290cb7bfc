"""Kernels kept on disk are not used once any source of the codec has changed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pvfiblets

CODE = """
from pvfiblets.codec import direction_kernels as kernels
print(kernels.quantise(3.0, 1.0, 100.0), len(kernels.quantise.stats.cache_hits))
"""


def run(folder: Path) -> list[str]:
    environment = {**os.environ, "PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder / "kept")}
    return subprocess.run(
        [sys.executable, "-c", CODE], env=environment, cwd=folder, capture_output=True, text=True, check=True
    ).stdout.split()


def test_a_change_in_another_module_compiles_anew(tmp_path: Path) -> None:
    shutil.copytree(
        Path(pvfiblets.__file__).parent, tmp_path / "pvfiblets", ignore=shutil.ignore_patterns("__pycache__", "shaders")
    )
    first, second = run(tmp_path), run(tmp_path)
    assert first == ["3.0", "0"]
    assert second == ["3.0", "1"], "an unchanged codec must use what was kept"
    other = tmp_path / "pvfiblets" / "codec" / "nearest.py"
    other.write_text(other.read_text() + "\n# changed\n")
    assert run(tmp_path) == ["3.0", "0"]
