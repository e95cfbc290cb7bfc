"""``.fiblets`` files: a FibletSet on disk.

The file is a stored zip (:mod:`.archive`): ``header.json``, then ``anchors.npy``, ``decoding.npy``, ``reach.npy``,
``codes.npy``, ``ends.npy``, ``pages.npy`` as `layout` states them, then what else the set holds. ``header.json``
names the members of arrays whose names are free text. Opening maps the arrays: constant time and memory whatever the
file's size.

The file of an exact set (`exact`) has its points in the place of all of these (:mod:`.exact_file`). They are
read, and records made of them, when it is opened. Small files (:mod:`.packed`) are unpacked when they are opened.
"""

from __future__ import annotations

from dataclasses import asdict, fields
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...errors import FormatError
from ...streamlines import Streamlines, offsets_from_counts
from ...support.addresses import is_url
from ..encoding.exact import plain_records
from ..layout import PAGE, SPLINE, WORDS, coded_kind
from ..parameters import Parameters, bounds_of, survey
from ..point_values import PointValues, linear_table, opened_table, stored_table
from .archive import Member, array_member, open_archive, write_archive
from .exact_file import pack_points, unpack_points
from .packed import pack_members, unpack

if TYPE_CHECKING:
    from ..fibletset import FibletSet

OF_CODES = 2
"""Version of files that hold records and codes, which older programs read too."""

OF_POINTS = 3
PACKED = 4
VERSION = 5
"""Version of files with fiblets of splines; of others with packed members `PACKED`, of other exact sets `OF_POINTS`."""

INDEX = "_spatial_index"  # attribute of a set, no field of it: a set that is made of another has other fiblets
INDEX_MEMBERS = ("spatial_index/order.npy", "spatial_index/leaves.npy", "spatial_index/pieces.npy")

CORE = ("anchors", "decoding", "reach", "codes", "ends", "pages")
OPTIONAL = ("anchors_low", "rank_to_id")
VALUE_FACTS = ("lo", "hi", "max_error", "mean_error", "reference")
_SHAPES: dict[str, tuple[str, int]] = {
    "anchors": ("<u4", WORDS["anchors"]),
    "decoding": ("<u4", WORDS["decoding"]),
    "reach": ("<u2", 0),
    "anchors_low": ("<u2", 3),
}


def save(fiblets: FibletSet, path: str | PathLike[str], *, small: bool = False) -> None:
    """Write a set to disk; packed where it is to be small."""
    if fiblets.exact is not None:
        _save_exact(fiblets, path, small)
        return
    members = {f"{name}.npy": array_member(np.asarray(getattr(fiblets, name))) for name in CORE}
    for name in OPTIONAL:
        if getattr(fiblets, name) is not None:
            members[f"{name}.npy"] = array_member(np.asarray(getattr(fiblets, name)))
    header, more = make_header(fiblets, {k: array_member(np.asarray(v.codes)) for k, v in fiblets.per_point.items()})
    write(path, header, members | more | index_members(fiblets), small=small)


def write(path: str | PathLike[str], header: dict[str, Any], members: dict[str, Member], *, small: bool) -> None:
    """Write an archive, with packed members where it is to be small."""
    if small:
        facts, members = pack_members(members)
        header = header | {"version": max(PACKED, header["version"]), "packed": facts} if facts else header
    write_archive(path, header, members, small="exact" in header and len(members) == 1)


def index_members(fiblets: FibletSet) -> dict[str, Member]:
    """A spatial index over the fiblets, which the room of questions has put with the set; none is none."""
    return {name: array_member(np.asarray(a)) for name, a in zip(INDEX_MEMBERS, _index_arrays(fiblets), strict=False)}


def _index_arrays(fiblets: FibletSet) -> tuple[Any, ...]:
    held: Any = fiblets.__dict__.get(INDEX)
    if held is None:
        return ()
    return held if isinstance(held, tuple) else (held.order, held.leaves, held.pieces)


