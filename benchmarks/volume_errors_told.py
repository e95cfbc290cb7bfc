"""How the study of errors of ray-cast volumes tells what it measured: a table for each mode, and a plot."""

from __future__ import annotations

from pathlib import Path
from typing import Any

MARKS = {"default": "*", "step": "o", "refinement": "s", "integrator": "D", "filter": "^", "jitter": "v", "stop": "<",
         "homogeneous": ">", "recon": "P", "octree": "X", "sparse": "d"}  # fmt: skip


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the results in Markdown."""
    lines = [
        f"# Error against run time of ray-cast volumes on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; the engine without VTK, "
        f"two pictures of {about['size']}×{about['size']}. *rms*: of colours from 0 to 1 against rays in float64, "
        "which know no steps, of pixels whose rays meet the volume. *place*: mean distance along the ray from where "
        "the surface is, in voxels, what is missed or false counted as one voxel; *median* and *p99* of the others; "
        "*missed*, *false*: over the surface's pixels. *CPU*: milliseconds of all threads, median; *ms*: by the clock, "
        "10th to 90th percentile in brackets. *differing*: pixels off the default's by more than "
        f"{about['differs']} of 255. **Bold**: nothing with the same filter beats it in both CPU time and error.",
    ]
    for data, mode in dict.fromkeys((row["data"], row["mode"]) for row in results):
        surface = mode == "isosurface"
        lines += ["", f"## {data}, {mode}", ""]
        more = " place | median | p99 | missed | false |" if surface else ""
        lines.append(f"| varied | setting | CPU | ms | rms |{more} differing |")
        lines.append("|" + (6 + more.count("|")) * "---|")
        lines += [line(row) for row in results if (row["data"], row["mode"]) == (data, mode)]
    return "\n".join(lines) + "\n"


def line(row: dict[str, Any]) -> str:
    """Return one row of the table."""
    low, high = row["ms_spread"]
    cells = [row["varied"], setting(row), f"{row['cpu_ms']:.1f}", f"{row['ms']:.1f} ({low:.1f}–{high:.1f})",
             marked(f"{row['rms']:.5f}", row["front"])]  # fmt: skip
    if "position" in row:
        cells.append(marked(f"{row['position']:.5f}", row["position_front"]))
        cells += ["" if row[key] is None else f"{row[key]:.1e}" for key in ("median", "p99")]
        cells += [f"{100 * row[key]:.2f} %" for key in ("missed", "false")]
    cells.append(f"{100 * row['differing']:.2f} %" if "differing" in row else "")
    return "| " + " | ".join(cells) + " |"


def marked(text: str, front: bool) -> str:
    """Return a number, bold if it is on the front."""
    return f"**{text}**" if front else text


def setting(row: dict[str, Any]) -> str:
    """Return what a row is of, beside its defaults."""
    step = f"step {row['step']:g}"
    return {
        "default": lambda: "",
        "step": lambda: step,
        "refinement": lambda: f"{step}, {row['refine']}" + (f" {row['iterations']}" if row["refine"] != "none" else ""),
        "integrator": lambda: f"{step}, {row['integrator']}",
        "filter": lambda: f"{step}, {row['filter']}",
        "jitter": lambda: f"{step}, jitter",
        "recon": lambda: "recon",
        "stop": lambda: f"stop {row['stop']:g}",
        "homogeneous": lambda: f"homogeneous {row['homogeneous']:g}",
        "octree": lambda: "no octree",
        "sparse": lambda: f"k {row['sparse']}, threshold {row['sparse_threshold']:g}",
    }[row["varied"]]()


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw error over time, a panel for each mode and measure, with a line through what nothing beats."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    data = list(dict.fromkeys(row["data"] for row in results))
    panels = [(mode, "rms") for mode in dict.fromkeys(row["mode"] for row in results)]
    panels += [("isosurface", "position")] if ("isosurface", "rms") in panels else []
    figure, axes = plt.subplots(len(data), len(panels), figsize=(1.0 + 4.2 * len(panels), 1.2 + 3.8 * len(data)),
                                layout="constrained", squeeze=False)  # fmt: skip
    used: dict[str, Any] = {}
    for i, name in enumerate(data):
        for j, (mode, key) in enumerate(panels):
            axis = axes[i][j]
            wanted = name, mode, "trilinear"
            rows = [row for row in results if (row["data"], row["mode"], row["filter"]) == wanted]
            for colour, (varied, mark) in enumerate(MARKS.items()):
                some = [row for row in rows if row["varied"] == varied]
                if some:
                    first = varied == "default"
                    used[varied] = axis.scatter(
                        [row["cpu_ms"] for row in some], [row[key] for row in some], marker=mark,
                        s=110 if first else 24, color="black" if first else f"C{colour - 1}", zorder=4 if first else 3,
                    )  # fmt: skip
            on = "front" if key == "rms" else "position_front"
            front = sorted((row["cpu_ms"], row[key]) for row in rows if row[on])
            axis.plot(*zip(*front, strict=True), color="black", linewidth=1, drawstyle="steps-post", zorder=2)
            axis.set_xscale("log")
            axis.set_yscale("log")
            axis.set_title(f"{name}, {mode}", size="medium")
            axis.set_xlabel("CPU ms per picture")
            axis.set_ylabel("rms of colours" if key == "rms" else "place, voxels")
            axis.grid(True, which="both", alpha=0.2)
            axis.tick_params(labelsize="x-small", which="both")
    figure.legend(used.values(), used, loc="outside right center", fontsize="small")
    card, size = about["card"].split("(")[0].strip(), about["size"]
    title = f"{card}, {size}×{size}, trilinear; line: nothing beats it in both"
    figure.suptitle(title, size="medium")
    figure.savefig(path, dpi=110)
    plt.close(figure)
