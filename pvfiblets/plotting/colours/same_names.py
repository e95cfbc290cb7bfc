"""Arrays of points and of lines that share a name: which of the two the name means."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import is_dataclass, replace
from typing import Any, Literal, TypeAlias

import numpy as np

from pvfiblets.plotting.actors.source_changes import is_dataset

Preference: TypeAlias = Literal["point", "cell"]

_OTHER = {"point": "line", "cell": "point"}


def with_preference(source: Any, preference: Preference) -> Any:
    """Return a source in which each name means one array, that of points or that of lines (cells of VTK)."""
    # The other array of this name is called `"NAME (line)"` or `"NAME (point)"`, and can be used by that. Sources
    # without such names are returned as they are, others are not changed.
    if preference not in _OTHER:
        raise ValueError(f"preference is {preference!r}; choose 'point' or 'cell'")
    other = _OTHER[preference]
    if is_dataset(source):
        import pyvista as pv

        mesh = pv.wrap(source)
        both = [name for name in mesh.point_data if name in mesh.cell_data]
        if not both:
            return source
        mesh = mesh.copy(deep=False)
        data = mesh.cell_data if preference == "point" else mesh.point_data
        for name in both:
            values = np.array(data[name])  # a copy: a new name would be the source's, too
            data.remove(name)
            data[f"{name} ({other})"] = values
        return mesh
    held = "per_streamline" if preference == "point" else "per_point"
    points, lines = (getattr(source, name, None) for name in ("per_point", "per_streamline"))
    if not isinstance(points, Mapping) or not isinstance(lines, Mapping) or not set(points) & set(lines):
        return source
    data = lines if preference == "point" else points
    rest = lines if data is points else points
    renamed = {f"{name} ({other})" if name in rest else name: values for name, values in data.items()}
    if is_dataclass(source) and not isinstance(source, type):
        return replace(source, **{held: renamed})
    copy = source[:]
    setattr(copy, held, renamed)
    return copy
