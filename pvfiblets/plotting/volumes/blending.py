"""Words of ``Plotter.add_volume`` for how values along a ray are put together."""

from __future__ import annotations

BLENDING = {"composite": "composite", "maximum": "mip", "minimum": "minimum", "average": "average"}
"""Modes by the words of ``Plotter.add_volume``."""


def mode_of_blending(blending: str) -> str:
    """Return the mode of a word of ``add_volume``'s."""
    if blending == "additive":
        raise ValueError(
            "blending='additive' adds up values times opacities, which depends on the step; mode 'average' does not"
        )
    if blending not in BLENDING:
        raise ValueError(f"blending is {blending!r}; choose one of {tuple(BLENDING)}")
    return BLENDING[blending]
