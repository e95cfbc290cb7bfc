"""Slices of images in layers, in a 3-D view: what ``plotter.add_slices`` returns."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.mappers.frames.observers import weakly
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.plotting.slices.layer import SliceLayer
from pvfiblets.plotting.slices.plane import SlicePlane
from pvfiblets.plotting.slices.settings import SliceSettings
from pvfiblets.slices import colours
from pvfiblets.slices.frames import ORIENTATIONS, PlaneGrid, checked_frame, checked_position, nearest_frame
from pvfiblets.slices.image import as_slice_image

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.plotting.slices.glyph_set import GlyphSet

Array = npt.NDArray[np.float64]

MOST_LAYERS = 8


class SliceStack:
    """Axial, coronal and sagittal slices of up to eight images; ``plotter.add_slices`` makes it.

    Its properties can be set at any time and take effect at the next render. ``stack["axial"]`` is one of its planes.

    Parameters
    ----------
    name : str
    planes : iterable of str
        Of ``"axial"``, ``"coronal"`` and ``"sagittal"``.
    axes : str or (3, 3) array
        As of ``plotter.add_slices``.
    """

    def __init__(self, name: str, planes: Iterable[str], axes: Any = "world") -> None:
        self.name = name
        self._layers: list[SliceLayer] = []
        self._position: Array = np.zeros(3)
        self._axes_given = axes
        self._frame: Array = np.eye(3) if isinstance(axes, str) else checked_frame(axes)
        if isinstance(axes, str) and axes not in ("world", "image"):
            raise ValueError(f'axes is {axes!r}; give "world", "image" or a (3, 3) array of unit directions')
        names = (planes,) if isinstance(planes, str) else tuple(planes)
        for one in names:
            if one not in ORIENTATIONS:
                raise ValueError(f"planes has {one!r}; choose among {ORIENTATIONS}")
        self._planes = {one: SlicePlane(self, one) for one in dict.fromkeys(names)}
        self._glyphs: list[GlyphSet] = []
        self._views: list[tuple[Any, Callable[[], tuple[Array, Array] | None]]] = []
        self._watchers: list[Callable[[], None]] = []
        self._removal: Callable[[SliceStack], None] | None = None
        self._matrix: Array | None = None

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_") and name != "name" and not isinstance(getattr(type(self), name, None), property):
            raise AttributeError(
                f"slices have no {name!r} to set: there are position, voxel, frame, visible and user_matrix; "
                "colours and opacity belong to slices.layers[0]"
            )
        object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        where = ", ".join(f"{part:g}" for part in self._position)
        layers = [one.name for one in self._layers]
        return f"<SliceStack {self.name!r}: {', '.join(self._planes)} at ({where}) mm, layers {layers}>"

    def __getitem__(self, name: str) -> SlicePlane:
        if name not in self._planes:
            raise KeyError(f"there is no plane {name!r}; there are: {', '.join(self._planes)}")
        return self._planes[name]

    def __iter__(self) -> Iterator[SlicePlane]:
        return iter(tuple(self._planes.values()))

    # Layers -------------------------------------------------------------------------------------

    @property
    def layers(self) -> tuple[SliceLayer, ...]:
        """All layers, the lowest first."""
        return tuple(self._layers)

    def layer(self, name: str) -> SliceLayer:
        """Return the layer of a name."""
        for one in self._layers:
            if one.name == name:
                return one
        raise KeyError(f"there is no layer {name!r}; there are: {', '.join(repr(one.name) for one in self._layers)}")

    def add(
        self,
        source: Any,
        *,
        kind: str | None = None,
        labels: Any = None,
        modulate: Any = None,
        vectors: str = "scanner",
        name: str | None = None,
        **settings: Any,
    ) -> SliceLayer:
        """Add another image on top.

        Parameters
        ----------
        source, kind, labels, modulate, vectors
            As of ``plotter.add_slices``.
        name : str, optional
            Of the layer; the file's by default.
        **settings
            Those of ``plotter.add_slices`` that are of layers, such as ``cmap``, ``opacity`` or ``blend``.

        Returns
        -------
        SliceLayer
            Its properties may be changed at any time.

        Raises
        ------
        ValueError
            If there are eight layers already, or as for ``plotter.add_slices``.
        """
        unknown = next((one for one in settings if one not in SliceSettings.DECLARED), None)
        if unknown is not None:
            raise TypeError(
                f"add() got an unexpected keyword argument {unknown!r}; a layer has {', '.join(SliceSettings.DECLARED)}"
            )
        return self.put(
            source,
            Given(SliceSettings, settings),
            kind=kind,
            labels=labels,
            modulate=modulate,
            vectors=vectors,
            name=name,
        )

    def put(self, source: Any, given: Given, *, name: str | None = None, **meaning: Any) -> SliceLayer:
        """Add a layer of settings that are checked already."""
        if len(self._layers) >= MOST_LAYERS:
            raise ValueError(f"{self.name!r} has {MOST_LAYERS} layers, the maximum; remove one first")
        layer = SliceLayer(as_slice_image(source, name), given, **meaning)
        taken = {one.name for one in self._layers}
        stem, number = layer.name, 2
        while layer.name in taken:
            layer.name, number = f"{stem} {number}", number + 1
        first = not self._layers
        self._layers.append(layer)
        layer.watch(weakly(self.changed))
        if first:
            self._position = layer.image.center
            if isinstance(self._axes_given, str) and self._axes_given == "image":
                self._frame = nearest_frame(layer.image.affine)
        self.changed()
        return layer

    def remove_layer(self, layer: SliceLayer | str) -> None:
        """Remove a layer, given itself or by name."""
        layer = self.layer(layer) if isinstance(layer, str) else layer
        self._layers.remove(layer)
        layer.watch(None)
        self.changed()

    def reorder(self, layers: Iterable[SliceLayer | str]) -> None:
        """Move some layers below all others; the first is the lowest."""
        first = [self.layer(one) if isinstance(one, str) else one for one in layers]
        order = [*first, *(one for one in self._layers if one not in first)]
        if sorted(map(id, order)) != sorted(map(id, self._layers)):
            raise ValueError(f"the order {first} must name each layer of these slices once")
        if order != self._layers:
            self._layers = order
            self.changed()

    def add_glyphs(
        self,
        source: Any,
        kind: str = "peaks",
        *,
        size: float = 1.0,
        normalize: bool | None = None,
        line_width: float = 2.0,
        basis: str = "mrtrix",
        full: bool = False,
        tensor: str = "mrtrix",
        vectors: str | None = None,
        scalars: Any = None,
        length: Any = None,
        cmap: Any = None,
        clim: Any = None,
    ) -> GlyphSet:
        """Show peaks and fixels as lines, tensors as ellipsoids or spherical harmonics as lobes, on the slices.

        Glyphs are made only for voxels on visible slices.

        Parameters
        ----------
        source : image
            Any of what ``plotter.add_slices`` takes, of four axes: three numbers of each peak, along right, front and
            up; six of a tensor; or coefficients of harmonics. Of fixels a fixel directory of MRtrix, or one
            of its files.
        kind : {"peaks", "tensor", "sh", "fixels"}, default: "peaks"
        size : float, default: 1.0
            Of the greatest, per the smallest side of a voxel.
        normalize : bool, optional
            Give all glyphs the same size. By default ellipsoids and lobes have it, and lines are as long as the peaks;
            the 99th percentile is as long as a voxel.
        line_width : float, default: 2.0
            Pixels.
        basis : {"mrtrix", "tournier07_legacy", "descoteaux07", "descoteaux07_legacy"}, default: "mrtrix"
            Of harmonics; the latter three as dipy names them.
        full : bool, default: False
            Whether harmonics of odd degree are there, too.
        tensor : {"mrtrix", "dipy", "fsl"}, default: "mrtrix"
            Order of a tensor's parts: xx, yy, zz, xy, xz, yz; xx, xy, yy, xz, yz, zz; or xx, xy, xz, yy, yz, zz.
        vectors : {"scanner", "fsl"}, optional
            Axes of peaks and tensors: right, front and up, or FSL's axes (``dtifit``, ``bedpostx``), which are the
            image's, x reversed if the affine's determinant is above 0. Default: FSL's for ``tensor="fsl"``, else the
            scanner's.
        scalars, length : str or (n,) array, optional
            Numbers of fixels that colour them, by default their direction does, and numbers that set the lengths of
            lines; the 99th percentile is as long as a voxel; names of files of the directory, without suffix.
        cmap, clim : optional
            Colour map of ``scalars``, and the numbers of its first and last colour.

        Returns
        -------
        GlyphSet
            ``size`` and ``visible`` are live; ``remove()`` takes them away.

        Raises
        ------
        ValueError
            If the image has another number of volumes, or an argument has no meaning.
        """
        from pvfiblets.plotting.slices.glyph_set import GlyphSet

        made = GlyphSet(
            as_slice_image(source),
            kind=kind,
            size=size,
            normalize=kind != "peaks" if normalize is None else normalize,
            line_width=line_width,
            basis=basis,
            full=full,
            tensor=tensor,
            vectors=vectors,
            scalars=scalars,
            length=length,
            cmap=cmap,
            clim=clim,
        )
        for plane in self:
            made.show_on(plane.renderer, plane.place)
        for view in self._views:
            made.show_on(*view)
        self._glyphs.append(made)
        return made

    def add_fixels(self, source: Any, scalars: Any = None, **options: Any) -> GlyphSet:
        """Show the fixels of a directory of MRtrix's as lines; :meth:`add_glyphs` of the kind ``"fixels"``.

        Parameters
        ----------
        source : path
            Of the directory or one of its files.
        scalars : str or (n,) array, optional
            Numbers that colour them, such as ``"fd"`` of ``fd.mif``; by default their direction does.
        **options
            ``length``, ``size``, ``line_width``, ``cmap`` and ``clim`` of :meth:`add_glyphs`.

        Returns
        -------
        GlyphSet

        Raises
        ------
        ValueError
            If the directory or its files do not fit each other, or there are no such numbers.

        Examples
        --------
        >>> slices = plotter.add_slices("fa.nii.gz")  # doctest: +SKIP
        >>> slices.add_fixels("fixels", "fd", length="fd", cmap="hot")  # doctest: +SKIP
        """
        return self.add_glyphs(source, "fixels", scalars=scalars, **options)

    def remove_glyphs(self, glyphs: GlyphSet) -> None:
        """Remove glyphs that :meth:`add_glyphs` returned; a second call has no effect."""
        glyphs.remove()
        if glyphs in self._glyphs:
            self._glyphs.remove(glyphs)

    def show_glyphs_on(self, renderer: vtkRenderer, place: Callable[[], tuple[Array, Array] | None]) -> None:
        """Show glyphs on a plane of another renderer, too, including glyphs added later."""
        self._views.append((renderer, place))
        for one in self._glyphs:
            one.show_on(renderer, place)

    def show_glyphs_on_plane(self, plane: SlicePlane) -> None:
        """Show existing glyphs on a plane of the stack that has just entered its renderer."""
        for one in self._glyphs:
            one.show_on(plane.renderer, plane.place)

    # Place --------------------------------------------------------------------------------------

    @property
    def position(self) -> Array:
        """``(3,)`` mm: the intersection of all planes."""
        return self._position.copy()

    @position.setter
    def position(self, position: Any) -> None:
        self._position = checked_position("position", position)
        self.changed()

    @property
    def voxel(self) -> tuple[int, int, int] | None:
        """Voxel of the lowest layer at the position; None outside the layer."""
        return self._layers[0].image.voxel_at(self._position) if self._layers else None

    @voxel.setter
    def voxel(self, voxel: Any) -> None:
        affine = self._layers[0].image.affine
        self.position = affine[:3, :3] @ checked_position("voxel", voxel) + affine[:3, 3]

    @property
    def frame(self) -> Array:
        """``(3, 3)`` unit directions, as columns: to the right, to the front and up of the slices."""
        return self._frame.copy()

    @frame.setter
    def frame(self, frame: Any) -> None:
        self._frame = checked_frame(frame)
        self.changed()

    @property
    def visible(self) -> bool:
        """Whether any plane is shown; set for all of them. ``visibility`` is the same."""
        return any(plane.visible for plane in self)

    @visible.setter
    def visible(self, visible: bool) -> None:
        for plane in self:
            plane.visible = visible

    visibility = visible

    @property
    def user_matrix(self) -> Array | None:
        """``(4, 4)`` from the images' mm, in which ``position`` is given, to the 3-D view's."""
        return None if self._matrix is None else self._matrix.copy()

    @user_matrix.setter
    def user_matrix(self, matrix: Any) -> None:
        import pyvista as pv

        self._matrix = None if matrix is None else pv.Transform(matrix).matrix
        for plane in self:
            self._move(plane)

    def _move(self, plane: SlicePlane) -> None:
        plane.actor.user_matrix = np.eye(4) if self._matrix is None else self._matrix

    @property
    def planes(self) -> Mapping[str, SlicePlane]:
        """All planes by name."""
        return MappingProxyType(self._planes)

    def new_plane(self, name: str, normal: Any) -> SlicePlane:
        """Return another plane, at any angle, through the position; it is in no renderer yet."""
        plane = SlicePlane(self, name, (self._frame[:, 0], self._frame[:, 1]))
        plane.normal = normal
        self._planes[name] = plane
        self._move(plane)
        return plane

    # Pictures and values ------------------------------------------------------------------------

    def pixels(self, grid: PlaneGrid, *, in_3d: bool = False) -> npt.NDArray[np.uint8]:
        """Return the colours of all layers at the pixels of a plane.

        Parameters
        ----------
        grid : PlaneGrid
        in_3d : bool, default: False
            Whether the outside of images is clear, as in the 3-D view.

        Returns
        -------
        numpy.ndarray
            ``(height, width, 4)`` uint8, the lowest row first; the opacity is 0 where no layer shows anything.
        """
        found = None
        for layer in self._layers:
            if layer.visible and layer.opacity > 0.0:
                picture, visible = layer.colours_on(grid, in_3d=in_3d)
                found = colours.blend(found, picture, visible, layer.opacity, layer.blend)
        if found is None:
            return np.zeros((grid.shape[1], grid.shape[0], 4), np.uint8)
        return colours.to_bytes(found)

    @property
    def smooth(self) -> bool:
        """Whether colours may be interpolated between pixels."""
        shown = [one for one in self._layers if one.visible]
        return all(one.kind != "labels" and one.interpolation != "nearest" for one in shown)

    def values(self, position: Any = None) -> dict[str, Any]:
        """Return the values of all layers at a position.

        Parameters
        ----------
        position : (3,) array, optional
            mm; that of the planes by default.

        Returns
        -------
        dict
            By the layer's name: a number; of labels ``(number, name)``; of colours and vectors ``(n,)``; None outside.
        """
        at = self._position if position is None else checked_position("position", position)
        found = {}
        for layer in self._layers:
            value = layer.value_at(at)
            if layer.labels is not None and value is not None:
                value = value, layer.labels.name(value)
            found[layer.name] = value
        return found

    # Life cycle ---------------------------------------------------------------------------------

    def watch(self, changed: Callable[[], None]) -> None:
        """Call that whenever layers, position or directions change."""
        self._watchers.append(changed)

    def changed(self) -> None:
        """Render all slices again."""
        for plane in self._planes.values():
            plane.update()
        for call in self._watchers:
            call()

    def removed_by(self, removal: Callable[[SliceStack], None] | None) -> None:
        """Set the function that takes it out of its plotter."""
        self._removal = removal

    def remove(self) -> None:
        """Remove all slices; a second call has no effect."""
        while self._glyphs:
            self._glyphs.pop().remove()
        removal, self._removal = self._removal, None
        if removal is not None:
            removal(self)
