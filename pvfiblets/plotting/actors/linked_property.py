"""Changes that users make to an actor's ``prop``, as for any PyVista actor, take effect.

VTK itself obeys opacity, lighting, ambient, diffuse and specular shares. Colour, line width and round lines are this
package's own to draw: an actor watches its property, and takes over what changed there.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

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
    """Return whether this package is making the current change."""
    return _writing > 0


def observe(watched: Any, method: Callable[[], None]) -> int:
    """Call a method whenever a VTK object is modified, and return the observer's tag; keeps no method alive."""
    this = weakref.WeakMethod(method)

    def modified(_watched: Any, _event: str) -> None:
        call = this()
        if call is not None:
            call()

    return int(watched.AddObserver("ModifiedEvent", modified))


class LinkedProperty:
    """The property that an actor watches, and may share with others."""

    _watched: Any = None
    _tag = 0

    def watch(self, prop: Any, modified: Callable[[], None]) -> None:
        """Call a method whenever a property is modified, and no longer when the one before is."""
        if self._watched is not None:
            self._watched.RemoveObserver(self._tag)
        self._watched, self._tag = prop, observe(prop, modified)
