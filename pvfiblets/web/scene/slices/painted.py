"""Regions that are painted on the slices of a scene."""

from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.plotting.filtering.state import unique_name
from pvfiblets.query.bundles.colours import distinct_colour, hex_colour
from pvfiblets.query.painting.painter import Stroke
from pvfiblets.web.session.document import Layer
from pvfiblets.web.session.painting import LONGEST, MOST_REGIONS, MOST_VOXELS, USES, Painted, Painting, Strokes
from pvfiblets.web.values import colour, number, numbers, shown, text, truth

if TYPE_CHECKING:
    from pvfiblets.query.painting.painter import RegionPainter
    from pvfiblets.web.scene.files.loading import Loaded
    from pvfiblets.web.scene.scene import Scene

TOOLS = ("brush", "erase", "fill", "outline", "sphere", "grow")
WIDEST = 100.0  # mm
MOST_PLACES = 600


class ScenePainting:
    """Regions of a scene that are painted on its slices."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    # Regions

    def add_painted(self, layer_id: str | None = None) -> Painted:
        """Add a region without voxels; streamlines that pass through it stay visible once it has some."""
        painting = self.scene.state.painting or self._begun(layer_id)
        if len(painting.regions) >= MOST_REGIONS:
            raise ValueError(f"there are {MOST_REGIONS} painted regions, which is the most; remove one first")
        label = max((one.label for one in painting.regions), default=0) + 1
        name = unique_name((one.name for one in painting.regions), "region")
        made = Painted(name, label, hex_colour(distinct_colour(label - 1)), use="passes")
        wanted = replace(painting, regions=(*painting.regions, made))
        self.scene.become(replace(self.scene.state, painting=wanted), f"add {name}")
        return made

    def _begun(self, layer_id: str | None) -> Painting:
        images = [layer for layer in self.scene.state.layers if layer.kind == "image"]
        chosen: Layer | None = next((one for one in images if one.id == layer_id), images[0] if images else None)
        if chosen is None:
            raise ValueError("regions are painted on slices; open an image as slices first")
        return _on(self.scene.data(chosen))

    def set_painted(self, region: str, /, **changes: Any) -> Painted:
        """Change a region's ``name``, ``color``, ``visible`` or ``use`` (of `painting.USES`)."""
        painting = self._painting
        old = painting.region(region)
        wanted: dict[str, Any] = {}
        for key, value in changes.items():
            if key == "name":
                wanted[key] = text(value, "name", LONGEST)
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
        self.scene.become(replace(self.scene.state, painting=painting.with_region(old, new)), what)
        return new

    def remove_painted(self, name: str) -> None:
        """Take a region and its voxels away; with the last one painting ends."""
        painting, painter = self._painting, self._painter
        old = painting.region(name)
        left = painting.with_region(old, None)
        strokes = self.scene.canvas.painted(painter.clear(old.name))
        self.scene.become(
            replace(self.scene.state, painting=replace(left, strokes=strokes) if left.regions else None),
            f"remove {old.name}",
        )

    # Strokes

    def paint(
        self, tool: str, name: str, path: Any, radius: float, plane: int | None = None, gesture: Any = None,
        share: float = 0.1,
    ) -> int:  # fmt: skip
        """Paint, erase, fill, outline or grow."""
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
        elif tool == "outline":
            if plane is None or len(places) < 3:
                raise ValueError("an outline is of one slice, and goes through three places or more")
            stroke = painter.polygon(target, places, plane)
        elif tool == "sphere":
            apart = float(np.linalg.norm(places[-1] - places[0]))
            stroke = painter.sphere(target, places[0], min(apart, WIDEST) if apart > 0.0 else reach)
        elif tool == "grow":
            stroke = self._grown(painter, name, places[0], number(share, "share of the window", 0.0, 1.0), plane)
        else:
            stroke = painter.paint(target, places, reach, plane=plane)
        if len(stroke):
            what = {"erase": "erase", "fill": f"fill {target}", "grow": f"grow {target}"}.get(tool, f"paint {target}")
            key = None if gesture is None else ("paint", str(gesture))
            wanted = replace(painting, strokes=self.scene.canvas.painted(stroke))
            self.scene.become(replace(self.scene.state, painting=wanted), what, key)
        return len(stroke)

    def _grown(self, painter: RegionPainter, name: str, seed: np.ndarray, share: float, plane: int | None) -> Stroke:
        painting = self._painting
        images = [
            (layer, self.scene.data(layer).data) for layer in reversed(self.scene.state.layers) if layer.kind == "image"
        ]
        fitting = [
            (layer, image) for layer, image in images
            if image.shape == painting.shape and np.allclose(image.affine, painting.matrix, atol=1e-4)
        ]  # fmt: skip
        if not fitting:
            raise ValueError("no image lies on the voxels that are painted; open the one that painting began on")
        layer, image = next((one for one in fitting if one[0].visible), fitting[0])
        shown_layer = self.scene.actor(layer.id)
        values = image.values[..., layer.settings["index"] if image.n_volumes > 1 else 0]
        low, high = shown_layer.window
        at = image.voxel_at(seed)
        if at is None or not np.isfinite(values[at]):
            raise ValueError("there is no value of the image; begin within it")
        reach = share * (high - low)
        return painter.grow(name, seed, values, float(values[at]) - reach, float(values[at]) + reach, plane=plane)

    def move_painted(self, name: str, by: int) -> None:
        """Move a region up (-1) or down in the list, which is the order in which waypoints are passed."""
        painting = self._painting
        at = painting.regions.index(painting.region(name))
        to = min(max(at + by, 0), len(painting.regions) - 1)
        rows = list(painting.regions)
        rows.insert(to, rows.pop(at))
        if to != at:
            self.scene.become(
                replace(self.scene.state, painting=replace(painting, regions=tuple(rows))), f"order of {name}"
            )

    def add_labels(self, loaded: Loaded) -> list[Painted]:
        """Take the labels of an image as painted regions, by their names and colours."""
        image = loaded.data
        found = self._labels_in(loaded)
        painting = self.scene.state.painting
        if painting is None:
            painting = _on(loaded)
        elif image.shape != painting.shape or not np.allclose(image.affine, painting.matrix, atol=1e-4):
            raise ValueError(
                f"{loaded.name} has {image.shape} voxels on another grid than the painted regions, "
                f"{painting.shape}; remove these regions first"
            )
        if len(painting.regions) + len(found) > MOST_REGIONS:
            raise ValueError(
                f"{loaded.name} has {len(found)} labels; {MOST_REGIONS} painted regions are the most: open it as an "
                "image and ask for its labels"
            )
        first = max((one.label for one in painting.regions), default=0) + 1
        names, table = [one.name for one in painting.regions], image.table
        made, labels = [], np.zeros(image.shape, np.uint16)
        for new, old in enumerate(found, first):
            named = "".join(filter(str.isprintable, table.name(old))) if table is not None else ""
            called = named[: LONGEST - 10].strip() or str(old)
            name = unique_name(names, called) if called in names else called
            colours = None if table is None else table.colours.get(old)
            rgb = distinct_colour(new - 1) if colours is None else tuple(part / 255.0 for part in colours[:3])
            color = hex_colour(rgb)
            names.append(name)
            made.append(Painted(name, new, color))
            labels[image.values[..., 0] == old] = new
        wanted = replace(painting, regions=(*painting.regions, *made))
        places = np.flatnonzero(labels.reshape(-1))
        before = np.zeros(len(places), np.uint16)
        if (painter := self.scene.canvas.painter) is not None:
            before = painter.labels.reshape(-1)[places].copy()
        stroke = Stroke(places, before, labels.reshape(-1)[places])
        wanted = replace(wanted, strokes=Strokes.after(painting.strokes, stroke))
        self.scene.become(replace(self.scene.state, painting=wanted), f"regions of {loaded.name}")
        return made

    @staticmethod
    def _labels_in(loaded: Loaded) -> list[int]:
        """Return the labels of an image but 0."""
        image = loaded.data
        values = np.unique(image.values)
        whole = np.isfinite(values).all() and (values == np.rint(values)).all()
        if image.n_volumes != 1 or not whole or not len(found := values[values != 0]):
            raise ValueError(f"{loaded.name} holds no labels; regions are whole numbers, one per voxel, 0 for none")
        return [int(one) for one in found]

    def voxels_of(self, name: str) -> int:
        """Return how many voxels a region has."""
        return int(np.count_nonzero(self._painter.labels == self._painting.region(name).label))

    def save_painting(self, path: str) -> Path:
        """Write the regions as labels, NIfTI, with a table of their names beside it; return the volume's place."""
        if not path.lower().endswith((".nii", ".nii.gz")):
            raise ValueError(f"{shown(path)}: regions are saved as .nii or .nii.gz")
        target = self.scene.files.resolve(path, new=True)
        painter = self._painter
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=".painted-") as folder:
            part = Path(folder) / target.name
            table = painter.save(part)
            table.replace(target.with_name(table.name))
            part.replace(target)
        return target

    @property
    def _painting(self) -> Painting:
        if self.scene.state.painting is None:
            raise ValueError("there are no painted regions; add one first")
        return self.scene.state.painting

    @property
    def _painter(self) -> RegionPainter:
        if self.scene.canvas.painter is None:
            raise ValueError("there are no painted regions; add one first")
        return self.scene.canvas.painter


def _on(loaded: Loaded) -> Painting:
    """Return an empty painting on the voxels of an image."""
    shape, affine = loaded.data.shape, loaded.data.affine
    if (voxels := math.prod(shape)) > MOST_VOXELS:
        raise ValueError(f"{loaded.name} has {voxels:,} voxels; regions are painted on {MOST_VOXELS:,} at most")
    return Painting(shape, tuple(float(part) for part in affine.ravel()))
