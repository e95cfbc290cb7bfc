"""All that a graphics card is asked for, from one command, without VTK or a window: ``benchmarks/card.sh``.

1. ``pvfiblets gl --check``: does it draw right?
2. Every pipeline with every culling, 10^6 to 5.4 * 10^9 segments, 1920x1080 and 3840x2160 (Schertzer et al. 2022,
   table 2).
3. Fiblets beside line strips of the same decoded points (table 3).
4. Features and views of a whole brain (section 5, figures 1, 11 and 12).
5. Spline tubes (Russig et al. 2020, figure 5), halos (Everts et al. 2009, table 1), ray-cast volumes.

A second process draws the cells: what a driver dies of is a row that says so, and the next cell has a new process.
Writes ``card-CARD.json``, ``.md`` and ``.png``, a sheet of what was drawn, after every cell, so that a run that is cut
short leaves what it has, and ``--resume`` goes on there. Brains are made as they are needed, 12 GB of them in all, and
kept in ``--folder``::

    python benchmarks/card.py --folder /tmp --output docs/benchmarks --resume
    python benchmarks/card.py --small      # a rehearsal in some minutes
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from card_cells import draw_cell
from card_process import Drawer
from common import add_places, card_of, machine, make_brain, on_machine, slug, to_table

from pvfiblets.report.studies.card.check import run_check
from pvfiblets.report.studies.card.report_file import png, summary
from pvfiblets.support.whole_files import replacing

SEGMENTS = (1e6, 6e6, 60e6, 434e6, 1e9, 5.4e9)
TABLE_3 = (8e6, 81e6, 202e6, 434e6)
SIZES = ((1920, 1080), (3840, 2160))
CULLINGS = ("two-phase", "coverage", "none")
FEATURES = ("plain", "lines 3 pixels wide, shaded", "lines tubes of 0.5 mm", "lines 4 layers", "lines all, in slices",
            "cut mesh", "cut sphere", "filter half of the streamlines", "effects ambient occlusion",
            "effects halos")  # fmt: skip
TUBES = ("fibers", "hotroom", "bundle", "brain", "furball")
HALOS = ("fibres-subset", "office", "shape-small")
VOLUMES = ("vessels-256", "vessels-512")
MODES = ("composite", "mip", "isosurface")
GOAL = (5.4e9, 8.0)  # segments, ms on a card of the H100's class; the paper: 33.9 ms on an RTX 2080 Ti
LATE = "the time given was used up"
HOPELESS = 3000.0  # ms a picture, beyond which a pipeline draws no larger set
COLUMNS = 4
TITLES = {
    "table 2": "Pipelines",
    "table 3": "Beside line strips",
    "figures": "Features and views",
    "others": "Spline tubes, halos, volumes",
}

Row = dict[str, Any]


def main() -> None:
    """Measure section by section, and write after each cell."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--segments", type=float, nargs="+", default=list(SEGMENTS))
    parser.add_argument("--step", type=float, default=0.1, help="mm between points; the paper's are 0.1 and 0.05")
    parser.add_argument("--frames", type=int, default=40, help="that count, in one flight")
    parser.add_argument("--seconds", type=float, default=10.0, help="of drawing per cell at most, once 3 frames count")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds that one cell may take in all")
    parser.add_argument(
        "--total", type=float, default=float("inf"), help="seconds for everything; what is left says so"
    )
    parser.add_argument("--small", action="store_true", help="a rehearsal: little data, small pictures")
    parser.add_argument("--resume", action="store_true", help="keep what --output has of this card, measure the rest")
    parser.add_argument("--draw-cells", action="store_true", help=argparse.SUPPRESS)
    add_places(parser)
    options = parser.parse_args()
    if options.draw_cells:
        for line in sys.stdin:
            print(json.dumps(draw_cell(json.loads(line), options.folder)), flush=True)
        return
    with tempfile.TemporaryDirectory(dir=options.folder) as temporary:
        measure_all(options, Path(temporary))


