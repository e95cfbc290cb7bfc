"""Real spherical harmonics in the bases of MRtrix and dipy, as a matrix from coefficients to values on directions.

Definitions: Tournier, Calamante and Connelly (2007) as MRtrix3 normalises it, and Descoteaux et al. (2007); names as of
dipy's ``sh_to_sf``, which gives the same values.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

BASES = ("mrtrix", "tournier07_legacy", "descoteaux07", "descoteaux07_legacy")
"""Of dipy, ``mrtrix`` is ``tournier07`` with ``legacy=False``; ``_legacy`` stands for ``legacy=True``."""

Array = npt.NDArray[np.float64]


def degrees(n: int, full: bool) -> int:
    """Return the highest degree of so many coefficients."""
    for degree in range(0, 33, 1 if full else 2):
        if n == ((degree + 1) ** 2 if full else (degree + 1) * (degree + 2) // 2):
            return degree
    series = "1, 4, 9, 16 …" if full else "1, 6, 15, 28, 45 …"
    raise ValueError(f"{n} numbers per voxel are no coefficients of spherical harmonics; expected {series}")


def sh_matrix(directions: npt.ArrayLike, degree: int, basis: str = "mrtrix", full: bool = False) -> Array:
    """Return values of all harmonics on directions."""
    if basis not in BASES:
        raise ValueError(f"basis is {basis!r}; choose one of {BASES}")
    x, y, z = np.asarray(directions, np.float64).T
    turn = np.arctan2(y, x)
    legendre = _legendre(np.clip(z, -1.0, 1.0), degree)
    columns = []
    for el in range(0, degree + 1, 1 if full else 2):
        for m in range(-el, el + 1):
            size = abs(m)
            cosine, sine = legendre[el, size] * np.cos(size * turn), legendre[el, size] * np.sin(size * turn)
            scale = 1.0 if m == 0 else math.sqrt(2.0)
            if basis in ("mrtrix", "tournier07_legacy"):
                found = sine if m < 0 else cosine
                scale = scale if basis == "mrtrix" else 1.0
            else:
                found = sine if m > 0 else cosine
                if basis == "descoteaux07" and m < 0 and size % 2:
                    scale = -scale  # Y of -m is the conjugate, with this sign
            columns.append(scale * found)
    return np.stack(columns, axis=1)


def _legendre(z: Array, degree: int) -> dict[tuple[int, int], Array]:
    """Return associated Legendre functions, normalised on the sphere, with the phase of Condon and Shortley."""
    # By recurrences over normalised functions, which neither overflow nor cancel at any degree in use.
    across = np.sqrt(np.maximum(1.0 - z * z, 0.0))
    found = {(0, 0): np.full_like(z, math.sqrt(0.25 / math.pi))}
    for m in range(degree + 1):
        if m:
            found[m, m] = -math.sqrt((2 * m + 1) / (2 * m)) * across * found[m - 1, m - 1]
        if m < degree:
            found[m + 1, m] = math.sqrt(2 * m + 3) * z * found[m, m]
        for el in range(m + 2, degree + 1):
            a = math.sqrt((4 * el * el - 1) / (el * el - m * m))
            b = math.sqrt(((el - 1) ** 2 - m * m) / (4 * (el - 1) ** 2 - 1))
            found[el, m] = a * (z * found[el - 1, m] - b * found[el - 2, m])
    return found
