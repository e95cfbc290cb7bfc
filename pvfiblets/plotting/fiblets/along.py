"""Profiles of `FibletActor.color_along`, from all that a user may hold, as values of points."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.codec.editing.point_arrays import with_point_values
from pvfiblets.errors import FormatError
from pvfiblets.formats.attachments import name_of
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.images.sources import is_image
from pvfiblets.plotting.fiblets.sources import with_values_of
from pvfiblets.query.bundles.along import TABLES, Profile, read_profile, read_profiles, values_along
from pvfiblets.query.bundles.tract_profile import tract_profile
from pvfiblets.support.real_numbers import real_numbers

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet

MOST_POSITIONS = 1000  # a longer column is of other streamlines


def with_table_of(fiblets: FibletSet, path: str | os.PathLike[str]) -> FibletSet:
    """Return a set with the values of a file more: of its points, its streamlines, or positions along its bundles."""
    try:
        return with_values_of(fiblets, path)
    except (FormatError, UnknownFormatError):
        found = profiles_in(fiblets, path)
        if not found:
            raise
    for name, profiles in found.items():
        values = np.full(fiblets.n_points, np.nan)
        for group, (along, core) in profiles.items():
            more = values_along(fiblets, slice(None) if group is None else group, along, orient_by=core)
            values = np.where(np.isnan(more), values, more)
        fiblets = with_point_values(fiblets, name, values, bits=16)
    return fiblets


def profiles_in(fiblets: FibletSet, path: str | os.PathLike[str]) -> dict[str, dict[str | None, Profile]]:
    """Return the profiles in a file by array and by group of a set; nothing of values of points or streamlines."""
    if not os.fspath(path).lower().endswith(TABLES):
        return {}
    found = read_profiles(path, fiblets.groups)
    if "" in found:
        length = len(found[""][None][0])
        if length in (fiblets.n_points, fiblets.n_streamlines) or not 2 <= length <= MOST_POSITIONS:
            return {}
    name = name_of(path)
    return {name if column in ("", "mean") else f"{name} {column}": rows for column, rows in found.items()}


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
