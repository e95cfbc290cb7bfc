"""Selected streamlines drawn once more, wider or as tubes, in the place of the actor that they belong to.

A small set of their own on a mapper of its own: the rest is drawn as before. What is drawn follows the owner: before
each picture its place, looks, shading, cuts and filters are looked at, and taken over where they changed.

Tubes are spline tubes (`pvfiblets.mappers.tubes`), smooth through the points. Where the owner is coloured by a volume,
which those cannot do, and where there are very many points, tubes are the engine's own, straight from point to point,
of compressed fiblets (`FibletSet.extract`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.mappers import Colouring, FibletMapper, TubeMapper
from pvfiblets.mappers.effects.line_tubes import Tubes
from pvfiblets.mappers.effects.shading import Silhouette
from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import partly_shown, renderers_of, to_array, weak
from pvfiblets.mappers.picking import Layer
from pvfiblets.streamlines import Streamlines

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.mappers.effects.shader_effects import Draw
    from pvfiblets.plotting.fiblets.filtering import BundledActor
    from pvfiblets.tubes.spline_tubes import SplineTubes


MOST_POINTS = 400_000  # of spline tubes: they take 50 bytes for each on the GPU, fiblets two

SHADES = ("ambient_occlusion", "depth_cue")  # names of effects whose defaults are the extent of all that the owner has


class _OfAll:
    """An effect that takes its defaults from the whole set instead of the drawn part."""

    def __init__(self, effect: Any, whole: FibletSet) -> None:
        self._effect, self._whole = effect, whole

    def __getattr__(self, name: str) -> Any:
        return getattr(self._effect, name)

    def prepare(self, kept: Any, draw: Draw) -> Any:
        return self._effect.prepare(kept, replace(draw, fiblets=self._whole))

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:
        self._effect.set_uniforms(kept, program, replace(draw, fiblets=self._whole))


@dataclass(frozen=True, eq=False)
class _Splines:
    """What spline tubes are made of."""

    values: str | None  # name of the per-point value that they are coloured by


class SelectionOverlay:
    """A second actor for some of an actor's streamlines."""

    def __init__(
        self,
        owner: BundledActor,  # whose streamlines they are
        ids: np.ndarray,  # `(n,)` int64, rising
        *,
        color: tuple[float, ...] | None,  # one colour for all; the owner's colours by default
        width: float,  # pixels of the lines
        radius: float | None = None,  # of tubes (mm) in place of lines
        outline: tuple[float, float, float] | None = None,  # RGB of an outline around all
    ) -> None:
        self.ids = ids
        self._owner = weak(owner)
        self._color = color
        self._width, self._radius, self._outline = width, radius, outline
        self._fiblets = owner.fiblets
        self._few = radius is not None and int(np.diff(owner.fiblets.offsets())[ids].sum()) <= MOST_POINTS
        self._taken: dict[str, Any] = {}
        self._matrix = vtkMatrix4x4()
        self._renderers: dict[str, tuple[Any, Callable[[], None]]] = {}
        self._plan: _Splines | None = None
        self._plan = self._plan_for(owner.mapper)
        self.mapper: Any = self._make(self._plan)
        self.actor = vtkActor()
        self.actor.SetPickable(False)
        self.actor.SetProperty(owner.GetProperty())
        self.mapper.attach(self.actor)
        self.follow()
        for renderer in renderers_of(owner):
            self.enter(renderer)

    @property
    def layer(self) -> Layer:
        """What picking sees: pixels that show these streamlines show the owner's."""
        if self._plan is None:
            return Layer(self.mapper, self.ids)
        return Layer(self.mapper, self.ids, self._starts)

    def enter(self, renderer: vtkRenderer) -> None:
        """Be drawn by a renderer that draws the owner."""
        address = renderer.GetAddressAsString("")
        if address in self._renderers:
            return
        renderer.AddActor(self.actor)
        end = observe(renderer, ("StartEvent",), weakly(self.before_picture, passing=True))
        self._renderers[address] = (weak(renderer), end)

    def leave(self) -> None:
        """Be gone from all renderers, and from the GPU."""
        for address in list(self._renderers):
            self._leave(address)
        self.mapper.release()
        self.mapper.detach()

    def _leave(self, address: str) -> None:
        reference, end = self._renderers.pop(address)
        end()
        renderer = reference.Get()
        if renderer is not None:
            renderer.RemoveActor(self.actor)

    def leave_with_owner(self) -> None:
        """Be gone from renderers that do not draw the owner any more."""
        owner = self._owner.Get()
        for address, (reference, _) in list(self._renderers.items()):
            renderer = reference.Get()
            if renderer is None or owner is None or not renderer.HasViewProp(owner):
                self._leave(address)

    def before_picture(self, renderer: vtkRenderer, _event: str = "") -> None:
        """Remove itself if the owner is gone, otherwise copy its state, before VTK lists its actors."""
        if partly_shown:
            return
        self.leave_with_owner()
        if renderer.GetAddressAsString("") in self._renderers:
            self.follow()

    def follow(self) -> None:
        """Take over what changed of the owner."""
        owner: Any = self._owner.Get()
        if owner is None:
            return
        mapper = owner.mapper
        if bool(self.actor.GetVisibility()) != bool(owner.GetVisibility()):
            self.actor.SetVisibility(owner.GetVisibility())
        place = vtkMatrix4x4()
        owner.GetModelToWorldMatrix(place)
        if self._changed("matrix", to_array(place).tobytes(), equal=True):
            self._matrix.DeepCopy(place)
            self.actor.SetUserMatrix(self._matrix)
        if self._changed("property", owner.GetProperty()):
            self.mapper.detach()
            self.actor.SetProperty(owner.GetProperty())
            self.mapper.attach(self.actor)
        self._remake(self._plan_for(mapper))
        if self._changed("colouring", mapper.colouring):
            self.mapper.colouring = self._colours(mapper.colouring)
        if self._changed("planes", mapper.GetClippingPlanes()):
            self.mapper.SetClippingPlanes(mapper.GetClippingPlanes())
        effects = mapper.effects
        for name in SHADES if self._radius is not None else (*SHADES, "light"):
            if self._changed(name, effects.get(name)):
                effect = effects.get(name)
                self.mapper.set_effect(name, None if effect is None else _OfAll(effect, self._fiblets))
        if self._changed("region", mapper.region):
            self.mapper.region = mapper.region
        if self._changed("filtering", mapper.filtering):
            part = part_of_filter if self._plan is None else self._segments_of_filter
            self.mapper.filtering = part(mapper.filtering, self._fiblets, self.ids)
        if self._plan is None and self._changed("options", mapper.options):
            self.mapper.options = mapper.options

    def _plan_for(self, mapper: Any) -> _Splines | None:
        """What spline tubes have to be made of that do as the owner's mapper does; None where none can."""
        values = None if self._color is not None else mapper.colouring.point_source
        packed = self._color is None and mapper.colouring.mode == "point_packed"  # which tubes cannot read
        if packed or not self._few or not isinstance(values, str | None):
            return None
        if self._plan is not None and self._plan.values == values:
            return self._plan
        return _Splines(values)

    def _segments_of_filter(self, filtering: Any, fiblets: FibletSet, ids: np.ndarray) -> np.ndarray | None:
        """Return which segments of the spline tubes a filter of the whole set shows."""
        if filtering is None:
            return None
        tubes = self.mapper.tubes
        mask = np.ones(len(ids), bool) if filtering.streamlines is None else filtering.streamlines[ids]
        shown: np.ndarray = mask[tubes.tubes]
        if filtering.points is not None:
            from pvfiblets.mappers.drawn_lines import point_flags

            shown &= point_flags(fiblets, filtering.points, ids)[tubes.segments].all(axis=1)
        return shown

    def _make(self, plan: _Splines | None) -> Any:
        """Return the mapper that a plan asks for."""
        if plan is not None:
            tubes = spline_tubes_of(self._fiblets, self.ids, float(self._radius or 0.0), plan.values)
            # Of a line of n points the segments begin at its points 0 to n - 2.
            self._starts = np.arange(tubes.n_segments) - np.searchsorted(tubes.tubes, tubes.tubes)
            mapper: Any = TubeMapper(tubes)
        else:
            mapper = FibletMapper(self._fiblets.extract(self.ids), line_width=self._width)
            if self._radius is not None:
                mapper.set_effect("tubes", Tubes(self._radius))
        if self._outline is not None:
            mapper.set_effect("silhouette", Silhouette(np.ones(len(self.ids), np.bool_), self._outline))
        return mapper

    def _remake(self, plan: _Splines | None) -> None:
        """Draw by another mapper where the plan is another one."""
        if plan is self._plan:
            return
        mapper = self._make(plan)
        self.mapper.release()
        self.mapper.detach()
        self.mapper, self._plan = mapper, plan
        self.mapper.attach(self.actor)
        for name in ("options", "colouring", "planes", "region", "filtering", "light", *SHADES):
            self._taken.pop(name, None)

    def _changed(self, name: str, value: Any, *, equal: bool = False) -> bool:
        """Whether the owner has another value now; remembers it."""
        missing = object()
        before = self._taken.get(name, missing)
        self._taken[name] = value
        if name not in ("colouring", "matrix") and value is None and before is missing:
            return False
        return before != value if equal else before is not value

    def _colours(self, colouring: Colouring) -> Colouring:
        if self._color is not None:
            return Colouring("solid", color=self._color)
        if colouring.mode in ("streamline_rgba", "streamline_scalar") and colouring.values is not None:
            return replace(colouring, values=np.asarray(colouring.values)[self.ids])
        return colouring


