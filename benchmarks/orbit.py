"""What the engine's benchmarks share: made-up brains, a camera that orbits them, and names for what they run on.

No VTK: the engine runs on a bare OpenGL context, headless where there is EGL.
"""

from __future__ import annotations

import contextlib
import json
import os
import platform
import re
import sys
import time
from pathlib import Path

import numpy as np

DEGREES_PER_FRAME = 1.14  # the paper's (Schertzer et al. 2022, section 4.5): 90 degrees a second at 80 frames
PER_STREAMLINE = 94.0  # mm, on average, of pvfiblets.synthetic.brain


def context():
    """Return a bare context: EGL, or this system's own way."""
    import moderngl

    if sys.platform.startswith("linux"):
        with contextlib.suppress(Exception):  # whatever the reason, there may be another way
            return moderngl.create_standalone_context(backend="egl")
    return moderngl.create_standalone_context()


def machine(ctx) -> dict:
    """Return what the numbers hold for."""
    return {
        "card": ctx.info["GL_RENDERER"],
        "driver": ctx.info["GL_VERSION"],
        "vendor": ctx.info["GL_VENDOR"],
        "cpus": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "date": time.strftime("%Y-%m-%d"),
    }


def card_slug(ctx) -> str:
    """Return the card's name as part of a file's name."""
    name = str(ctx.info["GL_RENDERER"]).split("(")[0].split("/")[0]
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-") or "unknown"


def add_places(parser) -> None:
    """Add the options for the picture's size, for the brains and for what is written."""
    parser.add_argument("--size", type=int, nargs=2, default=(1920, 1080))
    parser.add_argument("--folder", type=Path, help="where made-up brains are kept; a temporary one if left out")
    parser.add_argument("--output", type=Path, default=Path())


def write(stem: Path, about: dict, results: list[dict], table: str, plot) -> None:
    """Write JSON, table and plot beside each other, and print the table."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    stem.with_suffix(".json").write_text(json.dumps({**about, "results": results}, indent=1) + "\n")
    stem.with_suffix(".md").write_text(table)
    plot(about, results, stem.with_suffix(".png"))
    print(table)
    print(f"wrote {stem}.json, .md and .png")


def make_brain(segments: float, step: float, folder: Path, order: str = "input"):
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


def segments_of(fiblets) -> int:
    """Return how many segments a set has."""
    return int(fiblets.n_points - fiblets.n_ranks)


def view(fiblets, degrees: float, size: tuple[int, int]):
    """Return the view of a whole set from some angle around its vertical axis; it fills the picture's height."""
    from pvfiblets.engine import View

    box = np.array(fiblets.bounds).reshape(3, 2)
    centre, radius = box.mean(1), float(np.linalg.norm(box[:, 1] - box[:, 0])) / 2
    half_angle = np.radians(15.0)
    distance = 0.85 * radius / np.sin(half_angle)
    turn = np.radians(degrees + 141.0)
    eye = centre + distance * np.array([0.91 * np.cos(turn), 0.91 * np.sin(turn), 0.41])
    back = (eye - centre) / np.linalg.norm(eye - centre)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    camera = np.eye(4)
    camera[:3, :3] = right, np.cross(back, right), back
    camera[:3, 3] = -camera[:3, :3] @ eye
    near, far = distance - 1.2 * radius, distance + 1.2 * radius
    t = 1.0 / np.tan(half_angle)
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = t * size[1] / size[0], t
    projection[2, 2:] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
    projection[3, 2] = -1.0
    return View(size, projection @ camera)