def index_bytes(fiblets: FibletSet) -> int:
    """Bytes that the spatial index of a set takes in its file; 0 if it has none."""
    return sum(int(np.asarray(array).nbytes) for array in _index_arrays(fiblets))


def _save_exact(fiblets: FibletSet, path: str | PathLike[str], small: bool) -> None:
    """Points and their values stand in the file in the order of the streamlines."""
    points, per_point = np.asarray(fiblets.exact), {k: v.codes for k, v in fiblets.per_point.items()}
    if not fiblets.in_order:
        from ..streamline_ranges import coded_rows

        places = np.argsort(coded_rows(fiblets))
        points, per_point = points[places], {k: codes[places] for k, codes in per_point.items()}
    header, members = make_header(fiblets, {k: array_member(np.asarray(codes)) for k, codes in per_point.items()})
    for name in ("parameters", "bounds", "n_fiblets", *(k for k, v in header.items() if v in ({}, []))):
        del header[name]
    facts, packed = pack_points(points, np.diff(fiblets.offsets()))
    header |= {"version": OF_POINTS, "exact": {"member": "exact.npy", **facts}}
    write(path, header, {"exact.npy": array_member(packed)} | members, small=small)


def make_header(fiblets: FibletSet, per_point: dict[str, Member]) -> tuple[dict[str, Any], dict[str, Member]]:
    """The JSON header of a set, and the members that it names."""
    members: dict[str, Member] = {}

    def name(kind: str, member: Member) -> str:
        members[f"{kind}/{len(members)}.npy"] = member
        return list(members)[-1]

    def plain(a: Any) -> Member:
        return array_member(np.asarray(a))

    header = {
        "format": "fiblets",
        "version": VERSION if SPLINE in coded_kind(np.asarray(fiblets.decoding)) else OF_CODES,
        "parameters": asdict(fiblets.parameters),
        "bounds": list(fiblets.bounds),
        "n_streamlines": fiblets.n_streamlines,
        "n_points": fiblets.n_points,
        "n_fiblets": fiblets.n_fiblets,
        "per_point": {
            k: {
                "member": name("per_point", per_point[k]),
                **({} if v.table is None else {"table": name("table", plain(stored_table(v.table)))}),
                **{key: getattr(v, key) for key in VALUE_FACTS},
                "mean_error": float(f"{v.mean_error:.9g}"),  # the order of summing changes its last digits
            }
            for k, v in fiblets.per_point.items()
        },
        "per_streamline": {k: name("per_streamline", plain(v)) for k, v in fiblets.per_streamline.items()},
        "groups": {k: name("groups", plain(v)) for k, v in fiblets.groups.items()},
        "per_group": {
            g: {k: name("per_group", plain(v)) for k, v in values.items()} for g, values in fiblets.per_group.items()
        },
        "affine": np.asarray(fiblets.affine, float).tolist(),
        "space": _jsonable(fiblets.space),
        "dropped": {k: int(v) for k, v in fiblets.dropped.items()},
    }
    return header, members


def is_sharded(path: str | PathLike[str]) -> bool:
    """Whether a set of shards is meant: by a folder, or by an address such as ``https://...``."""
    return is_url(path) or Path(path).is_dir()


