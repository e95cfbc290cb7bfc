"""A feature, a subject that may have it, and how both are drawn for the study of features."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.engine.view import Style, View

from ...cameras import Camera, orbit

if TYPE_CHECKING:
    import moderngl

PLAIN = "plain"
TURNS = 315  # pictures of a whole turn: 1.14 degrees a frame, as in Schertzer et al. 2022, section 4.5

Effect = Callable[["Drawn", Any, Camera, View], None]


@dataclass(frozen=True)
class Feature:
    """One feature alone."""

    # Its group and name; the method and the setting of its record
    group: str
    name: str
    # Keywords of the engine's renderer that differ from the defaults
    options: dict[str, Any] = field(default_factory=dict)
    style: dict[str, Any] = field(default_factory=dict)  # Fields of the style that differ
    view: dict[str, Any] = field(default_factory=dict)  # Fields of the view that differ
    prepare: Callable[[Any], None] | None = None  # Called with the renderer before the first picture
    effect: Effect | None = None  # Called with its passes, the G-buffer, the camera and the view after each picture
    passes: Callable[[Any], Any] | None = None  # Makes, of a context, what `effect` draws with


@dataclass(frozen=True)
class Subject:
    """Something to be shown, its plain look, and the features that it may have."""

    name: str
    make: Callable[..., Any]  # Takes a context and the feature's options; returns the engine's renderer
    style: Style  # The plain one
    bounds: Sequence[float]  # `(xmin, xmax, ymin, ymax, zmin, zmax)`, mm
    features: list[Feature]  # The plain one first

    def path(self, frames: int, size: tuple[int, int]) -> list[Camera]:
        """Return cameras of a slow flight around it."""
        box = np.array(self.bounds, np.float64).reshape(3, 2)
        corners = np.stack(np.meshgrid(*box, indexing="ij"), axis=-1).reshape(-1, 3)
        around = SimpleNamespace(bounds=box.ravel(), points=corners, radius=np.zeros(len(corners)))
        return orbit(around, "far", TURNS, size)[:frames]


class Drawn:
    """A subject with one feature, drawn from camera after camera, and back; ``last`` is the last G-buffer."""

    def __init__(self, ctx: moderngl.Context, subject: Subject, feature: Feature, path: Sequence[Camera]) -> None:
        self._ctx, self._feature, self._path = ctx, feature, list(path)
        self.style = replace(subject.style, **feature.style)
        self.renderer = subject.make(ctx, **feature.options)
        self.passes: Any = None
        self.last: Any = None
        try:
            if feature.prepare is not None:
                feature.prepare(self.renderer)
            if feature.passes is not None:
                self.passes = feature.passes(ctx)
            for camera in self._path:  # compiles and measures everything that happens once
                self.render(camera)
        except BaseException:
            self.release()
            raise

    def render(self, camera: Camera) -> None:
        """Draw one picture, and wait for it."""
        view = View(camera.size, camera.model_view_projection, **self._feature.view)
        self.last = buffer = self.renderer.render(view, self.style)
        if self._feature.effect is not None:
            self._feature.effect(self, buffer, camera, view)
        self._ctx.finish()

    def __call__(self) -> None:
        """Fly back, or forth again."""
        self._path.reverse()
        for camera in self._path[1:]:
            self.render(camera)

    @property
    def nbytes(self) -> int:
        """Bytes of all buffers and textures on the GPU."""
        held = self.renderer.explain(counts=False)["buffers"]
        held += [] if self.passes is None else self.passes.explain()["buffers"]
        return sum(row["bytes"] for row in held)

    def release(self) -> None:
        """Give everything on the GPU back."""
        if self.passes is not None:
            self.passes.release()
        self.renderer.release()
