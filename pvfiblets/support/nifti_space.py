"""Positions of NIfTI images: the matrix that counts, and other programs' reading of ambiguous headers.

An image may have two matrices, each with a code: the sform and the qform. nibabel 5.4 and MRtrix 3.0.3 take the sform
where its code is above 0; SimpleITK 2.5 takes the qform if the sform's code is 2 to 5. With both codes 0 nibabel lets
the first axis of the voxels run from right to left, MRtrix from left to right.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal, NamedTuple, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from .file_notes import note

Array = npt.NDArray[np.float64]
Matrix: TypeAlias = Literal["sform", "qform", "LAS", "RAS"]
Units: TypeAlias = Literal["mm", "header"]

MATRICES: tuple[Matrix, ...] = get_args(Matrix)
UNITS: tuple[Units, ...] = get_args(Units)

DIFFERENT = 0.1  # tolerance of equal matrices: distance of an image's corners, in voxels

_MM = {"meter": 1000.0, "micron": 0.001}
_SIDES = {
    "R": "left to right",
    "L": "right to left",
    "A": "back to front",
    "P": "front to back",
    "S": "up",
    "I": "down",
}


class _Choice(NamedTuple):
    matrix: Matrix | None = None
    units: Units = "mm"


_choice = _Choice()


@contextmanager
def nifti_space(matrix: Matrix | None = None, *, units: Units = "mm") -> Iterator[None]:
    """Choose how NIfTI images are placed in space, in all threads, within the context.

    Parameters
    ----------
    matrix : {'sform', 'qform', 'LAS', 'RAS'}, optional
        ``'sform'`` and ``'qform'`` are the matrices of these names; an image without the one is refused. ``'LAS'`` and
        ``'RAS'`` take the voxel sizes alone, with the middle of the image at 0: its first axis runs from right to left,
        or from left to right. Default: the sform, or without one the qform, or without both ``'LAS'``, as of nibabel.
    units : {'mm', 'header'}, default: 'mm'
        ``'header'``: coordinates are in the header's unit (``xyzt_units``: metres, millimetres or micrometres).
        ``'mm'``: in millimetres whatever it says, as for nibabel and MRtrix.

    Raises
    ------
    ValueError
        If an argument has another value.

    Examples
    --------
    >>> import pvfiblets
    >>> with pvfiblets.nifti_space("qform"):  # doctest: +SKIP
    ...     density = pvfiblets.density("brain.trx", like="T1.nii.gz")
    """
    global _choice  # of a whole command, whose images are read in many places
    if matrix is not None and matrix not in MATRICES:
        raise ValueError(f"unknown matrix {matrix!r}; choose one of {', '.join(map(repr, MATRICES))}, or None")
    if units not in UNITS:
        raise ValueError(f"unknown units {units!r}; choose 'mm' or 'header'")
    before, _choice = _choice, _Choice(matrix, units)
    try:
        yield
    finally:
        _choice = before


def chosen() -> tuple[Matrix | None, Units]:
    """Return what :func:`nifti_space` was last given, for other processes."""
    return _choice


def affine_of(image: Any) -> Array | None:
    """Return the ``(4, 4)`` affine of an image of nibabel by the rule chosen, and warn once per file of a doubt."""
    own = None if image.affine is None else np.asarray(image.affine, np.float64)
    header = _nifti_header(image, own)
    if own is None or header is None:
        return own
    name = _path(image) or "the image"
    matrix, affine = _matrix(header, own, name)
    if _choice.matrix is None:
        _report_doubt(image, header, matrix, affine, name)
    return _scaled(image, header, affine, name)


def code_of(image: Any) -> int:
    """Return NIfTI's code of the space that an image's affine leads to; 1, the scanner's, if there is none."""
    header = _nifti_header(image, image.affine)
    codes = {} if header is None else _codes(header)
    wanted = [_choice.matrix] if _choice.matrix else ["sform", "qform"]
    return next((codes[one] for one in wanted if codes.get(one)), 1)


def _nifti_header(image: Any, affine: Any) -> Any:
    """Return a header of NIfTI that still tells of the image's affine; None if there is none."""
    header = getattr(image, "header", None)
    if affine is None or header is None or not hasattr(header, "get_qform") or not hasattr(header, "get_sform"):
        return None
    return header if np.allclose(header.get_best_affine(), affine) else None  # else the caller has changed either


def _codes(header: Any) -> dict[str, int]:
    return {"sform": int(header["sform_code"]), "qform": int(header["qform_code"])}