def measure_all(options: Any, temporary: Path) -> None:
    """Measure everything."""
    deadline = time.monotonic() + options.total
    folder = options.folder or temporary
    pictures = folder / "card-pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    about, earlier = before(options) if options.resume else ({}, [])
    about = about or {**checked(temporary), "step_mm": options.step}
    done = {json.dumps(row["cell"]): row for row in earlier if row.get("unmeasured") != LATE}
    results: list[Row] = []
    drawer = Drawer(__file__, folder)
    hopeless: dict[tuple[Any, ...], str] = {}
    pipelines = about["pipelines"]
    for section, cells in sections(options, pipelines):
        for number, cell in enumerate(cells):
            key = tuple(str(cell.get(name)) for name in ("kind", "size", "pipeline", "culling"))
            if json.dumps(cell) in done:
                row: Row = done[json.dumps(cell)]
            elif time.monotonic() > deadline:
                row = {"unmeasured": LATE}
            elif key in hopeless:
                row = {"unmeasured": hopeless[key]}
            else:
                row = measured(cell, folder, pictures / f"{slug(section)}-{number:02d}.npy", options, drawer)
            slowly = row.get("unmeasured") != LATE and not row.get("ms", HOPELESS) < HOPELESS
            if slowly and cell["kind"] in ("fiblets", "raw lines"):
                hopeless.setdefault(key, row.get("unmeasured", "far too slow at fewer segments"))
            results.append({"section": section, "number": number, "cell": cell, **cell, **row})
            print({name: value for name, value in results[-1].items() if name not in ("passes", "cell")}, flush=True)
            if json.dumps(cell) not in done:
                write(about, results, pictures, options.output)
    drawer.close()
    print(f"wrote {write(about, results, pictures, options.output)}.json, .md and .png", file=sys.stderr)


def checked(temporary: Path) -> Row:
    """Check what the card draws, tell it, and return that beside the machine's facts."""
    check = run_check(temporary, (), lambda part: print(part, "...", file=sys.stderr, flush=True))
    print(summary(check), file=sys.stderr, flush=True)
    if not check.opengl:
        sys.exit("without OpenGL there is nothing to measure")
    available = [row["name"] for row in check.opengl["pipelines"] if row["available"]]
    return {**machine(), "pipelines": available, "check": [one.as_dict() for one in check.findings],
            "check_text": summary(check)}  # fmt: skip


def before(options: Any) -> tuple[Row, list[Row]]:
    """Return what an earlier run wrote of this card; nothing if it measured other data."""
    path = stem_of(machine(), options.output).with_suffix(".json")
    if not path.exists():
        return {}, []
    about = json.loads(path.read_text(encoding="utf-8"))
    results = about.pop("results")
    return (about, results) if about["step_mm"] == options.step else ({}, [])


def measured(cell: Row, folder: Path, picture: Path, options: Any, drawer: Drawer) -> Row:
    """Draw one cell; its data is made before, outside its time."""
    if "segments" in cell:
        try:
            make_brain(cell["segments"], cell["step"], folder)
        except (OSError, MemoryError) as error:
            return {"unmeasured": f"its data was not made: {error or type(error).__name__}"}
    at_most = {"frames": 5, "seconds": 1.0} if options.small else {"frames": options.frames, "seconds": options.seconds}
    wanted = {**cell, **at_most, "picture": str(picture)}
    return drawer.draw(wanted, options.limit)


def sections(options: Any, pipelines: list[str]) -> list[tuple[str, list[Row]]]:
    """Return what is measured, section by section, the most important first."""
    small = options.small
    sizes = [list(size) for size in (((320, 180), (480, 270)) if small else SIZES)]
    segments = [5e4, 2e5] if small else options.segments
    common = {"step": options.step}
    whole, low = max(segments), sizes[0]
    table_2, larger = (
        [{"kind": "fiblets", "segments": count, "size": size, "pipeline": pipeline, "culling": culling, **common}
         for count in segments for pipeline in pipelines for culling in CULLINGS]
        for size in sizes
    )  # fmt: skip
    table_3 = [
        row
        for count in ([5e4] if small else TABLE_3)
        for row in (
            {"kind": "raw lines", "segments": count, "size": low, **common},
            {"kind": "fiblets", "segments": count, "size": low, "pipeline": "auto", "culling": "two-phase", **common},
        )
    ]
    brain = {"segments": min(60e6, whole), "size": low, **common}
    figures = [{"kind": "feature", "feature": name, **brain} for name in FEATURES]
    figures += [{"kind": "fiblets", "view": view, "pipeline": "auto", "culling": "two-phase", **brain}
                for view in ("close", "inside")]  # fmt: skip
    others = [{"kind": "tubes", "set": name, "view": view, "size": low}
              for name in (TUBES[:1] if small else TUBES) for view in ("far", "close")]  # fmt: skip
    others += [{"kind": "halos", "set": name, "size": low} for name in (HALOS[-1:] if small else HALOS)]
    others += [{"kind": "volume", "set": name, "mode": mode, "size": low}
               for name in (["vessels-48"] if small else VOLUMES) for mode in MODES]  # fmt: skip
    return [("table 2", table_2), ("table 3", table_3), ("figures", figures), ("others", others), ("table 2", larger)]


