"""Ray-cast volumes beside VTK's: time per frame, error and GPU memory of one run, and the paper's Table I.

Angiogram-like trees of vessels of 64^3 to 512^3 voxels and a brain, as light, greatest values and a surface; a camera
that circles (512x512) and one that rests, whose picture is made anew each time (1024x1024), as in Lesar 2015, section
IV. Errors are those of sampled pixels against rays in float64. VTK's GPU mapper is measured at the same step, and at
the step with which it is as wrong as this program in a plotter; where it never is, the row says so and shows its best::

    python benchmarks/volumes.py --output docs/benchmarks

writes ``volume-CARD.json``, ``.md`` and ``.png``, named after the card. ``--quick`` measures little of it.
"""

from __future__ import annotations

import argparse
import json
import pickle
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from common import machine, passed_on, run_child, write
from volumes_data import FOLDER, MODES, known_data, make_data
from volumes_effects import EFFECTS, effects
from volumes_methods import EQUAL, METHODS
from volumes_tables import plot, table
from volumes_timing import run

from pvfiblets.report.studies.volumes.scene import circle, look_of, truth
from pvfiblets.volumes import RaycastVolume

DATA = ("vessels-64", "vessels-128", "vessels-256", "vessels-512", "brain")
PICTURE = 256  # pixels along a side of the pictures whose errors are measured
QUICK = {"data": ["vessels-64"], "frames": 3, "seconds": 1.0, "search": 1.0, "pixels": 500, "size": 192, "still": 256,
         "effects_data": ["vessels-64"]}  # fmt: skip
PASSED_ON = (
    "data_folder", "step", "seed", "size", "still", "frames", "seconds", "search", "longest", "pixels", "effects_mode",
    "modes", "effects",
)  # fmt: skip


def main() -> None:
    """Measure every method on every volume, one process each, and write the table."""
    parser = parsed()
    options = parser.parse_args()
    if options.quick:
        parser.set_defaults(**QUICK)
        options = parser.parse_args()
    if options.run:
        for row in child(*options.run, options):
            print(json.dumps(row), flush=True)
        return
    with tempfile.TemporaryDirectory() as folder:
        results = measure_all(options, Path(folder))
    table_one: list[dict[str, Any]] = []
    for data in options.effects_data if options.effects else []:
        found, why = started("effects", data, Path(), options)
        wanted = [{"data": data, "mode": options.effects_mode, "effect": effect, "view": view}
                  for effect in options.effects for view in ("static", "circle")]  # fmt: skip
        table_one += [*found, *({**row, "unmeasured": why} for row in wanted[len(found) :])]
    about = {
        **machine(seed=options.seed),
        "size": options.size,
        "still": options.still,
        "step": options.step,
        "longest": options.longest,
        "pixels": options.pixels,
        "effects": table_one,
        "volumes": {row["data"]: row.pop("about") for row in results if "about" in row},
    }
    write("volume", about, results, table(about, results), plot, options.output)