def _matrix(header: Any, own: Array, name: str) -> tuple[Matrix, Array]:
    """Return which matrix counts, and the matrix."""
    codes = _codes(header)
    wanted = _choice.matrix
    if wanted in ("sform", "qform") and not codes[wanted]:
        raise ValueError(
            f"{name} has no {wanted}: its {wanted}_code is 0; choose "
            + (", ".join(one for one in codes if codes[one]) or "LAS or RAS")
        )
    match wanted:
        case None:
            return ("sform" if codes["sform"] else "qform" if codes["qform"] else "LAS"), own
        case "sform":
            return wanted, np.asarray(header.get_sform(), np.float64)
        case "qform":
            return wanted, _qform(header, name)
    sizes = np.array([header.get_zooms()[i] if i < len(header.get_zooms()) else 1.0 for i in range(3)], np.float64)
    sides = np.array([*header.get_data_shape()[:3], 1, 1, 1][:3], np.float64)
    affine = np.diag([*sizes, 1.0])
    affine[0, 0] *= 1.0 if wanted == "RAS" else -1.0
    affine[:3, 3] = -affine[:3, :3] @ ((sides - 1.0) / 2.0)
    return wanted, affine


def _qform(header: Any, name: str) -> Array:
    from nibabel.spatialimages import HeaderDataError

    try:
        return np.asarray(header.get_qform(), np.float64)
    except (HeaderDataError, ValueError) as error:
        raise ValueError(f"the qform of {name} is no rotation ({error}); choose sform, LAS or RAS") from None


def _report_doubt(image: Any, header: Any, matrix: Matrix, affine: Array, name: str) -> None:
    """Warn of an image that other programs place elsewhere."""
    if matrix == "LAS":
        _warn(
            image,
            f"{name} does not say where it lies (sform_code and qform_code are 0). It is placed as nibabel does, with "
            f"the middle at 0 and {_directions(affine)}; MRtrix swaps left and right. {_remedy('RAS', 'LAS')}",
        )
    elif matrix == "sform" and header["qform_code"]:
        try:
            other = _qform(header, name)
        except ValueError:  # of no use to any program
            return
        sides = np.array([*header.get_data_shape()[:3], 1, 1, 1][:3])
        corners = np.stack(np.meshgrid(*((-0.5, n - 0.5) for n in sides), indexing="ij"), axis=-1).reshape(-1, 3)
        apart = float(np.linalg.norm(corners @ (affine - other)[:3, :3].T + (affine - other)[:3, 3], axis=1).max())
        if not apart > DIFFERENT * np.linalg.norm(affine[:3, :3], axis=0).min():
            return
        codes = _codes(header)
        swapped = ", and left and right are swapped" if _x_way(affine) * _x_way(other) < 0 else ""
        _warn(
            image,
            f"the sform (code {codes['sform']}) and the qform (code {codes['qform']}) of {name} differ by up to "
            f"{apart:.3g} mm{swapped}. The sform is taken, as by nibabel and MRtrix: {_directions(affine)}. By the "
            f"qform, which ITK takes if the sform_code is 2 to 5, {_directions(other)}. {_remedy('qform', 'sform')}",
        )


def _scaled(image: Any, header: Any, affine: Array, name: str) -> Array:
    """Return an affine to mm where the header's unit counts, and warn where it does not."""
    unit = header.get_xyzt_units()[0]
    if unit not in _MM:
        return affine
    if _choice.units == "header":
        return np.diag([_MM[unit]] * 3 + [1.0]) @ affine
    _warn(
        image,
        f"the header of {name} gives coordinates in {unit}s (xyzt_units); they are taken as millimetres, as by nibabel "
        f"and MRtrix, where ITK multiplies them by {_MM[unit]:g}. For this, choose --nifti-units header (in Python "
        "pvfiblets.nifti_space(units='header'))",
    )
    return affine


def _remedy(other: Matrix, same: Matrix) -> str:
    return f"Choose --nifti-space {other} or {same} (in Python pvfiblets.nifti_space('{other}'))"


def _x_way(affine: Array) -> float:
    """Return the sign of the way in which the axis nearest to left and right runs."""
    from nibabel.orientations import io_orientation

    rows = io_orientation(affine)
    return float(rows[rows[:, 0] == 0, 1].sum())


def _directions(affine: Array) -> str:
    """Name the ways of the three axes of voxels."""
    from nibabel.orientations import aff2axcodes

    ways = (f"{axis} {_SIDES.get(str(code), 'nowhere')}" for axis, code in zip("ijk", aff2axcodes(affine), strict=True))
    return f"voxels running {', '.join(ways)}"


def _path(image: Any) -> str | None:
    found = image.get_filename() if hasattr(image, "get_filename") else None
    return None if found is None else os.fspath(found)


def _warn(image: Any, text: str) -> None:
    """Warn once of a file; of an image in memory Python's own filter of repeated warnings counts."""
    path = _path(image)
    if path is None:
        warnings.warn(text, UserWarning, stacklevel=2)
    else:
        note(path, text)
