"""`InteractiveQuality`: how much less is looked at while the camera moves, so that pictures follow the hand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from pvfiblets.support.real_numbers import is_number

from .raycast_options import PROJECTIONS, RaycastOptions

COARSEST_STEP = 4.0  # times the step at a quality of a quarter and less; 1 / quality above

LARGEST_STEP = 1e3  # of RaycastOptions


@dataclass(frozen=True)
class InteractiveQuality:
    """Changes to a casting while the camera moves."""

    # Times the step, 1 or more. Light that is integrated beforehand keeps its step, and with it its table, unless
    # ``exactly``.
    step: float = 1.0
    sparse: int = 1  # Pixels between first rays, 1, 2 or 4; more, if the casting has more
    # Whether light that is integrated beforehand has longer steps too; its table is then made for these as well
    exactly: bool = False

    @classmethod
    def of_quality(cls, quality: Any) -> InteractiveQuality | None:
        """Return what a quality means, and None for 1."""
        if isinstance(quality, Mapping):
            if unknown := set(quality) - {"step", "sparse"}:
                raise ValueError(f"interactive_quality has {sorted(map(str, unknown))}; give 'step' and 'sparse'")
            step, sparse = quality.get("step", 1.0), quality.get("sparse", 1)
            if not is_number(step) or not 1.0 <= step <= LARGEST_STEP:
                raise ValueError(f"interactive_quality['step'] is {step!r}; give a factor of 1 or more")
            if sparse not in (1, 2, 4):
                raise ValueError(f"interactive_quality['sparse'] is {sparse!r}; give 1, 2 or 4 pixels")
            return None if (step, sparse) == (1, 1) else cls(float(step), int(sparse), exactly=True)
        if not is_number(quality) or not 0.0 <= quality <= 1.0:
            raise ValueError(
                f"interactive_quality is {quality!r}; give a number from 0 to 1, or "
                "{'step': factor, 'sparse': pixels}"
            )
        if quality == 1.0:
            return None
        return cls(min(1.0 / max(quality, 1e-3), COARSEST_STEP), 2 if quality > 1.0 / COARSEST_STEP else 4)

    def applied_to(self, casting: RaycastOptions) -> RaycastOptions:
        """Return the casting while the camera moves."""
        integrator, light = casting.integrator, casting.mode == "composite"
        if integrator == "adaptive":
            integrator = "preintegrated"
        kept = light and integrator == "preintegrated" and not self.exactly
        step = casting.step if kept else min(casting.step * self.step, LARGEST_STEP)
        # Peaks by cells take twice the time of steps, which a moving picture does not show.
        refine = "regula-falsi" if casting.exact and casting.mode in PROJECTIONS else casting.refine
        sparse = max(casting.sparse, self.sparse)
        return replace(casting, step=step, sparse=sparse, integrator=integrator, refine=refine)
