"""The 1000-byte header of trk files: fields checked one by one, geometry by nibabel."""

from __future__ import annotations

import warnings
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError

HEADER_SIZE = 1000
_SCALAR_NAMES, _PROPERTY_NAMES = 38, 240  # bytes at which the two tables of ten names begin


class Header(NamedTuple):
    """Contents of a trk header."""

    order: str  # byte order, `"<"` or `">"`
    n_streamlines: int  # streamlines; 0 where not recorded
    n_scalars: int
    n_properties: int
    scalars: dict[str, slice]  # name to columns among the scalars' rows, x, y, z included
    properties: dict[str, slice]
    affine: NDArray[np.float64]
    to_ras: NDArray[np.float64]  # (4, 4): coordinates of the file to RAS+ mm
    space: dict[str, Any]

    @property
    def row_words(self) -> int:
        """4-byte words per point."""
        return 3 + self.n_scalars


def parse_header(path: str, raw: bytes) -> Header:
    """Parse and check the first 1000 bytes of a trk file."""
    from nibabel.streamlines.trk import header_2_dtype

    if raw[:5] != b"TRACK":
        raise FormatError(path, 0, repr(raw[:6]), "the magic b'TRACK'")
    if len(raw) < HEADER_SIZE:
        raise FormatError(path, len(raw), "the end of the file", "a header of 1000 bytes")
    kind: np.dtype[Any] = header_2_dtype
    orders: tuple[Literal["<", ">"], ...] = ("<", ">")
    for order in orders:
        fields = np.frombuffer(raw, kind.newbyteorder(order))[0]
        if fields["hdr_size"] == HEADER_SIZE:
            break
    else:
        size = np.frombuffer(raw, "<i4", 1, 996)[0]
        raise FormatError(path, 996, f"header size {size}", "1000 in either byte order")
    version = int(fields["version"])
    if version not in (1, 2, 3):
        raise FormatError(path, 992, f"version {version}", "1, 2 or 3")
    count = _at_least_zero(path, 988, int(fields["nb_streamlines"]), "number of streamlines")
    n_scalars = _at_least_zero(path, 36, int(fields["nb_scalars_per_point"]), "number of scalars")
    n_properties = _at_least_zero(path, 238, int(fields["nb_properties_per_streamline"]), "number of properties")
    affine, to_ras, space = _geometry(path, fields, version)
    scalars = _names(path, _SCALAR_NAMES, fields["scalar_name"], n_scalars, "scalars")
    return Header(
        order,
        count,
        n_scalars,
        n_properties,
        {name: slice(s.start + 3, s.stop + 3) for name, s in scalars.items()},
        _names(path, _PROPERTY_NAMES, fields["property_name"], n_properties, "properties"),
        affine,
        to_ras,
        space,
    )


def _at_least_zero(path: str, position: int, value: int, what: str) -> int:
    if value < 0:
        raise FormatError(path, position, f"{what} {value}", "0 or more")
    return value


def _geometry(path: str, fields: Any, version: int) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[str, Any]]:
    from nibabel.orientations import aff2axcodes

    sizes = fields["voxel_sizes"].astype(np.float64)
    if not (np.isfinite(sizes).all() and (sizes >= 0).all()):
        raise FormatError(path, 12, f"voxel size {sizes.tolist()}", "three positive numbers (mm)")
    affine = fields["voxel_to_rasmm"].astype(np.float64)
    recorded = version != 1 and affine[3, 3] != 0
    voxel_order = fields["voxel_order"].decode("latin-1").strip("\0 ").upper() or "LPS"
    if len(voxel_order) != 3 or {frozenset("LR"), frozenset("PA"), frozenset("SI")} != {
        pair for c in voxel_order for pair in map(frozenset, ("LR", "PA", "SI")) if c in pair
    }:
        raise FormatError(path, 948, f"voxel order {voxel_order!r}", "one of L/R, one of P/A and one of S/I")
    if not recorded:
        affine = unrecorded_affine(sizes, voxel_order)
        warnings.warn(
            f"{path}: the header has no voxel-to-RAS matrix; its voxel size {' x '.join(f'{n:g}' for n in sizes)} mm "
            f"and voxel order {voxel_order} are used, with the first voxel in RAS order at the origin",
            UserWarning,
            stacklevel=2,
        )
    axes = None
    if np.isfinite(affine).all() and np.abs(affine).max() < 1e30:
        with np.errstate(all="ignore"):
            invertible = abs(np.linalg.det(affine[:3, :3])) > 0
        axes = aff2axcodes(affine) if invertible else None
    if axes is None or None in axes or not np.array_equal(affine[3], [0, 0, 0, 1]):
        raise FormatError(path, 440, f"voxel-to-RAS matrix {affine.tolist()}", "an invertible affine")
    if not sizes.all():
        sizes = _sizes_of(path, sizes, affine, voxel_order)
    dimensions = fields["dimensions"].astype(int)
    to_ras = trackvis_to_ras(sizes, dimensions, voxel_order, affine)
    space = {
        "dimensions": tuple(dimensions.tolist()),
        "voxel_sizes": tuple(sizes.tolist()),
        "voxel_order": voxel_order,
        "affine_recorded": bool(recorded),
    }
    orientation = fields["image_orientation_patient"].astype(np.float64)
    if np.isfinite(orientation).all() and orientation.any():
        space["image_orientation_patient"] = tuple(orientation.tolist())
    if original := fields["pad2"].decode("latin-1").strip("\0 "):
        space["original_voxel_order"] = original
    return affine, to_ras, space


