# Written by scripts/plotter_stub.py from the settings that are declared; do not change it by hand.

from collections.abc import Iterable, Sequence
from typing import Any, Protocol

import numpy as np
import pyvista as pv
from pyvista.core._typing_core import TransformLike
from pyvista.plotting._typing import ColorLike, ColormapOptions

from pvfiblets.codec.encoding.compress import PerPoint
from pvfiblets.halos.displacement import Displacement
from pvfiblets.plotting.colours.same_names import Preference
from pvfiblets.plotting.connectomes.component import ConnectomesComponent
from pvfiblets.plotting.connectomes.component import Labels as ConnectomesLabels, Matrix as ConnectomesMatrix
from pvfiblets.plotting.connectomes.graph import ConnectomeGraph
from pvfiblets.plotting.fiblets.actor import FibletActor
from pvfiblets.plotting.fiblets.component import FibletsComponent
from pvfiblets.plotting.fiblets.component import Source as FibletsSource
from pvfiblets.plotting.halos.actors import HaloLineActor, HaloPointActor
from pvfiblets.plotting.halos.component import HaloLinesComponent, HaloPointsComponent
from pvfiblets.plotting.halos.component import LineSource as HaloLinesSource, PointSource as HaloPointsSource
from pvfiblets.plotting.halos.settings import Threshold
from pvfiblets.plotting.picture_component import PictureComponent
from pvfiblets.plotting.slices.component import SlicesComponent
from pvfiblets.plotting.slices.component import Source as SlicesSource
from pvfiblets.plotting.slices.stack import SliceStack
from pvfiblets.plotting.tubes.actor import TubeActor
from pvfiblets.plotting.tubes.component import Source as SplineTubesSource
from pvfiblets.plotting.tubes.component import SplineTubesComponent
from pvfiblets.plotting.volumes.actor import VolumeActor
from pvfiblets.plotting.volumes.component import RaycastVolumesComponent
from pvfiblets.plotting.volumes.component import Source as RaycastVolumesSource

__all__ = ["Plotter"]

class _AddFiblets(Protocol):
    def __call__(
        self, source: FibletsSource, *, scalars: str | np.ndarray | pv.ImageData | tuple[Any, Any] | None = None,
        per_point: PerPoint | Iterable[str] = "fit", max_error: float | None = None, progress: bool = False,
        preference: Preference = "point", look: str | None = None, color: ColorLike | None = None,
        rgb: bool | None = None, cmap: ColormapOptions | pv.LookupTable | None = None,
        clim: float | Sequence[float] | None = None, n_colors: int = 256, log_scale: bool = False,
        nan_color: ColorLike | None = None, below_color: ColorLike | None = None,
        above_color: ColorLike | None = None, annotations: dict[float, str] | None = None,
        flip_scalars: bool = False, categories: bool = False,
        opacity: float | str | Sequence[float] | np.ndarray | None = None, transparency: str | int | None = "all",
        line_width: float | None = None, point_size: float | None = None, style: Any = "surface",
        lighting: bool | None = None, pipeline: str = "auto", culling: str | None = "auto", fit: str | None = None,
        cluster: Any = None, silhouette: bool | None = None, render_lines_as_tubes: bool | None = None,
        ambient: float | None = None, diffuse: float | None = None, specular: float | None = None,
        specular_power: float | None = None, metallic: float | None = None, roughness: float | None = None,
        pbr: bool = False, smooth_shading: bool | None = None, component: int | None = None,
        nan_opacity: float | None = None, copy_mesh: bool = False, name: str | None = None, label: str | None = None,
        show_scalar_bar: bool | None = None, scalar_bar_args: dict[str, Any] | None = None, pickable: bool = True,
        user_matrix: TransformLike | None = None, reset_camera: bool | None = None, render: bool = True,
        **options: Any,
    ) -> FibletActor: ...

class _FibletsComponent(FibletsComponent):
    @property
    def add(self) -> _AddFiblets: ...

class _AddSplineTubes(Protocol):
    def __call__(
        self, source: SplineTubesSource, *, radius: float | str | np.ndarray | None = None,
        scalars: str | np.ndarray | None = None, tangents: str | np.ndarray | None = None, method: str = "finite",
        radius_slopes: float | str | np.ndarray | None = None, scalar_slopes: str | np.ndarray | None = None,
        scaled: bool | None = None, rgb: bool | None = None, preference: Preference = "point",
        color: ColorLike | None = None, cmap: ColormapOptions | pv.LookupTable | None = None,
        clim: float | Sequence[float] | None = None, n_colors: int = 256, log_scale: bool = False,
        nan_color: ColorLike | None = None, below_color: ColorLike | None = None,
        above_color: ColorLike | None = None, annotations: dict[float, str] | None = None,
        flip_scalars: bool = False, opacity: float | str | Sequence[float] | np.ndarray | None = None,
        lighting: bool | None = None, min_width: float = 1.0, silhouettes: str = "auto", solver: str = "auto",
        iterations: int | None = None, culling: str | None = "two-phase", silhouette: bool | None = None,
        render_lines_as_tubes: bool | None = None, ambient: float | None = None, diffuse: float | None = None,
        specular: float | None = None, specular_power: float | None = None, metallic: float | None = None,
        roughness: float | None = None, pbr: bool = False, smooth_shading: bool | None = None,
        component: int | None = None, nan_opacity: float | None = None, copy_mesh: bool = False,
        name: str | None = None, label: str | None = None, show_scalar_bar: bool | None = None,
        scalar_bar_args: dict[str, Any] | None = None, pickable: bool = True,
        user_matrix: TransformLike | None = None, reset_camera: bool | None = None, render: bool = True,
    ) -> TubeActor: ...

