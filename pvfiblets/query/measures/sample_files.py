"""Files of the values of an image along streamlines: numbers, one a row, or the streamlines with them."""

from __future__ import annotations

import warnings
from dataclasses import replace
from io import TextIOWrapper
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ... import formats
from ...codec.files.open_lines import open_lines
from ...formats import registry
from ...formats.attachments import write_scalars
from ...images.sources import as_image
from ...streamlines import Streamlines
from ...support.whole_files import replacing
from .samples import PointWeights, Statistic, sample

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet

NUMBERS = (".txt", ".csv", ".npy")
BITS = 16  # of a value in a .fiblets file


def check_target(target: str, statistic: Statistic | None) -> str:
    """Return the suffix of a file that such values can be written to; ValueError for others."""
    suffix = Path(target).suffix.lower()
    if suffix == ".tsf" and statistic is not None:
        raise ValueError(f"{target}: a .tsf file has a value per point; for --statistic give {', '.join(NUMBERS)}")
    if suffix not in (".tsf", *NUMBERS):
        registry.module_for(target, "write")
    return suffix


def write_samples(
    source: str, image: str, target: str, *, statistic: Statistic | None, weights: PointWeights, nearest: bool,
    name: str | None,
) -> tuple[npt.NDArray[np.float64], int]:  # fmt: skip
    """Write the values of an image along streamlines, or the streamlines with these."""
    # Return the values, and how many parts of the source reading left out.
    suffix = check_target(target, statistic)  # before any work, not after
    taken = as_image(image)
    data = open_lines(source)
    values = sample(data, taken, statistic, weights=weights, nearest=nearest)
    dropped = sum(data.dropped.values())
    if suffix in NUMBERS:
        _write_numbers(Path(target), values)
        return values, dropped
    called = name or taken.name
    if suffix == ".tsf":
        lines = _decoded(data)
        if lacking := int(np.isnan(values).sum()):
            warnings.warn(
                f"{lacking:,} of {len(values):,} points have no value in {image}; the .tsf of {source} has 0 there",
                UserWarning,
                stacklevel=2,
            )
        known = np.nan_to_num(values).astype(np.float32)
        write_scalars(target, Streamlines(lines.points, lines.offsets, {called: known}, space=lines.space), called)
    else:
        _write_lines(target, data, called, values, per_point=statistic is None)
    return values, dropped


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
        text.detach()  # the caller closes the file


def _write_lines(target: str, data: Any, name: str, values: npt.NDArray[np.float64], *, per_point: bool) -> None:
    """Write a tractogram with one more array."""
    numbers = values.astype(np.float32)
    if not isinstance(data, Streamlines) and registry.suffix_of(target) == ".fiblets":
        from pvfiblets.codec.editing.point_arrays import with_point_values

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
