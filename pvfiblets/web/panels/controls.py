"""Sliders for the numbers of shapes: what a cut or a region is made of, as a panel shows it and sends it back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from pvfiblets.web.panels.charts import short, steps
from pvfiblets.web.panels.describe import typed

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
NAMES = ("left–right", "back–front", "down–up")


def controls(shape: Mapping[str, Any], bounds: Sequence[float]) -> list[dict[str, Any]]:
    """Return the sliders of a shape."""
    sides = [(float(bounds[2 * k]), float(bounds[2 * k + 1])) for k in range(3)]
    reach = float(np.linalg.norm([high - low for low, high in sides])) or 1.0
    kind = shape["kind"]
    if kind in ("plane", "slab"):
        along, low, high = _span(shape["normal"], sides)
        axis = axis_of(shape["normal"])
        label = NAMES["xyz".index(axis)].capitalize() if axis else "Position"
        found = [_number("position", label, float(np.dot(along, shape["origin"])), low, high)]
        if kind == "slab":
            found.append(_number("thickness", "Thickness", shape["thickness"], 0.002 * reach, 0.5 * reach))
        return found
    if kind == "box":
        ends = shape["bounds"]
        return [_range("xyz"[k], NAMES[k].capitalize(), ends[2 * k : 2 * k + 2], *sides[k]) for k in range(3)]
    if kind == "sphere":
        centre = [_number("xyz"[k], NAMES[k].capitalize(), shape["center"][k], *sides[k]) for k in range(3)]
        return [*centre, _number("radius", "Radius", shape["radius"], 0.005 * reach, 0.5 * reach)]
    return []


def moved(shape: Mapping[str, Any], name: str, value: Any) -> dict[str, Any]:
    """Return the parts of a shape that a slider of :func:`controls` changes."""
    kind = shape["kind"]
    if kind == "box" and name in ("x", "y", "z"):
        low, high = _two(value)
        bounds = list(shape["bounds"])
        k = "xyz".index(name)
        bounds[2 * k : 2 * k + 2] = [low, high]
        return {"bounds": bounds}
    number = _one(value)
    if kind in ("plane", "slab") and name == "position":
        along = _unit(shape["normal"])
        origin = np.asarray(shape["origin"], np.float64)
        return {"origin": (origin + (number - np.dot(along, origin)) * along).tolist()}
    if kind == "slab" and name == "thickness":
        return {"thickness": number}
    if kind == "sphere" and name == "radius":
        return {"radius": number}
    if kind == "sphere" and name in ("x", "y", "z"):
        centre = list(shape["center"])
        centre["xyz".index(name)] = number
        return {"center": centre}
    raise ValueError(f"a {kind} has no {str(name)[:40]!r}")


def typed_value(shape: Mapping[str, Any], bounds: Sequence[float], name: str, end: int, text: str) -> Any:
    """Return what a slider of :func:`controls` is moved to by a number typed for it or for one of its ends."""
    found = next((one for one in controls(shape, bounds) if one["name"] == name), None)
    if found is None:
        raise ValueError(f"a {shape['kind']} has no {str(name)[:40]!r}")
    value = typed(text, found["label"])
    if found["type"] != "range":
        return value
    ends = list(found["value"])
    ends[1 if end else 0] = value
    return ends


def axis_of(normal: Sequence[float]) -> str:
    """Return the name of the axis that a normal runs along, or nothing."""
    along = np.abs(_unit(normal))
    k = int(np.argmax(along))
    return "xyz"[k] if along[k] > 0.9999 else ""


def _span(normal: Sequence[float], sides: Sequence[tuple[float, float]]) -> tuple[np.ndarray, float, float]:
    along = _unit(normal)
    corners = [np.dot(along, [sides[k][i >> k & 1] for k in range(3)]) for i in range(8)]
    return along, float(min(corners)), float(max(corners))


def _unit(vector: Sequence[float]) -> np.ndarray:
    array = np.asarray(vector, np.float64)
    return array / (np.linalg.norm(array) or 1.0)


def _number(name: str, label: str, value: float, low: float, high: float) -> dict[str, Any]:
    low, high = min(low, value), max(high, value)
    return {
        "name": name, "label": label, "type": "number", "value": float(value), "limits": [low, high],
        "step": steps((low, high)), "shown": [short(value)],
    }  # fmt: skip


def _range(name: str, label: str, ends: Sequence[float], low: float, high: float) -> dict[str, Any]:
    low, high = min(low, ends[0]), max(high, ends[1])
    return {
        "name": name, "label": label, "type": "range", "value": [float(end) for end in ends], "limits": [low, high],
        "step": steps((low, high)), "shown": [short(end) for end in ends],
    }  # fmt: skip


def _one(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"expected a number, found {type(value).__name__}")
    return float(value)


def _two(value: Any) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError("expected two numbers")
    return _one(value[0]), _one(value[1])
