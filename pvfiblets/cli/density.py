"""The command ``pvfiblets density``."""

from __future__ import annotations

import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

import numpy as np

from pvfiblets.cli.files import print_json, show_progress
from pvfiblets.formats.attachments import numbers_or_name as numbers
from pvfiblets.query.density.density_map import DensityMap
from pvfiblets.query.density.map_files import check_suffix
from pvfiblets.query.density.volume import CONTRASTS
from pvfiblets.query.density.volume import density as add_up


def density(
    source: str,
    target: str,
    *,
    voxel: list[float] | None,
    like: str | None,
    contrast: str,
    weights: str | None,
    ends_only: bool,
    quiet: bool,
    json: bool,
) -> None:
    """Write a volume of density."""
    check_suffix(target)  # before minutes of work, not after
    if voxel is not None and len(voxel) not in (1, 3):
        raise ValueError(f"--voxel has {len(voxel)} numbers; give one side in mm, or three")
    begin = time.perf_counter()
    with _warnings_off() if quiet else nullcontext():
        found = add_up(
            source,
            None if voxel is None else voxel if len(voxel) == 3 else voxel[0],
            like=like,
            weights=numbers(weights),
            contrast=contrast if contrast in CONTRASTS else numbers(contrast),
            ends_only=ends_only,
            progress=show_progress(quiet, json),
        )
    seconds = time.perf_counter() - begin
    found.save(target)
    result = facts(target, found, seconds)
    if json:
        print_json(result)
    else:
        print(summary(result))


@contextmanager
def _warnings_off() -> Iterator[None]:
    """Restrict the package's log to errors in this scope: the process may go on to do other things."""
    logger = logging.getLogger("pvfiblets")
    level = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(level)


def facts(target: str, found: DensityMap, seconds: float) -> dict[str, Any]:
    """Return the keys of ``density --json``."""
    voxels = found.values.reshape(*found.grid.shape, -1)
    return {
        "file": target,
        "contrast": found.name,
        "unit": found.unit or None,
        "shape": list(found.grid.shape),
        "voxel_mm": np.linalg.norm(found.affine[:3, :3], axis=0).tolist(),
        "low": float(voxels.min()),
        "high": float(voxels.max()),
        "share_not_zero": float((voxels != 0).any(axis=3).mean()),
        "share_outside": found.share_outside,
        "seconds": seconds,
    }


def summary(result: dict[str, Any]) -> str:
    """Return the same for people."""
    sides = " x ".join(f"{n:,}" for n in result["shape"])
    lines = [
        f"{result['file']}: {sides} voxels of {' x '.join(f'{mm:.4g}' for mm in result['voxel_mm'])} mm",
        f"{result['contrast']:<8} {result['low']:.6g} to {result['high']:.6g} {result['unit'] or ''}".rstrip()
        + f"; {100.0 * result['share_not_zero']:.3g} % of the voxels are not 0",
        f"time     {result['seconds']:.1f} s",
    ]
    if result["share_outside"] > 1e-9:
        lines.insert(2, f"outside  {100.0 * result['share_outside']:.3g} % of the streamlines, which no voxel holds")
    return "\n".join(lines)
