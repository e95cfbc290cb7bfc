"""Cameras for the tests of the float64 reference of halos, under which closed forms are short, and lines to see."""

from __future__ import annotations

import numpy as np

from pvfiblets.halos import HaloLines
from pvfiblets.report.studies.halos.reference import HALO, LINE, NOTHING

SIZE = (80, 60)
NEAR, FAR = 50.0, 250.0
PLAIN = {"n_tapered": 0, "min_width": 0.0, "smooth": False}


def parallel(size=SIZE):
    """The middle of the picture looks along +z from z = 0; one pixel per mm; y is up."""
    w, h = size
    return np.array([
        [2 / w, 0, 0, 0], [0, 2 / h, 0, 0], [0, 0, 2 / (FAR - NEAR), -(FAR + NEAR) / (FAR - NEAR)], [0, 0, 0, 1.0],
    ])  # fmt: skip


def perspective(size=SIZE, *, focal=100.0):
    """The same with the eye at 0: what is z mm away takes focal / z pixels per mm."""
    w, h = size
    return np.array([
        [2 * focal / w, 0, 0, 0], [0, 2 * focal / h, 0, 0],
        [0, 0, (FAR + NEAR) / (FAR - NEAR), -2 * FAR * NEAR / (FAR - NEAR)], [0, 0, 1.0, 0],
    ])  # fmt: skip


CAMERAS = {"parallel": parallel, "perspective": perspective}


def window_depth(z, camera="parallel"):
    """Of a place z mm away."""
    if camera == "perspective":
        return FAR * (z - NEAR) / (z * (FAR - NEAR))
    return (z - NEAR) / (FAR - NEAR)


def line(*points, **values):
    return HaloLines(np.array(points, float), [0, len(points)], {k: np.array(v, float) for k, v in values.items()})


def lines(*several):
    return HaloLines(np.concatenate(several).astype(float), np.cumsum([0, *map(len, several)]))


def centres(size=SIZE):
    """x and y of the pixels' centres, from the picture's middle."""
    w, h = size
    y, x = np.mgrid[:h, :w] + 0.5
    return x - w / 2, y - h / 2


def kinds(inked, there):
    return np.where(inked & there, LINE, np.where(there, HALO, NOTHING))
