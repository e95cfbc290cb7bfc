"""Regions that are painted on the slices of a scene."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.fiblets.filter_state import unique_name
from pvfiblets.query.bundles.colours import distinct_colour, hex_colour
from pvfiblets.web.document import Layer, State
from pvfiblets.web.painting import MOST_REGIONS, USES, Painted, Painting
from pvfiblets.web.values import colour, number, numbers, shown, text, truth

if TYPE_CHECKING:
    from pvfiblets.query.painting.painter import RegionPainter
    from pvfiblets.web.canvas import Canvas
    from pvfiblets.web.loading import Files, Loaded

__all__ = ["TOOLS", "ScenePainting"]

TOOLS = ("brush", "erase", "fill")
WIDEST = 100.0  # mm
MOST_PLACES = 600


class ScenePainting:
    """The part of :class:`~pvfiblets.web.scene.Scene` that paints."""

    if TYPE_CHECKING:
        files: Files
        canvas: Canvas

        @property
        def state(self) -> State: ...  # noqa: D102 - of the scene

        become: Callable[..., None]
        data: Callable[..., Loaded]

    # Regions

    def add_painted(self, layer_id: str | None = None) -> Painted:
        """Add a region without voxels.

        Parameters
        ----------
        layer_id : str, optional
            An image, on whose voxels regions are painted if there are none yet; the lowest by default.

        Raises
        ------
        ValueError
            If there is no image, or there are as many regions as there may be.
        """
        painting = self.state.painting or self._begun(layer_id)
        if len(painting.regions) >= MOST_REGIONS:
            raise ValueError(f"there are {MOST_REGIONS} painted regions, which is the most; remove one first")
        label = max((one.label for one in painting.regions), default=0) + 1
        name = unique_name((one.name for one in painting.regions), "region")
        made = Painted(name, label, hex_colour(distinct_colour(label - 1)))
        wanted = replace(painting, regions=(*painting.regions, made))
        self.become(replace(self.state, painting=wanted), f"add {name}")
        return made

    def _begun(self, layer_id: str | None) -> Painting:
        images = [layer for layer in self.state.layers if layer.kind == "image"]
        chosen: Layer | None = next((one for one in images if one.id == layer_id), images[0] if images else None)
        if chosen is None:
            raise ValueError("regions are painted on slices; open an image as slices first")
        image = self.data(chosen).data
        return Painting(image.shape, tuple(float(part) for part in image.affine.ravel()))

    def set_painted(self, region: str, /, **changes: Any) -> Painted:
        """Change a region's ``name``, ``color``, ``visible`` or ``use`` (of :data:`.painting.USES`).

        Raises
        ------
        KeyError
            If there is no such region.
        ValueError
            If a value makes no sense, or the name is taken.
        """
        painting = self._painting
        old = painting.region(region)
        wanted: dict[str, Any] = {}
        for key, value in changes.items():
            if key == "name":
                wanted[key] = text(value, "name", 60)
                if any(one.name == value for one in painting.regions if one is not old):
                    raise ValueError(f"there is a painted region {shown(value)} already; give another name")
            elif key == "color":
                wanted[key] = colour(value, "colour")
            elif key == "visible":
                wanted[key] = truth(value, "visible")
            elif key == "use" and isinstance(value, str) and value in USES:
                wanted[key] = value
            else:
                raise ValueError(f"{shown(key)} of a painted region cannot be {shown(value)}")
        new = replace(old, **wanted)
        what = f"{', '.join(wanted) or 'nothing'} of {new.name}"
        self.become(replace(self.state, painting=painting.with_region(old, new)), what)
        return new

    def remove_painted(self, name: str) -> None:
        """Take a region and its voxels away; with the last one painting ends."""
        painting, painter = self._painting, self._painter
        old = painting.region(name)
        left = painting.with_region(old, None)
        strokes = self.canvas.painted(painter.clear(old.name))
        self.become(
            replace(self.state, painting=replace(left, strokes=strokes) if left.regions else None), f"remove {old.name}"
        )

    # Strokes

    def paint(
        self, tool: str, name: str, path: Any, radius: float, plane: int | None = None, gesture: Any = None
    ) -> int:
        """Paint, erase or fill.

        Parameters
        ----------
        tool : {"brush", "erase", "fill"}
        name : str
            Of the region; erasing takes voxels out of all.
        path : list of [x, y, z]
            mm: along which the brush is drawn; of a fill, the first is where it begins.
        radius : float
            Of the brush, mm.
        plane : {0, 1, 2}, optional
            Only within the slice across this axis of voxels.
        gesture : str, optional
            Strokes of one gesture are one step to undo.

        Returns
        -------
        int
            Voxels that have changed.
        """
        painting, painter = self._painting, self._painter
        if tool not in TOOLS:
            raise ValueError(f"there is no tool {shown(tool)}; choose one of {', '.join(TOOLS)}")
        if not isinstance(path, (list, tuple)) or not 1 <= len(path) <= MOST_PLACES:
            raise ValueError(f"a stroke goes through {shown(path)}; give 1 to {MOST_PLACES} positions")
        places = np.array([numbers(list(one), "position", 3) for one in path])
        reach = number(radius, "radius of the brush", 1e-3, WIDEST, unit=" of mm")
        target = None if tool == "erase" else painting.region(name).name
        if tool == "fill":
            stroke = painter.fill(target, places[0], plane=plane)
        else:
            stroke = painter.paint(target, places, reach, plane=plane)
        if len(stroke):
            what = {"brush": f"paint {target}", "erase": "erase", "fill": f"fill {target}"}[tool]
            key = None if gesture is None else ("paint", str(gesture))
            wanted = replace(painting, strokes=self.canvas.painted(stroke))
            self.become(replace(self.state, painting=wanted), what, key)
        return len(stroke)

    def voxels_of(self, name: str) -> int:
        """Return how many voxels a region has."""
        return int(np.count_nonzero(self._painter.labels == self._painting.region(name).label))

    def save_painting(self, path: str) -> Path:
        """Write the regions as labels, NIfTI, with a table of their names beside it; return the volume's place."""
        if not path.lower().endswith((".nii", ".nii.gz")):
            raise ValueError(f"{shown(path)}: regions are saved as .nii or .nii.gz")
        target = self.files.resolve(path, new=True)
        painter = self._painter
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=".painted-") as folder:
            part = Path(folder) / target.name
            table = painter.save(part)
            table.replace(target.with_name(table.name))
            part.replace(target)
        return target

    @property
    def _painting(self) -> Painting:
        if self.state.painting is None:
            raise ValueError("there are no painted regions; add one first")
        return self.state.painting

    @property
    def _painter(self) -> RegionPainter:
        if self.canvas.painter is None:
            raise ValueError("there are no painted regions; add one first")
        return self.canvas.painter
