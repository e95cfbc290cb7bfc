"""Frames per second, memory and load time of lines: VTK's poly-lines, VTK's tubes, and fiblets.

The camera orbits by 1.14 degrees a frame around a whole-brain-like tractogram at 1920x1080. Every
method of drawing runs in a process of its own, so that memory is its own too and none warms another
one up. Reported is the median of the frames after the warm-up. Lines are one pixel wide, lit and
coloured by orientation. A plotter's default is to multi-sample: that smooths VTK's lines, and costs
them time, but not fiblets. So poly-lines are also drawn without it (``polylines-aliased``), which
gives the same picture as fiblets::

    python benchmarks/lines.py --segments 1e5 1e6 6e6 --output lines.json

writes ``lines.json`` and ``lines.png``. A method is left out above the size given for it by
``--limit``, where a frame would take minutes.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from common import DEGREES_PER_FRAME, data_bytes, finish, machine, passed_on, percentiles, pyplot, run_child

METHODS = ("polylines", "polylines-aliased", "tubes", "fiblets")
SIZE = (1920, 1080)
STEP = 0.5


def main() -> None:
    """Run every method at every size, one process each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--segments", type=float, nargs="+", default=[1e5, 3e5, 1e6, 3e6, 6e6, 1e7])
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=list(METHODS))
    parser.add_argument("--frames", type=int, default=15, help="frames that count")
    parser.add_argument("--seconds", type=float, default=60.0, help="of drawing per run at most, once 3 frames count")
    parser.add_argument("--limit", type=float, default=1e6, help="most segments for tubes")
    parser.add_argument("--output", type=Path, default=Path("lines.json"))
    parser.add_argument("--run", nargs=2, metavar=("METHOD", "FILE"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.run:
        print(json.dumps(measure(*options.run, options.frames, options.seconds)))
        return
    options.output.parent.mkdir(parents=True, exist_ok=True)
    results = []
    with tempfile.TemporaryDirectory() as folder:
        for segments in options.segments:
            path, exact = make_file(Path(folder), int(segments))
            for method in options.methods:
                if method == "tubes" and segments > options.limit:
                    continue
                more = passed_on(options, ("frames", "seconds"))
                found, reason = run_child(__file__, ["--run", method, path, *more], float("inf"))
                if not found:
                    sys.exit(f"{method} at {exact} segments {reason}")
                results.append({"method": method, "segments": exact, **found[-1]})
                print(row(results[-1]), flush=True)
            path.unlink()
    about = {"machine": machine(), "size": SIZE, "degrees_per_frame": DEGREES_PER_FRAME, "step_mm": STEP}
    options.output.write_text(json.dumps({**about, "results": results}, indent=1))
    plot(results, options.output.with_suffix(".png"))
    print(f"wrote {options.output} and {options.output.with_suffix('.png')}")
    for line in compare(results):
        print(line)


def make_file(folder: Path, segments: int) -> tuple[Path, int]:
    """Write a tractogram with about this many segments; return its path and their exact number."""
    from pvfiblets import formats
    from pvfiblets.synthetic import brain_streamlines

    sample = brain_streamlines(2000, STEP)
    per_streamline = (sample.n_points - len(sample)) / len(sample)
    brain = brain_streamlines(max(1, round(segments / per_streamline)), STEP)
    path = folder / f"{segments}.tck"
    formats.write(path, brain)
    return path, brain.n_points - len(brain)


def measure(method: str, path: str, frames: int, seconds: float) -> dict:
    """Load one file in one method, orbit, and return the numbers."""
    import pyvista as pv

    from pvfiblets import formats

    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("black")
    if method == "polylines-aliased":
        plotter.disable_anti_aliasing()
    begin = time.perf_counter()
    compress_seconds = None
    if method == "fiblets":
        from pvfiblets.codec.compress import compress
        from pvfiblets.synthetic import brain_streamlines

        compress(brain_streamlines(10))  # the codec compiles itself when first used
        begin = time.perf_counter()
        streamlines = formats.read(path)
        fiblets = compress(streamlines, exact=False)
        compress_seconds = time.perf_counter() - begin
        n_points = streamlines.n_points
        del streamlines
        actor = plotter.add_fiblets(fiblets, render=False)
        gpu = None
    else:
        lines = pv.wrap(formats.read(path).to_polydata())
        n_points = lines.n_points
        lines["orientation"] = orientation(lines)
        if method == "tubes":
            lines = lines.tube(radius=0.25 * STEP, n_sides=6)
        actor = plotter.add_mesh(lines, scalars="orientation", rgb=True, render=False)
        gpu = vertex_bytes(lines)
    plotter.view_vector((-1, 0.8, 0.45), viewup=(0, 0, 1))
    plotter.show(auto_close=False)
    finish(plotter)
    load = time.perf_counter() - begin
    times = orbit(plotter, frames, seconds)
    if gpu is None:
        gpu = data_bytes(actor.explain())
    picture = plotter.screenshot(None)
    plotter.close()
    median = float(np.median(times))
    segments = n_points - int(count_lines(path))
    return {
        "points": n_points,
        **percentiles(times, "ms_per_frame"),
        "frames": len(times),
        "segments_per_second": segments / median,
        "gpu_bytes": gpu,
        "gpu_bytes_per_point": gpu / n_points,
        "peak_memory_bytes": peak_memory(),
        "load_seconds": load,
        "read_and_compress_seconds": compress_seconds,
        "pixels": int((picture.max(axis=2) > 0).sum()),
    }


def peak_memory() -> int:
    """Return the most memory that this process ever had, bytes; needs Linux or macOS."""
    import resource

    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit


def orbit(plotter, frames: int, seconds: float) -> list[float]:
    """Turn the camera and return the seconds of each frame, the first two left out."""
    times: list[float] = []
    began = time.perf_counter()
    for frame in range(frames + 2):
        plotter.camera.azimuth += DEGREES_PER_FRAME
        start = time.perf_counter()
        plotter.renderer.ResetCameraClippingRange()
        plotter.render()
        finish(plotter)
        if frame >= 2:
            times.append(time.perf_counter() - start)
        if len(times) >= 3 and time.perf_counter() - began > seconds:
            break
    return times


def orientation(lines) -> np.ndarray:
    """Return |tangent| as RGB per point, what fiblets are coloured by."""
    tangent = np.abs(np.gradient(lines.points, axis=0))
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True) + 1e-12
    return (255 * tangent).astype(np.uint8)


def vertex_bytes(mesh) -> int:
    """Return what VTK keeps on the GPU for a mesh: float32 points, RGBA bytes, normals, indices.

    Poly-lines are drawn as index pairs, strips as index triples, 4 bytes each.
    """
    lines = mesh.n_cells and mesh.lines.size - mesh.n_lines  # points named by all lines
    indices = 2 * max(lines - mesh.n_lines, 0)
    strips = mesh.strips
    if len(strips):
        at, triangles = 0, 0
        while at < len(strips):
            triangles += strips[at] - 2
            at += strips[at] + 1
        indices += 3 * triangles
    normals = 12 if mesh.point_data.active_normals is not None else 0
    return int(mesh.n_points * (12 + 4 + normals) + 4 * indices)


def count_lines(path: str) -> int:
    """Return how many streamlines a file has."""
    from pvfiblets import formats

    return sum(len(chunk) for chunk in formats.iter_chunks(path))


def row(result: dict) -> str:
    """Return one line of the table."""
    return (
        f"{result['method']:<18} {result['segments']:>12,} segments {result['ms_per_frame']:>10.1f} ms/frame "
        f"{result['segments_per_second'] / 1e6:>8.2f} M/s {result['gpu_bytes_per_point']:>7.2f} B/point on the GPU "
        f"{result['peak_memory_bytes'] / 1e6:>7.0f} MB peak {result['load_seconds']:>6.1f} s to load"
    )


def compare(results: list[dict]) -> list[str]:
    """Say how fiblets fare against VTK's poly-lines at each size."""
    lines = []
    for segments in sorted({result["segments"] for result in results}):
        at = {result["method"]: result["segments_per_second"] for result in results if result["segments"] == segments}
        lines += [
            f"{segments:>12,} segments: fiblets are {at['fiblets'] / at[other]:.1f} times as fast as {other}"
            for other in ("polylines", "polylines-aliased")
            if {"fiblets", other} <= set(at)
        ]
    return lines


def plot(results: list[dict], path: Path) -> None:
    """Draw speed, GPU memory, peak memory and load time over the number of segments."""
    plt = pyplot()
    panels = (
        ("ms_per_frame", "ms per frame", 1.0),
        ("segments_per_second", "million segments per second", 1e6),
        ("gpu_bytes_per_point", "GPU bytes per point", 1.0),
        ("peak_memory_bytes", "peak memory [MB]", 1e6),
        ("load_seconds", "load time [s]", 1.0),
    )
    figure, axes = plt.subplots(1, len(panels), figsize=(4 * len(panels), 3.6), layout="constrained")
    for axis, (key, label, unit) in zip(axes, panels, strict=True):
        for method in METHODS:
            chosen = [result for result in results if result["method"] == method]
            if chosen:
                x, y = [r["segments"] for r in chosen], [r[key] / unit for r in chosen]
                axis.loglog(x, y, "o-", label=method)
        axis.set_xlabel("segments")
        axis.set_ylabel(label)
        axis.grid(True, which="both", alpha=0.2)
    axes[0].legend()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
