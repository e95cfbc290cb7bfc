"""What signatures of halos' components say; apart, so that they can be read without what halos are made of."""

from __future__ import annotations

__all__ = ["WIDTH_CUE"]

WIDTH_CUE = 0.5
"""Share by which the farthest lines are thinner, by default."""
