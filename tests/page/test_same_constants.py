"""Numbers that stand in shaders, in Python and in TypeScript are the same ones."""

import re
from pathlib import Path

import numpy as np

from pvfiblets.mappers.effects import gathering
from pvfiblets.plotting.slices import plane

ROOT = Path(__file__).resolve().parents[2]


def numbers(path, pattern):
    """Numbers of the only place of a file that a pattern fits."""
    (found,) = re.findall(pattern, (ROOT / path).read_text())
    return [float(number) for number in re.findall(r"-?\d+\.?\d*", found)]


def test_light_comes_from_one_direction():
    shader = numbers("shaders/frame/gentle_light.glsl", r"const vec3 SHOULDER = vec3\((.*?)\)")
    script = numbers("client/src/translucent.ts", r"const SHOULDER: Vec = \[(.*?)\]")
    np.testing.assert_allclose(shader, gathering._SHOULDER, atol=1e-8)
    np.testing.assert_allclose(script / np.linalg.norm(script), gathering._SHOULDER, rtol=1e-12)


def test_edges_of_slices_are_cut_at_the_same_alpha():
    pages = numbers("shaders/page/image.frag", r"clear == 0 \? (.*?)\) discard")
    plotters = [float(*re.findall(r"a <=? ([\d.]+)", code)) for code in (plane._CUT, plane._CLEAR)]
    assert pages == plotters
