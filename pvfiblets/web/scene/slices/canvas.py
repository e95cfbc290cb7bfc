"""Painted regions of a document in a scene: they show on slices, and filter streamlines."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.query.painting.live import LiveRegions
from pvfiblets.query.painting.painter import PaintedRegion, RegionPainter, Stroke
from pvfiblets.slices.image import SliceImage
from pvfiblets.slices.labels import LabelTable
from pvfiblets.web.session.painting import USES, Painting, Strokes, path_between

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.scene.slices.slicing import Slicing
    from pvfiblets.web.session.document import Layer

CONDITION = "painted"
OPACITY = 0.55


class Canvas:
    """The painted regions of a scene, kept in step with its document."""

    def __init__(self, slicing: Slicing) -> None:
        self._slicing = slicing  # whose slices show them
        self._painting: Painting | None = None
        self._strokes: Strokes | None = None
        self._shown: np.ndarray = np.zeros((0, 0, 0), np.uint16)
        self._live: dict[int, LiveRegions] = {}
        self._applied: dict[str, tuple[Any, Any]] = {}
        self.painter: RegionPainter | None = None

    @property
    def strokes(self) -> Strokes | None:
        """All that is painted now."""
        return self._strokes

    def painted(self, stroke: Stroke) -> Strokes | None:
        """Return the strokes; the painter has just painted the last one, and the document follows."""
        if len(stroke):
            self._strokes = Strokes.after(self._strokes, stroke)
        return self._strokes

    def become(self, painting: Painting | None, lines: Iterable[tuple[Layer, Any]]) -> None:
        """Bring voxels, slices and streamlines in step with a document."""
        before = self._painting
        if painting is None or before is None or (painting.shape, painting.affine) != (before.shape, before.affine):
            self._forget()
        self._painting = painting
        if painting is not None:
            self._voxels(painting)
            self._slices(painting, changed=painting != before)
        self._filter(painting, list(lines))

    def _forget(self) -> None:
        for live in self._live.values():
            live.close()
        self._live, self._strokes, self.painter = {}, None, None
        if self._slicing.painted is not None:
            self._slicing.remove_painted()

    # Voxels

    def _voxels(self, painting: Painting) -> None:
        if self.painter is None:
            self.painter = RegionPainter((painting.shape, painting.matrix))
            self._shown = np.zeros(painting.shape, np.uint16, order="F")
            self.painter.listeners.append(self._stroke)
        parts = {one.name: tuple(int(one.color[k : k + 2], 16) / 255.0 for k in (1, 3, 5)) for one in painting.regions}
        self.painter.regions = {
            one.name: PaintedRegion(one.name, one.label, parts[one.name], one.visible)  # type: ignore[arg-type]
            for one in painting.regions
        }
        back, on = path_between(self._strokes, painting.strokes)
        for stroke in back:
            self.painter.apply(Stroke(stroke.voxels, stroke.after, stroke.before))
        for stroke in on:
            self.painter.apply(stroke)
        self._strokes = painting.strokes

    def _stroke(self, stroke: Stroke) -> None:
        self._shown[np.unravel_index(stroke.voxels, self._shown.shape)] = stroke.after
        if self._slicing.painted is not None:
            self._slicing.painted.data_changed()

    def _slices(self, painting: Painting, *, changed: bool) -> None:
        if self._slicing.workspace is None:
            return
        if self._slicing.painted is None:
            image = SliceImage(self._shown[..., None], painting.matrix, "painted", is_labels=True)
            self._slicing.add_painted(image, opacity=OPACITY)
            changed = True
        if changed:
            table = LabelTable()
            for one in painting.regions:
                red, green, blue = (int(one.color[k : k + 2], 16) for k in (1, 3, 5))
                table.names[one.label] = one.name
                table.colours[one.label] = red, green, blue, 255 if one.visible else 0
            self._slicing.painted.labels = table
            self._slicing.painted.data_changed()

    # Streamlines

    def _filter(self, painting: Painting | None, lines: list[tuple[Layer, Any]]) -> None:
        used = self.used(painting)
        there = {layer.id for layer, _ in lines}
        self._applied = {key: value for key, value in self._applied.items() if key in there}
        wanted = (self._strokes, used) if used else None
        for layer, actor in lines:
            has = CONDITION in actor.conditions
            if self._applied.get(layer.id) == (actor, wanted) and has == (wanted is not None):
                continue
            if wanted is None:
                if has:
                    actor.remove_condition(CONDITION)
            else:
                actor.include(self._mask(actor.fiblets, used), name=CONDITION)
            self._applied[layer.id] = actor, wanted
        kept = {id(actor.fiblets) for _, actor in lines}
        for key in [key for key in self._live if key not in kept]:
            self._live.pop(key).close()

    def used(self, painting: Painting | None) -> tuple[tuple[str, str], ...]:
        """Return names and uses of regions with voxels, the ones that filter."""
        if painting is None or self.painter is None:
            return ()
        used = [one for one in painting.regions if one.use]
        if not used:
            return ()
        there = np.bincount(self.painter.labels.reshape(-1), minlength=1 + max(one.label for one in used)) > 0
        return tuple((one.name, one.use) for one in used if there[one.label])

    def _mask(self, fiblets: FibletSet, used: tuple[tuple[str, str], ...]) -> np.ndarray:
        live = self.live(fiblets)
        by = {use: [name for name, its in used if its == use] for use in USES}
        mask = live.select(
            include=by["passes"], exclude=by["misses"], ends_in=by["ends_in"], in_order=by["in_order"]
        )
        for name in by["stays_in"]:
            mask &= live.select(stays_in=name)
        return mask

    def live(self, fiblets: FibletSet) -> LiveRegions:
        """Return the state of a set's streamlines and the regions."""
        assert self.painter is not None
        if id(fiblets) not in self._live:
            self._live[id(fiblets)] = LiveRegions(fiblets, self.painter)
        return self._live[id(fiblets)]
