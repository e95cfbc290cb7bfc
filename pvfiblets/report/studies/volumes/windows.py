"""Volumes in PyVista windows: this program beside VTK's GPU mapper, by steps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from pvfiblets.synthetic.vessels import brain_like, vessel_tree
from pvfiblets.volumes import RaycastVolume

from ...cameras import Camera, by_turns
from ...record import Figure, Record
from ...study import Options
from ...timing import Comparison
from ...window import Window
from .scene import Look, circle, look_of, truth

if TYPE_CHECKING:
    import pyvista as pv

STEPS, QUICK_STEPS = (2.0, 1.0, 0.5, 0.25, 0.125, 0.0625), (1.0, 0.5)  # voxels; 0.5 is the default
SIDES, QUICK_SIDES = (64, 256), (48,)  # voxels along each side
SIZE, QUICK_SIZE = 512, 96
FRAMES = 3
PIXELS, QUICK_PIXELS = 3000, 500
PATIENCE = 3.0  # seconds a frame, beyond which no shorter steps are tried
MODES = ("composite", "mip", "isosurface")


class CastWindow(Window):
    """Ray-cast volumes of this program."""

    method, ours, lamp = "pvfiblets", True, 0

    def __init__(self, volume: RaycastVolume, look: Look, size: tuple[int, int]) -> None:
        super().__init__(size, headlight=True)
        self.actor = _added(self.plotter, volume, look)
        self.show()

    def step(self, voxels: float) -> None:
        """Set the length of steps."""
        self.actor.step = voxels

    @property
    def costs(self) -> dict[str, Figure]:
        """Bytes on the GPU, and the share of the octree's leaves that rays skip."""
        found = self.actor.explain()
        return {"memory": Figure(found["gpu_bytes"] / 1e6, "MB"), "cast": Figure(1.0 - found["skipped"], "of leaves")}


class VTKWindow(Window):
    """VTK's GPU mapper."""

    method, ours, lamp = "VTK's GPU mapper", False, 1

    def __init__(self, volume: RaycastVolume, look: Look, size: tuple[int, int]) -> None:
        super().__init__(size, headlight=True)
        self._spacing = float(volume.spacing.mean())
        added = self.plotter.add_volume(
            _image(volume), mapper="gpu", clim=look.clim, cmap="gray", shade=look.mode == "isosurface", ambient=0.0,
            diffuse=1.0, specular=0.0, opacity_unit_distance=look.transfer.unit, show_scalar_bar=False,
        )  # fmt: skip
        self._mapper = added.mapper
        {"composite": self._mapper.SetBlendModeToComposite, "mip": self._mapper.SetBlendModeToMaximumIntensity,
         "isosurface": self._mapper.SetBlendModeToIsoSurface}[look.mode]()  # fmt: skip
        self._mapper.SetAutoAdjustSampleDistances(0)
        _transfer_to(added.prop, look)
        self.show()

    def step(self, voxels: float) -> None:
        """Set the length of steps."""
        self._mapper.SetSampleDistance(voxels * self._spacing)

    @property
    def costs(self) -> dict[str, Figure]:
        """Return nothing: VTK does not say."""
        return {}


WINDOWS: tuple[type[CastWindow | VTKWindow], ...] = (CastWindow, VTKWindow)


def beside_vtk(options: Options) -> Iterator[Record]:
    """Yield records of volumes in windows, by this program and by VTK, at each length of steps."""
    side, sides = (QUICK_SIZE, QUICK_SIDES) if options.quick else (SIZE, SIDES)
    makers: list[tuple[str, Callable[[int, int, str], RaycastVolume], int]]
    makers = [("vessels", vessel_tree, n) for n in sides] + ([] if options.quick else [("head", brain_like, 192)])
    cases = [(name, make, n, mode) for name, make, n in makers for mode in MODES]
    for number, (name, make, n, mode) in enumerate(cases):
        part = options.share(1.0 / (len(cases) - number))
        data = f"{n}³ {name}, {mode}, in a window"
        if not part.lasts(data):
            continue
        yield from _measured(make(n, options.seed, "uint16"), mode, data, side, part)


