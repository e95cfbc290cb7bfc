"""Selected streamlines drawn once more, wider or as tubes, in the place of the actor that they belong to.

A small set of their own (`FibletSet.extract`) on a mapper of its own: the rest is drawn as before. What is drawn
follows the owner: before each picture its place, looks, cuts and filters are looked at, and taken over where they
changed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.mappers import Colouring, FibletMapper
from pvfiblets.mappers.picking import Layer
from pvfiblets.mappers.scene import renderers_of, to_array
from pvfiblets.mappers.windows import weak

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.plotting.actor import FibletActor


class Standout:
    """A second actor for some of an actor's streamlines.

    Parameters
    ----------
    owner : FibletActor
        Whose streamlines they are.
    ids : numpy.ndarray
        ``(n,)`` int64, rising.
    color : tuple of float, optional
        One colour for all; the owner's colours by default.
    width : float
        Pixels of the lines.
    extra : Any
        An extra of the mapper that makes tubes of them.
    """

    def __init__(
        self,
        owner: FibletActor,
        ids: np.ndarray,
        *,
        color: tuple[float, ...] | None,
        width: float,
        extra: Any = None,
    ) -> None:
        self.ids = ids
        self._owner = weak(owner)
        self._color = color
        self._fiblets = owner.fiblets
        self._taken: dict[str, Any] = {}
        self._matrix = vtkMatrix4x4()
        self._renderers: dict[str, tuple[Any, int]] = {}
        self.mapper = FibletMapper(owner.fiblets.extract(ids), line_width=width, options=owner.mapper.options)
        if extra is not None:
            self.mapper.set_extra("tubes", extra)
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
        return Layer(self.mapper, self.ids)

    def enter(self, renderer: Any) -> None:
        """Be drawn by a renderer that draws the owner."""
        address = renderer.GetAddressAsString("")
        if address in self._renderers:
            return
        renderer.AddActor(self.actor)
        this = weak_method(self)
        tag = renderer.AddObserver("StartEvent", lambda caller, _event: this(caller))
        self._renderers[address] = (weak(renderer), tag)

    def leave(self) -> None:
        """Be gone from all renderers, and from the GPU."""
        for address in list(self._renderers):
            self._leave(address)
        self.mapper.release()
        self.mapper.detach()

    def _leave(self, address: str) -> None:
        reference, tag = self._renderers.pop(address)
        renderer = reference.Get()
        if renderer is not None:
            renderer.RemoveObserver(tag)
            renderer.RemoveActor(self.actor)

    def leave_with_owner(self) -> None:
        """Be gone from renderers that do not draw the owner any more."""
        owner = self._owner.Get()
        for address, (reference, _) in list(self._renderers.items()):
            renderer = reference.Get()
            if renderer is None or owner is None or not renderer.HasViewProp(owner):
                self._leave(address)

    def before_picture(self, renderer: Any) -> None:
        """Leave if the owner has left, else do as it does. VTK lists what it draws after this."""
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
        if self._changed("options", mapper.options):
            self.mapper.options = mapper.options
        if self._changed("colouring", mapper.colouring):
            self.mapper.colouring = self._colours(mapper.colouring)
        if self._changed("planes", mapper.GetClippingPlanes()):
            self.mapper.SetClippingPlanes(mapper.GetClippingPlanes())
        if self._changed("region", mapper.region):
            self.mapper.region = mapper.region
        if self._changed("filtering", mapper.filtering):
            self.mapper.filtering = part_of_filter(mapper.filtering, self._fiblets, self.ids)

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
        if colouring.mode in ("streamline_rgb", "streamline_scalar") and colouring.values is not None:
            return replace(colouring, values=np.asarray(colouring.values)[self.ids])
        return colouring


def weak_method(standout: Standout) -> Any:
    """Return a function that calls ``before_picture`` while the object lives."""
    import weakref

    reference = weakref.ref(standout)

    def call(renderer: Any) -> None:
        alive = reference()
        if alive is not None:
            alive.before_picture(renderer)

    return call


def part_of_filter(filtering: Any, fiblets: FibletSet, ids: np.ndarray) -> Any:
    """Return a filter of a whole set as one of some of its streamlines.

    Parameters
    ----------
    filtering : Filter or None
        Of ``fiblets``.
    fiblets : FibletSet
        The whole.
    ids : numpy.ndarray
        ``(n,)`` int64, rising: streamlines of ``fiblets.extract(ids)``.

    Returns
    -------
    Filter or None
        Of the part.
    """
    from pvfiblets.engine.filtering import Filter

    if filtering is None:
        return None
    streamlines = None if filtering.streamlines is None else filtering.streamlines[ids]
    words = None
    if filtering.points is not None:
        from pvfiblets.codec.places import places_of

        places = places_of(fiblets, ids)
        places = places.at(np.argsort(places.point, kind="stable"))  # a part is coded in the order of the whole
        lengths = places.points
        first = np.cumsum(lengths) - lengths
        rows = np.arange(int(lengths.sum())) + np.repeat(places.point - first, lengths)
        bits = (filtering.points[rows >> 5] >> (rows & 31).astype(np.uint32)) & np.uint32(1)
        padded = np.zeros(32 * (len(bits) // 32 + 1), np.uint8)
        padded[: len(bits)] = bits
        words = np.packbits(padded, bitorder="little").view("<u4").astype(np.uint32)
    return Filter(streamlines, words)
