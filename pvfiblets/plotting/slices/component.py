"""``plotter.add_slices(...)`` and ``plotter.slices``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for either name.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.mappers.frames.scene import partly_shown
from pvfiblets.plotting.components import register
from pvfiblets.plotting.settings.call_signature import document, plotter_method, refuse_unknown, split_arguments
from pvfiblets.plotting.settings.settings import Given
from pvfiblets.plotting.slices.settings import SliceCommon, SliceSettings

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.plotting.slices.plane import SlicePlane
    from pvfiblets.plotting.slices.stack import SliceStack
    from pvfiblets.plotting.slices.workspace import Workspace
    from pvfiblets.slices.image import SliceImage

    Source: TypeAlias = str | PathLike[str] | SliceImage | np.ndarray | tuple[Any, Any] | pv.ImageData


@register("slices")
class SlicesComponent:
    """The slices of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import numpy as np
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> slices = pl.slices.add(np.random.default_rng(0).random((8, 9, 10)))
    >>> list(pl.slices) == [slices]
    True
    """

    _SETTINGS: ClassVar[type[SliceSettings]] = SliceSettings
    COMMON: ClassVar[type[SliceCommon]] = SliceCommon
    NAME: ClassVar[str] = "slices"
    ADD: ClassVar[str] = "add_slices"
    OWN: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)
        self._stacks: list[SliceStack] = []
        self._workspaces: list[Workspace] = []
        self._followed: dict[str, tuple[Any, int]] = {}
        self._bars: dict[int, str] = {}

    def __iter__(self) -> Iterator[SliceStack]:
        return iter(tuple(self._stacks))

    def __len__(self) -> int:
        return len(self._stacks)

    def add(self, /, source: Any, **arguments: Any) -> SliceStack:
        """Make slices and add them to the plotter."""
        common, given, own = split_arguments(self, self.COMMON, arguments)
        refuse_unknown(self, own)
        stack = self._make(source, given, **own)
        if common["name"] is not None:
            for other in self:
                if other.name == common["name"]:
                    other.remove()
            stack.name = str(common["name"])
        else:
            taken = {other.name for other in self}
            number = 1
            while stack.name in taken:
                number += 1
                stack.name = f"slices {number}"
        if common["user_matrix"] is not None:
            stack.user_matrix = common["user_matrix"]
        self._enter(stack, bool(common["pickable"]), common["reset_camera"])
        if common["show_scalar_bar"] and stack.layers[0].kind == "scalars":
            self._show_bar(stack, common["scalar_bar_args"] or {})
        if common["render"]:
            self._plotter.render()
        return stack

    def _make(
        self,
        source: Source,
        settings: Given,
        *,
        position: Any = None,
        planes: str | Iterable[str] = ("axial", "coronal", "sagittal"),
        axes: str | np.ndarray = "world",
        kind: str | None = None,
        labels: Any = None,
        modulate: Any = None,
        vectors: str = "scanner",
    ) -> SliceStack:
        """Add axial, coronal and sagittal slices of an image to the scene.

        The slices lie where the image's affine puts them, on any grid, sheared ones too, and show streamlines and
        meshes before and behind them. More images are laid over the first by ``slices.add(...)``, up to eight.

        Parameters
        ----------
        source : path, nibabel image, (array, affine), array, pyvista.ImageData or SliceImage
            What to slice: NIfTI 1 and 2, MGH, MIF, NRRD and MetaImage files among others. An image of four axes
            shows the volume ``index``.
        position : (3,) array, optional
            Where the planes meet, mm; the image's middle by default.
        planes : str or iterable of str, default: ("axial", "coronal", "sagittal")
            Which planes.
        axes : {"world", "image"} or (3, 3) array, default: "world"
            Axes that the planes follow: the scanner's, the image's, as near as right angles allow, or
            a rotation whose columns point to the right, to the front and up.
        kind : {"scalars", "rgb", "direction", "labels"}, optional
            What the numbers mean. By default bytes with three or four of them per voxel are colours, files that say
            so labels, and all others scalars. ``"direction"`` shows vectors, such as V1, by the size of their parts
            along right, front and up as red, green and blue.
        labels : path, mapping or LabelTable, optional
            Names and colours of labels: a colour table of FreeSurfer, a description of labels of ITK-SNAP, a ``.tsv``
            of BIDS, a GIFTI file, or a dict such as ``{17: ("hippocampus", "yellow")}``. With it numbers are labels.
        modulate : image, optional
            Brightness of direction-coded colours, such as FA; any type that ``source`` may have, on any grid.
        vectors : {"scanner", "fsl"}, default: "scanner"
            Axes of the vectors of ``kind="direction"``: right, front and up, or FSL's axes (V1 of ``dtifit``,
            ``dyads`` of ``bedpostx``), which are the image's, x reversed if the affine's determinant is above 0.

        Returns
        -------
        SliceStack
            ``position``, ``layers`` and ``planes`` are live; ``remove()`` takes all away.

        Raises
        ------
        FileNotFoundError
            If there is no such file.
        TypeError
            If ``source`` is of an unknown kind.
        ValueError
            If an argument has no meaning, or a file is damaged.

        Examples
        --------
        >>> import numpy as np
        >>> import pyvista as pv
        >>> x, y, z = np.mgrid[:40, :50, :45]
        >>> ball = np.exp(-((x - 20) ** 2 + (y - 25) ** 2 + (z - 22) ** 2) / 200.0)
        >>> pl = pv.Plotter(off_screen=True)
        >>> slices = pl.add_slices(ball, clim=(0, 1))
        >>> hot = slices.add(ball, cmap="hot", below=0.7, opacity=0.5)
        >>> slices.position = 20, 25, 30
        >>> round(slices.values()["image"], 3)
        0.726
        """
        from pvfiblets.plotting.slices.stack import SliceStack

        stack = SliceStack("slices", planes, axes)
        stack.put(source, settings, kind=kind, labels=labels, modulate=modulate, vectors=vectors)
        if position is not None:
            stack.position = position
        return stack

    def workspace(
        self,
        source: Source,
        *,
        thickness: float = 3.0,
        convention: str = "radiological",
        layout: str = "grid",
        cross_hair_color: Any = "#ffd040",
        **arguments: Any,
    ) -> Workspace:
        """Show axial, coronal and sagittal panes and the 3-D view, linked by a cross-hair.

        The plotter must have four views, as ``pv.Plotter(shape=(2, 2))`` has: the first three become panes, the fourth
        is the 3-D view, which later ``add_...`` calls add to, and a fifth is for an oblique slice
        (``workspace.add_oblique``). Streamlines of the 3-D view are shown in each pane as far
        as they lie in the slab about its slice; they are neither copied nor decoded for that.

        Parameters
        ----------
        source : image
            As of ``plotter.add_slices``.
        thickness : float, default: 3.0
            Of the slabs, mm.
        convention : {"radiological", "neurological"}, default: "radiological"
            Whether the patient's right is on the left or the right of the window.
        layout : {"grid", "row", "beside", "3d", "axial", "coronal", "sagittal"}, default: "grid"
            Which views are shown, and where.
        cross_hair_color : color-like
            Of cross-hair and letters.
        **arguments
            Of ``plotter.add_slices``.

        Returns
        -------
        Workspace
            ``position``, ``voxel``, ``values()``, ``slices`` and more are live.

        Raises
        ------
        ValueError
            If the plotter has fewer than four views, or as for ``plotter.add_slices``.

        Examples
        --------
        >>> import numpy as np
        >>> import pyvista as pv
        >>> pl = pv.Plotter(off_screen=True, shape=(2, 2))
        >>> workspace = pl.slices.workspace(np.random.default_rng(0).random((20, 20, 20)))
        >>> workspace.voxel = 3, 4, 5
        >>> workspace.position.tolist()
        [3.0, 4.0, 5.0]
        """
        from pvfiblets.plotting.slices.workspace import Workspace

        views = list(self._plotter.renderers)
        if len(views) < 4:
            raise ValueError(f"the plotter has {len(views)} view(s); make it by pv.Plotter(shape=(2, 2))")
        names = ("axial", "coronal", "sagittal", "3d")
        for spare in views[4:5]:
            spare.SetDraw(False)
            spare.SetInteractive(False)
        self._plotter.renderers.set_active_renderer(*self._plotter.renderers.index_to_loc(3))
        render = bool(arguments.pop("render", True))
        stack = self.add(source, render=False, **arguments)
        try:
            workspace = Workspace(
                self._plotter,
                stack,
                dict(zip(names, views, strict=False)),
                thickness=thickness,
                convention=convention,
                layout=layout,
                color=cross_hair_color,
            )
        except Exception:
            stack.remove()
            raise
        self._workspaces = [*(one for one in self._workspaces if not one.removed), workspace]
        if render:
            self._plotter.render()
        return workspace

    def add_oblique(
        self,
        slices: SliceStack | None = None,
        normal: Any = (0.0, -0.5, 1.0),
        *,
        name: str = "oblique",
        widget: bool = True,
        **widget_options: Any,
    ) -> SlicePlane:
        """Add a slice at any angle, and a widget that turns and moves it.

        Parameters
        ----------
        slices : SliceStack, optional
            Of which images; of the slices that were added last by default.
        normal : (3,) array, default: (0, -0.5, 1)
            Normal of the slice.
        name : str, default: "oblique"
            Of the plane: ``slices[name]``.
        widget : bool, default: True
            Whether it can be dragged.
        **widget_options
            Of :meth:`pyvista.Plotter.add_plane_widget`.

        Returns
        -------
        SlicePlane
            ``normal`` and ``origin`` are live.

        Raises
        ------
        ValueError
            If there are no slices, or the name is taken.
        """
        if slices is None:
            if not self._stacks:
                raise ValueError("there are no slices yet; add some by plotter.add_slices(...)")
            slices = self._stacks[-1]
        if name in slices.planes:
            raise ValueError(f"name is {name!r}, which another plane has; there are: {', '.join(slices.planes)}")
        plane = slices.new_plane(name, normal)
        self._plotter.add_actor(plane.actor, name=f"{slices.name} {name}", reset_camera=False, render=False)
        plane.enter(self._plotter.renderer)
        slices.show_glyphs_on_plane(plane)
        if widget:

            def moved(normal: Any, origin: Any) -> None:
                plane.normal, plane.origin = normal, origin

            corners = slices.layers[0].image.corners
            bounds = np.stack([corners.min(axis=0), corners.max(axis=0)], axis=1).ravel()
            options = {"interaction_event": "always", "outline_translation": False, **widget_options}
            self._plotter.add_plane_widget(
                moved, normal=tuple(plane.normal), origin=tuple(slices.position), bounds=tuple(bounds), **options
            )
        return plane

    # Life cycle ---------------------------------------------------------------------------------

    def _enter(self, stack: SliceStack, pickable: bool, reset_camera: bool | None) -> None:
        if reset_camera is None and self._plotter.camera_set:
            reset_camera = False
        renderer = self._plotter.renderer
        for plane in stack:
            self._plotter.add_actor(
                plane.actor, name=f"{stack.name} {plane.name}", pickable=pickable, reset_camera=False, render=False
            )
            plane.enter(renderer)
        if reset_camera or (reset_camera is None and not self._plotter.camera_set):
            self._plotter.reset_camera(render=False)
        self._stacks.append(stack)
        stack.removed_by(self._remove)
        address = renderer.GetAddressAsString("")
        if address not in self._followed:
            # `Renderer.remove_actor` and `clear` end in Modified(): no other sign is given.
            self._followed[address] = renderer, renderer.AddObserver("ModifiedEvent", self._forget_removed)

    def _forget_removed(self, *_: Any) -> None:
        """Forget slices that are in no renderer any more."""
        if partly_shown:
            return
        for stack in self:
            shown = [plane for plane in stack if plane.renderer is not None]
            if shown and not any(plane.renderer.HasViewProp(plane.actor) for plane in shown):
                stack.remove()

    def _show_bar(self, stack: SliceStack, arguments: dict[str, Any]) -> None:
        """Add a scalar bar of the first layer, which follows it."""
        table = pv.LookupTable()
        known, title = weakref.ref(stack), arguments.get("title", stack.layers[0].name)

        def follow() -> None:
            alive = known()
            if alive is not None and alive.layers:
                layer = alive.layers[0]
                table.log_scale = False
                table.values = layer.table()
                table.scalar_range = layer.window
                table.log_scale = bool(layer.log_scale)

        follow()
        self._plotter.add_scalar_bar(render=False, lookup_table=table, **{**arguments, "title": title})
        self._bars[id(stack)] = title
        stack.watch(follow)

    def _remove(self, stack: SliceStack) -> None:
        if stack in self._stacks:
            self._stacks.remove(stack)
        title = self._bars.pop(id(stack), None)
        if title is not None and title in self._plotter.scalar_bars:
            self._plotter.remove_scalar_bar(title, render=False)
        for plane in stack:
            plane.leave()
            self._plotter.remove_actor(plane.actor, reset_camera=False, render=False)

    def __plotter_close__(self) -> None:
        """Forget all; PyVista calls this before the render window goes."""
        for renderer, tag in self._followed.values():
            renderer.RemoveObserver(tag)
        self._followed.clear()
        while self._workspaces:
            self._workspaces.pop().stop()
        for stack in self:
            stack.removed_by(None)
            for plane in stack:
                plane.leave()
        self._stacks.clear()


document(SlicesComponent)
AddSlices = plotter_method(SlicesComponent)
