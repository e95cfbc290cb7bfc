"""The 256 directions that a code can mean, as rotations, for each of 16 cap angles.

Symbols (paper: Schertzer et al. 2022, section 3.2 and appendices A and B): ``alpha`` is the cap angle, the largest turn
between consecutive steps that a code reaches; ``Ratio = 1 - cos alpha``. A direction ``V`` of the cap is mapped to the
disc by the equal-area map ``rho = sqrt((1 - V.x) / Ratio)``.

What differs from the paper, and why:

- **Points of the disc.** The paper spreads 16 x 16 codes evenly (a half-octahedron's square). Turns are not even:
within
  a fiblet they crowd around straight on, and the even grid of 16 has no code there at all. Here code ``i`` lies on a
  Fibonacci spiral at ``rho = (i / 256) ** (7 / 8)``: code 0 is exactly straight on and codes thin out towards the rim.
  On real tracking this lowers the mean error by a quarter to a half at equal bytes.
- **A set of cap angles.** Sixteen, from 1.5 to 178 degrees at equal ratios; each fiblet names its own.
- **Frames.** The paper rebuilds a frame around each direction with a constant vector (equation 2). Here a code *is* the
  smallest rotation that turns X to its direction, and frames are products of those: no special direction, no square
  root while decoding, and a frame follows the streamline without twist.

1 - cos alpha is computed as 2 sin^2(alpha / 2), which keeps its digits when alpha is small. Tables are rounded to
float32 so that the GPU and the CPU read the very same numbers.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .layout import CAPS

__all__ = ["CAP_DEGREES", "CODES", "cap_ratios", "directions", "disc", "quaternions"]

CODES = 256
CAP_DEGREES = tuple(float(a) for a in np.round(1.5 * (178.0 / 1.5) ** (np.arange(CAPS) / (CAPS - 1)), 3))

# cos and sin of the golden angle pi (3 - sqrt 5): products of these need no library function per code.
_GOLDEN = complex(-0.7373688780783197, 0.6754902942615238)


@cache
def cap_ratios() -> npt.NDArray[np.float64]:
    """``Ratio = 1 - cos alpha`` of each cap angle.

    Returns
    -------
    numpy.ndarray
        ``(16,)`` float64, increasing.
    """
    half = np.sin(np.radians(np.array(CAP_DEGREES)) / 2).astype(np.float32).astype(np.float64)
    return _frozen(2.0 * half * half)


@cache
def disc() -> npt.NDArray[np.float64]:
    """Where the codes lie on the unit disc.

    Returns
    -------
    numpy.ndarray
        ``(256, 2)`` float64; row 0 is the centre.
    """
    points = np.empty((CODES, 2))
    turn = complex(1.0, 0.0)
    for code in range(CODES):
        t = code / CODES
        rho = np.sqrt(t * np.sqrt(t * np.sqrt(t)))  # t ** (7 / 8) by square roots, which every machine rounds alike
        points[code] = rho * turn.real, rho * turn.imag
        turn *= _GOLDEN
    return _frozen(points)


@cache
def quaternions() -> npt.NDArray[np.float32]:
    """The rotation that each code stands for.

    Returns
    -------
    numpy.ndarray
        ``(16, 256, 4)`` float32 unit quaternions ``(w, x, y, z)`` by cap index and code; each turns X = (1, 0, 0) by
        the smallest rotation to the code's direction.
    """
    points = disc()
    table = np.empty((CAPS, CODES, 4), np.float32)
    for cap, ratio in enumerate(cap_ratios()):
        x = 1.0 - ratio * (points**2).sum(1)
        lateral = points * np.sqrt(ratio * (1.0 + x))[:, None]  # y, z: length sqrt(1 - x^2) without cancellation
        q = np.stack([1.0 + x, np.zeros(CODES), -lateral[:, 1], lateral[:, 0]], axis=1)
        table[cap] = q / np.sqrt((q**2).sum(1))[:, None]
    return _frozen(table)


@cache
def directions() -> npt.NDArray[np.float64]:
    """The direction that each code turns X to, as decoded from :func:`quaternions`.

    Returns
    -------
    numpy.ndarray
        ``(16, 256, 3)`` float64, unit length within float32 rounding.
    """
    w, x, y, z = np.moveaxis(quaternions().astype(np.float64), -1, 0)
    return _frozen(np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=-1))


def _frozen(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    array.flags.writeable = False
    return array
