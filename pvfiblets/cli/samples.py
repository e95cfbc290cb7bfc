"""What ``pvfiblets sample`` does."""

from __future__ import annotations

import warnings
from dataclasses import replace
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets import formats
from pvfiblets.codec.files.open_lines import open_lines
from pvfiblets.formats import registry
from pvfiblets.formats.attachments import write_scalars
from pvfiblets.images.sources import as_image
from pvfiblets.query.measures.samples import PointWeights, Statistic
from pvfiblets.query.measures.samples import sample as sampled
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.whole_files import replacing

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

__all__ = ["sample"]

NUMBERS = (".txt", ".csv", ".npy")
BITS = 16  # of a value in a .fiblets file


def sample(
    source: str, image: str, target: str, *, statistic: Statistic | None, weights: PointWeights, nearest: bool,
    name: str | None,
) -> None:  # fmt: skip
    """Write the values of an image along streamlines, or the streamlines with these."""
    suffix = Path(target).suffix.lower()
    if suffix == ".tsf" and statistic is not None:
        raise ValueError(f"{target}: a .tsf file has a value per point; for --statistic give {', '.join(NUMBERS)}")
    if suffix not in (".tsf", *NUMBERS):
        registry.module_for(target, "write")  # before any work, not after
    taken = as_image(image)
    data = open_lines(source)
    values = sampled(data, taken, statistic, weights=weights, nearest=nearest)
    if suffix in NUMBERS:
        _write_numbers(Path(target), values)
        return
    called = name or taken.name
    if suffix == ".tsf":
        lines = _decoded(data)
        if lacking := int(np.isnan(values).sum()):
            warnings.warn(
                f"{lacking:,} of {len(values):,} points have no value in {image}; {target} has 0 there",
                UserWarning,
                stacklevel=2,
            )
        known = np.nan_to_num(values).astype(np.float32)
        write_scalars(target, Streamlines(lines.points, lines.offsets, {called: known}, space=lines.space), called)
    else:
        _write_lines(target, data, called, values, per_point=statistic is None)


def _decoded(data: FibletSet | Streamlines) -> Streamlines:
    return data if isinstance(data, Streamlines) else data.decompress()


def _write_numbers(target: Path, values: npt.NDArray[np.float64]) -> None:
    """Write a number a row."""
    with replacing(target) as file:
        if target.suffix.lower() == ".npy":
            np.save(file, values)
            return
        text = TextIOWrapper(file, encoding="utf-8")
        text.writelines(f"{value!r}\n" for value in values.tolist())
        text.flush()
        text.detach()  # the file is closed by who opened it


def _write_lines(target: str, data: Any, name: str, values: npt.NDArray[np.float64], *, per_point: bool) -> None:
    """Write a tractogram with one more array."""
    numbers = values.astype(np.float32)
    if not isinstance(data, Streamlines) and registry.suffix_of(target) == ".fiblets":
        from pvfiblets.codec.point_arrays import with_point_values

        if per_point:
            with_point_values(data, name, numbers, BITS).save(target)
        else:
            replace(data, per_streamline={**data.per_streamline, name: numbers}).save(target)
        return
    lines = _decoded(data)
    if per_point:
        lines.per_point = {**lines.per_point, name: numbers}
    else:
        lines.per_streamline = {**lines.per_streamline, name: numbers}
    formats.write(target, lines)
