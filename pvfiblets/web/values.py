"""Checks of values that come from browsers and session files, which are not trusted.

Each returns the value in one plain form, or raises :class:`ValueError` with the name, the value and the expected form.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

LONGEST_TEXT = 256
_SHOWN = 60


def shown(value: Any) -> str:
    """Return a value as messages show it: not longer than a line, whatever was sent."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) >= 10**_SHOWN:
        return f"a number of more than {_SHOWN} digits"
    if isinstance(value, (list, tuple, dict, set)) and len(value) > 16:
        return f"a {type(value).__name__} of {len(value)}"
    found = repr(value)
    return found if len(found) <= _SHOWN else f"{found[:_SHOWN]}…"


def number(value: Any, name: str, low: float = -math.inf, high: float = math.inf, *, unit: str = "") -> float:
    """Return a finite number from ``low`` to ``high``."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"{name} is {shown(value)}; give a number{unit}")
    try:
        given = float(value)
    except OverflowError:
        given = math.inf
    if not (math.isfinite(given) and low <= given <= high):
        ends = "" if (low, high) == (-math.inf, math.inf) else f" from {low:g} to {high:g}"
        raise ValueError(f"{name} is {shown(value)}; give a finite number{unit}{ends}")
    return given


def whole(value: Any, name: str, low: int = 0, high: int = 2**62) -> int:
    """Return a whole number from ``low`` to ``high``."""
    given = number(value, name, low, high)
    if given != int(given):
        raise ValueError(f"{name} is {shown(value)}; give a whole number")
    return int(value)


def numbers(value: Any, name: str, count: int | None = None, most: int = 16) -> list[float]:
    """Return a list of finite numbers: ``count`` of them, or from one to ``most``."""
    fine = isinstance(value, Sequence) and not isinstance(value, (str, bytes))
    if not fine or (len(value) != count if count is not None else not 1 <= len(value) <= most):
        expected = f"{count} numbers" if count is not None else f"a list of 1 to {most} numbers"
        raise ValueError(f"{name} is {shown(value)}; give {expected}")
    return [number(part, f"{name}[{i}]") for i, part in enumerate(value)]


def truth(value: Any, name: str) -> bool:
    """Return a bool."""
    if not isinstance(value, bool):
        raise ValueError(f"{name} is {shown(value)}; give true or false")
    return value


def text(value: Any, name: str, longest: int = LONGEST_TEXT) -> str:
    """Return a text of one line and at least one character."""
    if not isinstance(value, str) or not 1 <= len(value) <= longest or not value.isprintable():
        raise ValueError(f"{name} is {shown(value)}; give a text of 1 to {longest} printable characters")
    return value


def colour(value: Any, name: str) -> str:
    """Return a colour as ``#rrggbb``; names and other notations of :class:`pyvista.Color` will do."""
    import pyvista as pv

    try:
        return str(pv.Color(text(value, name, 32)).hex_rgb)
    except ValueError:
        raise ValueError(f"{name} is {shown(value)}; give a colour such as '#ff8800' or 'white'") from None


def mapping(value: Any, name: str, needed: Sequence[str] = (), optional: Sequence[str] = ()) -> Mapping[str, Any]:
    """Return a mapping that has all the keys ``needed`` and no others but ``optional`` ones."""
    if not isinstance(value, Mapping):
        raise ValueError(f"{name} is {shown(value)}; give an object with {', '.join(needed) or 'some'} in it")
    if missing := [key for key in needed if key not in value]:
        raise ValueError(f"{name} has no {missing[0]!r}; it needs {', '.join(needed)}")
    if unknown := [key for key in value if key not in needed and key not in optional]:
        known = ", ".join([*needed, *optional])
        raise ValueError(f"{name} has {shown(unknown[0])}, which it cannot have; it may have {known}")
    return value


def plain(value: Any) -> Any:
    """Return a value in JSON's own types; non-finite numbers become None."""
    import numpy as np

    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple, set, frozenset)):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if isinstance(value, (str, int, float, bool)) or value is None else str(value)
