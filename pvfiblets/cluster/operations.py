"""What a batch can do to one file: to a file, to rows of numbers, or to both.

An operation is a function of a source, of the file to be made (``None`` where there is none) and of its options; it
returns columns of numbers. It knows nothing of clusters: everything about where and when it runs lies in :mod:`.task`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from pvfiblets import formats
from pvfiblets.codec.parameters import DEFAULT_ANGLE
from pvfiblets.formats import registry

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.measures.samples import PointWeights, Statistic
    from pvfiblets.query.selection.point_flags import Sampling
    from pvfiblets.streamlines import Streamlines

    from .tables import Columns

COMPRESSED = ".fiblets"
PIECE = 1 << 20  # points looked at together


def convert(
    source: Path,
    target: Path,
    *,
    to: str = COMPRESSED,
    step: float | None = None,
    max_error: float | None = None,
    max_angle: float | None = DEFAULT_ANGLE,
    effort: Literal["fast", "high", "small"] = "fast",
    per_point: Any = "fit",
    per_point_bits: int = 8,
    exact: bool | None = None,
) -> Columns:
    """Compress, or write in another format; options as of :func:`pvfiblets.compress_file`."""
    if to == COMPRESSED:
        from pvfiblets.codec.files.convert import compress_file

        result = compress_file(
            source, target, step="auto" if step is None else step, max_error=max_error, max_angle=max_angle,
            effort=effort, per_point=per_point, per_point_bits=per_point_bits, exact=exact,
        )  # fmt: skip
    else:
        from pvfiblets.formats.rewrite import rewrite

        result = rewrite(str(source), str(target))
    told = ("streamlines", "points", "fiblets", "bytes", "bytes_per_point", "promise_mm", "exact")
    row = {name: result[name] for name in told if result.get(name) is not None}
    return row | _errors(result) | {"dropped": sum(result["dropped"].values())}


def verify(
    source: Path, target: None = None, *, original: str | None = None, max_angle: float | None = DEFAULT_ANGLE
) -> Columns:
    """Check against checksums, and against the original; as :func:`pvfiblets.codec.files.verify.verified`."""
    del target
    from pvfiblets.codec.files.verify import refuse_broken_promise, verified

    result = verified(source, original, max_angle=max_angle)
    refuse_broken_promise(result)
    told = ("checksums", "streamlines", "points", "exact", "promise_mm", "kept", "directions_kept")
    row = {name: result[name] for name in told if name in result} | _errors(result)
    return row | {"dropped": sum(result["dropped"].values())} if original is not None else row


def density(
    source: Path,
    target: Path,
    *,
    to: str = ".nii.gz",
    voxel: float | Sequence[float] | None = None,
    like: str | None = None,
    contrast: str = "count",
    weights: str | None = None,
    ends_only: bool = False,
) -> Columns:
    """Add streamlines up in the voxels of a grid; options as of :func:`pvfiblets.density`."""
    del to
    from pvfiblets.formats.attachments import numbers_or_name
    from pvfiblets.query.density.volume import CONTRASTS
    from pvfiblets.query.density.volume import density as add_up

    found = add_up(
        source, voxel, like=like, weights=numbers_or_name(weights),
        contrast=contrast if contrast in CONTRASTS else numbers_or_name(contrast), ends_only=ends_only,
    )  # fmt: skip
    found.save(target)
    voxels = found.values.reshape(*found.grid.shape, -1)
    nx, ny, nz = found.grid.shape
    return {
        "contrast": found.name, "nx": nx, "ny": ny, "nz": nz,
        "low": float(voxels.min()), "high": float(voxels.max()), "mean": float(voxels.mean(dtype=np.float64)),
        "share_not_zero": float((voxels != 0).any(axis=3).mean()), "share_outside": found.share_outside,
    }  # fmt: skip


def select(
    source: Path,
    target: Path,
    *,
    to: str = COMPRESSED,  # noqa: ARG001 - the target's name says it
    passes: Sequence[str] = (),
    avoids: Sequence[str] = (),
    ends_in: Sequence[str] = (),
    both_ends_in: Sequence[str] = (),
    stays_in: Sequence[str] = (),
    sampling: Sampling = "lines",
) -> Columns:
    """Write the streamlines that satisfy all conditions; regions as :func:`.query.region_text.parse_region`."""
    from pvfiblets.query.regions.region_text import parse_region
    from pvfiblets.query.selection import predicates

    conditions = [
        *(predicates.passes(parse_region(text), sampling=sampling) for text in passes),
        *(~predicates.passes(parse_region(text), sampling=sampling) for text in avoids),
        *(predicates.ends_in(parse_region(text)) for text in ends_in),
        *(predicates.ends_in(parse_region(text), "both") for text in both_ends_in),
        *(predicates.stays_in(parse_region(text), sampling=sampling) for text in stays_in),
    ]
    wanted = conditions[0]
    for condition in conditions[1:]:
        wanted = wanted & condition
    if registry.suffix_of(source) == COMPRESSED:
        fiblets = _opened(source)
        chosen = fiblets.select(wanted)
        fiblets.extract(chosen).save(target)
        counts = [len(chosen), int(chosen.sum()), 0]
    else:
        from pvfiblets.formats.spool import gathered

        counts = [0, 0, 0]
        with gathered(_chosen(source, wanted, counts), target.parent) as streamlines:
            formats.write(target, streamlines)
    n, kept, dropped = counts
    return {"streamlines": n, "selected": kept, "share": kept / n if n else 0.0, "dropped": dropped}


def _chosen(source: Path, wanted: Any, counts: list[int]) -> Iterator[Streamlines]:
    """Go through a file that is not compressed; its points are looked at as they are."""
    from pvfiblets.codec.encoding.compress import compress
    from pvfiblets.streamlines import Streamlines

    for chunk in formats.iter_chunks(source, PIECE):
        bare = Streamlines(chunk.points, chunk.offsets)
        keep = compress(bare, exact=True, per_point=()).select(wanted)
        counts[0] += len(keep)
        counts[1] += int(keep.sum())
        counts[2] += sum(chunk.dropped.values())
        yield chunk[np.flatnonzero(keep)]


def profile(source: Path, target: None = None, *, values: str, positions: int = 100) -> Columns:
    """Mean values at places along each group of streamlines, or along all; as :func:`.query.profile.mean_profile`."""
    # `values` names an array or a computed measure, or is an image, which is sampled at the points.
    del target
    from pvfiblets.images.sources import is_image
    from pvfiblets.query.measures.profile import mean_profile

    image = is_image(values)
    fiblets = _compressed(source, () if image else (values,))
    given: Any = _sampled(fiblets, values) if image else values
    bundles = fiblets.groups or {"": np.arange(len(fiblets))}
    columns: dict[str, list[Any]] = {name: [] for name in ("bundle", "position", "mean", "std", "streamlines")}
    for name, members in bundles.items():
        mean, std = mean_profile(fiblets, members, given, positions)
        columns["bundle"] += [name] * positions
        columns["position"] += np.linspace(0.0, 1.0, positions).tolist()
        columns["mean"] += mean.tolist()
        columns["std"] += std.tolist()
        columns["streamlines"] += [len(members)] * positions
    if not fiblets.groups:
        del columns["bundle"]  # a name of the file may say it
    return columns


def connectome(
    source: Path,
    target: None = None,
    *,
    labels: str,
    weights: str | None = None,
    contrast: str = "count",
    radius: float = 4.0,
    statistic: str | None = None,
) -> Columns:
    """A row for each pair of parcels; options as of :func:`pvfiblets.connectome`."""
    del target
    from pvfiblets.formats.attachments import numbers_or_name
    from pvfiblets.query.connectome.matrix import connectome as put_together

    found = put_together(
        source, labels, weights=numbers_or_name(weights),
        contrast=contrast if contrast == "count" else numbers_or_name(contrast), radius=radius, statistic=statistic,
    )  # fmt: skip
    first, second = np.triu_indices(len(found.labels))
    return {
        "parcel_a": found.labels[first], "parcel_b": found.labels[second], "value": found.matrix[first, second],
        "count": found.counts[first, second], "contrast": found.contrast, "statistic": found.statistic,
    }  # fmt: skip


def sample(
    source: Path,
    target: Path,
    *,
    to: str = ".txt",  # noqa: ARG001 - the target's name says it
    image: str,
    statistic: Statistic | None = None,
    weights: PointWeights = "length",
    nearest: bool = False,
    name: str | None = None,
) -> Columns:
    """Write the values of an image along streamlines; options as of :func:`pvfiblets.sample`."""
    from pvfiblets.query.measures.sample_files import write_samples

    values, dropped = write_samples(
        str(source), image, str(target), statistic=statistic, weights=weights, nearest=nearest, name=name
    )
    known = values[np.isfinite(values)]
    low, mean, high = (known.min(), known.mean(), known.max()) if known.size else (np.nan,) * 3
    return {
        "values": len(known), "without_value": len(values) - len(known), "low": low, "mean": mean, "high": high,
        "dropped": dropped,
    }  # fmt: skip


def _opened(source: Path) -> FibletSet:
    from pvfiblets.codec.fibletset import FibletSet

    return FibletSet.open(source)


def _compressed(source: Path, names: tuple[str, ...]) -> FibletSet:
    """Return a source as fiblets, of points as they are, with those of some arrays that it has."""
    if registry.suffix_of(source) == COMPRESSED:
        return _opened(source)
    from pvfiblets import compress

    streamlines = formats.read(source)
    return compress(streamlines, exact=True, per_point=[n for n in names if n in streamlines.per_point],
                    per_point_bits=16)  # fmt: skip


def _sampled(fiblets: FibletSet, image: str) -> Any:
    """Values of an image at all points, in the order in which these are coded."""
    from pvfiblets.images.sources import as_image
    from pvfiblets.query.measures.measures import decoded_by_rank

    volume = as_image(image)
    parts = [volume.at(c.points, nearest=volume.is_labels) for c in decoded_by_rank(fiblets, PIECE, np.float64)]
    return np.concatenate(parts) if parts else np.zeros(0)


def _errors(result: dict[str, Any]) -> dict[str, float]:
    """Errors as columns: ``error_mm_max`` and so on."""
    found: dict[str, float] = {}
    for kind in ("error_mm", "error_steps", "error_degrees"):
        found |= {f"{kind}_{name}": float(value) for name, value in (result.get(kind) or {}).items()}
    return found


@dataclass(frozen=True)
class Operation:
    """An operation, its result, and its options."""

    name: str
    run: Callable[..., Columns]  # `(source, target, **options) -> columns`
    # refuses options whose file, with the suffix `to`, cannot be written; None if it makes no file
    check_file: Callable[[Mapping[str, Any]], object] | None = None
    takes: tuple[str, ...] = ()  # suffixes of sources; any format if empty
    # options that may be paths; names between braces there are replaced by parts of the source's name
    paths: tuple[str, ...] = ()
    needs: tuple[tuple[str, ...], ...] = ()  # options; exactly one must be given

    def defaults(self) -> dict[str, Any]:
        """Options and their values where none are given."""
        found = inspect.signature(self.run).parameters
        return {name: p.default for name, p in found.items() if p.kind is p.KEYWORD_ONLY}

    def checked(self, options: dict[str, Any]) -> dict[str, Any]:
        """Return all options, with defaults."""
        known = self.defaults()
        strange = sorted(set(options) - set(known))
        if strange:
            raise TypeError(f"{self.name} has no option {', '.join(strange)}; it has {', '.join(known)}")
        for names in self.needs:
            if not any(_given(options.get(name)) for name in names):
                raise ValueError(f"{self.name} needs {' or '.join(names)}; give {names[0]}=")
        made = {name: options.get(name, value) for name, value in known.items()}
        if self.check_file is not None:
            self.check_file(made)
        return made

    def check_source(self, source: Path) -> None:
        """Refuse a source that the operation cannot take, by its name."""
        suffix = registry.suffix_of(source)
        if self.takes and suffix not in self.takes:
            raise ValueError(f"{source}: {self.name} is for {', '.join(self.takes)} files")


def _given(value: Any) -> bool:
    with suppress(TypeError):
        return len(value) > 0
    return value is not None


def _check_lines(options: Mapping[str, Any]) -> None:
    registry.module_for(f"made{options['to']}", "write")


def _check_map(options: Mapping[str, Any]) -> None:
    from pvfiblets.query.density.map_files import check_suffix

    check_suffix(f"map{options['to']}")


def _check_numbers(options: Mapping[str, Any]) -> None:
    from pvfiblets.query.measures.sample_files import check_target

    check_target(f"made{options['to']}", options["statistic"])


OPERATIONS: dict[str, Operation] = {
    made.name: made
    for made in (
        Operation("convert", convert, _check_lines),
        Operation("verify", verify, None, (COMPRESSED,), ("original",)),
        Operation("density", density, _check_map, (), ("like", "weights", "contrast"), (("voxel", "like"),)),
        Operation(
            "select", select, _check_lines, (), ("passes", "avoids", "ends_in", "both_ends_in", "stays_in"),
            (("passes", "avoids", "ends_in", "both_ends_in", "stays_in"),),
        ),
        Operation("profile", profile, None, (), ("values",), (("values",),)),
        Operation("connectome", connectome, None, (), ("labels", "weights", "contrast"), (("labels",),)),
        Operation("sample", sample, _check_numbers, (), ("image",), (("image",),)),
    )
}  # fmt: skip
"""By name: what a batch can do."""
