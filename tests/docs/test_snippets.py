"""Every command and every piece of Python on these pages runs, in their order, as a reader would run them."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

pytestmark = pytest.mark.more


def _pages():
    spec = importlib.util.spec_from_file_location("docs_pages", Path(__file__).with_name("pages.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


pages = _pages()


@pytest.mark.parametrize("page", pages.GIVEN)
def test_a_page_runs(page, tmp_path):
    script = tmp_path / "page.py"
    script.write_text(pages.program(page))
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PYVISTA_OFF_SCREEN": "true",
        "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow",
        "MPLBACKEND": "Agg",
    }
    environment.pop("GALLIVM_PERF", None)  # in large pictures optimised shaders soon make up for their compilation
    command = [sys.executable, "-W", "error", str(script)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr
    named = set(re.findall(r'screenshot\("([^"]+)"', pages.program(page)))
    assert named <= {path.name for path in tmp_path.iterdir()}
    for name in pages.COLOURED.get(page, ()):
        with Image.open(tmp_path / name) as picture:
            lines = np.asarray(picture.convert("RGB"))[: picture.height * 4 // 5]  # without the scalar bar
        assert len(np.unique(lines.reshape(-1, 3), axis=0)) > 100, f"{name} of {page} has hardly any colours"


def test_every_page_with_something_to_run_is_run():
    assert pages.pages_with_blocks() == {*pages.GIVEN, *pages.RUN_ELSEWHERE}
