"""What the benchmarks share: the machine's facts, synthetic brains, cameras, windows, child processes and tables."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.cameras import Camera
from pvfiblets.report.machine import about, slug

# Pictures are drawn once, of one sample a pixel, unless a benchmark asks for more.
os.environ.setdefault("PVFIBLETS_ANTIALIAS", "off")

DEGREES_PER_FRAME = 1.14  # the paper's (Schertzer et al. 2022, section 4.5): 90 degrees a second at 80 frames
PER_STREAMLINE = 94.0  # mm, on average, of pvfiblets.synthetic.brain
OF_THE_PICTURE = ("gbuffer", "occlusion", "framebuffer", "depth")
"""Buffers that grow with the picture, not with the data."""

# ------------------------------------------------------------------------------------------------- machine and options


def machine(ctx: Any = None, seed: int = 0) -> dict[str, Any]:
    """Return what the numbers hold for: the report's facts of this machine, and the graphics card's of a context."""
    made = bare_context() if ctx is None else None
    info = (ctx or made).info
    found = about(seed, quick=False, driver=info["GL_VERSION"]) | {"card": info["GL_RENDERER"]}
    if made is not None:
        made.release()
    return found


def on_machine(facts: dict[str, Any]) -> str:
    """Return the machine's facts as a table's first words."""
    return f"{facts['driver']}, {facts['system']}, {facts['cores']} CPU cores, {facts['date']}"


def card_of(facts: dict[str, Any]) -> str:
    """Return the short name of the graphics card."""
    return str(facts["card"].split("(")[0].strip())


def add_places(parser: Any) -> None:
    """Add the options for the picture's size, for the brains and for what is written."""
    parser.add_argument("--size", type=int, nargs=2, default=(1920, 1080))
    parser.add_argument("--folder", type=Path, help="where synthetic brains are kept; a temporary one if left out")
    parser.add_argument("--output", type=Path, default=Path())


# -------------------------------------------------------------------------------------------------------------- results


def percentiles(seconds: Sequence[float], name: str = "ms") -> dict[str, Any]:
    """Return the median in ms, and the 10th and 90th percentile."""
    low, median, high = (1e3 * float(np.percentile(seconds, q)) for q in (10, 50, 90))
    return {name: median, f"{name}_spread": [low, high]}


def data_bytes(report: dict[str, Any]) -> int:
    """Return the bytes on the GPU that grow with the data, of what a renderer or an actor explains."""
    return sum(buffer["bytes"] for buffer in report["buffers"] if buffer["name"] not in OF_THE_PICTURE)


def verdict(reached: bool) -> str:
    """Return one word about a goal."""
    return "kept" if reached else "missed"


def to_table(heads: str | Sequence[str], rows: Iterable[str]) -> list[str]:
    """Return a Markdown table: its column heads, as a line or one by one, and its finished rows."""
    head = heads if isinstance(heads, str) else "| " + " | ".join(heads) + " |"
    return [head, "|" + (head.count("|") - 1) * "---|", *rows]


def write(name: str, facts: dict[str, Any], results: list[dict[str, Any]], page: str, plot: Any, folder: Path) -> None:
    """Write JSON, page and plot beside each other, named after the graphics card, and print the page."""
    name = f"{name}-{slug(facts['card'].split('(')[0].split('/')[0])}"
    record(name, {**facts, "results": results}, page, folder)
    plot(facts, results, folder / f"{name}.png")
    print(page)
    print(f"wrote {folder / name}.json, .md and .png")


def record(name: str, content: dict[str, Any], page: str, folder: Path) -> None:
    """Write JSON and page beside each other."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    (folder / f"{name}.md").write_text(page, encoding="utf-8")


def pyplot() -> Any:
    """Return matplotlib's pyplot, which draws into files."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    return plt


# --------------------------------------------------------------------------------------------------- processes, windows


def why_it_failed(said: str, code: int) -> str:
    """Pass on what a process said, and return in a few words what it died of."""
    said = said.strip()
    print(said, file=sys.stderr)
    return f"failed: {said.splitlines()[-1]}" if said else f"failed: ended with {code}"


def too_long(seconds: float) -> str:
    """Return in a few words that a process was given no more time."""
    return f"takes more than {seconds:g} s here"


def run_child(script: str, arguments: Sequence[object], seconds: float) -> tuple[list[dict[str, Any]], str]:
    """Run a benchmark in a process of its own, so that memory is its own and nothing is warm.

    Parameters
    ----------
    script : str
    arguments : sequence
    seconds : float
        That it may take.

    Returns
    -------
    rows : list of dict
        Lines of JSON that it printed before it ended, or before its time was up.
    reason : str
        Why there are no more; empty if it ended well.
    """
    environment = dict(os.environ)
    if sys.platform.startswith("linux") and not environment.get("DISPLAY"):
        environment.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    command = [sys.executable, script, *map(str, arguments)]
    limit = None if seconds == float("inf") else seconds
    try:
        done = subprocess.run(command, capture_output=True, check=False, timeout=limit, env=environment)
        printed, reason = done.stdout, ""
        if done.returncode != 0:
            reason = why_it_failed((done.stderr or b"").decode(errors="replace"), done.returncode)
    except subprocess.TimeoutExpired as error:
        printed, reason = error.stdout or b"", too_long(seconds)
    lines = printed.decode().splitlines(keepends=True)
    return [json.loads(line) for line in lines if line.startswith("{") and line.endswith("}\n")], reason


def passed_on(options: Any, names: Iterable[str]) -> list[object]:
    """Return options as a child's command line; those that are None are left out."""
    found: list[object] = []
    for name in names:
        value = getattr(options, name)
        if value is not None:
            found += ["--" + name.replace("_", "-"), *(value if isinstance(value, (list, tuple)) else [value])]
    return found


class Window:
    """A PyVista window without anti-aliasing, drawn from cameras, each picture waited for."""

    def __init__(self, size: Sequence[int], background: str = "black", headlight: bool = True) -> None:
        import pyvista as pv

        lighting = {"lighting": "none"} if headlight else {}
        self.plotter = pv.Plotter(off_screen=True, window_size=list(size), **lighting)
        self.plotter.disable_anti_aliasing()
        self.plotter.set_background(background)
        if headlight:
            self.plotter.add_light(pv.Light(light_type="headlight"))

    def draw(self, camera: Camera) -> None:
        """Draw a picture and wait for it."""
        camera.aim(self.plotter)
        self.plotter.render()
        finish(self.plotter)

    def close(self) -> None:
        """Give all back."""
        self.plotter.close()


def finish(plotter: Any) -> None:
    """Wait until the picture is really there: reading one pixel needs all of it."""
    plotter.render_window.WaitForCompletion()
    plotter.render_window.GetPixelData(0, 0, 0, 0, 0, 0)


# ------------------------------------------------------------------------------------------------------------- brains


def make_brain(segments: float, step: float, folder: Path, order: str = "input") -> Any:
    """Return a set of about so many segments, from a file in a folder if it is there already."""
    from pvfiblets import FibletSet
    from pvfiblets.synthetic import brain

    count = max(1, round(segments * step / PER_STREAMLINE))
    path = folder / f"brain-{count}-{step:g}-{order}.fiblets"
    if not path.exists():
        unfinished = path.with_suffix(".part")
        brain(count, step, path=unfinished, order=order, progress=sys.stderr.isatty())
        unfinished.rename(path)
    return FibletSet.open(path)


def segments_of(fiblets: Any) -> int:
    """Return how many segments a set has."""
    return int(fiblets.n_points - fiblets.n_ranks)
