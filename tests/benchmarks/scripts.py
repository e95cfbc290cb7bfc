"""How tests use benchmarks, which are scripts and no package: import their modules, and run their commands."""

import contextlib
import importlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "benchmarks"


@contextlib.contextmanager
def imported(**names: str) -> Iterator[SimpleNamespace]:
    """Give modules of the benchmarks, by other names, and forget all of that folder afterwards."""
    stems = [path.stem for path in FOLDER.glob("*.py")]
    # Folders of tests, such as tests/volumes, have the names of some.
    others = {stem: sys.modules.pop(stem) for stem in stems if stem in sys.modules}
    sys.path.insert(0, str(FOLDER))
    try:
        yield SimpleNamespace(**{key: importlib.import_module(name) for key, name in names.items()})
    finally:
        sys.path.remove(str(FOLDER))
        for stem in stems:
            sys.modules.pop(stem, None)
        sys.modules.update(others)


def run(folder: Path, script: str, *arguments: object) -> tuple[Path, dict]:
    """Run a benchmark, and return what it wrote: the path of the JSON and its content."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg"}
    command = [sys.executable, f"benchmarks/{script}.py", *map(str, arguments), "--output", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, env=environment)
    assert done.returncode == 0, done.stderr
    (path,) = folder.glob("*.json")
    assert path.with_suffix(".png").stat().st_size > 0
    return path, json.loads(path.read_text())