def _measured(
    volume: RaycastVolume, mode: str, data: str, side: int, options: Options
) -> Iterator[Record]:
    look, cameras = look_of(volume, mode), circle(volume, 1 if options.quick else FRAMES, (side, side))
    # The reference takes floats; else it would convert the voxels for every camera.
    floats = RaycastVolume(np.ascontiguousarray(volume.values, np.float32), volume.affine)
    right = truth(floats, look, cameras, QUICK_PIXELS if options.quick else PIXELS)
    made: list[CastWindow | VTKWindow] = []
    timed: Comparison | None = None
    options.budget = options.budget.share()  # the reference is no measurement
    try:
        for kind in WINDOWS:
            window = kind(volume, look, (side, side))
            made.append(window)
            timed = timed or Comparison(data, options, window.turns, len(cameras))
            taken = 0.0
            for step in QUICK_STEPS if options.quick else STEPS:
                if not timed.allows(f"{kind.method}, step {step:g}"):
                    continue
                if taken > PATIENCE:
                    timed.refuse(f"{kind.method}, step {step:g}", f"longer steps take more than {PATIENCE:g} s a frame")
                    continue
                window.step(step)
                begun, shown = window.clock(), []
                for camera in cameras:
                    window.draw(camera)
                    shown.append(window.colours())
                taken = (window.clock() - begun) / len(cameras)
                record = Record(
                    data=data,
                    group="windows",
                    approximation="a picture of a volume",
                    method=kind.method,
                    setting=f"{step:g} voxels",
                    errors={"colour rms": Figure(right.error(shown, kind.lamp), "of 1")},
                    costs=window.costs,
                    ours=kind.ours,
                    default=kind.ours and step == 0.5,
                )
                timed.add(record, draw=_drawing(window, step, cameras))
        if timed is not None:
            yield from timed.finish()
    finally:
        for window in made:
            window.release()


def _drawing(window: CastWindow | VTKWindow, step: float, cameras: list[Camera]) -> Callable[[], None]:
    drawn = by_turns(window.draw, cameras)

    def draw() -> None:
        window.step(step)
        drawn()

    return draw


def _added(plotter: pv.BasePlotter, volume: RaycastVolume, look: Look) -> Any:
    """Add a volume as the study looks at it; refuse to show another transfer function than it asks for."""
    from matplotlib.colors import ListedColormap

    common = {"mode": look.mode, "clim": look.clim, "show_scalar_bar": False}
    if look.mode == "isosurface":
        actor = plotter.add_raycast_volume(volume, values=look.value, color="white", **common)
        actor.prop.ambient, actor.prop.diffuse, actor.prop.specular = 0.0, 1.0, 0.0
        return actor
    if look.mode == "mip":
        return plotter.add_raycast_volume(volume, cmap="gray", opacity=1.0, **common)
    table = look.transfer.table
    actor = plotter.add_raycast_volume(
        volume, cmap=ListedColormap(table[:, :3]), n_colors=len(table), opacity=table[:, 3],
        opacity_unit_distance=look.transfer.unit, **common,
    )  # fmt: skip
    shown = actor.casting.transfer
    if not np.allclose(shown.table, table, atol=1e-6) or shown.clim != look.transfer.clim:
        raise RuntimeError("the plotter shows light of another transfer function than it was given")
    return actor


def _image(volume: RaycastVolume) -> Any:
    """Return a volume as PyVista's image, which shares its numbers."""
    import pyvista as pv

    made = pv.ImageData(dimensions=volume.shape, spacing=volume.spacing, origin=volume.affine[:3, 3])
    made.direction_matrix = volume.affine[:3, :3] / volume.spacing
    made.point_data["values"] = volume.values.ravel(order="F")
    return made


def _transfer_to(prop: Any, look: Look) -> None:
    """Give VTK's property of a volume colours and opacities."""
    from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
    from vtkmodules.vtkRenderingCore import vtkColorTransferFunction

    colours, opacities = vtkColorTransferFunction(), vtkPiecewiseFunction()
    if look.mode == "composite":
        for value, row in zip(np.linspace(*look.clim, len(look.transfer.table)), look.transfer.table, strict=True):
            colours.AddRGBPoint(value, *map(float, row[:3]))
            opacities.AddPoint(value, float(row[3]))
    else:
        first = (0.0, 0.0, 0.0) if look.mode == "mip" else (1.0, 1.0, 1.0)
        colours.AddRGBPoint(look.clim[0], *first)
        colours.AddRGBPoint(look.clim[1], 1.0, 1.0, 1.0)
        for value in look.clim:
            opacities.AddPoint(value, 1.0)
    prop.SetColor(colours)
    prop.SetScalarOpacity(opacities)
    prop.SetScalarOpacityUnitDistance(look.transfer.unit)
    prop.SetInterpolationTypeToLinear()
    if look.mode == "isosurface":
        prop.GetIsoSurfaceValues().SetValue(0, look.value)
