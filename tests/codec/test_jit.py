"""Kernels kept on disk are not used once any source of the codec has changed."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import pvfiblets

CODE = """
from pvfiblets.codec.kernels import direction_kernels as kernels
print(kernels.quantise(3.0, 1.0, 100.0), len(kernels.quantise.stats.cache_hits))
"""


def copy_sources(folder):
    ignored = shutil.ignore_patterns("__pycache__", "shaders")
    shutil.copytree(Path(pvfiblets.__file__).parent, folder / "pvfiblets", ignore=ignored)


def run(folder, **more):
    environment = {**os.environ, "PYTHONPATH": str(folder), **(more or {"NUMBA_CACHE_DIR": str(folder / "kept")})}
    return subprocess.run(
        [sys.executable, "-c", CODE], env=environment, cwd=folder, capture_output=True, text=True, check=True
    ).stdout.split()


@pytest.mark.more
def test_a_change_in_another_module_compiles_anew(tmp_path):
    copy_sources(tmp_path)
    first, second = run(tmp_path), run(tmp_path)
    assert first == ["3.0", "0"]
    assert second == ["3.0", "1"], "an unchanged codec must use what was kept"
    other = tmp_path / "pvfiblets" / "codec" / "kernels" / "nearest.py"
    other.write_text(other.read_text() + "\n# changed\n")
    assert run(tmp_path) == ["3.0", "0"]


@pytest.mark.more
@pytest.mark.skipif(sys.platform != "linux", reason="the user's folder for such things is set for Linux")
def test_another_copy_of_the_same_sources_finds_them_compiled(tmp_path):
    home = {"XDG_CACHE_HOME": str(tmp_path / "home"), "NUMBA_CACHE_DIR": ""}
    for name in ("one", "other"):
        copy_sources(tmp_path / name)
    old = tmp_path / "home" / "pvfiblets" / "kernels" / "0123456789abcdef"
    old.mkdir(parents=True)
    os.utime(old, (0, 0))
    assert run(tmp_path / "one", **home) == ["3.0", "0"]
    assert run(tmp_path / "other", **home) == ["3.0", "1"]
    assert not old.exists(), "kernels of sources of long ago stay for ever"
    assert not list(tmp_path.glob("o*/pvfiblets/**/*.nbi"))


@pytest.mark.more
@pytest.mark.skipif(sys.platform != "linux", reason="the user's folder for such things is set for Linux")
def test_a_home_that_cannot_be_written_to_is_no_error(tmp_path):
    copy_sources(tmp_path)
    (tmp_path / "file").write_text("")
    home = {"XDG_CACHE_HOME": str(tmp_path / "file"), "NUMBA_CACHE_DIR": ""}
    assert run(tmp_path, **home) == ["3.0", "0"]
    assert run(tmp_path, **home) == ["3.0", "1"]


FORKS = """
import multiprocessing
import numpy as np
import pvfiblets
from pvfiblets.synthetic import brain_streamlines

lines = brain_streamlines(40, seed=1)

def work(_):
    fiblets = pvfiblets.compress(lines)
    return fiblets.decompress().points, pvfiblets.density(fiblets, voxel_size=8.0).values

wanted = work(0)
with multiprocessing.get_context("fork").Pool(2) as pool:
    for found in pool.map_async(work, range(3)).get(120):
        for ours, theirs in zip(found, wanted, strict=True):
            np.testing.assert_array_equal(ours, theirs)
print("done")
"""


@pytest.mark.more
@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are forked, which this system cannot")
def test_processes_that_were_forked_after_kernels_ran_do_the_same(tmp_path):
    """GNU's OpenMP ended or hung them; pools of processes then waited for ever."""
    script = tmp_path / "forks.py"
    script.write_text(FORKS)
    environment = {**os.environ, "PYTHONPATH": str(Path(pvfiblets.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, str(script)], env=environment, capture_output=True, text=True, check=False, timeout=150
    )
    assert done.stdout.split() == ["done"], done.stderr


@pytest.mark.more
def test_all_that_codes_is_compiled_beforehand():
    """A part that lacks a kernel would leave it to the first large set."""
    environment = {**os.environ, "PYTHONPATH": str(Path(pvfiblets.__file__).parents[1])}
    code = "from pvfiblets.codec.precompile import PARTS\nfor part in PARTS.values():\n    part()\n" + BEFOREHAND
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["done"]


BEFOREHAND = """
import pvfiblets
from pvfiblets.codec import jit
from pvfiblets.codec.encoding import compiled_coder
from pvfiblets.codec.kernels import decode_kernels, direction_kernels, lattice_kernels, turn_kernels
from pvfiblets.codec.small_sets import STATES
from pvfiblets.synthetic import brain_streamlines

def compiled():
    modules = compiled_coder, decode_kernels, direction_kernels, lattice_kernels, turn_kernels
    kernels = [k for m in modules for k in vars(m).items() if isinstance(k[1], jit._ParallelKernel)]
    return {name: set(kernel._threaded.signatures) for name, kernel in kernels}

before = compiled()
STATES["coding"].loaded = STATES["decoding"].loaded = True
lines = brain_streamlines(20)
uneven = pvfiblets.Streamlines(lines.points ** 2, lines.offsets)
for made in (lines, uneven):
    pvfiblets.compress(made, exact=False).decompress()
assert all(before.values()), before
assert compiled() == before
print("done")
"""
