"""One part of the card's check, in a process of its own: ``python -m pvfiblets.report.studies.card.part``.

Each line that it reads asks for one thing (:mod:`pvfiblets.report.process`): first the name of a part's feature by its
number, then that this feature is tried. The check knows from the last line what a driver died of.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from pvfiblets.engine.errors import EngineError, GPUMemoryError

from ...process import Row, serve
from .findings import FAILS, MISSING, SLOW, Finding
from .scenes import Scene, tried

if TYPE_CHECKING:
    import moderngl

LACKING = re.compile(r"needs OpenGL|, which this OpenGL|has no function|no (GPU )?memory")
SPEED = "speed"


def parts_of(pipelines: list[str]) -> list[str]:
    """Return the names of all parts, of pipelines that are there."""
    return [*(f"fiblets {name}" for name in pipelines), *PARTS, *(f"{SPEED} {name}" for name in pipelines)]


PARTS = {"spline tubes": "others:tubes_part", "halos": "others:halos_part", "volumes": "others:volumes_part",
         "features": "features:features_part"}  # fmt: skip
"""Parts that do not depend on the pipeline: modules and functions."""


def _scenes(ctx: moderngl.Context, part: str, folder: Path) -> Iterator[tuple[str, Callable[[], Scene]]]:
    kind, _, pipeline = part.rpartition(" ")
    if part in PARTS:
        module, function = PARTS[part].split(":")
        yield from getattr(import_module(f".{module}", __package__), function)(ctx)
    elif kind == SPEED:
        from .speed import speed_part

        yield from speed_part(ctx, pipeline, folder)
    else:
        from .fiblets import fiblets_part

        yield from fiblets_part(ctx, pipeline)


class Trial:
    """The features of one part, one after the other, on a context of its own."""

    def __init__(self) -> None:
        self._part = ""

    def __call__(self, wanted: Row) -> Row:
        """Return the name of a feature, empty after the last, or what trying it finds."""
        if "feature" in wanted:
            return self._tried(wanted["feature"])
        if not self._part:
            from pvfiblets.engine.gl.standalone import bare_context

            self._part, self._folder, self._ctx = wanted["part"], Path(wanted["folder"]), bare_context()
            self._left = enumerate(_scenes(self._ctx, self._part, self._folder))
        for number, (feature, make) in self._left:
            if number == wanted["number"]:
                self._number, self._make = number, make
                return {"feature": feature}
        return {"feature": ""}

    def _tried(self, feature: str) -> Row:
        names = []
        try:
            finding, pictures = tried(self._ctx, self._part, feature, self._make)
            finding = _judged_by_speed(finding)
            for name, picture in pictures.items():
                names.append(f"{self._part}-{self._number}-{name}.npy".replace(" ", "-"))
                np.save(self._folder / names[-1], picture)
        except (EngineError, MemoryError) as error:
            lacking = isinstance(error, (GPUMemoryError, MemoryError)) or LACKING.search(str(error))
            finding = Finding(self._part, feature, MISSING if lacking else FAILS, _first_line(error))
        except Exception as error:  # noqa: BLE001  any failure of a driver is a finding
            finding = Finding(self._part, feature, FAILS, f"{type(error).__name__}: {_first_line(error)}")
        return {"finding": finding.as_dict(), "pictures": names}


def _judged_by_speed(finding: Finding) -> Finding:
    from .speed import SEGMENTS, SLUGGISH, TOO_SLOW, named

    if finding.bad or finding.ms is None or not finding.part.startswith(f"{SPEED} "):
        return finding
    limit = TOO_SLOW if finding.feature == named(SEGMENTS[0]) else SLUGGISH
    if finding.ms <= limit:
        return finding
    return replace(finding, verdict=SLOW, note=f"{finding.note}; more than {limit:g} ms a picture")


def _first_line(error: BaseException) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0]


if __name__ == "__main__":
    serve(Trial())