def open_fiblets(path: str | PathLike[str], kind: type[FibletSet]) -> FibletSet:
    """Map a ``.fiblets`` file; shards of a folder or an address (:mod:`.shards`) are read at first use."""
    if is_sharded(path):
        from ..shards.unread_set import UnreadSet

        return UnreadSet.open_shards(path)
    header, arrays = open_archive(path)
    if header.get("format") != "fiblets":
        raise FormatError(path, 0, f"format {header.get('format')!r} in header.json", "'fiblets'")
    version = header.get("version")
    if not isinstance(version, int) or version < 1:
        raise FormatError(path, 0, f"version {version!r} in header.json", f"version {VERSION}")
    if version > VERSION:
        raise FormatError(
            path, 0, f"version {version} in header.json", f"at most {VERSION}: update pvfiblets to read this file"
        )
    if version < OF_CODES:
        raise FormatError(
            path,
            0,
            f"version {version} in header.json, written by an older pvfiblets",
            f"versions {OF_CODES} to {VERSION}: compress the original again",
        )
    exact = version >= OF_POINTS and "exact" in header
    try:
        for member, facts in header.get("packed", {}).items() if version >= PACKED else ():
            arrays[member] = unpack(path, member, facts, arrays[member])
        fiblets = _assemble_exact(path, kind, header, arrays) if exact else _assemble(kind, header, arrays)
    except FormatError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise FormatError(
            path, 0, f"a header.json that does not fit its members ({error!r})", "a whole .fiblets file"
        ) from error
    _check_shapes(path, fiblets, fiblets.n_fiblets if exact else int(header["n_fiblets"]), int(header["n_points"]))
    return fiblets


def _assemble_exact(
    path: str | PathLike[str], kind: type[FibletSet], header: dict[str, Any], arrays: dict[str, npt.NDArray[Any]]
) -> FibletSet:
    n_streamlines, n_points = int(header["n_streamlines"]), int(header["n_points"])
    facts = header["exact"]
    points, counts = unpack_points(path, facts, np.asarray(arrays[facts["member"]]), n_streamlines, n_points)
    streamlines = Streamlines(points, offsets_from_counts(counts))
    found = survey([streamlines])
    made = plain_records(streamlines, Parameters.of_exact(found))
    return kind(bounds=bounds_of(found), n_streamlines=n_streamlines, **made, **_data(header, arrays))


def _data(header: dict[str, Any], arrays: dict[str, npt.NDArray[Any]]) -> dict[str, Any]:
    """Return the data beside the points, as fields of a FibletSet; a missing key of the header means none."""
    found = {name: header.get(name, {}) for name in ("per_point", "per_streamline", "groups", "per_group")}
    return {
        "per_point": {
            k: _point_values(v, arrays)
            for k, v in found["per_point"].items()
        },
        "per_streamline": {k: arrays[v] for k, v in found["per_streamline"].items()},
        "groups": {k: arrays[v] for k, v in found["groups"].items()},
        "per_group": {g: {k: arrays[v] for k, v in values.items()} for g, values in found["per_group"].items()},
        "affine": np.array(header["affine"], float).reshape(4, 4),
        "space": dict(header.get("space", {})),
        "dropped": {k: int(v) for k, v in header.get("dropped", {}).items()},
    }


def _point_values(said: dict[str, Any], arrays: dict[str, npt.NDArray[Any]]) -> PointValues:
    """Values of points; older files have no table, and mean even steps."""
    codes, (lo, hi, worst, mean, reference) = arrays[said["member"]], (float(said.get(k, 0.0)) for k in VALUE_FACTS)
    table = opened_table(arrays[said["table"]], 8 * codes.dtype.itemsize) if "table" in said else None
    if "reference" not in said:
        table = linear_table(lo, hi, 8 * codes.dtype.itemsize)
    return PointValues(codes, lo, hi, worst, mean, table, reference)


