"""One part of the card's check, in a process of its own: ``python -m pvfiblets.report.studies.card.part PART FOLDER``.

Every line on standard output is an object in JSON: ``{"begin": feature}`` before a feature is tried, and
``{"finding": ..., "pictures": [names]}`` after it. Who reads them knows from the last line what a driver died of.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.engine.errors import EngineError, GPUMemoryError

from .findings import FAILS, MISSING, SLOW, Finding
from .scenes import Scene, tried

__all__ = ["PARTS", "SPEED", "main", "parts_of"]

LACKING = re.compile(r"needs OpenGL|, which this OpenGL|has no function|no (GPU )?memory")
SPEED = "speed"


def parts_of(pipelines: list[str]) -> list[str]:
    """Return the names of all parts, of pipelines that are there."""
    return [*(f"fiblets {name}" for name in pipelines), *PARTS, *(f"{SPEED} {name}" for name in pipelines)]


def _tubes(ctx: Any) -> Iterator[tuple[str, Callable[[], Scene]]]:
    from .others import tubes_part

    return tubes_part(ctx)


def _halos(ctx: Any) -> Iterator[tuple[str, Callable[[], Scene]]]:
    from .others import halos_part

    return halos_part(ctx)


def _volumes(ctx: Any) -> Iterator[tuple[str, Callable[[], Scene]]]:
    from .others import volumes_part

    return volumes_part(ctx)


def _features(ctx: Any) -> Iterator[tuple[str, Callable[[], Scene]]]:
    from .features import features_part

    return features_part(ctx)


PARTS: dict[str, Any] = {"spline tubes": _tubes, "halos": _halos, "volumes": _volumes, "features": _features}
"""Those that are the same whatever the pipeline."""


def _scenes(ctx: Any, part: str, folder: Path) -> Iterator[tuple[str, Callable[[], Scene]]]:
    kind, _, pipeline = part.rpartition(" ")
    if part in PARTS:
        yield from PARTS[part](ctx)
    elif kind == SPEED:
        from .speed import speed_part

        yield from speed_part(ctx, pipeline, folder)
    else:
        from .fiblets import fiblets_part

        yield from fiblets_part(ctx, pipeline)


def main(part: str, folder: Path, after: str = "") -> None:
    """Try all features of a part, or those after one, and tell of each."""
    from pvfiblets.engine.gl.standalone import bare_context

    ctx = bare_context()
    waiting = bool(after)
    for number, (feature, make) in enumerate(_scenes(ctx, part, folder)):
        if waiting:
            waiting = feature != after
            continue
        _tell({"begin": feature})
        names = []
        try:
            finding, pictures = tried(ctx, part, feature, make)
            finding = _judged_by_speed(finding)
            for name, picture in pictures.items():
                names.append(f"{part}-{number}-{name}.npy".replace(" ", "-"))
                np.save(folder / names[-1], picture)
        except (EngineError, MemoryError) as error:
            lacking = isinstance(error, (GPUMemoryError, MemoryError)) or LACKING.search(str(error))
            finding = Finding(part, feature, MISSING if lacking else FAILS, _first_line(error))
        except Exception as error:  # noqa: BLE001  whatever a driver leads to is what is looked for
            finding = Finding(part, feature, FAILS, f"{type(error).__name__}: {_first_line(error)}")
        _tell({"finding": finding.as_dict(), "pictures": names})


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


def _tell(what: dict[str, Any]) -> None:
    print(json.dumps(what), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), *sys.argv[3:])
