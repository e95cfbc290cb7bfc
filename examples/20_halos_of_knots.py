"""
Halos of knots
==============

Knots as in a book of mathematics, the three displacement functions side by side, and a page for the printer.

Run it as ``python examples/20_halos_of_knots.py [FOLDER]``. Pictures like figures 16 and 17 of Everts et al. 2009.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

TORUS, TUBE = 20.0, 8.0  # mm, radii of the torus


def torus_knot(p: int, q: int, strands: int = 1, tube: float = TUBE) -> list[np.ndarray]:
    """Return a line that runs p times around a torus and q times through it, or several side by side."""
    t = np.linspace(0.0, 2.0 * np.pi, 1500)
    lines = []
    for shift in np.linspace(-0.14, 0.14, strands) if strands > 1 else [0.0]:
        ring = TORUS + tube * np.cos(q * t + shift * q)
        lines.append(np.stack([ring * np.cos(p * t), ring * np.sin(p * t), -tube * np.sin(q * t + shift * q)], axis=1))
    return lines


def figure_eight() -> list[np.ndarray]:
    """Return the knot of four crossings, which lies on no torus."""
    t = np.linspace(0.0, 2.0 * np.pi, 1500)
    ring = TORUS * (2.0 + np.cos(2.0 * t)) / 2.2
    return [np.stack([ring * np.cos(3.0 * t), ring * np.sin(3.0 * t), TUBE * np.sin(4.0 * t)], axis=1)]


def ball_of_wool(turns: int = 110, seed: int = 4) -> list[np.ndarray]:
    """Return circles around a ball, in bundles: neighbours in some places, crossings in others."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0.0, 2.0 * np.pi, 240)
    lines = []
    for bundle in range(turns // 10):
        axis = rng.normal(size=3)
        for strand in range(10):
            normal = axis / np.linalg.norm(axis) + rng.normal(0.0, 0.06, 3)
            first = np.cross(normal, (0.3, 0.5, 0.8))
            first /= np.linalg.norm(first)
            second = np.cross(normal, first) / np.linalg.norm(normal)
            radius = 25.0 - 0.5 * bundle - 0.05 * strand
            lines.append(radius * (np.cos(t)[:, None] * first + np.sin(t)[:, None] * second))
    return lines


def main(folder: Path) -> None:
    """Write a page of knots at 300 dots per inch, one bit each, and a ball of wool three times."""
    folder.mkdir(parents=True, exist_ok=True)
    knots = [torus_knot(2, 3), torus_knot(3, 7, tube=7.0), figure_eight(), torus_knot(2, 5, strands=7, tube=10.0)]
    page = pv.Plotter(off_screen=True, window_size=(1200, 320), shape=(1, len(knots)), border=False)
    page.set_background("white", all_renderers=True)
    for index, knot in enumerate(knots):
        page.subplot(0, index)
        width = 1.6 if len(knot) == 1 else 0.45
        # These lines are closed: their ends need not narrow.
        page.add_halo_lines(knot, line_width=width, strip_width=5.5, max_displacement=8.0, tapering=False)
        page.view_vector((0.25, -0.45, 1.0), viewup=(0, 1, 0))
        page.camera.zoom(1.4)
    printed = page.halo_lines.screenshot(folder / "halos_of_knots.png", scale=3, one_bit=True, dpi=300)
    print(f"{printed.shape[1]} x {printed.shape[0]} dots, black or white")
    page.close()

    wool, widths = ball_of_wool(), {"line_width": 0.35, "strip_width": 3.0, "max_displacement": 6.0}
    plotter = pv.Plotter(off_screen=True, window_size=(1350, 460), shape=(1, 3), border=False)
    plotter.set_background("white", all_renderers=True)
    for index, displacement in enumerate(("square", "linear", "square root")):
        plotter.subplot(0, index)
        plotter.add_halo_lines(wool, **widths, displacement=displacement, tapering=False)
        plotter.add_text(displacement, color="black", font_size=10)
        plotter.camera.zoom(1.4)
    plotter.halo_lines.screenshot(folder / "displacement_functions.png", supersampling=2)
    plotter.close()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
