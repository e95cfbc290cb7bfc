"""Spline tubes beside baselines: time per frame, triangles, GPU memory and wrong silhouettes, of one run.

The paper's comparison (Russig et al. 2020, section 4, figure 5): 1920x1080, 45 degrees from top to bottom, an orbit
around each set from *far*, where all of it fits into the picture, and *close*, at a third of that distance; with and
without fragment work. Every method of drawing runs in a process of its own. One that would take more seconds or
gigabytes than ``--limit`` gets a row that says so::

    python benchmarks/tubes.py --folder /tmp --output docs/benchmarks

writes ``tubes-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from common import (
    add_places,
    card_of,
    machine,
    on_machine,
    passed_on,
    pyplot,
    run_child,
    to_table,
    write,
)
from tubes_methods import ABOUT, DEFAULT, TUBE, TooMuchError, make_set, reference, run
from tubes_reference import Reference

from pvfiblets.report.cameras import VIEWS

SETS = ("fibers", "hotroom", "bundle", "brain", "furball")
ERRORS = (0.2, 0.1, 0.05, 0.02)  # pixels, for which the least memory is looked up

COLUMNS = ("view", "method", "ms", "empty", "triangles", "bytes", "off", "gross")


def main() -> None:
    """Measure every method on every set, one process each, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sets", nargs="+", default=list(SETS), help="or helices-N, N small tubes")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--methods", nargs="+", type=known_method, default=list(DEFAULT), metavar="METHOD")
    parser.add_argument("--views", nargs="+", choices=list(VIEWS), default=list(VIEWS))
    parser.add_argument("--frames", type=int, default=24, help="in one orbit")
    parser.add_argument("--seconds", type=float, default=20.0, help="of drawing per orbit at most, once 3 frames count")
    parser.add_argument("--limit", type=float, nargs=2, default=(300.0, 8.0), metavar=("SECONDS", "GB"),
                        help="what one method may take for one set, making its mesh included")  # fmt: skip
    parser.add_argument("--supersampling", type=int, default=4, help="of the reference picture; 0 for no reference")
    parser.add_argument("--silhouettes", help="of this program; its own choice if left out")
    parser.add_argument("--solver", help="of this program; its own choice if left out")
    parser.add_argument("--min-width", type=float, help="pixels that this program makes thinner tubes; 1 if left out")
    parser.add_argument("--run", nargs=3, metavar=("METHOD", "SET", "FILE"), help=argparse.SUPPRESS)
    add_places(parser)
    options = parser.parse_args()
    if options.run:
        print(json.dumps(child(*options.run, options)))
        return
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        results = measure_all(options, Path(folder))
    about = {
        **machine(seed=options.seed),
        "size": list(options.size),
        "frames": options.frames,
        "supersampling": options.supersampling,
        "limit": list(options.limit),
        "silhouettes": options.silhouettes or "auto",
        "solver": options.solver or "auto",
        "min_width": 1.0 if options.min_width is None else options.min_width,
        "sets": {row["set"]: row["about_set"] for row in results if "about_set" in row},
    }
    write("tubes", about, results, table(about, results), plot, options.output)


def known_method(name: str) -> str:
    """Return the name of a method if it is one."""
    if (name not in ABOUT or name.startswith("tube-")) and not TUBE.fullmatch(name):
        raise argparse.ArgumentTypeError(f"unknown method {name!r}, expected one of {', '.join(ABOUT)}")
    return name


def child(method: str, name: str, path: str, options: Any) -> dict[str, Any]:
    """Measure one method on one set, leave its pictures in a file, and return the rest."""
    tubes = make_set(name, options.seed)
    about = {"tubes": tubes.n_tubes, "segments": tubes.n_segments, "mean_radius": float(tubes.radius.mean())}
    if method == "reference":
        np.savez_compressed(path, **reference(tubes, options))
        return {"about_set": about}
    try:
        rows = run(method, tubes, options)
    except TooMuchError as error:
        return {"about_set": about, "unmeasured": str(error)}
    np.savez_compressed(path, **{row["view"]: row.pop("covered") for row in rows})
    return {"about_set": about, "rows": rows}


def measure_all(options: Any, folder: Path) -> list[dict[str, Any]]:
    """Return a row for every set, method and view."""
    results = []
    for name in options.sets:
        references: dict[str, Reference] = {}
        if options.supersampling:
            found = started("reference", name, folder / "reference.npz", options)
            if "unmeasured" in found:
                print(f"{name}: no reference: {found['unmeasured']}", flush=True)
            else:
                with np.load(folder / "reference.npz") as file:
                    for view in options.views:
                        same_size, shares, length = (file[f"{view}-{key}"] for key in ("same_size", "shares", "length"))
                        references[view] = Reference(same_size, shares, float(length))
        for method in options.methods:
            path = folder / "picture.npz"
            found = started(method, name, path, options)
            common = {"set": name, "method": method} | {key: found[key] for key in ("about_set",) if key in found}
            if "unmeasured" in found:
                results += [{**common, "view": view, "unmeasured": found["unmeasured"]} for view in options.views]
                print(results[-1], flush=True)
                continue
            with np.load(path) as pictures:
                for row in found["rows"]:
                    view = row["view"]
                    if references:
                        row |= references[view].compare(pictures[view])
                    results.append({**common, **row})
                    print({key: value for key, value in results[-1].items() if key != "about_set"}, flush=True)
    return results