def parsed() -> argparse.ArgumentParser:
    """Return what reads the options."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", nargs="+", type=known_data, default=list(DATA), metavar="DATA",
                        help="of vessels-N and brain-N, of N voxels along each side, and brain")  # fmt: skip
    parser.add_argument("--data-folder", type=Path, default=FOLDER, help="where a brain's template may lie")
    parser.add_argument("--modes", nargs="+", choices=MODES, default=list(MODES))
    parser.add_argument("--methods", nargs="+", choices=list(METHODS), default=list(METHODS))
    parser.add_argument("--step", type=float, default=0.5, help="voxels")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--size", type=int, default=512, help="pixels along a side of the circling view")
    parser.add_argument("--still", type=int, default=1024, help="of the static view")
    parser.add_argument("--frames", type=int, default=12, help="in either view, at most")
    parser.add_argument("--seconds", type=float, default=4.0, help="of drawing either view; one frame at least")
    parser.add_argument("--search", type=float, default=8.0, help="seconds that pictures of VTK's finest step may take")
    parser.add_argument("--longest", type=float, default=15.0, help="seconds of a frame of the static view")
    parser.add_argument("--pixels", type=int, default=3000, help="whose errors are measured, in each of two pictures")
    parser.add_argument("--limit", type=float, default=600.0, help="seconds that one method may take with one volume")
    parser.add_argument("--effects", nargs="*", choices=list(EFFECTS), default=list(EFFECTS), help="of Table I")
    parser.add_argument("--effects-data", nargs="+", type=known_data, default=["vessels-256", "brain"], metavar="DATA")
    parser.add_argument("--effects-mode", choices=MODES, default="isosurface")
    parser.add_argument("--quick", action="store_true", help="a little of all")
    parser.add_argument("--output", type=Path, default=Path())
    parser.add_argument("--run", nargs=3, metavar=("WHAT", "DATA", "FILE"), help=argparse.SUPPRESS)
    return parser


def child(what: str, data: str, file: str, options: Any) -> Iterator[dict[str, Any]]:
    """Do one thing with one volume, and return its rows: the ground truth, one method, or the paper's Table I."""
    if what == "effects":
        yield from effects(data, options.effects_mode, options.effects, options)
    elif what == "truth":
        volume = make_data(data, options.seed, options.data_folder)
        cameras = circle(volume, 2, (PICTURE, PICTURE))
        # The reference takes floats, in this order; else it would make them anew for every mode and camera.
        floats = RaycastVolume(np.ascontiguousarray(volume.values, np.float32), volume.affine)
        right = {mode: truth(floats, look_of(volume, mode), cameras, options.pixels) for mode in options.modes}
        Path(file).write_bytes(pickle.dumps(right))
        yield {"shape": list(volume.shape), "bytes": volume.nbytes, "name": volume.name}
    else:
        targets = json.loads(Path(file).with_suffix(".json").read_text())
        yield from run(what, data, pickle.loads(Path(file).read_bytes()), targets, options)


def measure_all(options: Any, folder: Path) -> list[dict[str, Any]]:
    """Return a row for every volume, mode and method, in this order."""
    results = []
    for data in options.data:
        file, targets = folder / f"{data}.pickle", {}
        about, why = started("truth", data, file, options)
        if not about:
            common = {"data": data, "unmeasured": why}
            results += [{**common, "mode": mode, "method": one} for mode in options.modes for one in options.methods]
            continue
        rows = []
        # Ours come first: what VTK's errors shall be is theirs.
        for method in sorted(options.methods, key=list(METHODS).index):
            file.with_suffix(".json").write_text(json.dumps(targets))
            found, why = started(method, data, file, options)
            rows += [{"data": data, **row} for row in found]
            wanted = [(mode, method) for mode in options.modes]
            wanted += [(mode, EQUAL) for mode in targets] if method == "vtk-gpu" else []
            done = [(row["mode"], row["method"]) for row in found]
            rows += [{"data": data, "mode": mode, "method": one, "unmeasured": why} for mode, one in wanted
                     if (mode, one) not in done]  # fmt: skip
            if method in ("engine", "plotter"):
                targets |= {row["mode"]: row["error"] for row in found}
        order = [*METHODS, EQUAL]
        rows.sort(key=lambda row: (options.modes.index(row["mode"]), order.index(row["method"])))
        rows[0] = {**rows[0], "about": about[0]}
        results += rows
    return results


def started(what: str, data: str, file: Path, options: Any) -> tuple[list[dict[str, Any]], str]:
    """Do one thing in a process of its own, for as long as it may take; return its rows, and why there are no more."""
    print(f"{data}, {what} ...", flush=True)
    rows, reason = run_child(__file__, ["--run", what, data, file, *passed_on(options, PASSED_ON)], options.limit)
    for row in rows:
        print({key: value for key, value in row.items() if key != "passes"}, flush=True)
    return rows, reason


if __name__ == "__main__":
    main()
