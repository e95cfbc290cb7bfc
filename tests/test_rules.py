"""The rule about skips on continuous integration holds."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

CONFTEST = Path(__file__).with_name("conftest.py")


@pytest.mark.parametrize(
    ("body", "on_ci", "passes"),
    [
        ("def test_a(): pytest.skip('no OpenGL')", True, False),
        ("def test_a(): pytest.skip('no OpenGL')", False, True),
        ("nothing = pytest.importorskip('no_such_module')\ndef test_a(): pass\n", True, False),
        ("@pytest.mark.parametrize('n', [1, 2])\ndef test_a(n):\n    if n == 2: pytest.skip('no meaning')", True, True),
        ("def test_a(shared_data): pass", True, True),
    ],
)
def test_a_check_cannot_vanish_on_ci(tmp_path, body, on_ci, passes):
    shutil.copy(CONFTEST, tmp_path / "conftest.py")
    (tmp_path / "test_it.py").write_text(f"import pytest\n{body}\n")
    (tmp_path / "test_other.py").write_text("def test_other(): pass\n")
    environment = {**os.environ, "PVFIBLETS_DATA": str(tmp_path / "none"), "PVFIBLETS_CI": "1" if on_ci else ""}
    command = [sys.executable, "-m", "pytest", "-q", "--rootdir", str(tmp_path), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment, cwd=tmp_path)
    assert (done.returncode == 0) is passes, done.stdout
