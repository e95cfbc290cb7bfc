"""What a browser sees of ``pvfiblets serve``: frames and latency while it drags, bytes, memory, many sessions at once.

A server and Chromium on this machine, over loopback: they share its processors. Each set is a synthetic brain that is
compressed beforehand::

    python scripts/browser_speed.py DIR [--millions 1 6 60] [--steps 0.1 0.5] [--sessions 8]

Writes report.json, a page and plots into DIR, as ``pvfiblets report`` does. It is no study because it opens pages by
the tests' means.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # the tests' server and pages

from pvfiblets.report import machine
from pvfiblets.report.record import FRAME, Axes, Figure, Record, StudyResult
from pvfiblets.report.report_file import Report
from pvfiblets.report.run import write_pages
from pvfiblets.report.studies.speed.cells import stored_brain
from pvfiblets.report.timing import timing
from tests.web.browsing import Served, Visit, launched

# Notes when each picture came, and its bytes.
COUNTING = """() => {
    window.came = [];
    const real = URL.createObjectURL;
    URL.createObjectURL = (blob) => { window.came.push([performance.now(), blob.size]); return real.call(URL, blob); };
}"""
MOVED = """() => { window.came.length = 0; window.moved = null;
    addEventListener('pointermove', () => { window.moved ??= performance.now(); }, { capture: true }); }"""
DRAGGED = 10.0  # seconds
TOUCHES = 10  # single moves, whose latency is measured
TOGETHER = 120.0  # seconds that many sessions last
SETTLE = 6.0  # seconds that the server has before a page opens
NOTES = (
    "Server and Chromium share the processors, over loopback; lines are dragged in circles for 10 s. *first*: from the "
    "address to a picture with something in it (goal: 3 s); *latency*: from one move of the pointer to the first "
    "picture after it; *rest*: messages in 3 s without a change; *memory*: of a session's process, and its share of "
    "what processes share. The goal is 8 frames a second, 125 ms, of 6 million segments.",
)


def main() -> None:
    """Measure, and write the report."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--millions", type=float, nargs="+", default=(1.0, 6.0, 60.0), help="segments")
    parser.add_argument("--steps", type=float, nargs="+", default=(0.1, 0.5), help="mm a segment")
    parser.add_argument("--sessions", type=int, default=8, help="at once; 0 for none")
    options = parser.parse_args()
    report = Report(machine.about(0, quick=False))
    axes = [Axes("frames", "times/frame", "costs/latency", "ms per frame", "latency, ms", alternatives=False)]
    found = StudyResult("browser", "In a browser", "Nothing: pages of `pvfiblets serve`.", list(NOTES), axes)
    report.studies.append(found)
    with tempfile.TemporaryDirectory() as spare, launched() as browser:
        for step in options.steps:
            for millions in options.millions:
                path = served_brain(Path(spare), millions, step)
                record = one_visit(browser, path, f"{millions:g} M segments of {step:g} mm")
                record.machine = report.about["name"]
                found.records.append(record)
                report.save(options.folder)
        if options.sessions:
            path = served_brain(Path(spare), min(options.millions), max(options.steps))
            found.records.append(together(browser, path, options.sessions))
    report.save(options.folder)
    print(write_pages(report, options.folder))


def served_brain(folder: Path, millions: float, step: float) -> Path:
    """Return a file of so many segments of so many mm, in a folder of its own."""
    home = folder / f"{millions:g}M-{step:g}mm"
    home.mkdir(exist_ok=True)
    stored_brain(1e6 * millions, step, home)
    (path,) = home.glob("*.fiblets")
    return path


