"""A layer of slices: an image and how it is shown."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.plotting.slices.resampling import Resampler, reaching_border
from pvfiblets.plotting.slices.settings import SliceSettings
from pvfiblets.slices import colours
from pvfiblets.slices.image import KINDS, SliceImage, as_slice_image
from pvfiblets.slices.labels import LabelTable, as_label_table
from pvfiblets.slices.vectors import check_axes, fsl_axes, in_scanner_axes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from pvfiblets.slices.frames import PlaneGrid

N_COLOURS = 256


class SliceLayer(SliceSettings):
    """An image in a stack of slices; its properties are live and show with the next render.

    Parameters
    ----------
    image : SliceImage
    settings : mapping
        Those of `SliceSettings`, checked.
    kind : str, optional
        As of ``plotter.add_slices``.
    labels : object, optional
        As of ``plotter.add_slices``.
    modulate : object, optional
        As of ``plotter.add_slices``.
    vectors : str
        As of ``plotter.add_slices``.
    """

    def __init__(
        self,
        image: SliceImage,
        settings: Mapping[str, Any],
        *,
        kind: str | None = None,
        labels: Any = None,
        modulate: Any = None,
        vectors: str = "scanner",
    ) -> None:
        if check_axes(vectors) != "scanner" and kind not in (None, "direction"):
            raise ValueError(f"vectors is of direction-coded images, but kind is {kind!r}; leave one of both out")
        self.kind = _kind(image, "direction" if vectors != "scanner" else kind, labels, modulate)
        self.image, self._vectors = image, vectors
        self.name = image.name
        self.labels: LabelTable | None = None
        self._changed: Callable[[], None] | None = None
        self._resamplers: dict[int, Resampler] = {}
        self._weights: SliceLayer | None = None
        self._table: npt.NDArray[np.uint8] | None = None
        self._state: dict[str, Any] = {}
        for name, value in settings.items():
            self._state[name] = self._checked(name, value)
        if self.kind == "labels":
            self.labels = LabelTable() if labels is None else as_label_table(labels)
        if modulate is not None:
            weights = as_slice_image(modulate)
            if weights.n_volumes != 1:
                raise ValueError(
                    f"modulate has {weights.n_volumes} numbers per voxel; give an image of one, such as FA"
                )
            state = {**self._state, "index": 0}
            self._weights = SliceLayer(weights, state, kind="scalars")

    def __repr__(self) -> str:
        return f"<SliceLayer {self.name!r}: {self.kind}, {' x '.join(map(str, self.image.shape))} voxels>"

    # Settings -----------------------------------------------------------------------------------

    def watch(self, changed: Callable[[], None] | None) -> None:
        """Call that whenever another picture is needed."""
        self._changed = changed

    def data_changed(self) -> None:
        """Update the slices after the image's values were changed in place."""
        for one in self._resamplers.values():
            one.changed()
        if self._changed is not None:
            self._changed()

    def _checked(self, name: str, value: Any) -> Any:
        if name == "index" and not -self.n_volumes <= value < self.n_volumes:
            raise ValueError(
                f"index is {value}; {self.name} has {self.n_volumes} volumes, give 0 to {self.n_volumes - 1}"
            )
        return value

    def _write(self, name: str, value: Any) -> None:
        self._state[name] = self._checked(name, value)
        if name == "cmap":
            self._table = None
        if self._weights is not None and name in ("clim", "percentiles", "below", "above", "outside"):
            setattr(self._weights, name, value)
        if self._changed is not None:
            self._changed()

    @property
    def n_volumes(self) -> int:
        """Volumes that ``index`` chooses among."""
        return self.image.n_volumes if self.kind in ("scalars", "labels") else 1

    @property
    def window(self) -> tuple[float, float]:
        """Values of the first and the last colour."""
        if self._weights is not None:
            return self._weights.window
        given = self._state["clim"]
        if given is not None or self.kind not in ("scalars",):
            return (0.0, 1.0) if given is None else given
        low, high = self._state["percentiles"]
        return self.image.percentiles(low, high, self._state["index"])

    @property
    def outside_level(self) -> float | None:
        """Largest transparent value around the object in the 3-D view (see ``outside``); None for none."""
        if self._weights is not None:
            return self._weights.outside_level
        given: float | None = self._state["outside"]
        if given is not None or self.kind == "labels":
            return given
        return self.image.outside(self._state["index"] % self.n_volumes if self.kind == "scalars" else None)

    # Values and colours -------------------------------------------------------------------------

    def values_on(self, grid: PlaneGrid) -> npt.NDArray[np.float64]:
        """Return values at the pixels of a plane.

        Returns
        -------
        numpy.ndarray
            ``(height, width)``, of colours and vectors ``(height, width, n)``; NaN outside of the image.
        """
        return self._resampler().at(grid, self._how())

    def value_at(self, position: npt.ArrayLike) -> Any:
        """Return the value of the image at a position in mm.

        Returns
        -------
        float, int, (n,) array or None
            None outside the image, and if a number is not finite.
        """
        if self.kind == "labels":
            found = self._resampler().value(position, "nearest")
            return int(found[0]) if np.isfinite(found[0]) else None
        if self.kind == "direction":  # the vector itself, signs and all, of the nearest voxel
            voxel = self.image.voxel_at(position)
            if voxel is None:
                return None
            turn = np.eye(3) if self._vectors == "scanner" else fsl_axes(self.image.affine)
            return turn @ np.asarray(self.image.values[voxel], np.float64)
        found = self._resampler().value(position, self._how())
        if not np.isfinite(found).all():
            return None
        return float(found[0]) if len(found) == 1 else found

    def colours_on(self, grid: PlaneGrid, *, in_3d: bool = False) -> tuple[colours.Floats, colours.Mask]:
        """Return colours ``(height, width, 4)`` at the pixels of a plane, and which of them are visible."""
        values, below, above = self.values_on(grid), self._state["below"], self._state["above"]
        if self.kind == "labels":
            return self._label_colours(values, colours.shown(values, below, above))
        if self.kind == "scalars":
            table = self.table()
            mapped = colours.mapped(values, table, self.window, self._state["log_scale"])
            return mapped, colours.shown(values, below, above) & self._within(values, in_3d)
        inside: colours.Mask = np.asarray(np.isfinite(values).all(axis=-1))
        if self.kind == "direction":
            weights = None if self._weights is None else self._weights.values_on(grid)
            if weights is not None:
                inside &= colours.shown(weights, below, above)
            inside &= self._within(values.max(axis=-1) if weights is None else weights, in_3d)
            return colours.direction_colours(values, weights, self.window), inside
        scale = 255.0 if self.image.values.dtype == np.uint8 else 1.0
        out = np.ones((*values.shape[:2], 4), np.float32)
        out[..., : values.shape[2]] = np.clip(np.nan_to_num(values) / scale, 0.0, 1.0)
        brightest = values[..., :3].max(axis=-1)
        return out, inside & colours.shown(brightest, below, above) & self._within(brightest, in_3d)

    def _within(self, values: npt.NDArray[np.float64], in_3d: bool) -> colours.Mask:
        """Return the pixels that the outside of the image does not hide."""
        level = self.outside_level if in_3d else None
        if level is None:
            return np.ones(values.shape, bool)
        return ~reaching_border(~(values > level))

    def table(self) -> npt.NDArray[np.uint8]:
        """Return the colours of the window, ``(n, 4)`` uint8."""
        if self._table is None:
            cmap = self._state["cmap"]
            table = cmap if isinstance(cmap, pv.LookupTable) else pv.LookupTable(cmap, n_values=N_COLOURS)
            self._table = np.array(table.values, np.uint8).reshape(-1, 4)
        return self._table

    def _label_colours(
        self, values: npt.NDArray[np.float64], inside: colours.Mask
    ) -> tuple[colours.Floats, colours.Mask]:
        assert self.labels is not None
        known, codes = np.unique(np.nan_to_num(values), return_inverse=True)
        codes = codes.reshape(values.shape)
        table = self.labels.rows(np.rint(known).astype(np.int64))
        visible = inside & (table[codes, 3] > 0)
        if self._state["outline"]:
            visible &= colours.outlines(codes)
        return colours.table_colours(codes, table), visible

    def _how(self) -> str:
        return "nearest" if self.kind == "labels" else str(self._state["interpolation"])

    def _resampler(self) -> Resampler:
        index = self._state["index"] % self.n_volumes
        if index not in self._resamplers:
            values = in_scanner_axes(self.image, self._vectors).values
            if self.kind == "direction":
                values = abs(values.astype(np.float32))  # directions have no sign, and would cancel between voxels
            elif self.kind != "rgb":
                values = values[..., index]
            self._resamplers = {index: Resampler(values, self.image.inverse)}  # one volume at a time
        return self._resamplers[index]


