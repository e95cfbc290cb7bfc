"""What each feature costs a frame, beside the same scene with every feature off.

A made-up brain turns in a PyVista window, 1.14 degrees a frame. Every feature's frames take turns with frames that have
none on; the picture right after a change is timed on its own, as *change*: it is what dragging costs::

    python benchmarks/features.py --segments 6e6 --folder /tmp --output docs/benchmarks

writes ``features-CARD.json``, ``.md`` and ``.png``, named after the card.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from orbit import DEGREES_PER_FRAME, add_places, card_slug, machine, make_brain, segments_of, write

from pvfiblets import regions

Step = Callable[[Any, int], Any]


def torus(scale: float) -> Any:
    """Return a closed surface with a hole."""
    return pv.ParametricTorus(ringradius=0.6 * scale, crosssectionradius=0.25 * scale).clean()


def features(fiblets) -> dict[str, tuple[Step, Callable[[Any], Any]]]:
    """Return, by name, what turns a feature on, or changes it for the n-th time, and what turns it off."""
    box = np.array(fiblets.bounds).reshape(3, 2)
    centre, half = box.mean(1), (box[:, 1] - box[:, 0]).max() / 2
    x, y, z = centre
    ring = torus(half)
    surfaces: list[Any] = []

    def clip_mesh(actor, n):
        from pvfiblets.plotting.region_sources import as_region

        if not surfaces:
            surfaces.append(as_region(ring))
        matrix = np.eye(4)
        matrix[:3, 3] = centre + (n % 20, 0, 0)
        actor.clip(surfaces[0].moved(matrix), name="clip")

    def volume(actor, n):
        if n == 0:
            grid = np.indices((64, 64, 64)).sum(0).astype(np.float32)
            affine = np.diag([*((box[:, 1] - box[:, 0]) / 63.0), 1.0])
            affine[:3, 3] = box[:, 0]
            actor.scalars = grid, affine

    def choose(actor, n):
        actor.select(np.arange(n, fiblets.n_streamlines, 20))

    def tubes(actor, n):
        if n == 0:
            actor.selection_style(as_tubes=True, radius=0.5)
        actor.select(np.arange(n, fiblets.n_streamlines, 200))

    def let_go(actor):
        actor.deselect()
        actor.selection_style(as_tubes=False)

    def set_to(name: str, on: Any = True, off: Any = False):
        return (lambda actor, _: setattr(actor, name, on)), (lambda actor: setattr(actor, name, off))

    def wide_tubes(actor, _):
        actor.line_width, actor.tube_shading = 3, True

    def thin(actor):
        actor.tube_shading, actor.line_width = False, 1

    def layers(actor, _):
        actor.opacity, actor.transparency = 0.4, "layers"

    def opaque(actor):
        actor.transparency, actor.opacity = None, 1.0

    def colour(name: str):
        def on(actor, _):
            actor.scalars = name

        return on, lambda actor: setattr(actor, "scalars", None)

    unclip = lambda actor: actor.unclip()  # noqa: E731
    no_criteria = lambda actor: actor.remove_criterion()  # noqa: E731
    free = lambda actor: actor.remove_condition()  # noqa: E731
    return {
        "clip: plane": (lambda actor, n: actor.clip(((1, 0, 0), (x + n % 20 - 10, y, z)), name="clip"), unclip),
        "clip: box": (
            lambda actor, n: actor.clip(
                (x - 40 + n % 20, x + 40, y - 40, y + 40, z - 40, z + 40), name="clip"
            ),
            unclip,
        ),
        "clip: slab of 5 mm": (lambda actor, n: actor.clip_slab("y", y + n % 20, 5.0, name="clip"), unclip),
        f"clip: torus of {ring.n_cells:,} triangles": (clip_mesh, unclip),
        "criterion: length": (lambda actor, n: actor.criterion("length", (40.0 + n % 20, 100.0)), no_criteria),
        "criterion: curvature, per point": (
            lambda actor, n: actor.criterion("curvature", (0.0, 0.05 + 0.001 * (n % 20))),
            no_criteria,
        ),
        "include: passes through a ball": (
            lambda actor, n: actor.include(regions.Sphere((x + 20 + n % 10, y, z), 15.0), name="ball"),
            free,
        ),
        "selection: a twentieth, the rest dimmed": (choose, lambda actor: actor.deselect()),
        "selection: 0.5 % as tubes": (tubes, let_go),
        "illuminated lines": set_to("illuminated"),
        "ambient occlusion": set_to("ambient_occlusion"),
        "depth cueing": set_to("depth_cue"),
        "halos": set_to("halos"),
        "lines of 3 pixels, shaded as tubes": (wide_tubes, thin),
        "layers: four, blended": (layers, opaque),
        "colours: one": set_to("color", "red", None),
        "colours: a volume": (volume, lambda actor: setattr(actor, "scalars", None)),
        "colours: arc length": colour("arc_length"),
    }


def main() -> None:
    """Measure, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--segments", type=float, default=6e6)
    parser.add_argument("--step", type=float, default=0.5, help="mm between points")
    parser.add_argument("--frames", type=int, default=7, help="frames that count, of each feature")
    parser.add_argument("--only", help="features whose names hold this")
    add_places(parser)
    parser.set_defaults(size=(1024, 768))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        fiblets = make_brain(options.segments, options.step, options.folder or Path(temporary))
        plotter = pv.Plotter(off_screen=True, window_size=list(options.size))
        actor = plotter.add_fiblets(fiblets)
        plotter.view_vector((1.0, 0.8, 0.5), (0.0, 0.0, 1.0))
        plotter.camera.zoom(1.4)
        plotter.show(auto_close=False)
        results = measure_all(plotter, actor, fiblets, options)
        from pvfiblets.mappers.windows import borrowed_context

        with borrowed_context(plotter.render_window) as ctx:
            about = {
                **machine(ctx),
                "size": list(options.size),
                "step_mm": options.step,
                "segments": segments_of(fiblets),
                "pipeline": actor.pipeline_in_use,
            }
            slug = card_slug(ctx)
        plotter.close()
        del fiblets, actor
    write(options.output / f"features-{slug}", about, results, table(about, results), plot)


