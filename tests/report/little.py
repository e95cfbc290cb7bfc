"""Options of a study that is to measure hardly anything."""

from pvfiblets.report.study import Options


def little(**more):
    """Return options of a quick run, timed once."""
    return Options(quick=True, repeats=1, log=lambda line: None, machine="m", **more)
