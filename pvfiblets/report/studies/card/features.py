"""The card's check of effects: each feature of the study of features alone, drawn and not compared.

What an effect should look like is a matter of its own tests; here it must compile, run without a complaint of OpenGL,
and leave a picture.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.gbuffer import EMPTY as NO_KEY

from ...study import Options
from ..features.scenes import Drawn
from ..features.study import subjects
from .findings import EMPTY
from .scenes import SIZE, Judged, Scene

if TYPE_CHECKING:
    import moderngl


def features_part(ctx: moderngl.Context) -> Iterator[tuple[str, Callable[[], Scene]]]:
    """Yield every feature of every drawable."""
    for make in subjects(Options(quick=True)):
        subject = make()
        for feature in subject.features:
            name = f"{subject.name}: {feature.group} {feature.name}".strip()
            if feature.group not in ("pipeline", "culling"):  # these have parts of their own
                yield name, partial(_scene, ctx, subject, feature)


def _scene(ctx: moderngl.Context, subject: Any, feature: Any) -> Scene:
    path = subject.path(2, SIZE)
    drawn = Drawn(ctx, subject, feature, path)

    def judge(_: Any) -> Judged:
        keys = np.frombuffer(drawn.last.depth.read(), np.uint32)
        return Judged({EMPTY: float((keys == NO_KEY).all())}, {EMPTY: 0.0}, compared=False)

    return Scene(lambda _number: drawn(), judge, drawn.release)
