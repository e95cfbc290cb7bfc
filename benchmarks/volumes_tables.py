"""Tables and plot of the benchmark of ray-cast volumes, and whether it reached its goals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from common import card_of, on_machine, pyplot, to_table, verdict
from volumes_effects import table as effects_table
from volumes_methods import ABOUT, EQUAL
from volumes_timing import BYTES

SURFACES = 3.0
"""The goal: so many times as fast as VTK's GPU mapper with surfaces of sparse data, and faster in all else."""

SPARSE = {"speed_up": 1.8, "differing": 0.01}
"""The goals of sparse casting in a moving view."""

VIEWS = ("circle", "static")
COLUMNS = ("mode", "method", "step", "error", "circle ms", "CPU", "static ms", "CPU", "bytes", "build ms", "CPU",
           "skipped", "octree")  # fmt: skip


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    lines = [
        f"# Ray-cast volumes beside VTK's on {about['card']}",
        "",
        f"{on_machine(about)}; circling "
        f"{about['size']}×{about['size']} and static {about['still']}×{about['still']}, steps of {about['step']:g} "
        "voxels, each method in its own process, no anti-aliasing, no jitter. One transfer function, one step and one "
        "surface for all; data of 16 bits.",
        "",
        "*error*: root mean square of colours from 0 to 1 against rays in float64, of pixels whose rays meet the "
        f"volume; bytes alone cost {BYTES:.4f}. *ms*: median of the frames by the clock, 10th to 90th percentile in "
        "brackets; *CPU*: the processor's time of all threads. *bytes*: all that the context holds, pictures of the "
        "static view included, which is left out where a frame of it would take more than "
        f"{about['longest']:g} s. *build*: until the first picture is there, without drawing it, from voxels in "
        "memory. *skipped*: of the octree's leaves; *octree*: its bytes over the voxels'.",
        "",
        *(f"- *{method}*: {text}." for method, text in ABOUT.items()),
    ]
    for data in dict.fromkeys(row["data"] for row in results):
        facts = about["volumes"].get(data)
        size = f": {' × '.join(map(str, facts['shape']))} voxels, {facts['bytes']:,} bytes" if facts else ""
        lines += ["", f"## {data}{size}", ""]
        lines += to_table(COLUMNS, (line(row) for row in results if row["data"] == data))
    lines += ["", *effects_table(about["effects"]), *goals(results), *sparse_goals(about["effects"])]
    return "\n".join(lines) + "\n"


def line(row: dict[str, Any]) -> str:
    """Return one row of the table."""
    head = f"| {row['mode']} | {row['method']} | "
    if "unmeasured" in row:
        return head + f"unmeasured: {row['unmeasured']} |" + " |" * 10
    step = "own" if row["method"] == "vtk-smart" else f"{row['step']:.3g}"
    if row["method"] == EQUAL and not row["reached"]:
        step += f", not {row['target']:.4f}"
    cells = [step, f"{row['error']:.4f}"]
    for view in VIEWS:
        if view in row:
            low, high = row[view]["ms_spread"]
            cells += [f"{row[view]['ms']:.1f} ({low:.1f}–{high:.1f})", f"{row[view]['cpu_ms']:.1f}"]
        else:
            cells += ["", ""]
    cells += [f"{row['gpu_bytes']:,}" if row.get("gpu_bytes") is not None else ""]
    cells += [f"{row[key]:.0f}" if key in row else "" for key in ("build_ms", "build_cpu_ms")]
    cells += [f"{100 * row[key]:.1f} %" if key in row else "" for key in ("skipped", "octree_share")]
    return head + " | ".join(cells) + " |"


