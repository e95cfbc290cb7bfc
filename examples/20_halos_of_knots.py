"""Halos of knots
==============

Knots as in a book of mathematics, for a black-and-white printer, and the three displacement functions.

Run it as ``python examples/20_halos_of_knots.py [FOLDER]``. Images like figures 16 and 17 of Everts et al. 2009.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)
t, bunch = np.linspace(0.0, 2.0 * np.pi, 1500), np.linspace(-0.14, 0.14, 7)
page = pv.Plotter(off_screen=True, window_size=(1200, 320), shape=(1, 4), border=False)
page.set_background("white", all_renderers=True)
# Lines that run p times around a torus and q times through it.
for index, (p, q, tube, shifts) in enumerate([(2, 3, 8, [0]), (3, 7, 7, [0]), (3, 4, 8, [0]), (2, 5, 10, bunch)]):
    turns = [(20 + tube * np.cos(q * (t + shift)), -tube * np.sin(q * (t + shift))) for shift in shifts]
    knot = [np.stack([ring * np.cos(p * t), ring * np.sin(p * t), z], axis=1) for ring, z in turns]
    page.subplot(0, index)
    page.add_halo_lines(knot, line_width=1.6 / len(knot) ** 0.65, strip_width=5.5, max_displacement=8, tapering=False)
    page.view_vector((0.25, -0.45, 1.0), viewup=(0, 1, 0))
    page.camera.zoom(1.4)
page.halo_lines.screenshot(folder / "halos_of_knots.png", scale=3, one_bit=True, dpi=300)
rng, circle = np.random.default_rng(4), np.stack([np.cos(t), np.sin(t)], axis=1)
axes = np.repeat(rng.normal(size=(14, 3, 2)), 10, axis=0) + rng.normal(0.0, 0.05, (140, 3, 2))
wool = [(25.0 - 0.05 * index) * circle @ np.linalg.qr(two)[0].T for index, two in enumerate(axes)]
plotter = pv.Plotter(off_screen=True, window_size=(1350, 460), shape=(1, 3), border=False)
plotter.set_background("white", all_renderers=True)
for index, name in enumerate(("square", "linear", "square root")):
    plotter.subplot(0, index)
    plotter.add_halo_lines(wool, line_width=0.35, strip_width=3, max_displacement=6, displacement=name, tapering=False)
    plotter.add_text(name, position="lower_edge", color="black", font_size=18)
    plotter.camera.zoom(1.4)
plotter.halo_lines.screenshot(folder / "displacement_functions.png", supersampling=2)
