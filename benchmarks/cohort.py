"""Cohorts: files a minute on 1 and 2 workers, what the engine costs beside a loop of the shell, and killed workers.

    python benchmarks/cohort.py [--subjects N] [--streamlines N] [--kill-every SECONDS] [--json OUT]

Every way converts the same synthetic subjects to ``.fiblets`` files. *shell* calls ``pvfiblets convert`` for each, one
after another; *in one process* calls ``compress_file`` in a loop, which pays for no start: what a file takes at least.
The last way kills a worker every so many seconds, and counts what is lost.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import pvfiblets
from pvfiblets.cluster import batch
from pvfiblets.cluster.connection import connected
from pvfiblets.synthetic import brain_streamlines


def make(folder: Path, subjects: int, streamlines: int) -> list[Path]:
    """Write subjects; eight of them differ, the others are copies."""
    paths = []
    for n in range(subjects):
        path = folder / f"sub-{n:03d}" / f"sub-{n:03d}_tractography.trk"
        path.parent.mkdir(parents=True)
        if n < 8:
            pvfiblets.write(path, brain_streamlines(streamlines, 1.0, seed=n))
        else:
            shutil.copy(paths[n % 8], path)
        paths.append(path)
    return paths


def shell(paths: list[Path], out: Path) -> None:
    out.mkdir()
    for n, path in enumerate(paths):
        command = [sys.executable, "-m", "pvfiblets", "convert", str(path), str(out / f"{n}.fiblets"), "--quiet"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def in_one_process(paths: list[Path], out: Path) -> None:
    out.mkdir()
    for n, path in enumerate(paths):
        pvfiblets.compress_file(path, out / f"{n}.fiblets")


def engine(paths: list[Path], out: Path, workers: int) -> None:
    result = batch("convert", paths, out, workers=workers, dashboard=False)
    assert len(result.done) == len(paths), result.failed


def with_kills(paths: list[Path], out: Path, every: float) -> int:
    """Convert while workers are killed; return how many were."""
    killed, over = [], threading.Event()
    with connected(None, 2, None, dashboard=False) as client:

        def kill() -> None:
            while not over.wait(every):
                pids = client.run(os.getpid, on_error="ignore").values()
                pid = sorted(pid for pid in pids if isinstance(pid, int))[len(killed) % 2 - 1]
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            result = batch("convert", paths, out, cluster=client)
        finally:
            over.set()
            killer.join()
    assert len(result.done) == len(paths), result.failed
    return len(killed)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--subjects", type=int, default=200)
    parser.add_argument("--streamlines", type=int, default=5_000)
    parser.add_argument("--kill-every", type=float, default=10.0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = make(folder / "study", options.subjects, options.streamlines)
        in_one_process(paths[:1], folder / "warm")  # kernels are compiled and cached before the clock runs
        ways = {
            "shell": lambda out: shell(paths, out),
            "in one process": lambda out: in_one_process(paths, out),
            "batch, 1 worker": lambda out: engine(paths, out, 1),
            "batch, 2 workers": lambda out: engine(paths, out, 2),
            f"batch, 2 workers, one killed every {options.kill_every:g} s": lambda out: with_kills(
                paths, out, options.kill_every
            ),
        }
        print("| way | files | s | files a minute | workers killed |\n|---|---|---|---|---|")
        for n, (way, run) in enumerate(ways.items()):
            begin = time.perf_counter()
            killed = run(folder / f"out{n}") or 0
            seconds = time.perf_counter() - begin
            rows.append({"way": way, "files": len(paths), "seconds": seconds, "killed": killed})
            print(f"| {way} | {len(paths)} | {seconds:.1f} | {60 * len(paths) / seconds:.0f} | {killed} |", flush=True)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
