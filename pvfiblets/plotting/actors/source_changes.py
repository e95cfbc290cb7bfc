"""Changes in place of a data set that was copied when it was added: actors do not follow, and a warning tells of it.

`add_mesh` follows them. To follow here would compress the data anew in every frame of an animation without a word.
"""

from __future__ import annotations

import warnings
from typing import Any


def is_dataset(source: Any) -> bool:
    """Return whether a source is a data set of VTK's, PyVista's included."""
    return hasattr(source, "IsA") and bool(source.IsA("vtkDataSet"))


class SourceChanges:
    """The state in which a data set was added."""

    def __init__(self, source: Any, actor: Any) -> None:
        from pvfiblets.mappers.frames.scene import weak

        self._source, self._drawn = weak(source), _drawn_by(actor)
        self._times = _times(source)

    def warn(self, actor: Any, add: str) -> bool:
        """Warn if the data set has changed, and return True once no further warning is needed."""
        source = self._source.Get()
        if source is None or _drawn_by(actor) is not self._drawn:  # the caller gave other data
            return True
        now = _times(source)
        changed = [name for name, time in self._times.items() if now.get(name, time) != time]
        if not changed:
            return False
        how = "actor.update(mesh) has it drawn anew"
        if not hasattr(actor, "update"):
            how = f"{add}(mesh, name={actor.name!r}) draws it anew in the actor's place"
        warnings.warn(
            f"{', '.join(changed)} of the {type(source).__name__} changed after {add}() had copied it, so the "
            f"image is out of date: {how}",
            UserWarning,
            stacklevel=4,
        )
        return True


def _drawn_by(actor: Any) -> Any:
    return getattr(actor, actor._DATA)  # noqa: SLF001 - of this package's actors


def _times(source: Any) -> dict[str, int]:
    """Return when points, lines and each array were changed last."""
    found = {}
    for name, get in (("points", "GetPoints"), ("lines", "GetLines")):
        part = getattr(source, get)() if hasattr(source, get) else None
        if part is not None:
            found[name] = part.GetMTime()
    for data in (source.GetPointData(), source.GetCellData()):
        for index in range(data.GetNumberOfArrays()):
            array = data.GetAbstractArray(index)
            found[f"array {array.GetName()!r}"] = array.GetMTime()
    return found
