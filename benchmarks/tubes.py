"""Spline tubes beside their rivals: time per frame, triangles, GPU memory and wrong silhouettes, of one run.

The paper's comparison (Russig et al. 2020, section 4, figure 5): 1920x1080, 45 degrees from top to bottom, an orbit
around each set from *far*, where all of it fits into the picture, and *close*, at a third of that distance; with and
without fragment work. Every way of drawing runs in a process of its own. One that would take more seconds or gigabytes
than ``--limit`` gets a row that says so::

    python benchmarks/tubes.py --folder /tmp --output docs/benchmarks

writes ``tubes-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from orbit import add_places, card_slug, context, machine, write
from tube_reference import Reference
from tube_ways import ABOUT, DEFAULT, TUBE, TooMuchError, make_set, reference, run

from pvfiblets.report.cameras import VIEWS

SETS = ("fibers", "hotroom", "bundle", "brain", "furball")
ERRORS = (0.2, 0.1, 0.05, 0.02)  # pixels, for which the least memory is looked up


def main() -> None:
    """Measure every way on every set, one process each, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", default=list(SETS), help="or helices-N, N small tubes")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--ways", nargs="+", type=known_way, default=list(DEFAULT), metavar="WAY")
    parser.add_argument("--views", nargs="+", choices=list(VIEWS), default=list(VIEWS))
    parser.add_argument("--frames", type=int, default=24, help="in one orbit")
    parser.add_argument("--seconds", type=float, default=20.0, help="of drawing per orbit at most, once 3 frames count")
    parser.add_argument("--limit", type=float, nargs=2, default=(300.0, 8.0), metavar=("SECONDS", "GB"),
                        help="what one way may take for one set, making its mesh included")  # fmt: skip
    parser.add_argument("--supersampling", type=int, default=4, help="of the reference picture; 0 for no reference")
    parser.add_argument("--silhouettes", help="of this program; its own choice if left out")
    parser.add_argument("--solver", help="of this program; its own choice if left out")
    parser.add_argument("--min-width", type=float, help="pixels that this program makes thinner tubes; 1 if left out")
    parser.add_argument("--run", nargs=3, metavar=("WAY", "SET", "FILE"), help=argparse.SUPPRESS)
    add_places(parser)
    options = parser.parse_args()
    if options.run:
        print(json.dumps(child(*options.run, options)))
        return
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        results = measure_all(options, Path(folder))
    ctx = context()
    about = {
        **machine(ctx),
        "size": list(options.size),
        "frames": options.frames,
        "supersampling": options.supersampling,
        "limit": list(options.limit),
        "silhouettes": options.silhouettes or "auto",
        "solver": options.solver or "auto",
        "min_width": 1.0 if options.min_width is None else options.min_width,
        "sets": {row["set"]: row["about_set"] for row in results if "about_set" in row},
    }
    write(options.output / f"tubes-{card_slug(ctx)}", about, results, table(about, results), plot)


def known_way(name: str) -> str:
    """Return the name of a way if it is one."""
    if (name not in ABOUT or name.startswith("tube-")) and not TUBE.fullmatch(name):
        raise argparse.ArgumentTypeError(f"unknown way {name!r}, expected one of {', '.join(ABOUT)}")
    return name


def child(way: str, name: str, path: str, options: Any) -> dict[str, Any]:
    """Measure one way on one set, leave its pictures in a file, and return the rest."""
    tubes = make_set(name, options.seed)
    about = {"tubes": tubes.n_tubes, "segments": tubes.n_segments, "mean_radius": float(tubes.radius.mean())}
    if way == "reference":
        np.savez_compressed(path, **reference(tubes, options))
        return {"about_set": about}
    try:
        rows = run(way, tubes, options)
    except TooMuchError as error:
        return {"about_set": about, "unmeasured": str(error)}
    np.savez_compressed(path, **{row["view"]: row.pop("covered") for row in rows})
    return {"about_set": about, "rows": rows}


def measure_all(options: Any, folder: Path) -> list[dict[str, Any]]:
    """Return a row for every set, way and view."""
    results = []
    for name in options.sets:
        references: dict[str, Reference] = {}
        if options.supersampling:
            told = started("reference", name, folder / "reference.npz", options)
            if "unmeasured" in told:
                print(f"{name}: no reference: {told['unmeasured']}", flush=True)
            else:
                with np.load(folder / "reference.npz") as file:
                    for view in options.views:
                        same_size, shares, length = (file[f"{view}-{key}"] for key in ("same_size", "shares", "length"))
                        references[view] = Reference(same_size, shares, float(length))
        for way in options.ways:
            path = folder / "picture.npz"
            told = started(way, name, path, options)
            common = {"set": name, "way": way, **({"about_set": told["about_set"]} if "about_set" in told else {})}
            if "unmeasured" in told:
                results += [{**common, "view": view, "unmeasured": told["unmeasured"]} for view in options.views]
                print(results[-1], flush=True)
                continue
            with np.load(path) as pictures:
                for row in told["rows"]:
                    view = row["view"]
                    if references:
                        row |= references[view].compare(pictures[view])
                    results.append({**common, **row})
                    print({key: value for key, value in results[-1].items() if key != "about_set"}, flush=True)
    return results


