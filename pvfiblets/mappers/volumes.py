"""`VolumeMapper`: a volume that rays are cast through, as geometry of an ordinary VTK actor.

The engine (`pvfiblets.engine.volumes`) puts into its G-buffer what each pixel's ray meets. A surface is drawn by VTK
among its opaque actors, with its lights on the surface's normals. Light and peaks are drawn in its translucent pass,
when all that is opaque is there, so that rays end at it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.engine.gbuffer import EMPTY
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.line_tubes import SurfaceNormals
from pvfiblets.mappers.effects.volume_lamps import OwnLight, shading_of
from pvfiblets.mappers.engine_mapper import CutMapper
from pvfiblets.mappers.engine_options import Options
from pvfiblets.mappers.frames.scene import in_motion, others_opaque
from pvfiblets.mappers.frames.windows import Slot, WindowContext
from pvfiblets.mappers.picking import PixelHit, nearest_pixel

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.engine.effects.picture import SeenThrough
    from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
    from pvfiblets.volumes import RaycastVolume
    from pvfiblets.volumes.interactive_quality import InteractiveQuality
    from pvfiblets.volumes.raycast_options import RaycastOptions

_LIGHT = "light"  # what the engine has in the place of a number at every point


def volume_renderer(ctx: moderngl.Context, volume: Any, **options: Any) -> VolumeRenderer:
    """Make the engine's renderer of a volume; the default ``renderer_factory``."""
    from pvfiblets.engine.volumes import VolumeRenderer

    return VolumeRenderer(ctx, volume, **options)


@dataclass(frozen=True, eq=False)
class RayHit:
    """The appearance of a volume in a pixel."""

    voxel: tuple[int, int, int]  # The nearest voxel
    # ``(3,)`` float64 mm, in the data's coordinates: where the ray meets the surface, where its first light comes
    # from, or where its peak is
    position: npt.NDArray[np.float64]
    value: float  # Of the surface or the peak; of light that of the voxel


