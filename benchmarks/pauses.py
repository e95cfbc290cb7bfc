"""How late a move is drawn after a pause within a drag, without a browser: what a whole picture holds up.

    python benchmarks/pauses.py --millions 6 60 --output docs/benchmarks

A stream of pictures as ``pvfiblets serve`` has it draws a synthetic brain. A thread drags over it, pauses so long that
a whole picture, or a sample of it, is being drawn, and moves again; until a picture of that move is ready, that many
milliseconds pass. Their times by the clock and, as machines are busy, what the process worked meanwhile: of whole
pictures that are drawn in pieces, as they are, and of the same drawn at once.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
from common import machine, make_brain, on_machine, record

from pvfiblets.mappers.ahead import draw_ahead

SIZE = (640, 692)
SETTLED = 3.0  # seconds before the first drag, in which programs are compiled
MOVES, BETWEEN = 15, 0.03  # of a drag, and seconds between them


class Times:
    """A streamer that notes when pictures are ready."""

    def __init__(self) -> None:
        self.pictures: list[tuple[float, int]] = []

    def push_content(self, _name: str, meta: dict[str, Any], _content: bytes) -> None:
        """Note one."""
        self.pictures.append((time.monotonic(), meta["w"]))


class Handled:
    """A stream whose moves note when they have been heard."""

    def __init__(self, stream: Any, loop: asyncio.AbstractEventLoop) -> None:
        self._stream, self._loop = stream, loop
        self._angle = 0.0
        self.at = 0.0  # when the last one was heard

    def event(self, kind: str) -> threading.Event:
        """Have the stream hear an event, as the network has it do."""
        done = threading.Event()
        width, height = SIZE
        x = 0.5 * width + 0.2 * height * np.cos(self._angle)
        y = 0.5 * height + 0.2 * height * np.sin(self._angle)
        self._angle += 0.05
        keys = {"ctrlKey": False, "altKey": False, "shiftKey": False}
        event = {"type": kind, "x": int(x), "y": int(y), "w": width, "h": height, **keys}

        def hear() -> None:
            self.at = time.monotonic()
            self._stream.on_interaction("", event)
            done.set()

        self._loop.call_soon_threadsafe(hear)
        return done


def late(stream: Any, loop: asyncio.AbstractEventLoop, times: Times, pause: float) -> tuple[float, float]:
    """Drag, pause, move, and return the ms until a picture of that move, by the clock and of the processor."""
    hand = Handled(stream, loop)
    hand.event("LeftButtonPress").wait()
    for _ in range(MOVES):
        hand.event("MouseMove").wait()
        time.sleep(BETWEEN)
    time.sleep(pause)
    began, worked = time.monotonic(), time.process_time()
    hand.event("MouseMove").wait()
    while not (later := [when for when, _ in times.pictures if when > hand.at]):
        time.sleep(0.001)
    found = later[0] - began, time.process_time() - worked
    hand.event("LeftButtonRelease").wait()
    return 1e3 * found[0], 1e3 * found[1]


def measure(data: Any, pauses: list[float], repeats: int, *, pieces: bool) -> dict[str, Any]:
    """Return what moves after pauses took with one set."""
    import pyvista as pv

    from pvfiblets.web.view import stream as module
    from pvfiblets.web.view.stream import PictureStream

    module.draw_ahead = draw_ahead if pieces else (lambda *_, **__: iter(()))
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.enable_trackball_style()
    plotter.add_fiblets(data)
    stream, times = PictureStream(plotter, "view"), Times()
    stream.update_size("", {"w": SIZE[0], "h": SIZE[1], "p": 1.0})
    rows: dict[str, list[tuple[float, float]]] = {}

    async def run() -> None:
        stream.set_streamer(times)
        loop = asyncio.get_running_loop()
        await asyncio.to_thread(late, stream, loop, times, SETTLED)  # compiles what moving frames need
        for _ in range(repeats):
            for pause in pauses:
                found = await asyncio.to_thread(late, stream, loop, times, pause)
                rows.setdefault(f"{pause:g}", []).append(found)
                times.pictures.clear()
        await stream.close()

    asyncio.run(run())
    plotter.close()
    found = np.array([row for each in rows.values() for row in each])
    return {
        "median_ms": float(np.median(found[:, 0])),
        "worst_ms": float(found[:, 0].max()),
        "median_cpu_ms": float(np.median(found[:, 1])),
        "worst_cpu_ms": float(found[:, 1].max()),
        "by_pause": {pause: np.round(each).tolist() for pause, each in rows.items()},
        "given_up": stream.given_up,
    }


def main() -> None:
    """Measure, and print or write what was found."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--millions", type=float, nargs="+", default=(6.0, 60.0), help="segments")
    parser.add_argument("--step", type=float, default=0.5, help="mm a segment")
    parser.add_argument("--pauses", type=float, nargs="+", default=(0.3, 0.5, 0.8, 1.5, 2.5), help="s")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--folder", type=Path, help="where synthetic brains are kept; a temporary one if left out")
    parser.add_argument("--output", type=Path, help="a folder for pauses-llvmpipe.json and .md")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as spare:
        folder = options.folder or Path(spare)
        results = []
        for millions in options.millions:
            data = make_brain(1e6 * millions, options.step, folder, "hilbert")
            for pieces in (False, True):
                found = measure(data, list(options.pauses), options.repeats, pieces=pieces)
                results.append({"millions": millions, "step_mm": options.step, "pieces": pieces, **found})
                print(json.dumps(results[-1]), flush=True)
    about = {**machine(), "size": SIZE}
    page = table(about, results)
    print(page)
    if options.output is not None:
        record("pauses-llvmpipe", {"about": about, "sets": results}, page, options.output)


def table(about: dict[str, Any], results: list[dict[str, Any]]) -> str:
    """Return the page."""
    pauses = ", ".join(results[0]["by_pause"])
    lines = [
        f"# A move after a pause within a drag, on {about['card']}", "",
        f"{on_machine(about)}. Milliseconds until a picture of the move is ready, by the clock and of the "
        f"processor, all cores together; {SIZE[0]}×{SIZE[1]} pixels, lines, pauses of {pauses} s.", "",
        "| segments | mm each | whole pictures | median | worst | processor: median | worst | given up |",
        "|---|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    for row in results:
        cells = (
            f"{row['millions']:g} M",
            f"{row['step_mm']:g}",
            "in pieces" if row["pieces"] else "at once",
            *(f"{row[name]:.0f}" for name in ("median_ms", "worst_ms", "median_cpu_ms", "worst_cpu_ms")),
            f"{row['given_up']}",
        )
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
