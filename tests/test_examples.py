"""Every example runs as its user runs it, and its pictures show something."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

pytestmark = pytest.mark.more

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SCRIPTS = sorted(EXAMPLES.glob("*.py"))
HEAVY = {
    "08_large_and_culled", "13_more_colours", "15_selected_tracts", "16_furball", "18_halos_of_air",
    "19_halos_of_a_scan", "20_halos_of_knots", "21_depth_of_field", "22_angiogram",
    "23_tracts_in_their_anatomy", "24_inside_a_volume",
}  # fmt: skip
"""What other examples and pages show as well, and larger. `make docs` draws all."""

SMALL = """
import runpy, sys
import pyvista
from pvfiblets import synthetic
pyvista.global_theme.window_size = (512, 384)
whole = synthetic.brain_streamlines
synthetic.brain_streamlines = lambda n, **more: whole(n // 8, **more)
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""
"""What runs an example with an eighth of the streamlines, and with windows of a quarter of the usual size where it
gives them none."""


def test_examples_are_numbered_without_a_gap():
    numbers = [int(re.match(r"(\d\d)_", script.name)[1]) for script in SCRIPTS]
    assert numbers == list(range(1, len(SCRIPTS) + 1))
    assert SCRIPTS


@pytest.mark.parametrize(
    "script",
    [
        pytest.param(script, id=script.stem, marks=[pytest.mark.exhaustive] if script.stem in HEAVY else [])
        for script in SCRIPTS
    ],
)
def test_example_runs_and_makes_what_it_names(script, tmp_path):
    command = [sys.executable, "-W", "error", "-c", SMALL, str(script), str(tmp_path)]
    environment = {**os.environ, "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"}
    if script.stem in HEAVY:
        environment.pop("GALLIVM_PERF", None)  # in large pictures optimised shaders soon make up for their compilation
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    made = {path.name for path in tmp_path.iterdir()}
    named = set(re.findall(r'folder / "([^"]+)"', script.read_text()))
    assert named <= made
    pictures = {path: np.asarray(Image.open(path).convert("RGB")) for path in tmp_path.glob("*.png")}
    assert len({pixels.tobytes() for pixels in pictures.values()}) == len(pictures), "two pictures are the same"
    for picture, pixels in pictures.items():
        background = pixels[2, 2]
        assert (pixels != background).any(axis=2).mean() > 0.02, f"{picture.name} is nearly empty"
    assert made or done.stdout
