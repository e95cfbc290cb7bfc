"""The commands ``pvfiblets convert``, ``info`` and ``verify``."""

from __future__ import annotations

import json as json_
import math
import sys
from collections import Counter
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pvfiblets import formats
from pvfiblets.codec.parameters import DEFAULT_ANGLE
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.formats.rewrite import rewrite
from pvfiblets.line_cells import NOT_LINES
from pvfiblets.support.addresses import is_url, path_of
from pvfiblets.support.summary import counting
from pvfiblets.web.values import plain

if TYPE_CHECKING:
    from pvfiblets.codec.encoding.compress import PerPoint
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.painting.fiblet_index import FibletIndex

COMPRESSED = ".fiblets"


def convert(
    source: str,
    target: str,
    *,
    step: float | None,
    max_error: float | None,
    max_angle: float | None,
    effort: Literal["fast", "high", "small"],
    per_point: list[str],
    per_point_bits: int,
    max_value_error: float | None,
    exact: bool | None,
    shards: int | None,
    small: bool,
    index: bool,
    double: bool,
    verify: Literal["all", "sample"],
    quiet: bool,
    json: bool,
) -> None:
    """Compress a file, in one or in shards, or write it in another format."""
    if Path(source).resolve() == Path(target).resolve():
        raise ValueError(f"{source} would be overwritten by itself; give another name")
    formats.registry.module_for(target, "write")  # before hours of work, not after
    if index and (shards is not None or Path(target).suffix.lower() != COMPRESSED):
        raise ValueError(
            f"--index is for a {COMPRESSED} file; shards are put together when they are opened, and other formats have "
            "no place for it: leave it out"
        )
    if double and formats.registry.suffix_of(target) not in formats.DOUBLES:
        raise ValueError(
            f"--double is for {' and '.join(formats.DOUBLES)} files; {target} is of another format: leave it out"
        )
    if Path(target).suffix.lower() == COMPRESSED:
        indexed: list[FibletIndex] = []
        if shards is None:
            from pvfiblets.codec.files.convert import compress_file

            work = partial(compress_file, prepare=partial(_index, indexed) if index else None)
        else:
            from pvfiblets.codec.shards.write import compress_file_in_shards

            work = partial(compress_file_in_shards, size=shards)
        result = work(
            source,
            target,
            small=small,
            step="auto" if step is None else step,
            max_error=max_error,
            max_angle=max_angle,
            effort=effort,
            per_point=which_per_point(per_point),
            per_point_bits=per_point_bits,
            max_value_error=max_value_error,
            exact=exact,
            verify=verify,
            progress=show_progress(quiet, json),
        )
        if index:
            made = next(iter(indexed), None)
            result["index_bytes"] = 0 if made is None else made.nbytes
            result["index_seconds"] = 0.0 if made is None else made.seconds
    else:
        own = (step, max_error, max_value_error, exact, shards) != (None,) * 5 or max_angle != DEFAULT_ANGLE
        if own or small or per_point or verify != "all":
            raise ValueError(
                "--step, --max-error, --max-angle, --max-value-error, --exact, --per-point, --verify, --shards and "
                f"--small are for {COMPRESSED} files; {target} is of another format"
            )
        result = rewrite(source, target, double=double)
    if json:
        print_json(result)
    else:
        print(summary(source, target, result))


def _index(made: list[FibletIndex], fiblets: FibletSet) -> None:
    """Make the spatial index of a set that is about to be written, and note it."""
    from pvfiblets.regions import index_of

    made.append(index_of(fiblets))


def which_per_point(given: list[str]) -> PerPoint:
    """Return what ``--per-point``, given so often, asks to keep."""
    words = [word for word in given if word in ("all", "none")]
    if words and len(given) > 1:
        raise ValueError(f"--per-point is given as {', '.join(given)}; give all, or none, or names")
    if words == ["all"]:
        return "all"
    return "none" if words else given or "fit"


def info(path: str, *, json: bool) -> None:
    """Print what a file holds."""
    facts: dict[str, Any] = {"file": path, "bytes": None, **_facts(path)}
    facts.pop("path", None)
    if not is_url(path):
        facts["bytes"] = bytes_of(path)
    if json:
        print_json(facts)
        return
    _print_facts(facts)


def _print_facts(facts: dict[str, Any]) -> None:
    """Print what there is a line each, and what reading left out last."""
    dropped = facts.pop("dropped", None) or {}
    for key, value in facts.items():
        if value is None or (isinstance(value, (list, dict, tuple)) and not value):
            continue
        print(f"{key:<16} {readable(value)}")
    for reason, count in dropped.items():
        print(f"{'dropped':<16} {count:,}: {reason}")