def started(way: str, name: str, path: Path, options: Any) -> dict[str, Any]:
    """Run one way on one set in a process of its own, for as long as it may take."""
    command = [sys.executable, __file__, "--run", way, name, str(path), "--seed", str(options.seed)]
    for key in ("frames", "seconds", "supersampling"):
        command += [f"--{key}", str(getattr(options, key))]
    for key in ("views", "size", "limit"):
        command += [f"--{key}", *map(str, getattr(options, key))]
    for key in ("silhouettes", "solver", "min_width"):
        if (value := getattr(options, key)) is not None:
            command += ["--" + key.replace("_", "-"), str(value)]
    environment = dict(os.environ)
    if sys.platform.startswith("linux") and not environment.get("DISPLAY"):
        environment.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    # The reference is no way: it is given four times as long before errors go unmeasured.
    seconds = options.limit[0] * (4 if way == "reference" else 1)
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=seconds, env=environment)
    except subprocess.TimeoutExpired:
        return {"unmeasured": f"takes more than {seconds:g} s here"}
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines() or [f"ended with {done.returncode}"]
        print(done.stderr, file=sys.stderr)
        return {"unmeasured": f"failed: {lines[-1]}"}
    return json.loads(done.stdout.splitlines()[-1])


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    lines = [
        f"# Spline tubes and their rivals on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; {width}×{height}, 45° from "
        f"top to bottom, {about['frames']} frames around each set, each way in its own process, no anti-aliasing. "
        f"This program: silhouettes `{about['silhouettes']}`, solver `{about['solver']}`; tubes thinner than "
        f"{about['min_width']:g} pixels are drawn as wide as that, which counts as wrong here.",
        "",
        "*ms*: median of the orbit's frames, 10th to 90th percentile in brackets; *empty*: with every fragment "
        "discarded first thing; *triangles*: submitted, the mean of an orbit where they depend on the view; *bytes*: "
        "geometry on the GPU; *off*: mean distance between the picture's silhouette and the true one, in pixels: pixel "
        "middles between the two over the true one's length; *gross*: pixels wrong by all of their "
        f"{about['supersampling']}×{about['supersampling']} samples, over that length too.",
        "",
        *(f"- *{way}*: {text}." for way, text in ABOUT.items()),
    ]
    for name in dict.fromkeys(row["set"] for row in results):
        rows = [row for row in results if row["set"] == name]
        facts = about["sets"].get(name)
        counts = f": {facts['tubes']:,} tubes, {facts['segments']:,} segments" if facts else ""
        lines += ["", f"## {name}{counts}", "", "| view | way | ms | empty | triangles | bytes | off | gross |"]
        lines += ["|---|---|---|---|---|---|---|---|", *(line(row) for row in rows)]
        lines += least_bytes(rows)
    return "\n".join(lines) + "\n"


def line(row: dict[str, Any]) -> str:
    """Return one row of the table."""
    head = f"| {row['view']} | {row['way']} | "
    if "unmeasured" in row:
        return head + f"unmeasured: {row['unmeasured']} | | | | | |"
    low, high = row["ms_spread"]
    empty = f"{row['empty_ms']:.1f}" if "empty_ms" in row else ""
    many = "" if row["primitives"] is None else f"{row['primitives']:,}"
    errors = f"{row['off_pixels']:.4f} | {row['gross']:.4f}" if "off_pixels" in row else " | "
    return head + f"{row['ms']:.1f} ({low:.1f}–{high:.1f}) | {empty} | {many} | {row['gpu_bytes']:,} | {errors} |"


def least_bytes(rows: list[dict[str, Any]]) -> list[str]:
    """Return a table of the least GPU memory with which each family of ways keeps to some silhouette error."""
    found = [row for row in rows if "off_pixels" in row]
    if not found:
        return []
    families = list(dict.fromkeys(family(row["way"]) for row in found))
    lines = ["", "Least bytes measured with a silhouette off by no more than so many pixels:", ""]
    lines += ["| view | pixels | " + " | ".join(families) + " |", "|---|---|" + "---|" * len(families)]
    for view in dict.fromkeys(row["view"] for row in found):
        for error in ERRORS:
            cells = []
            for one in families:
                enough = [
                    (row["gpu_bytes"], row["way"]) for row in found
                    if row["view"] == view and family(row["way"]) == one and row["off_pixels"] <= error
                ]  # fmt: skip
                least, way = min(enough, default=(None, ""))
                cells.append("none" if least is None else f"{least:,}" + (f" ({way})" if way != one else ""))
            lines.append(f"| {view} | {error:g} | " + " | ".join(cells) + " |")
    return lines


def family(way: str) -> str:
    """Return a way's name without how fine it is."""
    return "tube filter" if way.startswith("tube-") else way


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw the paper's figure 5: time per frame of each way, hatched the part without fragment work."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    sets = list(dict.fromkeys(row["set"] for row in results))
    views = list(dict.fromkeys(row["view"] for row in results))
    ways = list(dict.fromkeys(row["way"] for row in results))
    figure, axes = plt.subplots(
        len(views), len(sets), figsize=(2.0 + 3.0 * len(sets), (1.0 + 0.25 * len(ways)) * len(views)),
        layout="constrained", squeeze=False, sharey=True,
    )  # fmt: skip
    for i, view in enumerate(views):
        for j, name in enumerate(sets):
            axis = axes[i][j]
            rows = {row["way"]: row for row in results if (row["set"], row["view"]) == (name, view)}
            for place, way in enumerate(ways):
                row = rows.get(way, {"unmeasured": ""})
                if "ms" not in row:
                    where = axis.get_yaxis_transform()
                    axis.text(0.02, place, "unmeasured", transform=where, va="center", size="x-small")
                    continue
                axis.barh(place, row["ms"], color=f"C{place}")
                if "empty_ms" in row:
                    axis.barh(place, row["empty_ms"], color="none", edgecolor="black", hatch="////")
            axis.set_yticks(range(len(ways)), ways)
            axis.set_title(f"{name}, {view}", size="small")
            axis.set_xlabel("ms per frame", size="small")
    axes[0][0].invert_yaxis()
    figure.suptitle(f"{about['card'].split('(')[0].strip()}; hatched: without fragment work", size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