def _kind(image: SliceImage, given: str | None, labels: Any, modulate: Any) -> str:
    """Return what the numbers of an image mean."""
    if given is not None and given not in KINDS:
        raise ValueError(f"kind is {given!r}; choose one of {KINDS}")
    if labels is not None and given not in (None, "labels"):
        raise ValueError(f"labels are given, but kind is {given!r}; leave one of both out")
    if modulate is not None and given not in (None, "direction"):
        raise ValueError(f"modulate is of direction-coded images, but kind is {given!r}; leave one of both out")
    if given is None:
        if labels is not None or (image.is_labels and modulate is None):
            given = "labels"
        elif modulate is not None:
            given = "direction"
        else:
            given = "rgb" if image.is_colours else "scalars"
    wanted = {"rgb": (3, 4), "direction": (3,)}.get(given)
    if wanted is not None and image.n_volumes not in wanted:
        raise ValueError(
            f"{image.name} has {image.n_volumes} numbers per voxel; kind={given!r} needs "
            f"{' or '.join(map(str, wanted))}"
        )
    if given == "labels" and image.values.dtype.kind == "f":
        some = image.values.ravel(order="K")[:: max(1, image.values.size // 100_000)]
        if not (np.isfinite(some) & (some == np.rint(some))).all():
            raise ValueError(f"{image.name} holds fractions; labels are whole numbers")
    return given
