"""The paper's Table I: what depth of field, sparse casting, screen-space ambient occlusion and `recon` cost a frame.

Each is measured in two PyVista windows that take turns, one with it and one without (Lesar 2015, section IV): a static
view of 1024x1024 that is drawn anew each time, and a circle of 512x512. Beside the time stands how much of the picture
it changes: for sparse casting and recon, which ought to change nothing, that is an error.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from common import to_table
from volumes_data import make_data
from volumes_methods import Plotter
from volumes_timing import FrameTimes, nudged

from pvfiblets.report.studies.volumes.scene import circle, look_of

PAPER = {
    "dof": {"static": (15.70, 16.15), "circle": (14.25, 14.63)},
    "sparse-2": {"static": (14.48, 16.11), "circle": (16.84, 14.23)},
    "ssao": {"static": (15.64, 16.20), "circle": (14.33, 15.02)},
    "recon": {"static": (16.75, 16.04), "circle": (15.93, 14.74)},
}
"""Its frames a second, with and without; its sparse casting has k = 2."""

DIFFERS = 4  # levels of 255: more than that is another colour
SHOWN = 2  # pictures in which pixels are compared


class AbsentError(Exception):
    """There is no such effect here."""


def _depth_of_field(method: Plotter) -> None:
    picture = getattr(method.plotter, "picture", None)
    if picture is None or not hasattr(picture, "depth_of_field"):
        raise AbsentError("there is no plotter.picture.depth_of_field here")
    picture.depth_of_field = True


def _of_actor(name: str, value: Any) -> Any:
    def switch(method: Plotter) -> None:
        if not hasattr(type(method.actor), name):
            raise AbsentError(f"volumes have no {name} here")
        setattr(method.actor, name, value)

    return switch


EFFECTS = {
    "dof": _depth_of_field,
    "sparse-2": _of_actor("sparse", 2),
    "sparse-4": _of_actor("sparse", 4),
    "ssao": _of_actor("ambient_occlusion", True),
    "recon": _of_actor("recon", True),
    "ray-occlusion": _of_actor("ray_occlusion", True),
}
"""The last one is not in the table: rays from each hit, section III.G, equation 10."""

WITHOUT = {"recon": _of_actor("recon", False)}
"""Of effects that are there unless they are taken away."""

OWN_MODE = {"recon": "composite"}
"""Of effects that other modes do not have."""

ABOUT = {
    "dof": "depth of field, `plotter.picture.depth_of_field`",
    "sparse-2": "a ray for every second pixel along each axis first (section III.D), `actor.sparse`",
    "sparse-4": "for every fourth",
    "ssao": "screen-space ambient occlusion, `actor.ambient_occlusion`",
    "recon": "no reconstruction where that does not show, of light, `actor.recon`; the paper's is of a filter",
    "ray-occlusion": "ambient occlusion by rays from every hit, `actor.ray_occlusion`: not in the paper's table",
}
COLUMNS = ("data", "effect", "view", "ms with", "without", "CPU ms with", "without", "×", "× CPU", "differing", "rms",
           "paper")  # fmt: skip


def effects(name: str, mode: str, wanted: list[str], options: Any) -> Iterator[dict[str, Any]]:
    """Return one after the other a row for each effect and view."""
    volume = make_data(name, options.seed, options.data_folder)
    for effect in wanted:
        shown = OWN_MODE.get(effect, mode)
        look = look_of(volume, shown)
        for view, side in (("static", options.still), ("circle", options.size)):
            common = {"data": name, "mode": shown, "effect": effect, "view": view}
            size = (side, side)
            cameras = circle(volume, options.frames, size)
            cameras = nudged(cameras[0], options.frames) if view == "static" else cameras
            methods = [Plotter("", volume, look, options.step, size) for _ in range(2)]
            try:
                EFFECTS[effect](methods[0])
                if effect in WITHOUT:
                    WITHOUT[effect](methods[1])
                yield {**common, **turns(methods, cameras, options.seconds)}
            except AbsentError as error:
                yield {**common, "unmeasured": str(error)}
            finally:
                for method in methods:
                    method.close()


def turns(methods: list[Plotter], cameras: list[Any], seconds: float) -> dict[str, Any]:
    """Return times with and without, which take turns, and how the pictures differ."""
    times = [FrameTimes(), FrameTimes()]
    pictures: list[tuple[np.ndarray, np.ndarray]] = []
    for method in methods:
        method.draw(cameras[-1])
    for k, camera in enumerate(cameras):
        order = (0, 1) if k % 2 == 0 else (1, 0)  # whoever comes second finds warmer caches
        for one in order:
            times[one].time(methods[one].draw, camera)
        if k < SHOWN:
            pictures.append((methods[0].picture(), methods[1].picture()))
        if sum(times[0].wall) + sum(times[1].wall) > 1e3 * seconds:
            break
    found = {"with": times[0].report(), "without": times[1].report()}
    return {**found, "speed_up": found["without"]["ms"] / found["with"]["ms"],
            "cpu_speed_up": found["without"]["cpu_ms"] / found["with"]["cpu_ms"], **differing(pictures)}  # fmt: skip


def differing(pictures: list[tuple[np.ndarray, np.ndarray]]) -> dict[str, float]:
    """Return in how many pixels pairs of pictures differ by more than `DIFFERS` levels, and than one; and their rms."""
    off = np.abs(np.stack([one - other for one, other in pictures]))
    levels = np.rint(255.0 * off).max(axis=-1)
    return {"differing": float((levels > DIFFERS).mean()), "differing_at_all": float((levels > 1).mean()),
            "rms": float(np.sqrt((off**2).mean()))}  # fmt: skip


def table(rows: list[dict[str, Any]]) -> list[str]:
    """Return the rows in Markdown."""
    if not rows:
        return []
    used = dict.fromkeys(row["effect"] for row in rows)
    lines = [
        "## The paper's Table I",
        "",
        "`plotter.add_raycast_volume`; with and without take turns. *×*: as many times as many "
        "frames with it, by the clock and by the processor's time. *differing*: pixels that it changes by more than "
        f"{DIFFERS} of 255, by more than 1 in brackets. *paper*: its frames a second, with and without.",
        "",
        *(f"- *{effect}*: {ABOUT[effect]}." for effect in used),
        "",
        *to_table(COLUMNS, ()),
    ]
    for row in rows:
        head = f"| {row['data']}, {row['mode']} | {row['effect']} | {row['view']} | "
        paper = PAPER.get(row["effect"], {}).get(row["view"])
        said = "" if paper is None else f"{paper[0]:.2f}, {paper[1]:.2f}"
        if "unmeasured" in row:
            lines.append(head + f"unmeasured: {row['unmeasured']} | | | | | | | | {said} |")
            continue
        cells = [f"{row[one]['ms']:.0f} ({row[one]['ms_spread'][0]:.0f}–{row[one]['ms_spread'][1]:.0f})"
                 for one in ("with", "without")]  # fmt: skip
        cells += [f"{row[one]['cpu_ms']:.0f}" for one in ("with", "without")]
        cells += [f"{row['speed_up']:.2f}", f"{row['cpu_speed_up']:.2f}"]
        cells += [f"{100 * row['differing']:.2f} % ({100 * row['differing_at_all']:.2f} %)", f"{row['rms']:.4f}", said]
        lines.append(head + " | ".join(cells) + " |")
    return [*lines, ""]