def one_visit(browser: Any, path: Path, data: str) -> Record:
    """Return what one browser sees of one file."""
    with tempfile.TemporaryDirectory() as root:
        served = Served(path, root=root)
        try:
            visit = Visit(browser, served)
            time.sleep(SETTLE)
            began = time.monotonic()
            visit.page.goto(served.url)
            visit.page.wait_for_selector("#pv-view img[src^=blob]")
            while visit.picture().std() <= 1.0:
                visit.page.wait_for_timeout(20)
            first = time.monotonic() - began
            visit.rests()
            visit.page.evaluate(COUNTING)
            came = np.array(dragged(visit, DRAGGED))
            latency = float(np.median([late(visit) for _ in range(TOUCHES)]))
            visit.rests()
            resting = len(visit.received)
            visit.page.wait_for_timeout(3000)
            costs = {
                "first": Figure(first, "s"),
                "latency": Figure(latency, "ms"),
                "frame": Figure(float(np.median(came[:, 1])) / 1e3, "kB"),
                "rest": Figure(float(len(visit.received) - resting), "messages"),
                **memory(served),
            }
            frames = (1e-3 * np.diff(came[:, 0])).tolist()
            visit.close()
        finally:
            served.stop()
    times = {"frame": timing(frames, 1.0, FRAME, "wall")}
    return Record(data, "pages", "nothing", "dragged", "", {}, costs, times, ours=True, default=True)


def dragged(visit: Any, seconds: float) -> list[list[float]]:
    """Drag in circles, and return when each picture came, ms, and its bytes."""
    box = visit.page.locator("#pv-view").bounding_box()
    middle = np.array([box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]])
    reach = 0.2 * min(box["width"], box["height"])
    visit.page.mouse.move(*(middle + [reach, 0.0]))
    visit.page.mouse.down()
    visit.page.evaluate("() => { window.came.length = 0; }")
    began = time.monotonic()
    while (now := time.monotonic() - began) < seconds:
        visit.page.mouse.move(*(middle + reach * np.array([np.cos(now), np.sin(now)])))
        visit.page.wait_for_timeout(16)
    came: list[list[float]] = visit.page.evaluate("window.came")
    visit.page.mouse.up()
    visit.rests()
    return came


def late(visit: Any) -> float:
    """Return how many ms pass from one move of the pointer to the first picture after it."""
    box = visit.page.locator("#pv-view").bounding_box()
    visit.page.mouse.move(box["x"] + 0.45 * box["width"], box["y"] + 0.5 * box["height"])
    visit.page.mouse.down()
    visit.page.wait_for_timeout(700)  # until the full picture has come
    visit.page.evaluate(MOVED)
    visit.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.52 * box["height"])
    visit.wait(lambda: visit.page.evaluate("window.came.length > 0"), "a picture")
    found = visit.page.evaluate("window.came[0][0] - window.moved")
    visit.page.mouse.up()
    return float(found)


def memory(served: Any) -> dict[str, Figure]:
    """Return the memory of a server's sessions: resident, and their part of shared memory."""
    total = {"Rss:": 0, "Pss:": 0}
    for thread in Path(f"/proc/{served.process.pid}/task").iterdir():
        for child in (thread / "children").read_text().split():
            for row in Path(f"/proc/{child}/smaps_rollup").read_text().splitlines():
                name, *rest = row.split()
                if name in total:
                    total[name] += 1024 * int(rest[0])
    names = {"memory": "Rss:", "share of memory": "Pss:"}
    return {name: Figure(total[key] / 1e6, "MB") for name, key in names.items()}


def together(browser: Any, path: Path, sessions: int) -> Record:
    """Return what many sessions at once saw: pictures, errors, and memory after less before."""
    with tempfile.TemporaryDirectory() as root:
        served = Served(path, "--limit", str(sessions), root=root)
        try:
            visits = [Visit(browser, served, width=800, height=600) for _ in range(sessions)]
            for visit in visits:
                visit.open()
                visit.page.evaluate(COUNTING)
                dragged(visit, 1.0)
            before, pictures = memory(served), 0
            began = time.monotonic()
            while time.monotonic() - began < TOGETHER:
                pictures += sum(len(dragged(visit, 1.0)) for visit in visits)
            grown = memory(served)["memory"].value - before["memory"].value
            alive = sum(bool(visit.layers() == 1 and visit.picture().std() > 1.0) for visit in visits)
            errors = sum(len(visit.errors) for visit in visits)
            for visit in visits:
                visit.close()
        finally:
            served.stop()
    costs = {
        "lost": Figure(float(sessions - alive), "sessions"),
        "errors": Figure(float(errors), "on consoles"),
        "grown": Figure(grown, "MB"),
        **before,
    }
    setting = f"{pictures} pictures in {TOGETHER:g} s"
    return Record(f"{sessions} sessions at once", "", "nothing", "dragged in turn", setting, {}, costs, ours=True)


if __name__ == "__main__":
    main()
