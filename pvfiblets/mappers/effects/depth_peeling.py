"""An effect that lets lines be looked through: several layers of the picture, blended in order.

The mapper's geometry then has two triangles for each layer, the farthest first
(`pvfiblets.mappers.vtk_pipeline.proxy`), and the engine has one for each
(`pvfiblets.engine.fiblets.gather.depth_peeling`). While the actor is opaque neither is drawn, and no layer behind the
nearest is made.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from pvfiblets.engine.fiblets.gather.depth_peeling import MOST_LAYERS
from pvfiblets.mappers.effects.blank_arrays import BlankArrays
from pvfiblets.mappers.effects.shader_effects import ShaderEffect

if TYPE_CHECKING:
    import moderngl

_BESIDE = {
    "point_value": "layers_value",
    "tube_normal": "layers_normal",
    "tube_shading": "layers_across",
}
"""Pieces of the resolve that others need where there are layers."""

_EMPTY = {"depth": (1, "u4"), "ids": (2, "u4"), "position": (2, "f4"), "across": (1, "f2"), "normal": (1, "u4")}


class _Held:
    """State of one window: the engine that has layers, or empty textures in their place."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._engine: Any = None
        self._empty = BlankArrays(ctx, "no layer")
        self.count = 1

    def layers(self, draw: Any, count: int) -> dict[str, Any]:
        """Return texture arrays by their contents."""
        self._engine, self.count = draw.engine, count
        return dict(draw.engine.render_layers(draw.view, draw.style, count).arrays)

    def empty(self) -> dict[str, Any]:
        """Return an empty texture array for unused samplers."""
        self.count = 1
        self._drop_layers()
        return {name: self.blank(name) for name in ("depth", "ids", "position")}

    def blank(self, name: str) -> Any:
        """Return what a sampler of these may look at."""
        return self._empty.named(name, *_EMPTY[name])

    def explain(self) -> dict[str, list[dict[str, Any]]]:
        """Return ``passes`` (none) and ``buffers``, name and bytes."""
        return {"passes": [], "buffers": self._empty.buffers()}

    def _drop_layers(self) -> None:
        if self._engine is not None:
            self._engine.drop_layers()
            self._engine = None

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        self._drop_layers()
        self._empty.release()


@dataclass(frozen=True)
class Layers(ShaderEffect):
    """Shows several layers where the actor is translucent."""

    # layers, 2 to 64. What lies behind the last is not seen. Each takes 44 bytes a pixel and is drawn from all fiblets
    # in view, whenever the camera, the data or the style has changed.
    count: int = 4
    features: ClassVar[frozenset[str]] = frozenset({"layers", "layers_covered", "layers_geometry"})

    def __post_init__(self) -> None:
        if isinstance(self.count, bool) or int(self.count) != self.count or not 2 <= self.count <= MOST_LAYERS:
            raise ValueError(f"{self.count!r} layers are not possible; give a whole number from 2 to {MOST_LAYERS}")
        object.__setattr__(self, "count", int(self.count))

    def make(self, ctx: moderngl.Context) -> _Held:
        """Make room for a window's textures."""
        return _Held(ctx)

    def prepare(self, kept: _Held, draw: Any) -> Mapping[str, Any]:
        """Draw the layers in the engine, unless nothing shows through or VTK selects."""
        through = draw.renderer.GetSelector() is None and draw.actor.HasTranslucentPolygonalGeometry()
        arrays = kept.layers(draw, self.count) if through else kept.empty()
        names = {"fibletDepthLayers": "depth", "fibletIdLayers": "ids", "fibletPositionLayers": "position"}
        textures = {sampler: arrays[name] for sampler, name in names.items()}
        for sampler, relief in (("fibletAcrossLayers", "across"), ("fibletNormalLayers", "normal")):
            held = "across" in arrays and draw.style.relief == relief
            textures[sampler] = arrays["across"] if held else kept.blank(relief)
        return textures

    def set_uniforms(self, kept: _Held, program: Any, draw: Any) -> None:  # noqa: ARG002  as all effects
        """Set the number of layers."""
        program.SetUniformi("fibletLayerCount", kept.count)


def layers_of(effects: Iterable[Any]) -> int:
    """Return how many layers a mapper's geometry must have."""
    return max((getattr(effect, "count", 1) for effect in effects), default=1)


def with_layers(features: frozenset[str]) -> frozenset[str]:
    """Return the pieces of the resolve, including those for layers."""
    if "layers" not in features:
        return features
    return features | {piece for other, piece in _BESIDE.items() if other in features}
