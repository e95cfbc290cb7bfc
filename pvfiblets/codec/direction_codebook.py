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
  smallest rotation that turns X to its direction, and frames are products of those: no special direction, and a frame
  follows the streamline without twist.

1 - cos alpha is computed as 2 sin^2(alpha / 2), which keeps its digits when alpha is small.

**What a code is decoded with.** A rotation without a part about X is two numbers, y and z; w follows from the unit
length. Both are kept as 16-bit integers times a scale for each cap angle, so that all rotations are 16 KiB: what every
driver gives to a uniform block, and what fits beside a GPU's other caches. CPU and GPU start from the same integers
and take the same float32 operations, and the encoder searches among their decoded vectors: nothing is lost by rounding.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .layout import CAPS

CODES = 256
PACKED_LEVELS = 32767
CAP_DEGREES = tuple(float(a) for a in np.round(1.5 * (178.0 / 1.5) ** (np.arange(CAPS) / (CAPS - 1)), 3))

# cos and sin of the golden angle pi (3 - sqrt 5): products of these need no library function per code.
_GOLDEN = complex(-0.7373688780783197, 0.6754902942615238)


@cache
def cap_ratios() -> npt.NDArray[np.float64]:
    """``Ratio = 1 - cos alpha`` of each cap angle."""
    half = np.sin(np.radians(np.array(CAP_DEGREES)) / 2).astype(np.float32).astype(np.float64)
    return _frozen(2.0 * half * half)


@cache
def disc() -> npt.NDArray[np.float64]:
    """Return the places of the codes on the unit disc."""
    points = np.empty((CODES, 2))
    turn = complex(1.0, 0.0)
    for code in range(CODES):
        t = code / CODES
        rho = np.sqrt(t * np.sqrt(t * np.sqrt(t)))  # t ** (7 / 8) by square roots, which every machine rounds alike
        points[code] = rho * turn.real, rho * turn.imag
        turn *= _GOLDEN
    return _frozen(points)


@cache
def _lateral() -> npt.NDArray[np.float64]:
    """Parts y, z of the unit quaternion of each code before rounding, ``(16, 256, 2)`` float64."""
    points = disc()
    parts = np.empty((CAPS, CODES, 2))
    for cap, ratio in enumerate(cap_ratios()):
        x = 1.0 - ratio * (points**2).sum(1)
        lateral = points * np.sqrt(ratio * (1.0 + x))[:, None]  # y, z: length sqrt(1 - x^2) without cancellation
        q = np.stack([1.0 + x, -lateral[:, 1], lateral[:, 0]], axis=1)
        parts[cap] = (q / np.sqrt((q**2).sum(1))[:, None])[:, 1:]
    return _frozen(parts)


@cache
def packed_scales() -> npt.NDArray[np.float32]:
    """Return the value of one unit of a packed rotation's integers."""
    return _frozen((np.abs(_lateral()).max(axis=(1, 2)) / PACKED_LEVELS).astype(np.float32))


@cache
def packed() -> npt.NDArray[np.uint32]:
    """The rotations as a GPU keeps them."""
    levels = np.rint(_lateral() / packed_scales().astype(np.float64)[:, None, None]).astype(np.int64)
    levels = np.clip(levels, -PACKED_LEVELS, PACKED_LEVELS)
    return _frozen(((levels[..., 0] & 0xFFFF) | (levels[..., 1] & 0xFFFF) << 16).astype(np.uint32))


@cache
def quaternions() -> npt.NDArray[np.float32]:
    """The rotation that each code stands for, unpacked from :func:`packed`."""
    # The float32 operations and their order are as in `shaders/fiblets/decode/words.glsl`.
    words = packed()
    levels = np.stack([words & np.uint32(0xFFFF), words >> np.uint32(16)], axis=-1).astype(np.uint16).view(np.int16)
    parts = levels.astype(np.float32) * packed_scales()[:, None, None]
    y, z = parts[..., 0], parts[..., 1]
    w = np.sqrt(np.float32(1.0) - y * y - z * z)
    return _frozen(np.stack([w, np.zeros_like(w), y, z], axis=-1))


@cache
def directions() -> npt.NDArray[np.float64]:
    """The direction that each code turns X to, as decoded from :func:`quaternions`."""
    w, x, y, z = np.moveaxis(quaternions().astype(np.float64), -1, 0)
    return _frozen(np.stack([1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=-1))


def _frozen(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    array.flags.writeable = False
    return array
