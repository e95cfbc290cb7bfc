"""What users set of an actor's ``prop``, as they do of any PyVista actor, changes what is drawn.

VTK itself obeys opacity, lighting, ambient, diffuse and specular shares. Colour, line width and round lines are this
package's own to draw: an actor watches its property, and takes over what changed there.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["LinkedProperty", "is_own_write", "own_writes"]

_writing = 0


@contextmanager
def own_writes() -> Iterator[None]:
    """While open, no actor takes changes of a property or look-up table for a user's."""
    global _writing
    _writing += 1
    try:
        yield
    finally:
        _writing -= 1


def is_own_write() -> bool:
    """Say whether what is being changed is by this package."""
    return _writing > 0


class LinkedProperty:
    """The part of an actor that watches its property, which it may share with others."""

    _watched: Any = None
    _tag = 0

    def SetProperty(self, prop: Any) -> None:  # noqa: N802 - VTK's name
        """Have another property, and take over what it says."""
        super().SetProperty(prop)  # type: ignore[misc]  # of vtkActor
        self._watch_property(prop)
        self._take_property()

    def _watch_property(self, prop: Any) -> None:
        if self._watched is not None:
            self._watched.RemoveObserver(self._tag)
        this = weakref.ref(self)

        def changed(_prop: Any, _event: str) -> None:
            actor = this()
            if actor is not None:
                actor._take_property()  # noqa: SLF001 - a method would keep the actor alive for ever

        self._watched, self._tag = prop, prop.AddObserver("ModifiedEvent", changed)

    def _take_property(self) -> None:
        """Take over what a user has changed of the property, now that the actor is whole."""
        if not _writing and getattr(self, "_mapper", None) is not None:
            with own_writes():
                self._property_changed()

    def _property_changed(self) -> None:
        """Be told that it changed, by somebody else."""
        raise NotImplementedError
