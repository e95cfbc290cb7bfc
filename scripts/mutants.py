"""Shows that the tests catch faults: ``python scripts/mutants.py [ROOM ...]``.

``tests/mutants/ROOM.toml`` lists faults made by hand, each a piece of code, its replacement, and tests
that must then fail. Every fault is put, alone, into a copy of the tree; a fault that no named test sees ends this with
status 1.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LISTS = ROOT / "tests" / "mutants"


def copy_tree(target: Path) -> None:
    """Copy every file that git tracks, and those it would."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    for name in subprocess.run(command, cwd=ROOT, capture_output=True, check=True, text=True).stdout.split("\0"):
        if name and (ROOT / name).is_file():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, target / name)


def failing(tree: Path, tests: list[str]) -> subprocess.CompletedProcess[str]:
    """Run `tests` in `tree` until one fails."""
    environment = os.environ | {"PYTHONPATH": str(tree), "GALLIVM_PERF": "nopt", "PVFIBLETS_CI": ""}
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-m", "", "-p", "no:cacheprovider", *tests]
    return subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True, check=False)


def main(rooms: list[str]) -> int:
    """Try the faults of `rooms`, or all; returns 1 if one was not caught."""
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        copy_tree(tree)
        data = os.environ.setdefault("PVFIBLETS_DATA", str(ROOT.parent / "shared" / "data"))
        print(f"real data from {data}")
        for room in rooms or sorted(path.stem for path in LISTS.glob("*.toml")):
            for fault in tomllib.loads((LISTS / f"{room}.toml").read_text())["mutant"]:
                path = tree / fault["file"]
                sound = path.read_text()
                if (times := sound.count(fault["was"])) != 1:
                    raise SystemExit(f"{fault['file']} holds {fault['was']!r} {times} times, not once")
                path.write_text(sound.replace(fault["was"], fault["now"]))
                done = failing(tree, fault["tests"])
                path.write_text(sound)
                caught = done.returncode == 1  # of pytest: tests ran, and some failed
                missed += not caught
                last = done.stdout.strip().splitlines()[-1:] or [done.stderr[-300:]]
                print(f"{'caught' if caught else 'MISSED'}  {room}: {fault['fault']} ({last[0]})", flush=True)
    return int(missed > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