def unrecorded_affine(sizes: NDArray[np.float64], voxel_order: str) -> NDArray[np.float64]:
    """Return the voxel-to-RAS matrix for a header without one: voxel sizes (1 mm for 0) along R, A and S."""
    from nibabel import orientations as orient

    axes = orient.axcodes2ornt(voxel_order)[:, 0].astype(int)
    scale = np.ones(4)
    scale[axes] = np.where(sizes > 0, sizes, 1.0)
    return np.diag(scale)


def _sizes_of(
    path: str, sizes: NDArray[np.float64], affine: NDArray[np.float64], voxel_order: str
) -> NDArray[np.float64]:
    """Voxel sizes along the header's axes; sizes of 0 are replaced by the affine's."""
    from nibabel import orientations as orient

    by_affine = np.sqrt((affine[:3, :3] ** 2).sum(axis=0))
    move = orient.ornt_transform(orient.axcodes2ornt(voxel_order), orient.axcodes2ornt(orient.aff2axcodes(affine)))
    found = np.where(sizes > 0, sizes, by_affine[move[:, 0].astype(int)])
    warnings.warn(
        f"{path}: voxel size is {sizes.tolist()}; {found.tolist()} mm is taken, by the voxel-to-RAS matrix",
        stacklevel=2,
    )
    return found


def trackvis_to_ras(
    sizes: NDArray[Any], dimensions: NDArray[Any], voxel_order: str, affine: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(4, 4) float64 matrix from the file's coordinates to RAS+ mm."""
    # From millimetres to voxels; by half a voxel, since the file counts from a voxel's corner; then axes permuted and
    # flipped from the header's voxel order to the affine's; then the affine. This is what nibabel computes, without its
    # rounding of the result to float32, which for images far from the origin is coarser than the coordinates.
    from nibabel import orientations as orient

    to_voxel = np.diag([*(1.0 / sizes), 1.0])
    to_voxel[:3, 3] = -0.5
    move = orient.ornt_transform(orient.axcodes2ornt(voxel_order), orient.axcodes2ornt(orient.aff2axcodes(affine)))
    matrix: NDArray[np.float64] = affine @ orient.inv_ornt_aff(move, dimensions) @ to_voxel
    return matrix


def along_affine(dimensions: Any, voxel_order: str, affine: NDArray[np.float64]) -> tuple[int, ...]:
    """Voxels along each axis of the affine's matrix, of those along the axes of a header's voxel order."""
    from nibabel import orientations as orient

    axes = orient.aff2axcodes(affine)
    if None in axes:
        return tuple(int(n) for n in dimensions)
    move = orient.ornt_transform(orient.axcodes2ornt(tuple(voxel_order)), orient.axcodes2ornt(axes))
    moved = [1, 1, 1]
    for n, to in zip(dimensions, move[:, 0], strict=True):
        moved[int(to)] = int(n)
    return tuple(moved)


def _names(path: str, position: int, table: Any, total: int, rest: str) -> dict[str, slice]:
    """Read a table of ten 20-byte names; a zero byte and digits after a name say how many columns."""
    columns: dict[str, slice] = {}
    begin = 0
    for i, raw in enumerate(table if total else ()):
        text = raw.decode("latin-1").rstrip("\0")
        if not text:
            continue
        name, *more = text.split("\0")
        # After the first name's end old writers left garbage; only digits mean something.
        digits = more[0].strip() if more else ""
        width = int(digits) if digits.isdecimal() and digits.isascii() else 1
        if begin + width > total:
            raise FormatError(
                path,
                position + 20 * i,
                f"{rest} {text!r}, which need {begin + width} columns",
                f"at most the {total} columns that the header announces",
            )
        columns[_unique(name.rstrip() or rest, columns)] = slice(begin, begin + width)
        begin += width
    if begin < total:
        columns[_unique(rest, columns)] = slice(begin, total)
    return {name: part for name, part in columns.items() if part.stop > part.start}


def _unique(name: str, taken: dict[str, slice]) -> str:
    candidate, i = name, 2
    while candidate in taken:
        candidate, i = f"{name}_{i}", i + 1
    return candidate
