"""The command ``pvfiblets connectome``."""

from __future__ import annotations

import time
from typing import Any

from pvfiblets.cli.files import print_json
from pvfiblets.formats.attachments import numbers_or_name as numbers
from pvfiblets.query.connectome.matrix import Connectome, check_target
from pvfiblets.query.connectome.matrix import connectome as put_together


def connectome(
    source: str, labels: str, target: str, *, weights: str | None, contrast: str, radius: float,
    statistic: str | None, json: bool,
) -> None:  # fmt: skip
    """Write a matrix of how strongly parcels are connected."""
    check_target(target)  # before minutes of work, not after
    begin = time.perf_counter()
    found = put_together(
        source, labels, weights=numbers(weights), contrast=contrast if contrast == "count" else numbers(contrast),
        radius=radius, statistic=statistic,
    )  # fmt: skip
    found.save(target)
    result = facts(target, found, time.perf_counter() - begin)
    if json:
        print_json(result)
        return
    share = 100.0 * result["connecting"] / max(result["streamlines"], 1)
    print(f"{target}: {result['parcels']} x {result['parcels']} parcels, {result['contrast']}, {result['statistic']}")
    print(f"connecting   {result['connecting']:,} of {result['streamlines']:,} streamlines, {share:.3g} %")
    print(f"time         {result['seconds']:.1f} s")


def facts(target: str, found: Connectome, seconds: float) -> dict[str, Any]:
    """Return the keys of ``connectome --json``."""
    return {
        "file": target,
        "contrast": found.contrast,
        "statistic": found.statistic,
        "radius_mm": found.radius,
        "parcels": len(found.labels),
        "streamlines": len(found.ends),
        "connecting": found.n_connecting,
        "seconds": seconds,
    }