def frame(plotter) -> float:
    """Turn, draw, and return the seconds it took."""
    plotter.camera.azimuth += DEGREES_PER_FRAME
    start = time.perf_counter()
    plotter.render()
    plotter.render_window.WaitForCompletion()
    return time.perf_counter() - start


def measure_all(plotter, actor, fiblets, options) -> list[dict]:
    """Time every feature's frames and changes, and frames without beside them."""
    for _ in range(3):
        frame(plotter)
    results = []
    for name, (on, off) in features(fiblets).items():
        if options.only and options.only not in name:
            continue
        base, with_it, changes = [], [], []
        on(actor, 0)  # what is measured or compiled once
        frame(plotter)
        for n in range(1, options.frames + 1):
            start = time.perf_counter()
            on(actor, n)
            plotter.render()
            plotter.render_window.WaitForCompletion()
            changes.append(time.perf_counter() - start)
            frame(plotter)
            with_it.append(frame(plotter))
            if n == 1:
                report = actor.explain()
            off(actor)
            frame(plotter)
            base.append(frame(plotter))
            on(actor, 0)
            frame(plotter)
        off(actor)
        results.append(
            {
                "feature": name,
                "ms": 1e3 * float(np.median(with_it)),
                "base_ms": 1e3 * float(np.median(base)),
                "change_ms": 1e3 * float(np.median(changes)),
                "fiblets_in_frustum": report["fiblets"]["in_frustum"],
                "fiblets_total": report["fiblets"]["total"],
                "gpu_bytes": report["gpu_bytes"],
            }
        )
        print(results[-1], flush=True)
    return results


def table(about: dict, results: list[dict]) -> str:
    """Return the results in Markdown."""
    width, height = about["size"]
    lines = [
        f"# What features cost on {about['card']}",
        "",
        f"{about['driver']}, {about['system']}, {about['cpus']} CPU cores, {about['date']}; pipeline "
        f"`{about['pipeline']}`, {about['segments'] / 1e6:,.1f} M segments of {about['step_mm']:g} mm, "
        f"{width}×{height}, in a PyVista window, all of VTK's work included. *off*: the same frames with every feature "
        "off, in turns; *change*: setting the feature anew and drawing, which is what dragging costs; *fiblets*: the "
        "share of all that is left to draw.",
        "",
        "| feature | ms per frame, median | off | more | change | fiblets |",
        "|---|---|---|---|---|---|",
    ]
    for row in results:
        left = row["fiblets_in_frustum"] / max(row["fiblets_total"], 1)
        lines.append(
            f"| {row['feature']} | {row['ms']:.0f} | {row['base_ms']:.0f} | {row['ms'] - row['base_ms']:+.0f} "
            f"| {row['change_ms']:.0f} | {100 * left:.0f} % |"
        )
    return "\n".join(lines) + "\n"


def plot(about: dict, results: list[dict], path: Path) -> None:
    """Draw the cost of each feature beside that of none."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    names = [row["feature"] for row in results][::-1]
    places = np.arange(len(names))
    figure, axes = plt.subplots(figsize=(8, 0.35 * len(names) + 1.2), layout="constrained")
    axes.barh(places + 0.2, [row["base_ms"] for row in results][::-1], 0.35, label="off", color="silver")
    axes.barh(places - 0.2, [row["ms"] for row in results][::-1], 0.35, label="on", color="tab:blue")
    axes.set_yticks(places, names)
    axes.set_xlabel("ms per frame")
    axes.set_title(f"{about['segments'] / 1e6:,.1f} M segments, {about['card'].split('(')[0].strip()}")
    axes.legend(loc="lower right")
    figure.savefig(path, dpi=110)
    plt.close(figure)


if __name__ == "__main__":
    main()
