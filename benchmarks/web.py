"""What a browser sees of ``pvfiblets serve``: frames a second and latency while it drags, bytes, memory, many at once.

A server and Chromium on this machine, over loopback: they share its processors. Each size is a synthetic brain that is
compressed beforehand::

    python benchmarks/web.py --output docs/benchmarks

writes ``web-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from common import machine, make_brain, on_machine, pyplot, verdict, write

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))  # the tests' server and pages

GOALS = {"frames_per_second": 8.0, "first_picture_s": 3.0}
"""Of 6 million segments while dragging, and of a file that is ready."""

# Notes when each picture came, and its bytes.
COUNTING = """() => {
    window.came = [];
    const real = URL.createObjectURL;
    URL.createObjectURL = (blob) => { window.came.push([performance.now(), blob.size]); return real.call(URL, blob); };
}"""


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--millions", type=float, nargs="+", default=(1.0, 6.0, 60.0), help="segments")
    parser.add_argument("--steps", type=float, nargs="+", default=(0.1, 0.5), help="mm a segment")
    parser.add_argument("--seconds", type=float, default=10.0, help="of dragging")
    parser.add_argument("--settle", type=float, default=6.0, help="that the server has before a page opens")
    parser.add_argument("--touches", type=int, default=10, help="single moves, whose latency is measured")
    parser.add_argument("--sessions", type=int, default=8, help="at once; 0 for none")
    parser.add_argument("--together", type=float, default=120.0, help="seconds that they last")
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 720), help="of the browser's window")
    parser.add_argument("--folder", type=Path, help="where synthetic brains are kept; a temporary one if left out")
    parser.add_argument("--output", type=Path, default=Path())
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as spare:
        folder = options.folder or Path(spare)
        folder.mkdir(parents=True, exist_ok=True)
        results, many = measure(options, folder)
    about = {**machine(), "size": list(options.size), "seconds": options.seconds, "together": many}
    write("web", about, results, table(about, results, many), plot, options.output)


def measure(options: Any, folder: Path) -> tuple[list[dict[str, Any]], dict[str, Any] | None]:
    """Return the rows of all sizes, and what many sessions did."""
    from playwright import sync_api

    from tests.web.browsing import FLAGS, chromium

    results, many = [], None
    with sync_api.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium(), args=list(FLAGS))
        for step in options.steps:
            for millions in options.millions:
                path = made(folder, millions, step)
                data = {"millions": millions, "step_mm": step, "file_bytes": path.stat().st_size}
                results.append({**data, **one(browser, path, options)})
                print(results[-1], flush=True)
        if options.sessions:
            many = together(browser, made(folder, min(options.millions), max(options.steps)), options)
            print(many, flush=True)
        browser.close()
    return results, many


def made(folder: Path, millions: float, step: float) -> Path:
    """Return a compressed synthetic brain of so many segments of so many mm."""
    home = folder / f"{millions:g}M-{step:g}mm"
    home.mkdir(exist_ok=True)
    make_brain(1e6 * millions, step, home, "hilbert")
    (path,) = home.glob("*.fiblets")
    return path


def one(browser: Any, path: Path, options: Any) -> dict[str, Any]:
    """Return what one browser sees of one file."""
    from tests.web.browsing import Served, Visit

    with tempfile.TemporaryDirectory() as root:
        served = Served(path, root=root)
        try:
            width, height = options.size
            visit = Visit(browser, served, width=width, height=height)
            time.sleep(options.settle)
            began = time.monotonic()
            visit.page.goto(served.url)
            visit.page.wait_for_selector("#pv-view img[src^=blob]")
            while visit.picture().std() <= 1.0:
                visit.page.wait_for_timeout(20)
            first = time.monotonic() - began
            visit.rests()
            visit.page.evaluate(COUNTING)
            came = dragged(visit, options.seconds)
            waits = [latency(visit) for _ in range(options.touches)]
            visit.rests()
            resting = len(visit.received)
            visit.page.wait_for_timeout(3000)
            view = visit.picture().shape
            found = {
                "first_picture_s": first,
                "frames_per_second": (len(came) - 1) / (came[-1][0] - came[0][0]) * 1e3,
                "latency_ms": float(np.median(waits)),
                "latency_ms_spread": [float(np.percentile(waits, q)) for q in (10, 90)],
                "bytes_moving": float(np.median([size for _, size in came])),
                "messages_at_rest": len(visit.received) - resting,
                "view": [view[1], view[0]],
                **memory(served),
            }
            visit.close()
            return found
        finally:
            served.stop()


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
    came = visit.page.evaluate("window.came")
    visit.page.mouse.up()
    visit.rests()
    return came


def latency(visit: Any) -> float:
    """Return how many ms pass from one move of the pointer to the first picture after it."""
    box = visit.page.locator("#pv-view").bounding_box()
    visit.page.mouse.move(box["x"] + 0.45 * box["width"], box["y"] + 0.5 * box["height"])
    visit.page.mouse.down()
    visit.page.wait_for_timeout(700)  # until the full picture has come
    visit.page.evaluate(
        """() => { window.came.length = 0; window.moved = null;
            addEventListener('pointermove', () => { window.moved ??= performance.now(); }, { capture: true }); }"""
    )
    visit.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.52 * box["height"])
    visit.wait(lambda: visit.page.evaluate("window.came.length > 0"), "a picture")
    found = visit.page.evaluate("window.came[0][0] - window.moved")
    visit.page.mouse.up()
    return float(found)


def memory(served: Any) -> dict[str, int]:
    """Return the bytes of a server's sessions: resident, and their share of what they share."""
    resident = shared = count = 0
    for line in Path(f"/proc/{served.process.pid}/task").iterdir():
        for child in (line / "children").read_text().split():
            for row in Path(f"/proc/{child}/smaps_rollup").read_text().splitlines():
                name, *rest = row.split()
                resident += 1024 * int(rest[0]) if name == "Rss:" else 0
                shared += 1024 * int(rest[0]) if name == "Pss:" else 0
            count += 1
    return {"sessions": count, "resident_bytes": resident, "proportional_bytes": shared}


