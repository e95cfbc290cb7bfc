"""Changes that users make to an actor's ``prop``, as for any PyVista actor, take effect.

VTK itself obeys opacity, lighting, ambient, diffuse and specular shares. Colour, line width and round lines are this
package's own to draw: an actor watches its property, and takes over what changed there.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

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
