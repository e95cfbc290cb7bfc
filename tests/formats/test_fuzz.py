"""Damaged files for every reader: an error of ours or a result, in bounded time and memory.

``PVFIBLETS_FUZZ=N`` makes N damaged files per format instead of twenty, and ``PVFIBLETS_FUZZ_SEED`` others.
``fuzzing.py`` is the process that reads them.
"""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from pvfiblets import compress, formats
from pvfiblets.errors import FormatError

from .samples import corpus, image_corpus, label_corpus, rich, surface_corpus, values_corpus, volume_corpus

N = int(os.environ.get("PVFIBLETS_FUZZ", "20"))
SEED = os.environ.get("PVFIBLETS_FUZZ_SEED", "1")
ROOT = Path(__file__).resolve().parents[2]

VARIANTS = [
    ".tck", ".trk", ".trx", ".vtk", ".vtp", ".trk.gz", ".tt.gz",
    "text.vtk", "inline.vtp", "text.vtp", "deflated.trx",
]  # fmt: skip
VALUES = ["v.tsf", "v.npy", "v.txt", "v.csv"]
VOLUMES = [
    "v.nii", "v.nii.gz", "v.mgh", "v.mgz", "v.nrrd", "gzip.nrrd", "bzip2.nrrd", "text.nrrd", "apart.nhdr",
    "v.mha", "deflated.mha", "apart.mhd", "v.vti", "text.vti", "deflated.vti",
]  # fmt: skip


IMAGES = ["v.mif", "v.mif.gz"]
SURFACES = ["s.pial", "s.annot", "s.thickness"]
LABELS = ["v.ctab", "v.label", "v.tsv", "v.label.gii"]
# Reader, file, and of how many damaged copies more than one is refused: in tables of labels much may be anything.
DAMAGED = [
    *(("lines", variant, 20) for variant in VARIANTS), ("fiblets", ".fiblets", 20), ("fiblets", "small.fiblets", 20),
    *(("values", variant, 20) for variant in VALUES), *(("volume", variant, 50) for variant in VOLUMES),
    *(("image", variant, 20) for variant in IMAGES), *(("labels", variant, None) for variant in LABELS),
    *(("surface", variant, 20) for variant in SURFACES),
]  # fmt: skip


@pytest.fixture(scope="module")
def healthy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("corpus")
    files = corpus(folder) | values_corpus(folder) | volume_corpus(folder) | image_corpus(folder) | label_corpus(folder)
    files |= surface_corpus(folder)
    files[".fiblets"] = folder / "rich.fiblets"
    compress(rich(counts=(80, 1, 125, 0, 2, 7)), per_point=("fa",)).save(files[".fiblets"])
    files["small.fiblets"] = folder / "small.fiblets"
    longer = compress(rich(counts=(800, 1, 1250, 0, 2, 7)), per_point=("fa",), exact=False)
    longer.save(files["small.fiblets"], small=True)
    return files


def fuzzed(reader: str, path: Path, folder: Path, count: int = N, seed: str = SEED) -> dict[str, int]:
    """Read damaged copies of a file in a process of their own, and return how they ended."""
    for beside in path.parent.glob("*.raw"):  # of formats whose data are apart
        (folder / beside.name).write_bytes(beside.read_bytes())
    command = [sys.executable, str(Path(__file__).with_name("fuzzing.py")), reader, str(count), seed, str(path)]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run([*command, str(folder)], capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, f"ended with {done.returncode}: {done.stderr}"
    outcomes = json.loads(done.stdout.splitlines()[-1])
    assert outcomes["untold"] == 0, done.stderr
    return outcomes


@pytest.mark.few(2)
@pytest.mark.parametrize(("reader", "variant", "share"), DAMAGED)
def test_damaged_files_give_errors_or_results(reader, variant, share, healthy, tmp_path):
    outcomes = fuzzed(reader, healthy[variant], tmp_path)
    assert outcomes["read"] + outcomes["refused"] == N
    if share is not None:
        assert outcomes["refused"] > N // share


@pytest.mark.few(1)
@pytest.mark.parametrize("how", ["hang", "hang in C", "crash", "memory", "memory of C", "other error"])
def test_what_must_not_be_is_found(how, tmp_path):
    """The harness itself: readers that do each of these."""
    bad = {
        "hang": "while True: pass",
        "hang in C": "import signal; signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPROF})\n    while True: pass",
        "crash": "import ctypes; ctypes.string_at(0)",
        "memory": "bytearray(3_000_000)",
        "memory of C": "import mmap; mmap.mmap(-1, 1 << 30)",
        "other error": "raise KeyError('x')",
    }[how]
    script = tmp_path / "bad.py"
    script.write_text(
        "import sys\nsys.path.insert(0, sys.argv.pop(1))\nimport fuzzing\n"
        "fuzzing.SECONDS, fuzzing.BY_THE_CLOCK = 1, 5\nfirst = []\n"
        f"def bad(path):\n    if not first:\n        first.append(1)\n        return\n    {bad}\n"
        "fuzzing.READERS['lines'] = bad\nfuzzing.main(*sys.argv[1:])\n"
    )
    (tmp_path / "a.txt").write_text("1 2 3")
    command = [sys.executable, str(script), str(Path(__file__).parent), "lines", "3", "0", str(tmp_path / "a.txt")]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run([*command, str(tmp_path)], capture_output=True, text=True, check=False, env=environment)
    assert done.returncode != 0
    said = {
        "hang": "more than 1 s", "hang in C": "Timeout", "crash": "", "memory": "MemoryError", "memory of C": "Cannot",
        "other error": "KeyError: 'x'; it is",
    }[how]  # fmt: skip
    assert said in done.stderr
    assert (how == "crash") == (done.returncode == -signal.SIGSEGV)


@pytest.mark.parametrize("variant", VARIANTS)
def test_every_truncation_is_noticed(variant, healthy, tmp_path):
    whole = healthy[variant].read_bytes()
    target = tmp_path / f"short{''.join(healthy[variant].suffixes)}"
    full = formats.read(healthy[variant])
    for size in sorted({*range(0, len(whole), max(1, len(whole) // 60)), len(whole) - 1}):
        target.write_bytes(whole[:size])
        try:
            s = formats.read(target)
        except FormatError:
            continue
        assert len(s) == len(full)
        assert np.array_equal(s.points, full.points)
        # A last newline carries nothing; a legacy vtk file is whole after any of its sections.
        rest = whole[size:].strip()
        section = variant.endswith(".vtk") and re.match(rb"[A-Z_]+ ", rest)
        assert not rest or section or rest == b"</VTKFile>" or s.dropped