def together(browser: Any, path: Path, options: Any) -> dict[str, Any]:
    """Return what many sessions at once did: pictures of each, and memory at the start and at the end."""
    from tests.web.browsing import Served, Visit

    with tempfile.TemporaryDirectory() as root:
        served = Served(path, "--limit", str(options.sessions), root=root)
        try:
            visits = [Visit(browser, served, width=800, height=600) for _ in range(options.sessions)]
            for visit in visits:
                visit.open()
                visit.page.evaluate(COUNTING)
            for visit in visits:
                dragged(visit, 1.0)
            before, pictures = memory(served), [0] * len(visits)
            began = time.monotonic()
            while time.monotonic() - began < options.together:
                for k, visit in enumerate(visits):
                    pictures[k] += len(dragged(visit, 1.0))
            after = memory(served)
            errors = [error for visit in visits for error in visit.errors]
            alive = [bool(visit.layers() == 1 and visit.picture().std() > 1.0) for visit in visits]
            for visit in visits:
                visit.close()
        finally:
            served.stop()
    return {
        "seconds": options.together,
        "before": before,
        "after": after,
        "pictures": pictures,
        "errors": errors,
        "alive": alive,
    }


def line(row: dict[str, Any]) -> str:
    """Return a line of the table."""
    low, high = row["latency_ms_spread"]
    cells = (
        f"{row['millions']:g} M",
        f"{row['step_mm']:g}",
        f"{row['file_bytes'] / 1e6:.1f}",
        f"{row['view'][0]}×{row['view'][1]}",
        f"{row['first_picture_s']:.1f}",
        f"{row['frames_per_second']:.1f}",
        f"{row['latency_ms']:.0f} ({low:.0f}–{high:.0f})",
        f"{row['bytes_moving'] / 1e3:.0f}",
        f"{row['messages_at_rest']}",
        f"{row['resident_bytes'] / 1e6:.0f} / {row['proportional_bytes'] / 1e6:.0f}",
    )
    return "| " + " | ".join(cells) + " |"


def table(about: dict[str, Any], results: list[dict[str, Any]], many: dict[str, Any] | None) -> str:
    """Return the page."""
    width, height = about["size"]
    said = [
        f"# pvfiblets serve in a browser on {about['card']}",
        "",
        f"{on_machine(about)}. Server and Chromium share "
        f"them, over loopback; a window of {width}×{height}, of which the panels leave the view. Streamlines drawn as "
        f"lines, dragged for {about['seconds']:g} s.",
        "",
        "*first*: seconds from the address to a picture with something in it, of a server that is up for a while; "
        "*latency*: ms from one move of the pointer to the first picture after it, 10th to 90th percentile; *rest*: "
        "messages in 3 s without a change; *memory*: MB of a session's process, and its share of what processes share.",
        "",
        "| segments | mm each | file, MB | view | first, s | frames a second | latency, ms | kB a frame | rest | "
        "memory, MB |",
        "|---|---|---|---|---|---|---|---|---|---|",
        *map(line, results),
        "",
    ]
    said += [
        f"The goals, of {row['step_mm']:g} mm: {GOALS['frames_per_second']:g} frames a second while 6 M segments are "
        f"dragged, "
        f"{verdict(row['frames_per_second'] >= GOALS['frames_per_second'])}; the first picture within "
        f"{GOALS['first_picture_s']:g} s, {verdict(row['first_picture_s'] <= GOALS['first_picture_s'])}."
        for row in results
        if row["millions"] == 6.0
    ]
    if many is not None:
        before, after, pictures = many["before"], many["after"], many["pictures"]
        said += [
            "",
            f"{len(pictures)} sessions at once for {many['seconds']:g} s: {sum(pictures)} pictures, {min(pictures)} to "
            f"{max(pictures)} each; {sum(many['alive'])} alive at the end, {len(many['errors'])} errors on consoles. "
            f"Processes took {before['resident_bytes'] / 1e6:.0f} MB before and {after['resident_bytes'] / 1e6:.0f} MB "
            f"after ({before['proportional_bytes'] / 1e6:.0f} and {after['proportional_bytes'] / 1e6:.0f} by shares).",
        ]
    return "\n".join(said) + "\n"


def plot(about: dict[str, Any], results: list[dict[str, Any]], path: Path) -> None:
    """Draw frames a second and latency against segments."""
    plt = pyplot()
    figure, left = plt.subplots(figsize=(6, 4))
    right = left.twinx()
    for step, style in zip(sorted({row["step_mm"] for row in results}), ("-", "--", ":", "-."), strict=False):
        rows = [row for row in results if row["step_mm"] == step]
        sizes = [row["millions"] for row in rows]
        rates, waits = ([row[name] for row in rows] for name in ("frames_per_second", "latency_ms"))
        left.loglog(sizes, rates, "o" + style, color="tab:blue", label=f"{step:g} mm")
        right.loglog(sizes, waits, "s" + style, color="tab:red")
    left.axhline(GOALS["frames_per_second"], color="tab:blue", linestyle=":")
    left.set_title(f"dragged in a window of {about['size'][0]}×{about['size'][1]}")
    left.set_xlabel("segments, millions")
    left.set_ylabel("frames a second", color="tab:blue")
    left.legend(title="a segment")
    right.set_ylabel("latency, ms", color="tab:red")
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


if __name__ == "__main__":
    main()