class VolumeMapper(CutMapper[Options]):
    """Mapper that draws a `RaycastVolume` through VTK's own lights, passes, clipping planes and selection.

    Rays of light and peaks end at whatever is opaque in the scene, in whichever order it was added, in each pixel at
    the farthest of its samples. Where a render pass keeps no depth that can be read, they run through it, and all of
    the volume's light lies over what its first part is in front of.

    Exceptions while drawing wait for `raise_pending`; GL objects are given back as `EngineMapper` says.

    Source: Lesar, "Real-time ray casting of volumetric data" (2015), section III.
    """

    _NAME = "VolumeMapper"

    COPIED = (*CutMapper.COPIED, "_casting", "_taken", "coarser", "shaded", "lit_surfaces")

    def __init__(
        self,
        # What to draw. Without it, the image that ``SetInputConnection`` or ``SetInputData`` connects.
        volume: RaycastVolume | None = None,
        # Options of the rays; by default the greatest value on each ray (``'mip'``) of connected data
        casting: RaycastOptions | None = None,
        *,
        # Of surfaces and peaks: ``'solid'``, or ``'point_scalar'`` of any source, with the values of the volume. By
        # default white, and peaks of connected data by look-up table and scalar range of ``vtkMapper``, surfaces in
        # the colour of the actor's property. Light has the colours of its transfer function.
        colouring: Colouring | None = None,
        # Takes a moderngl context and the volume; returns a renderer as of `pvfiblets.engine.volumes`
        renderer_factory: Callable[..., Any] = volume_renderer,
    ) -> None:
        if casting is None:
            if volume is not None:
                raise TypeError("VolumeMapper has a volume but no casting; give RaycastOptions, such as mode 'mip'")
            from pvfiblets.volumes.raycast_options import RaycastOptions

            casting = RaycastOptions("mip")
        self._casting = casting
        self._taken: tuple[Any, ...] = (0, None)
        # How rays are cast instead while an interactor moves the camera. Takes effect with the next frame.
        self.coarser: InteractiveQuality | None = None
        # Whether lights shine on light through the volume, and on translucent surfaces, if `casting` has several.
        self.shaded, self.lit_surfaces = False, True
        usual = _plain(casting) if volume is not None else None
        super().__init__(volume, colouring=usual, options=Options(), renderer_factory=renderer_factory)
        follows = self._follows and colouring is None
        self.show(casting, colouring)
        self._follows = follows

    def SetInputData(self, image: Any) -> None:  # noqa: N802 - VTK's name
        """Connect a ``vtkImageData``, which ``vtkPolyDataMapper`` would refuse."""
        self.SetInputDataObject(0, image)

    def _input_state(self, data: Any) -> tuple[Any, ...]:
        return self._casting, *super()._input_state(data)

    def _made_of(self, data: Any) -> tuple[Any, Colouring]:
        from pvfiblets.mappers.vtk_pipeline.vtk_scalars import paint_of
        from pvfiblets.volumes import as_raycast_volume

        if self._taken[0] != data.GetMTime():
            self._taken = data.GetMTime(), as_raycast_volume(data)
        volume = self._taken[1]
        if not self._follows:
            return volume, self._colouring
        from pvfiblets.volumes.raycast_options import PROJECTIONS

        peaks = self._casting.mode in PROJECTIONS
        paint = paint_of(self, data) if peaks else None
        if paint is not None and paint.numbers is not None:
            return volume, paint.mapped(volume.name)
        solid = Colouring("solid", color=self._property_color())
        return volume, _plain(self._casting) if self._casting.coloured else solid

    @property
    def volume(self) -> RaycastVolume:
        """The drawn volume."""
        volume: RaycastVolume = self._drawn
        return volume

    def set_volume(self, volume: RaycastVolume) -> None:
        """Draw another volume from the next frame on."""
        self._put(volume)
        self._link.modified()

    @property
    def casting(self) -> RaycastOptions:
        """Options of ray casting; set another `RaycastOptions` to change them; the colours stay as far as they can."""
        return self._casting

    @casting.setter
    def casting(self, casting: RaycastOptions) -> None:
        same, follows = casting.coloured == self._casting.coloured, self._follows
        self.show(casting, self._colouring if same else None)
        self._follows = follows
        if follows and self._connection.input is not None:
            self._connection.input.Modified()

    def show(self, casting: RaycastOptions, colouring: Colouring | None = None) -> None:
        """Change both from the next frame on. Without colours the volume is white; of light it has none."""
        colouring = _plain(casting) if colouring is None else colouring
        _check(casting, colouring)
        self._casting = casting
        CutMapper.colouring.fset(self, colouring)  # type: ignore[attr-defined]  # installs, and tells the actor
        surface = casting.mode == "isosurface" and not casting.layered
        if surface != ("normals" in self._effects):
            self.set_effect("normals", SurfaceNormals() if surface else None)
        light = casting.coloured
        if light != ("own light" in self._effects):
            self.set_effect("own light", OwnLight() if light else None)

    @property
    def colouring(self) -> Colouring:
        """Source of the colours of surfaces and peaks."""
        return self._colouring

    @colouring.setter
    def colouring(self, colouring: Colouring) -> None:
        self.show(self._casting, colouring)

    def pick_at(self, x: float, y: float, *, renderer: vtkRenderer | None = None, tolerance: int = 0) -> RayHit | None:
        """Return what a pixel of the picture that was drawn last shows of the volume; None for nothing."""
        # x and y count from the window's lower left corner. Other actors are not looked at.
        found = nearest_pixel(self, (x, y), ("owner", "position"), renderer=renderer, tolerance=tolerance)
        if found is None:
            return None
        place = _place(found)
        voxel = self._voxel(int(found.texels["owner"][0]), place)
        light = found.shown.drawn.style.casting.mode == "composite"
        value = self.volume.values[voxel] if light else found.texels["position"][1]
        return RayHit(voxel, place, float(value) + self.volume.offset)

    def _voxel(self, owner: int, place: npt.NDArray[np.float64]) -> tuple[int, int, int]:
        """Return a pixel's voxel: by its number, or where there are more than 32 bits count the nearest to a place."""
        volume = self.volume
        if volume.n_points < EMPTY:
            at = np.array(np.unravel_index(owner, volume.shape, order="F"))
        else:
            near = volume.inverse[:3, :3] @ place + volume.inverse[:3, 3]
            at = np.clip(np.floor(near + 0.5), 0, np.array(volume.shape) - 1)
        x, y, z = at.astype(int).tolist()
        return x, y, z

    @property
    def _translucent(self) -> bool:
        return self._casting.mode != "isosurface" or self._casting.layered or super()._translucent

    def _outside(
        self, context: WindowContext, slot: Slot, renderer: vtkRenderer, viewport: tuple[int, int, int, int]
    ) -> moderngl.Texture | None:
        # What VTK selects are props, each by the nearest depth that it has: rays need not end.
        if renderer.GetSelector() is not None or self.actor is None or not others_opaque(renderer, self.actor):
            return None
        depth = slot.outside_depth(context.ctx)
        found = depth.copy(viewport, moved=True)
        return depth.copy_of_window(renderer, viewport[2:]) if found is None else found

    def _faint_light(self, buffer: Any) -> SeenThrough:
        """Light and peaks that hardly show are not looked at."""
        from pvfiblets.engine.effects.picture import FAINTEST, SeenThrough

        if self._casting.coloured:
            return SeenThrough(buffer.depth, lights=buffer.colours)
        colours = self._colouring
        if self._casting.mode == "isosurface" or colours.lut is None or colours.clim is None:
            return SeenThrough(buffer.depth)
        shown = np.flatnonzero(colours.lut[:, 3] >= FAINTEST * 255.0)
        if not shown.size:
            return SeenThrough(buffer.depth, positions=buffer.position, values=(math.inf, -math.inf))
        low, high = (end - self.volume.offset for end in colours.clim)
        ends = low + (high - low) * np.array([shown[0], shown[-1] + 1]) / len(colours.lut)
        least = -math.inf if shown[0] == 0 else float(ends[0])
        greatest = math.inf if shown[-1] == len(colours.lut) - 1 else float(ends[1])
        return SeenThrough(buffer.depth, positions=buffer.position, values=(least, greatest))

    def _style(self, renderer: vtkRenderer, pixel_scale: float) -> VolumeStyle:  # noqa: ARG002
        from pvfiblets.engine.volumes import VolumeStyle

        casting = self._casting
        if self.coarser is not None and in_motion(renderer):
            casting = self.coarser.applied_to(casting)
        shone = self.shaded if casting.mode == "composite" else casting.layered and self.lit_surfaces
        lit = shading_of(renderer, self.actor) if shone and self.actor is not None else None
        return VolumeStyle(casting=casting, shading=lit)


def _plain(casting: RaycastOptions) -> Colouring:
    """Colours without any choice."""
    if casting.coloured:
        return Colouring("point_rgba", source=_LIGHT, has_alpha=True)
    return Colouring("solid")


def _check(casting: RaycastOptions, colouring: Colouring) -> None:
    light = casting.coloured
    known = ("point_rgba",) if light else ("solid", "point_scalar")
    if colouring.mode not in known:
        instead = "light has the colours of casting.transfer: leave colouring out" if light else f"choose of {known}"
        raise ValueError(f"the colouring of mode {casting.mode!r} is {colouring.mode!r}; {instead}")


def _place(found: PixelHit) -> npt.NDArray[np.float64]:
    """Return where the depth of a pixel lies, mm."""
    view = found.shown.drawn.view
    x, y = (2.0 * (np.asarray(found.pixel) + 0.5) / view.size - 1.0).tolist()
    far = (EMPTY - found.key) / 2.0**32
    place = np.linalg.solve(view.model_view_projection, [x, y, 1.0 - 2.0 * far, 1.0])
    position: npt.NDArray[np.float64] = place[:3] / place[3]
    return position
