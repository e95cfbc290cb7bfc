"""Stiff and extreme cases of every system, as objects that both the tests and the report run.

A `studies.stability.case.Case` states its input and a condition, and judges one measured figure against
something independent: an error bound, a formula, NumPy in float64. A statement that does not hold is an error of the
program, reported by the report and failed by the tests.

To add a case, write a function in its system's module; to add a system, a module with ``CASES``, and its name here.
"""

from __future__ import annotations

from importlib import import_module

from .case import Case

__all__ = ["MODULES", "all_cases"]

MODULES = (
    "codec_cases",
    "decode_cases",
    "capsule_cases",
    "camera_cases",
    "tube_cases",
    "halo_cases",
    "volume_cases",
    "picking_cases",
    "format_cases",
)


def all_cases() -> list[Case]:
    """Return all cases, system by system."""
    return [case for name in MODULES for case in import_module(f".{name}", __package__).CASES]