class _SplineTubesComponent(SplineTubesComponent):
    @property
    def add(self) -> _AddSplineTubes: ...  # type: ignore[override]

class _AddHaloLines(Protocol):
    def __call__(
        self, source: HaloLinesSource, *, scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None, rgb: bool | None = None, preference: Preference = "point",
        line_width: float | None = None, strip_width: float | None = None, tapering: bool | tuple[int, float] = True,
        filter_taper: float | None = None, max_displacement: float | None = None,
        displacement: Displacement = "linear", width_cue: float = 0.5, threshold: Threshold = None,
        color: ColorLike | None = None, halo_color: ColorLike | None = None, light_on_dark: bool | None = None,
        cmap: ColormapOptions | pv.LookupTable | None = None, clim: float | Sequence[float] | None = None,
        n_colors: int = 256, log_scale: bool = False, nan_color: ColorLike | None = None,
        below_color: ColorLike | None = None, above_color: ColorLike | None = None,
        annotations: dict[float, str] | None = None, flip_scalars: bool = False,
        opacity: float | str | Sequence[float] | np.ndarray | None = None, lighting: bool = False,
        smooth: bool = True, min_width: float = 1.0, culling: str | None = "two-phase", ambient: float | None = None,
        diffuse: float | None = None, specular: float | None = None, specular_power: float | None = None,
        metallic: float | None = None, roughness: float | None = None, pbr: bool = False,
        smooth_shading: bool | None = None, component: int | None = None, nan_opacity: float | None = None,
        copy_mesh: bool = False, name: str | None = None, label: str | None = None,
        show_scalar_bar: bool | None = None, scalar_bar_args: dict[str, Any] | None = None, pickable: bool = True,
        user_matrix: TransformLike | None = None, reset_camera: bool | None = None, render: bool = True,
    ) -> HaloLineActor: ...

class _HaloLinesComponent(HaloLinesComponent):
    @property
    def add(self) -> _AddHaloLines: ...  # type: ignore[override]

class _AddHaloPoints(Protocol):
    def __call__(
        self, source: HaloPointsSource, *, scalars: str | np.ndarray | None = None,
        filter_by: str | np.ndarray | None = None, rgb: bool | None = None, point_size: float | None = None,
        halo_size: float | None = None, max_displacement: float | None = None, displacement: Displacement = "linear",
        width_cue: float = 0.5, threshold: Threshold = None, color: ColorLike | None = None,
        halo_color: ColorLike | None = None, light_on_dark: bool | None = None,
        cmap: ColormapOptions | pv.LookupTable | None = None, clim: float | Sequence[float] | None = None,
        n_colors: int = 256, log_scale: bool = False, nan_color: ColorLike | None = None,
        below_color: ColorLike | None = None, above_color: ColorLike | None = None,
        annotations: dict[float, str] | None = None, flip_scalars: bool = False,
        opacity: float | str | Sequence[float] | np.ndarray | None = None, lighting: bool = False,
        smooth: bool = True, min_width: float = 1.0, culling: str | None = "two-phase", name: str | None = None,
        label: str | None = None, show_scalar_bar: bool | None = None, scalar_bar_args: dict[str, Any] | None = None,
        pickable: bool = True, user_matrix: TransformLike | None = None, reset_camera: bool | None = None,
        render: bool = True,
    ) -> HaloPointActor: ...

class _HaloPointsComponent(HaloPointsComponent):
    @property
    def add(self) -> _AddHaloPoints: ...  # type: ignore[override]

