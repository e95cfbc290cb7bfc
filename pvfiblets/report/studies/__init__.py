"""The studies by name. Their modules are imported when they are run.

To add one, such as ``culling``: write ``pvfiblets/report/studies/culling/study.py`` with an object ``STUDY`` that is a
:class:`~pvfiblets.report.study.Study`, and put ``"culling": "pvfiblets.report.studies.culling.study"`` into
``MODULES``. Nothing else depends on it: records, Pareto fronts, page and plots are the same for all. A study takes its
share of a run's time, asks ``options.allows(what)`` before each measurement, and raises ``Unavailable`` where it cannot
be done (a drawing study: where no OpenGL context can be made). Variants of one data set that are timed by turns are a
:class:`~pvfiblets.report.timing.Comparison`.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from ..study import Study

__all__ = ["MODULES", "ONLY_NAMED", "chosen_names", "find"]

MODULES = {
    "antialias": "pvfiblets.report.studies.antialias.study",
    "codec": "pvfiblets.report.studies.codec.study",
    "decode": "pvfiblets.report.studies.decode.study",
    "tractograms": "pvfiblets.report.studies.codec.tractograms",
    "measures": "pvfiblets.report.studies.codec.measures",
    "pixels": "pvfiblets.report.studies.codec.pixels",
    "culling": "pvfiblets.report.studies.culling.study",
    "tubes": "pvfiblets.report.studies.tubes.study",
    "volumes": "pvfiblets.report.studies.volumes.study",
    "halos": "pvfiblets.report.studies.halos.study",
    "features": "pvfiblets.report.studies.features.study",
    "translucency": "pvfiblets.report.studies.translucency.study",
    "query": "pvfiblets.report.studies.query.study",
    "speed": "pvfiblets.report.studies.speed.study",
    "lines": "pvfiblets.report.studies.speed.lines",
    "card": "pvfiblets.report.studies.card.study",
    "work": "pvfiblets.report.studies.work.study",
    "reading": "pvfiblets.report.studies.speed.reading",
    "stability": "pvfiblets.report.studies.stability.study",
}


ONLY_NAMED = ("speed", "lines", "card", "reading", "work")
"""Studies that compare no approximations, and take hours and gigabytes: a report of all is without them."""


def chosen_names(only: Sequence[str] | None = None) -> list[str]:
    """Return the names of the studies asked for; all but :data:`ONLY_NAMED` if none are named."""
    names = list(dict.fromkeys(only or (name for name in MODULES if name not in ONLY_NAMED)))
    for name in names:
        if name not in MODULES:
            raise ValueError(f"there is no study {name!r}; choose among {', '.join(MODULES)}")
    return names


def find(name: str) -> Study:
    """Import a study's module and return its ``STUDY``."""
    study: Study = import_module(MODULES[name]).STUDY
    return study