def sheet(results: list[Row], folder: Path) -> tuple[bytes | None, list[Row]]:
    """Return the pictures of all cells but those of table 2 as one PNG, and their cells in its order."""
    shown = [(row, folder / f"{slug(row['section'])}-{row['number']:02d}.npy") for row in results
             if row["section"] != "table 2" and "ms" in row]  # fmt: skip
    shown = [(row, path) for row, path in shown if path.exists()]
    if not shown:
        return None, []
    pictures = [np.load(path) for _, path in shown]
    pictures += [np.zeros_like(pictures[0])] * (-len(pictures) % COLUMNS)
    rows = [np.concatenate(pictures[i : i + COLUMNS], axis=1) for i in range(0, len(pictures), COLUMNS)]
    return png(np.concatenate(rows[::-1], axis=0)), [row for row, _ in shown]  # row 0 is at the bottom


def stem_of(about: Row, folder: Path) -> Path:
    """Return the path of what is written, without its ending."""
    return folder / f"card-{slug(about['card'].split('(')[0].split('/')[0])}"


def write(about: Row, results: list[Row], pictures: Path, folder: Path) -> Path:
    """Write what there is so far; return the path without its ending."""
    folder.mkdir(parents=True, exist_ok=True)
    stem = stem_of(about, folder)
    picture, shown = sheet(results, pictures)
    told = json.dumps({**about, "results": results}, indent=1) + "\n"
    for ending, content in ((".json", told.encode()), (".md", page(about, results, shown, stem.name).encode()),
                            (".png", picture)):  # fmt: skip
        if content is not None:
            with replacing(stem.with_suffix(ending)) as file:
                file.write(content)
    return stem


def page(about: Row, results: list[Row], shown: list[Row], name: str) -> str:
    """Return everything in Markdown."""
    lines = [f"# {card_of(about)}", "", f"{on_machine(about)}. Milliseconds a picture: the median of a slow flight, "
             "each picture waited for; 10th to 90th percentile in the JSON file.", ""]  # fmt: skip
    for section, title in TITLES.items():
        rows = [row for row in results if row["section"] == section]
        if rows:
            lines += [f"## {title}", "", *(table_2(rows) if section == "table 2" else listed(rows)), ""]
    best = [row for row in results if row.get("segments", 0) >= 0.9 * GOAL[0] and "ms" in row]
    if best:
        least = min(best, key=lambda row: row["ms"])
        lines += [f"{least['segments']:,.0f} segments take {least['ms']:.1f} ms by {least['pipeline']}; the goal is "
                  f"{GOAL[1]:g} ms, the paper has 33.9 ms on an RTX 2080 Ti.", ""]  # fmt: skip
    if shown:
        names = [f"{number + 1}. {named(row)}" for number, row in enumerate(shown)]
        lines += [f"![What was drawn]({name}.png)", "", f"From left to right, {COLUMNS} in a row:", "", *names, ""]
    return "\n".join([*lines, "## Does it draw right?", "", "```", about["check_text"], "```", ""])


def table_2(rows: list[Row]) -> list[str]:
    """Return pipelines by segments, a table for each size."""
    found = []
    for size in dict.fromkeys(tuple(row["size"]) for row in rows):
        here = [row for row in rows if tuple(row["size"]) == size]
        counts = sorted({row["cell"]["segments"] for row in here})
        cells = {(row["pipeline"], row["culling"], row["cell"]["segments"]): told(row) for row in here}
        body = [
            f"| {pipeline} | {culling} | " + " | ".join(cells.get((pipeline, culling, n), "") for n in counts) + " |"
            for pipeline in dict.fromkeys(row["pipeline"] for row in here) for culling in CULLINGS
        ]  # fmt: skip
        heads = ["pipeline", "culling", *(f"{n / 1e6:,g} M segments" for n in counts)]
        found += [f"{size[0]}×{size[1]}:", "", *to_table(heads, body), ""]
    return found


def listed(rows: list[Row]) -> list[str]:
    """Return rows one by one."""
    body = []
    for row in rows:
        what = named(row)
        count = next((f"{row[key]:,.0f} {key}" for key in ("segments", "points", "voxels") if key in row), "")
        nbytes = f"{row['gpu_bytes'] / 1e6:,.1f}" if "gpu_bytes" in row else ""
        body.append(f"| {what} | {count} | {row['size'][0]}×{row['size'][1]} | {told(row)} | {nbytes} |")
    return to_table(["what", "of", "pixels", "ms", "MB on the card"], body)


def named(row: Row) -> str:
    """Return what a row is of."""
    return ", ".join(str(row[key]) for key in ("kind", "feature", "set", "mode", "view", "pipeline") if key in row)


def told(row: Row) -> str:
    """Return a time, or why there is none."""
    return row["unmeasured"] if "unmeasured" in row else f"{row['ms']:.2f}"


if __name__ == "__main__":
    main()