def started(method: str, name: str, path: Path, options: Any) -> dict[str, Any]:
    """Measure one method on one set in a process of its own, for as long as it may take."""
    names = ("seed", "frames", "seconds", "supersampling", "views", "size", "limit", "silhouettes", "solver")
    more = passed_on(options, (*names, "min_width"))
    # The reference is no method: it is given four times as long before errors go unmeasured.
    seconds = options.limit[0] * (4 if method == "reference" else 1)
    rows, reason = run_child(__file__, ["--run", method, name, path, *more], seconds)
    return rows[-1] if rows else {"unmeasured": reason}


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    lines = [
        f"# Spline tubes and baselines on {about['card']}",
        "",
        f"{on_machine(about)}; {width}×{height}, 45° from "
        f"top to bottom, {about['frames']} frames around each set, each method in its own process, no anti-aliasing. "
        f"This program: silhouettes `{about['silhouettes']}`, solver `{about['solver']}`; tubes thinner than "
        f"{about['min_width']:g} pixels are drawn as wide as that, which counts as wrong here.",
        "",
        "*ms*: median of the orbit's frames, 10th to 90th percentile in brackets; *empty*: with every fragment "
        "discarded first thing; *triangles*: submitted, the mean of an orbit where they depend on the view; *bytes*: "
        "geometry on the GPU; *off*: mean distance between the picture's silhouette and the true one, in pixels: pixel "
        "middles between the two over the true one's length; *gross*: pixels wrong by all of their "
        f"{about['supersampling']}×{about['supersampling']} samples, over that length too.",
        "",
        *(f"- *{method}*: {text}." for method, text in ABOUT.items()),
    ]
    for name in dict.fromkeys(row["set"] for row in results):
        rows = [row for row in results if row["set"] == name]
        facts = about["sets"].get(name)
        counts = f": {facts['tubes']:,} tubes, {facts['segments']:,} segments" if facts else ""
        lines += ["", f"## {name}{counts}", "", *to_table(COLUMNS, map(line, rows))]
        lines += least_bytes(rows)
    return "\n".join(lines) + "\n"


def line(row: dict[str, Any]) -> str:
    """Return one row of the table."""
    head = f"| {row['view']} | {row['method']} | "
    if "unmeasured" in row:
        return head + f"unmeasured: {row['unmeasured']} | | | | | |"
    low, high = row["ms_spread"]
    empty = f"{row['empty_ms']:.1f}" if "empty_ms" in row else ""
    many = "" if row["primitives"] is None else f"{row['primitives']:,}"
    errors = f"{row['off_pixels']:.4f} | {row['gross']:.4f}" if "off_pixels" in row else " | "
    return head + f"{row['ms']:.1f} ({low:.1f}–{high:.1f}) | {empty} | {many} | {row['gpu_bytes']:,} | {errors} |"


def least_bytes(rows: list[dict[str, Any]]) -> list[str]:
    """Return a table of the least GPU memory with which each family of methods keeps to some silhouette error."""
    found = [row for row in rows if "off_pixels" in row]
    if not found:
        return []
    families = list(dict.fromkeys(family(row["method"]) for row in found))
    lines = ["", "Least bytes measured with a silhouette off by no more than so many pixels:", ""]
    lines += ["| view | pixels | " + " | ".join(families) + " |", "|---|---|" + "---|" * len(families)]
    for view in dict.fromkeys(row["view"] for row in found):
        for error in ERRORS:
            cells = []
            for one in families:
                enough = [
                    (row["gpu_bytes"], row["method"]) for row in found
                    if row["view"] == view and family(row["method"]) == one and row["off_pixels"] <= error
                ]  # fmt: skip
                least, method = min(enough, default=(None, ""))
                cells.append("none" if least is None else f"{least:,}" + (f" ({method})" if method != one else ""))
            lines.append(f"| {view} | {error:g} | " + " | ".join(cells) + " |")
    return lines


def family(method: str) -> str:
    """Return a method's name without how fine it is."""
    return "tube filter" if method.startswith("tube-") else method


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw the paper's figure 5: time per frame of each method, hatched the part without fragment work."""
    plt = pyplot()
    sets = list(dict.fromkeys(row["set"] for row in results))
    views = list(dict.fromkeys(row["view"] for row in results))
    methods = list(dict.fromkeys(row["method"] for row in results))
    figure, axes = plt.subplots(
        len(views), len(sets), figsize=(2.0 + 3.0 * len(sets), (1.0 + 0.25 * len(methods)) * len(views)),
        layout="constrained", squeeze=False, sharey=True,
    )  # fmt: skip
    for i, view in enumerate(views):
        for j, name in enumerate(sets):
            axis = axes[i][j]
            rows = {row["method"]: row for row in results if (row["set"], row["view"]) == (name, view)}
            for place, method in enumerate(methods):
                row = rows.get(method, {"unmeasured": ""})
                if "ms" not in row:
                    where = axis.get_yaxis_transform()
                    axis.text(0.02, place, "unmeasured", transform=where, va="center", size="x-small")
                    continue
                axis.barh(place, row["ms"], color=f"C{place}")
                if "empty_ms" in row:
                    axis.barh(place, row["empty_ms"], color="none", edgecolor="black", hatch="////")
            axis.set_yticks(range(len(methods)), methods)
            axis.set_title(f"{name}, {view}", size="small")
            axis.set_xlabel("ms per frame", size="small")
    axes[0][0].invert_yaxis()
    figure.suptitle(f"{card_of(about)}; hatched: without fragment work", size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