def _facts(path: str) -> dict[str, Any]:
    """Return the facts of a tractogram, or of a surface."""
    try:
        facts = formats.info(path)
    except UnknownFormatError:
        from pvfiblets.plotting.meshes import SUFFIXES, mesh_facts

        if is_url(path) or not path.lower().endswith(SUFFIXES):
            raise
        return mesh_facts(path)
    if "dropped" not in facts:  # the header may be wrong of counts, and knows nothing of damage
        return facts | _counted(path)
    if facts["streamlines"] or NOT_LINES not in facts["dropped"]:
        return facts
    from pvfiblets.plotting.meshes import mesh_facts

    return mesh_facts(path)


def _counted(path: str) -> dict[str, Any]:
    """Return the counts of streamlines and points in a file, and of what reading leaves out."""
    streamlines = points = 0
    dropped: Counter[str] = Counter()
    for chunk in counting(formats.iter_chunks(path), dropped):
        streamlines, points = streamlines + len(chunk), points + chunk.n_points
    return {"streamlines": streamlines, "points": points, "dropped": dict(dropped)}


def verify(path: str, original: str | None, *, max_angle: float | None, quiet: bool, json: bool) -> None:
    """Check a compressed file's checksums and, given the original, every point and direction."""
    from pvfiblets.codec.files.verify import refuse_broken_promise, verified

    result = verified(path, original, max_angle=max_angle, progress=show_progress(quiet, json))
    if json:
        print_json(result)
    else:
        _print_facts(dict(result))
    refuse_broken_promise(result)


def summary(source: str, target: str, result: dict[str, Any]) -> str:
    """Return the outcome of ``convert`` for people."""
    before, after = bytes_of(source), result["bytes"]
    parts = f", in {result['shards']:,} shards" if "shards" in result else ""
    lines = [
        f"{target}: {result['streamlines']:,} streamlines, {result['points']:,} points{parts}",
        f"size     {after:,} bytes, {result['bytes_per_point']:.2f} per point; "
        f"{100.0 * after / max(before, 1):.1f} % of {Path(source).name}",
    ]
    if result.get("exact"):
        lines.append("error    none: exact, every bit of the points and their values is kept")
    elif result.get("error_mm"):
        if (every := result["compared_every"]) > 1:
            ending = "th" if every % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(every % 10, "th")
            lines.append(f"compared every {every}{ending} streamline with its original (--verify all: each)")
        lines += [
            "error    " + ", ".join(f"{k} {v:.2g} mm" for k, v in result["error_mm"].items()),
        ]
        if math.isfinite(result["error_steps"]["max"]):  # else no segment has a length
            lines.append("         " + ", ".join(f"{k} {v:.2g} steps" for k, v in result["error_steps"].items()))
        if result["points"] and math.isfinite(result["error_degrees"]["max"]):
            angles = ", ".join(f"{k} {v:.2g}°" for k, v in result["error_degrees"].items())
            lines.append(f"         directions: {angles}")
    if "seconds" in result:  # else the source was compressed before
        speed = result["points_per_second"] / 1e6
        lines.append(f"time     {result['seconds']:.1f} s, {speed:.1f} million points per second")
    if result.get("index_bytes"):
        lines.append(f"index    {result['index_bytes']:,} bytes, made in {result['index_seconds']:.1f} s")
    elif "index_bytes" in result:
        lines.append("index    none: an exact file's fiblets are made when it is opened, and their index with them")
    for name, error in result.get("error_values", dict.fromkeys(result.get("per_point", ()))).items():
        told = "" if error is None else ": exact"
        if error is not None and error["max"]:
            told = f": off by max {error['max']:.2g}, mean {error['mean']:.2g}"
        lines.append(f"values   {name}{told}")
    lines += [f"dropped  {number:,}: {reason}" for reason, number in result["dropped"].items()]
    return "\n".join(lines)


def bytes_of(path: str | Path) -> int:
    """Return the size of a file, or of a folder's files."""
    place = path_of(path)
    files = [part for part in place.rglob("*") if part.is_file()] if place.is_dir() else [place]
    return sum(part.stat().st_size for part in files)


def show_progress(quiet: bool, json: bool) -> bool:
    """Return whether a person is there to watch a progress bar."""
    return not (quiet or json) and sys.stderr.isatty()


def print_json(result: dict[str, Any]) -> None:
    """Print a result as strict JSON: no NaN, no NumPy types."""
    print(json_.dumps(plain(result), allow_nan=False))


def readable(value: Any) -> str:
    """Return a value on one line, for people."""
    value = plain(value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, float):
        # For points at one place, and others as near: 300 zeros are unreadable.
        small, large = 0.0 < abs(value) < 1e-30, 1e99 < value < math.inf
        return "less than 1e-30" if small else "more than 1e99" if large else f"{value:.6g}"
    if value is None:
        return "none"
    if isinstance(value, dict):
        return ", ".join(f"{key} {readable(item)}" for key, item in value.items())
    if isinstance(value, list):
        return ", ".join(f"[{readable(item)}]" if isinstance(item, list) else readable(item) for item in value)
    return str(value)