def compared(results: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return how many times as fast the plotter is as VTK's GPU mapper at the same error, by volume, mode and view.

    Where VTK never gets there, the times are those of its best, or at the same step, and the ratio is a lower bound.
    """
    found = {(row["data"], row["mode"], row["method"]): row for row in results if "unmeasured" not in row}
    rows = []
    for data, mode, method in found:
        ours, theirs = found.get((data, mode, "plotter")), found.get((data, mode, EQUAL))
        if method != "plotter" or theirs is None:
            continue
        for view in VIEWS:
            other = theirs.get(view, None if theirs["reached"] else found[data, mode, "vtk-gpu"].get(view))
            if view in ours and other is not None:
                rows.append({"data": data, "mode": mode, "view": view, "reached": theirs["reached"],
                             "times": other["ms"] / ours[view]["ms"],
                             "cpu_times": other["cpu_ms"] / ours[view]["cpu_ms"]})  # fmt: skip
    return rows


def goals(results: list[dict[str, Any]]) -> list[str]:
    """Say where this program is faster than VTK's GPU mapper with pictures as wrong as its own."""
    rows = compared(results)
    if not rows:
        return []
    lines = [
        "## Goals",
        "",
        "As many times as fast as VTK's GPU mapper with a picture as wrong (`plotter` beside `vtk-gpu-equal`), by the "
        f"clock and by the processor's time; to be above 1, and of vessels' surfaces {SURFACES:g} or more. *≥*: VTK's "
        "picture is still the more wrong one at the finest step that was tried.",
        "",
        "| data | mode | view | × | × CPU | goal |",
        "|---|---|---|---|---|---|",
    ]
    for row in rows:
        wanted = SURFACES if row["mode"] == "isosurface" and row["data"].startswith("vessels") else 1.0
        more = "" if row["reached"] else "≥ "
        times = f"{more}{row['times']:.2f} | {more}{row['cpu_times']:.2f}"
        kept = verdict(row["cpu_times"] >= wanted)
        lines.append(f"| {row['data']} | {row['mode']} | {row['view']} | {times} | {wanted:g}: {kept} |")
    return [*lines, ""]


def sparse_goals(effects: list[dict[str, Any]]) -> list[str]:
    """Say whether sparse casting is as fast and as right as wanted."""
    rows = [row for row in effects if row["effect"].startswith("sparse") and row["view"] == "circle" and "rms" in row]
    said = []
    for row in rows:
        fast, right = row["cpu_speed_up"] >= SPARSE["speed_up"], row["differing"] <= SPARSE["differing"]
        said.append(
            f"- {row['effect']}, {row['data']}, circling: {row['cpu_speed_up']:.2f} times as fast, {verdict(fast)}; "
            f"{100 * row['differing']:.2f} % of the pixels differ, {verdict(right)}."
        )
    head = f"Sparse casting, {SPARSE['speed_up']:g} times and {100 * SPARSE['differing']:g} % are wanted:"
    return [head, "", *said] if said else []


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw time per frame over error, a panel for each volume and mode, an open mark for the static view."""
    plt = pyplot()
    data = list(dict.fromkeys(row["data"] for row in results))
    modes = list(dict.fromkeys(row["mode"] for row in results))
    figure, axes = plt.subplots(len(modes), len(data), figsize=(1.5 + 2.7 * len(data), 1.2 + 2.4 * len(modes)),
                                layout="constrained", squeeze=False, sharey="row")  # fmt: skip
    for i, mode in enumerate(modes):
        for j, name in enumerate(data):
            axis = axes[i][j]
            rows = {row["method"]: row for row in results if (row["data"], row["mode"]) == (name, mode)}
            for colour, method in enumerate(ABOUT):
                row = rows.get(method)
                if row is None or "error" not in row:
                    continue
                for view, fill in zip(VIEWS, ("full", "none"), strict=True):
                    if view in row:
                        axis.loglog(row["error"], row[view]["cpu_ms"], "o", color=f"C{colour}", fillstyle=fill)
            if EQUAL in rows and "target" in rows[EQUAL]:
                axis.axvline(rows[EQUAL]["target"], color="black", linestyle=":", linewidth=1)
            axis.set_title(f"{name}, {mode}", size="small")
            axis.grid(True, which="both", alpha=0.2)
            axis.tick_params(labelsize="x-small", which="both")
            if i == len(modes) - 1:
                axis.set_xlabel("root mean square error", size="small")
            if j == 0:
                axis.set_ylabel("CPU ms per frame", size="small")
    marks = {method: axes[0][0].plot([], [], "o", color=f"C{colour}")[0] for colour, method in enumerate(ABOUT)}
    figure.legend(marks.values(), marks, loc="outside lower center", ncols=3, fontsize="small")
    card, size, still = card_of(about), about["size"], about["still"]
    title = f"{card}; filled: circling {size}×{size},\nopen: static {still}×{still}; dotted: the error to keep to"
    figure.suptitle(title, size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)
