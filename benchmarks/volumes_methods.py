"""The methods of casting rays through volumes that the benchmark compares.

Every method shows the same (`pvfiblets.report.studies.volumes.scene`) at the same step, on black, without
anti-aliasing and without jitter. What differs is said with each method in :data:`ABOUT`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import Window
from gpu_memory import allocated

from pvfiblets.engine.gl.standalone import bare_context
from pvfiblets.report.cameras import Camera
from pvfiblets.report.studies.volumes.pictures import colours_of
from pvfiblets.report.studies.volumes.scene import Look, Truth
from pvfiblets.volumes import RaycastVolume

ABOUT = {
    "engine": "this program's ray casting on a bare context, without VTK: a G-buffer, not lit",
    "plotter": "`plotter.add_raycast_volume`: the same in a PyVista window, lit by VTK",
    "vtk-gpu": "`plotter.add_volume(mapper='gpu')`, vtkGPUVolumeRayCastMapper, at the same step",
    "vtk-gpu-equal": "the same at the step with which its picture is as wrong as the plotter's",
    "vtk-smart": "`plotter.add_volume(mapper='smart')`, vtkSmartVolumeMapper: VTK 9.7 gives its GPU mapper a step of "
    "its own, whatever sample distance is asked for",
}
EQUAL = "vtk-gpu-equal"


class Method:
    """What methods share.

    Parameters
    ----------
    name : str
    volume : RaycastVolume
    look : Look
    step : float
        In mean spacings of voxels.
    size : tuple of int
        Of the first picture.
    """

    lamp = 0

    def draw(self, camera: Camera) -> None:
        """Draw a picture and wait for it."""
        raise NotImplementedError

    def picture(self) -> np.ndarray:
        """Return the picture drawn last: ``(height, width, 3)``, 0 to 1, row 0 at the bottom."""
        raise NotImplementedError

    def error(self, of: Truth) -> float:
        """Return by how much pictures are off."""
        pictures = []
        for camera in of.cameras:
            self.draw(camera)
            pictures.append(self.picture())
        return of.error(pictures, self.lamp)

    def facts(self) -> dict[str, Any]:
        """Return further figures."""
        return {}

    def bytes(self) -> int | None:
        """Return what the context holds beyond an empty one of the same size."""
        raise NotImplementedError

    def close(self) -> None:
        """Give all back."""
        raise NotImplementedError


class Engine(Method):
    """The engine on a bare context."""

    def __init__(self, _: str, volume: RaycastVolume, look: Look, step: float, __: tuple[int, int]) -> None:
        from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle

        self.ctx, self.look, self.volume = bare_context(), look, volume
        self.before = allocated()
        self.renderer = VolumeRenderer(self.ctx, volume)
        self.style = VolumeStyle(casting=look.casting(step=step))

    def draw(self, camera: Camera) -> None:
        """Cast rays and wait for them."""
        from pvfiblets.engine import View

        self.camera = camera
        self.gbuffer = self.renderer.render(View(camera.size, camera.model_view_projection), self.style)
        self.ctx.finish()

    def picture(self) -> np.ndarray:
        """Return what the G-buffer means."""
        return colours_of(self.gbuffer, self.look, self.camera)

    def facts(self) -> dict[str, Any]:
        """Return the engine's figures."""
        return octree_facts(self.renderer.explain(), self.volume)

    def bytes(self) -> int | None:
        """Return what has come since the context was empty."""
        now = allocated()
        return None if now is None or self.before is None else now - self.before

    def close(self) -> None:
        """Give all back, the context included."""
        self.renderer.release()
        self.ctx.release()


class _Window(Window, Method):
    """A PyVista window, of any size."""

    def __init__(self, size: tuple[int, int]) -> None:
        super().__init__(size)
        self.drawn: list[Camera] = []  # the first of each size

    def draw(self, camera: Camera) -> None:
        if not self.drawn or self.drawn[-1].size != camera.size:
            self.plotter.window_size = list(camera.size)
            self.drawn.append(camera)
        super().draw(camera)

    def picture(self) -> np.ndarray:
        return np.asarray(self.plotter.screenshot(None))[::-1, :, :3] / 255.0

    def bytes(self) -> int | None:
        self.plotter.render_window.MakeCurrent()
        now = allocated()
        empty = _Window(self.drawn[0].size)
        empty.plotter.show(auto_close=False)
        for camera in self.drawn:
            empty.draw(camera)
        empty.plotter.render_window.MakeCurrent()
        before = allocated()
        empty.close()
        return None if now is None or before is None else now - before


class Plotter(_Window):
    """Ray-cast volumes of this program in a PyVista window."""

    def __init__(self, _: str, volume: RaycastVolume, look: Look, step: float, size: tuple[int, int]) -> None:
        super().__init__(size)
        self.volume = volume
        self.actor = added(self.plotter, volume, look, step=step)
        self.plotter.show(auto_close=False)

    def facts(self) -> dict[str, Any]:
        """Return the actor's figures."""
        return octree_facts(self.actor.explain(), self.volume)


class VTK(_Window):
    """VTK's own mappers."""

    lamp = 1

    def __init__(self, name: str, volume: RaycastVolume, look: Look, step: float, size: tuple[int, int]) -> None:
        super().__init__(size)
        self.spacing = float(volume.spacing.mean())
        surface = look.mode == "isosurface"
        self.volume = self.plotter.add_volume(
            image(volume), mapper="smart" if name == "vtk-smart" else "gpu", clim=look.clim, cmap="gray",
            shade=surface, ambient=0.0, diffuse=1.0, specular=0.0, opacity_unit_distance=look.transfer.unit,
            show_scalar_bar=False,
        )  # fmt: skip
        self.mapper = self.volume.mapper
        {"composite": self.mapper.SetBlendModeToComposite, "mip": self.mapper.SetBlendModeToMaximumIntensity,
         "isosurface": self.mapper.SetBlendModeToIsoSurface}[look.mode]()  # fmt: skip
        self.mapper.SetAutoAdjustSampleDistances(0)
        transfer_to(self.volume.prop, look)
        self.step(step)
        self.plotter.show(auto_close=False)

    def step(self, voxels: float) -> None:
        """Have steps of another length."""
        self.mapper.SetSampleDistance(voxels * self.spacing)


METHODS = {"engine": Engine, "plotter": Plotter, "vtk-gpu": VTK, "vtk-smart": VTK}


def added(plotter: Any, volume: RaycastVolume, look: Look, **more: Any) -> Any:
    """Add a volume to a plotter as this program has it, and return the actor.

    Raises
    ------
    RuntimeError
        If the light that the plotter makes of the table is not that of the table.
    """
    from matplotlib.colors import ListedColormap

    common = {"mode": look.mode, "clim": look.clim, "show_scalar_bar": False, **more}
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


def image(volume: RaycastVolume) -> Any:
    """Return a volume as PyVista's image, which shares its numbers."""
    import pyvista as pv

    made = pv.ImageData(dimensions=volume.shape, spacing=volume.spacing, origin=volume.affine[:3, 3])
    made.direction_matrix = volume.affine[:3, :3] / volume.spacing
    made.point_data["values"] = volume.values.ravel(order="F")
    return made


def transfer_to(prop: Any, look: Look) -> None:
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


def octree_facts(report: dict[str, Any], volume: RaycastVolume) -> dict[str, Any]:
    """Return an engine's figures of its octree and its passes."""
    nodes = sum(buffer["bytes"] for buffer in report["buffers"] if buffer["name"] in ("nodes", "means"))
    return {"skipped": report["skipped"], "octree_share": nodes / volume.nbytes, "passes": report["passes"]}
