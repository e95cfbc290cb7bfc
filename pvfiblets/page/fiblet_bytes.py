"""The bytes of a set of fiblets for a page: a ``.fiblets`` file without data that the page does not show."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pvfiblets.codec.files.archive import array_member, open_archive, write_archive
from pvfiblets.codec.files.fiblets_file import make_header, write
from pvfiblets.codec.point_values import PointValues, as_codes

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

SMALL_FROM = 1_000_000
"""Bytes of a set that a page holds packed; below, the page's script is as large."""

_MEMBERS = ("pages", "rank_to_id", "anchors", "anchors_low", "decoding", "codes", "reach", "ends")
"""In this order, after values of points: a page that gets the file from its start has all that the first codes need.

The page skips the last two, which pvfiblets needs to open the file.
"""


def fiblet_bytes(fiblets: FibletSet, keep: tuple[str, ...] = ()) -> bytes:
    """Return a set as a file of records, without other data of streamlines."""
    if missing := [name for name in keep if name not in fiblets.per_point]:
        raise KeyError(f"there are no values per point {missing}; there are {sorted(fiblets.per_point)}")
    bare = replace(
        fiblets, per_point={name: _coded(fiblets.per_point[name]) for name in keep}, per_streamline={}, groups={},
        per_group={}, space={}, dropped={}, exact=None,
    )  # fmt: skip
    arrays = {name: getattr(bare, name) for name in _MEMBERS}
    members = {f"{name}.npy": array_member(np.asarray(array)) for name, array in arrays.items() if array is not None}
    values = {name: array_member(np.asarray(points.codes)) for name, points in bare.per_point.items()}
    header, more = make_header(bare, values)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.fiblets"
        write_archive(path, header, more | members)
        return path.read_bytes()


def small_bytes(file: bytes) -> bytes:
    """Return a file as a small one (:mod:`pvfiblets.codec.files.packed`), as a page with its data in it has it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.fiblets"
        path.write_bytes(file)
        header, arrays = open_archive(path)
        write(path.with_suffix(".small"), header, {k: array_member(v) for k, v in arrays.items()}, small=True)
        return path.with_suffix(".small").read_bytes()


def _coded(values: PointValues) -> PointValues:
    """Values as pages read them: codes of what float32 holds."""
    coded, table = (values, values.table) if values.table is not None else as_codes(values.values())
    return replace(coded, table=np.asarray(table, "<f4"))