class _AddRaycastVolume(Protocol):
    def __call__(
        self, source: RaycastVolumesSource, *, scalars: str | np.ndarray | None = None, spacing: Any = None,
        origin: Any = None, direction: Any = None, affine: Any = None, shape: Any = None, dtype: Any = None,
        blending: str | None = None, resolution: Any = None, multi_colors: bool = False,
        categories: bool | int = False, preference: str | None = None, mode: str = "composite",
        values: float | Any = None, surface_opacities: float | Any = None,
        surface_colors: Sequence[ColorLike] | None = None, closed: bool = False, color: ColorLike | None = None,
        cmap: ColormapOptions | pv.LookupTable | None = None, clim: float | Sequence[float] | None = None,
        n_colors: int = 256, log_scale: bool = False, annotations: dict[float, str] | None = None,
        flip_scalars: bool = False, opacity: float | str | Sequence[float] | np.ndarray = "linear",
        opacity_unit_distance: float | None = None, thresholds: Any = None, peak: float | None = None,
        smooth: float | Any = None, step: float = 0.5, filter: str = "trilinear", refine: str = "exact",
        iterations: int = 5, integrator: str = "adaptive", jitter: bool = False, octree: bool = True,
        homogeneous: float = 0.0, recon: bool = True, sparse: int = 1, sparse_threshold: float = 0.05,
        stop: float = 0.999, interactive_quality: float | dict[str, Any] = 0.5, box: Any = None,
        lighting: bool | None = None, shade: bool = False, ambient: float | None = None,
        diffuse: float | None = None, specular: float | None = None, specular_power: float | None = None,
        ray_occlusion: bool | dict[str, Any] = False, name: str | None = None, label: str | None = None,
        show_scalar_bar: bool | None = None, scalar_bar_args: dict[str, Any] | None = None, pickable: bool = True,
        user_matrix: TransformLike | None = None, reset_camera: bool | None = None, render: bool = True,
    ) -> VolumeActor: ...

class _RaycastVolumesComponent(RaycastVolumesComponent):
    @property
    def add(self) -> _AddRaycastVolume: ...  # type: ignore[override]

class _AddSlices(Protocol):
    def __call__(
        self, source: SlicesSource, *, position: Any = None,
        planes: str | Iterable[str] = ('axial', 'coronal', 'sagittal'), axes: str | np.ndarray = "world",
        kind: str | None = None, labels: Any = None, modulate: Any = None, vectors: str = "scanner",
        cmap: ColormapOptions | pv.LookupTable = "gray", clim: float | Sequence[float] | None = None,
        percentiles: tuple[float, float] = (1.0, 99.0), log_scale: bool = False, below: float | None = None,
        above: float | None = None, outside: float | None = None, opacity: float = 1.0, blend: str = "over",
        interpolation: str = "linear", index: int = 0, outline: bool = False, visible: bool = True,
        name: str | None = None, pickable: bool = True, show_scalar_bar: bool = False,
        scalar_bar_args: dict[str, Any] | None = None, user_matrix: TransformLike | None = None,
        reset_camera: bool | None = None, render: bool = True,
    ) -> SliceStack: ...

class _SlicesComponent(SlicesComponent):
    @property
    def add(self) -> _AddSlices: ...  # type: ignore[override]

class _AddConnectome(Protocol):
    def __call__(
        self, matrix: ConnectomesMatrix, labels: ConnectomesLabels, *, nodes: str | None = "spheres",
        edges: str | None = "tubes", threshold: float = 0.0, names: Any = None, streamlines: Any = None,
        radius: float | None = None, node_radius: float | np.ndarray | None = None,
        cmap: ColormapOptions | pv.LookupTable | None = None, clim: float | Sequence[float] | None = None,
        n_colors: int = 256, log_scale: bool = False,
        opacity: float | str | Sequence[float] | np.ndarray | None = None, name: str | None = None,
        show_scalar_bar: bool | None = None, scalar_bar_args: dict[str, Any] | None = None, pickable: bool = True,
        user_matrix: TransformLike | None = None, reset_camera: bool | None = None, render: bool = True,
    ) -> ConnectomeGraph: ...

class _ConnectomesComponent(ConnectomesComponent):
    @property
    def add(self) -> _AddConnectome: ...  # type: ignore[override]

class Plotter(pv.Plotter):
    @property
    def add_fiblets(self) -> _AddFiblets: ...
    @property
    def fiblets(self) -> _FibletsComponent: ...
    @property
    def add_spline_tubes(self) -> _AddSplineTubes: ...
    @property
    def spline_tubes(self) -> _SplineTubesComponent: ...
    @property
    def add_halo_lines(self) -> _AddHaloLines: ...
    @property
    def halo_lines(self) -> _HaloLinesComponent: ...
    @property
    def add_halo_points(self) -> _AddHaloPoints: ...
    @property
    def halo_points(self) -> _HaloPointsComponent: ...
    @property
    def add_raycast_volume(self) -> _AddRaycastVolume: ...
    @property
    def raycast_volumes(self) -> _RaycastVolumesComponent: ...
    @property
    def add_slices(self) -> _AddSlices: ...
    @property
    def slices(self) -> _SlicesComponent: ...
    @property
    def add_connectome(self) -> _AddConnectome: ...
    @property
    def connectomes(self) -> _ConnectomesComponent: ...
    @property
    def picture(self) -> PictureComponent: ...
