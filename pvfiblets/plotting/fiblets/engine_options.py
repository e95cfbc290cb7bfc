"""How an actor's fiblets become pixels, as far as that can be chosen and does not show in the picture."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pvfiblets.plotting.fiblets.actor import PlottedMapper


class Engines:
    """The part of :class:`~pvfiblets.plotting.fiblets.actor.FibletActor` that chooses pipeline and culling."""

    _mapper: PlottedMapper

    @property
    def pipeline(self) -> str:
        """How fiblets become pixels; ``plotter.fiblets.pipelines()`` lists the choices."""
        return self._mapper.options.pipeline

    @pipeline.setter
    def pipeline(self, pipeline: str) -> None:
        self._mapper.options = replace(self._mapper.options, pipeline=pipeline)

    @property
    def pipeline_in_use(self) -> str | None:
        """The pipeline that drew the last picture; ``None`` before the first."""
        return self._mapper.pipeline_in_use

    @property
    def share(self) -> float | None:
        """How many of the streamlines are drawn: 1.0 for all; ``None`` before the first picture.

        Less only where ``fit`` is ``"sample"`` and memory does not suffice for all.
        """
        return self._mapper.share

    @property
    def culling(self) -> str | None:
        """How fiblets behind others are found out: ``"two-phase"``, ``"coverage"`` or ``None``."""
        return self._mapper.options.culling

    @culling.setter
    def culling(self, culling: str | None) -> None:
        self._mapper.options = replace(self._mapper.options, culling=culling)

    @property
    def fit(self) -> str | None:
        """What to do where memory does not suffice: ``None`` refuses, ``"sample"`` draws a share."""
        return self._mapper.options.fit

    @fit.setter
    def fit(self, fit: str | None) -> None:
        self._mapper.options = replace(self._mapper.options, fit=fit)
