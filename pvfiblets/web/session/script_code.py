"""Values as Python."""

from __future__ import annotations

from typing import Any


class Python(str):
    """A value that is Python already."""

    __slots__ = ()


def code(value: Any) -> str:
    """Return Python of a value."""
    if isinstance(value, Python):
        return value
    if isinstance(value, float) and value in (float("inf"), float("-inf")):
        return f"float('{value}')"
    return repr(value)