def spline_tubes_of(fiblets: FibletSet, ids: np.ndarray, radius: float, values: str | None = None) -> SplineTubes:
    """Return streamlines as spline tubes of one radius."""
    from pvfiblets.plotting.fiblets.scalars import point_values
    from pvfiblets.tubes.build import as_spline_tubes

    lines = fiblets.decompress(ids, dtype=np.float64)
    numbers = None
    if values is not None and (found := point_values(fiblets, ids, values)) is not None:
        numbers = found[0]
    per_point = {} if numbers is None or values is None else {values: numbers}
    bare = Streamlines(lines.points, lines.offsets, per_point=per_point)
    return as_spline_tubes(bare, radius=radius, scalars=values if per_point else None)


def part_of_filter(filtering: Any, fiblets: FibletSet, ids: np.ndarray) -> Any:
    """Return a filter of a whole set as one of some of its streamlines."""
    from pvfiblets.engine.fiblets.data.filter_textures import Filter

    if filtering is None:
        return None
    streamlines = None if filtering.streamlines is None else filtering.streamlines[ids]
    words = None
    if filtering.points is not None:
        from pvfiblets.codec.streamline_ranges import ranges_of

        places = ranges_of(fiblets, ids)
        places = places.at(np.argsort(places.point, kind="stable"))  # a part is coded in the order of the whole
        lengths = places.points
        first = np.cumsum(lengths) - lengths
        rows = np.arange(int(lengths.sum())) + np.repeat(places.point - first, lengths)
        bits = (filtering.points[rows >> 5] >> (rows & 31).astype(np.uint32)) & np.uint32(1)
        padded = np.zeros(32 * (len(bits) // 32 + 1), np.uint8)
        padded[: len(bits)] = bits
        words = np.packbits(padded, bitorder="little").view("<u4").astype(np.uint32)
    return Filter(streamlines, words)
