"""Profiles of `FibletActor.color_along`, from all that a user may hold, as values of points."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.formats.attachments import name_of
from pvfiblets.images.sources import is_image
from pvfiblets.query.bundles.along import TABLES, read_profile, values_along
from pvfiblets.query.bundles.tract_profile import tract_profile
from pvfiblets.support.real_numbers import real_numbers

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet


def along_bundle(
    fiblets: FibletSet, profile: Any, n: int, ids: Any, column: str, orient_by: Any
) -> tuple[Any, str, np.ndarray]:
    """Return a profile or its numbers, the name of an array of its values, and these, one per point."""
    shown, said, core = profile, "", None
    if isinstance(profile, (str, os.PathLike)) and os.fspath(profile).lower().endswith(TABLES):
        shown, core = read_profile(profile, column, ids if isinstance(ids, str) else None)
        said = name_of(profile) if column == "mean" else column
    elif isinstance(profile, str) or is_image(profile):
        name = Path(profile).name if isinstance(profile, (str, os.PathLike)) else ""
        shown = tract_profile(fiblets, ids, profile, n, orient_by=orient_by, name=name)
    if hasattr(shown, "mean") and hasattr(shown, "position"):
        core = getattr(shown, "core", None)
        core = core if core is not None and np.isfinite(core).all() else None
        numbers, said = shown.mean, shown.name
    else:
        numbers = shown = real_numbers(shown, "values along a bundle")
    like = core if orient_by is None else orient_by
    # A name of its own: the set may hold the array that was averaged.
    name = said if "profile" in said.lower() else f"{said} profile".strip()
    return shown, name, values_along(fiblets, ids, numbers, orient_by=like)
