"""Makes docs/pictures/light.jpg, the lights that lines could have side by side: ``python docs/light_pictures.py``.

One picture of a brain is rendered, from its left, and lit by each formula in NumPy: the G-buffer tells the tangent of
each pixel. The table that is printed says what each light leaves of the colours. The tracts come from the folder that
``PVFIBLETS_DATA`` names, or of ``../shared/data``; where they are missing, made-up ones.
"""

from __future__ import annotations

import argparse
import io
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt

import pvfiblets
from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.studies.culling.pictures import averaged, directions, visible
from pvfiblets.synthetic import brain_streamlines

HERE = Path(__file__).resolve().parent
DATA = Path(os.environ.get("PVFIBLETS_DATA", HERE.parents[1] / "shared" / "data"))
SIZE, SAMPLES = (440, 330), 2
LARGEST = 330_000  # bytes

Array = npt.NDArray[np.float64]

# From the left: x of the picture runs to the front, y upwards, z towards the viewer.
TO_VIEW = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
VIEWER = np.array([0.0, 0.0, 1.0])
SHOULDER = np.array([-1.0, 1.0, 1.0]) / np.sqrt(3.0)

# VTK's light kit, a plotter's default: directions to the lights, and intensities.
KIT = [
    ((0.0, 0.0, 1.0), 0.25),
    ((0.1116, 0.7660, 0.6330), 0.75),
    ((-0.0449, -0.9659, 0.2549), 0.25),
    ((0.9397, 0.0, -0.3420), 0.2143),
    ((-0.9397, 0.0, -0.3420), 0.2143),
]


def across(tangents: Array, vector: Array) -> Array:
    """Return the part of a vector that is perpendicular to each tangent."""
    return vector - tangents * (tangents @ vector)[..., None]


def kit(light: Callable[[Array, Array], Array]) -> Callable[[Array], Array]:
    """Return the sum of the kit's lights, each as ``light(tangents, direction)`` has it."""
    return lambda tangents: sum(strength * light(tangents, np.array(towards)) for towards, strength in KIT)


def facing(tangents: Array, light: Array) -> Array:
    """The normal nearest to the viewer, as VTK has it for lines."""
    normal = across(tangents, VIEWER)
    size = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = np.where(size > 1e-3, normal / np.maximum(size, 1e-9), VIEWER)
    return np.maximum(normal @ light, 0.0)


def cylinder(tangents: Array, light: Array) -> Array:
    """Mallo et al. 2005, section 3: the mean over the visible side of a cylinder; 1 if the light is the viewer's."""
    seen, lit = across(tangents, VIEWER), across(tangents, light)
    sizes = np.linalg.norm(seen, axis=-1), np.linalg.norm(lit, axis=-1)
    angle = np.arccos(np.clip((seen * lit).sum(-1) / np.maximum(sizes[0] * sizes[1], 1e-9), -1.0, 1.0))
    return sizes[1] * (np.sin(angle) + (np.pi - angle) * np.cos(angle)) / np.pi


def along(tangents: Array, light: Array) -> Array:
    """Zöckler et al. 1996: the normal that reflects most."""
    return np.sqrt(np.maximum(1.0 - (tangents @ light) ** 2, 0.0))


def floored(light: Array) -> Callable[[Array], Array]:
    """Illuminated lines with a floor, of one light."""
    return lambda tangents: 0.8 + 0.2 * (1.0 - (tangents @ light) ** 4)


LIGHTS: dict[str, Callable[[Array], Array]] = {
    "no light": lambda tangents: np.ones(tangents.shape[:-1]),
    "the normal that faces the viewer": kit(facing),
    "mean of a cylinder (Mallo et al. 2005)": kit(cylinder),
    "illuminated lines (Zöckler et al. 1996)": lambda t: kit(along)(t) / sum(s for _, s in KIT),
    "with a floor, from the viewer": floored(VIEWER),
    "with a floor, over the shoulder: the default": floored(SHOULDER),
}


def fiblets() -> pvfiblets.FibletSet:
    """Return the compressed tracts."""
    real = DATA / "wholebrain_eudx_0.5mm_fifth.tck"
    return pvfiblets.compress(pvfiblets.read(real) if real.is_file() else brain_streamlines(20_000))


def view_of(bounds: tuple[float, ...]) -> View:
    """Return a parallel view from the left, which the bounds fill."""
    box = np.array(bounds).reshape(3, 2)
    low, high = np.sort(np.stack([TO_VIEW @ box[:, 0], TO_VIEW @ box[:, 1]]), axis=0)
    middle, half = (low + high) / 2, (high - low) / 2 * 1.02
    scale = np.array([1.0, 1.0, 1.0]) / max(half[0] / SIZE[0], half[1] / SIZE[1])
    scale /= (*SIZE, 1.0)
    scale[2] = -1.0 / half[2]
    matrix = np.eye(4)
    matrix[:3, :3] = scale[:, None] * TO_VIEW
    matrix[:3, 3] = -scale * middle
    return View(tuple(SAMPLES * side for side in SIZE), matrix)


def panels() -> dict[str, Array]:
    """Return each light's picture, ``(height, width, 3)`` of 0 to 1, and print the brightness that it leaves."""
    drawn = fiblets()
    context = bare_context()
    renderer = FibletRenderer(context, drawn)
    picture = visible(renderer.render(view_of(drawn.bounds), FibletStyle()))
    renderer.release()
    there = picture.streamline >= 0
    tangents = directions(picture.tangent)
    shown = {}
    print(f"{'light':56s} median  least  below a half")
    for name, light in LIGHTS.items():
        colours = np.minimum(np.abs(tangents) * light(tangents @ TO_VIEW.T)[..., None], 1.0) * there[..., None]
        left = (colours.sum(-1) / np.abs(tangents).sum(-1))[there]
        print(f"{name:56s} {np.median(left):6.2f} {left.min():6.2f} {(left < 0.5).mean():8.1%}")
        shown[name] = averaged(colours.astype(np.float32), SAMPLES)[::-1]
    return shown


def main() -> None:
    """Make the picture."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=HERE / "pictures" / "light.jpg")
    path = parser.parse_args().output
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt
    from PIL import Image

    figure, axes = plt.subplots(2, 3, figsize=(3 * SIZE[0] / 100, 2 * (SIZE[1] + 24) / 100), dpi=100, facecolor="black")
    figure.subplots_adjust(0, 0, 1, 1 - 24 / (2 * (SIZE[1] + 24)), 0.005, 24 / SIZE[1])
    for axis, (name, picture) in zip(axes.flat, panels().items(), strict=True):
        axis.imshow(picture, interpolation="nearest")
        axis.set_axis_off()
        axis.set_title(name, color="white", fontsize=12, pad=4)
    whole = io.BytesIO()
    figure.savefig(whole, format="png", facecolor="black")
    for quality in range(88, 30, -4):
        file = io.BytesIO()
        Image.open(whole).convert("RGB").save(file, "jpeg", quality=quality, optimize=True, progressive=True)
        if file.tell() <= LARGEST:
            break
    path.write_bytes(file.getvalue())


if __name__ == "__main__":
    main()