def _assemble(kind: type[FibletSet], header: dict[str, Any], arrays: dict[str, npt.NDArray[Any]]) -> FibletSet:
    values = header["parameters"]
    values = {"resampled": 0.0, **values}  # which older files do not say
    chosen: dict[str, Any] = {
        f.name: tuple(values[f.name]) if isinstance(values[f.name], list) else values[f.name]
        for f in fields(Parameters)
    }
    parameters = Parameters(**chosen)
    numbers = [*parameters.origin, *parameters.anchor_scale, *header["bounds"]]
    numbers += [v for k, v in asdict(parameters).items() if k not in ("origin", "anchor_scale", "anchor_bits")]
    if len(numbers) != 21 or not np.isfinite(np.array(numbers, float)).all() or parameters.anchor_bits not in (16, 32):
        raise ValueError("parameters out of range")
    if not (parameters.end_scale > 0.0 and parameters.largest_radius >= 0.0):
        raise ValueError(f"end_scale {parameters.end_scale}, largest_radius {parameters.largest_radius}")
    b = [float(v) for v in header["bounds"]]
    plain: dict[str, Any] = {name: arrays[f"{name}.npy"] for name in CORE}
    plain |= {name: arrays.get(f"{name}.npy") for name in OPTIONAL}
    made = kind(
        parameters=parameters,
        bounds=(b[0], b[1], b[2], b[3], b[4], b[5]),
        n_streamlines=int(header["n_streamlines"]),
        **plain,
        **_data(header, arrays),
    )
    if all(name in arrays for name in INDEX_MEMBERS):
        made.__dict__[INDEX] = tuple(arrays[name] for name in INDEX_MEMBERS)
    return made


def _check_shapes(path: str | PathLike[str], f: FibletSet, n: int, n_points: int) -> None:
    """Everything that can be checked without reading the arrays, of so many fiblets and points."""

    def expect(true: bool, found: str, expected: str) -> None:
        if not true:
            raise FormatError(path, None, found, expected)

    for name, (dtype, columns) in _SHAPES.items():
        array = getattr(f, name)
        if array is None:
            continue
        shape = (n, columns) if columns else (n,)
        expect(array.dtype == dtype and array.shape == shape, f"{name} {array.dtype}{array.shape}", f"{dtype}{shape}")
    pages = -(-n // PAGE)
    expect(f.codes.dtype == np.uint8 and f.codes.ndim == 1, f"codes {f.codes.dtype}{f.codes.shape}", "bytes")
    expect(f.pages.dtype == "<i8" and f.pages.shape == (pages + 1, 3), f"pages {f.pages.shape}", f"{(pages + 1, 3)}")
    f.pages = np.array(f.pages)  # small, and read all the time
    table = f.pages
    rising = bool((np.diff(table, axis=0) >= 0).all()) and bool((table >= 0).all())
    expect(rising, "a page table that does not rise", "one that does")
    last = table[-1]
    expect(int(last[1]) == len(f.codes), f"{len(f.codes)} code bytes", f"the {last[1]} of the page table")
    expect(int(last[2]) == n_points, f"{n_points} points", f"the {last[2]} of the page table")
    ranks = int(last[0])
    expect(f.ends.dtype == "<u4" and f.ends.shape == (ranks,), f"ends {f.ends.dtype}{f.ends.shape}", f"<u4({ranks},)")
    if f.rank_to_id is None:
        expect(ranks == f.n_streamlines, f"{f.n_streamlines} streamlines", f"the {ranks} of the page table")
    else:
        expect(f.rank_to_id.shape == (ranks,), f"rank_to_id {f.rank_to_id.shape}", f"({ranks},)")
    expect(
        (f.anchors_low is not None) == (f.parameters.anchor_bits == 32), "anchors_low", "it with 32-bit anchors only"
    )
    for name, points in f.per_point.items():
        kind, meant = points.codes.dtype, points.table
        if meant is None:
            fits = kind.kind in "fiub"
        else:
            fits = kind in (np.dtype(np.uint8), np.dtype("<u2")) and meant.dtype.kind in "fiub"
            fits = fits and meant.shape == (1 << (8 * kind.itemsize),)
        fits = fits and points.codes.shape == (f.n_points,)
        expect(fits, f"per-point {name} {points.codes.dtype}{points.codes.shape}", f"({f.n_points},)")
    for name, rows in f.per_streamline.items():
        expect(
            rows.ndim > 0 and len(rows) == f.n_streamlines, f"per-streamline {name} {rows.shape}", f"{f.n_streamlines}"
        )


def _jsonable(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _jsonable(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_jsonable(v) for v in value]
    if isinstance(value, np.ndarray):
        return _jsonable(value.tolist())
    if isinstance(value, np.generic):
        return value.item()
    return value
