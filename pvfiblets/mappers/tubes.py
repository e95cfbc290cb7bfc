"""`TubeMapper`: Hermite spline tubes as geometry of an ordinary VTK actor.

The engine (`pvfiblets.engine.tubes`) finds for each pixel where its ray enters the tubes; its G-buffer holds depth,
surface normal, tube, segment and value, and the resolve that serves fiblets shows it. It has no layers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.engine.tubes import TubeStyle, check_choices
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.line_tubes import SurfaceNormals
from pvfiblets.mappers.engine_mapper import FilteredMapper
from pvfiblets.mappers.engine_options import Options
from pvfiblets.mappers.frames.scene import Frame
from pvfiblets.mappers.line_data import SIDES, STEPS, segment_ids
from pvfiblets.mappers.picking import nearest_pixel

if TYPE_CHECKING:
    import moderngl
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from pvfiblets.engine.tubes import TubeRenderer
    from pvfiblets.tubes.spline_tubes import SplineTubes


@dataclass(frozen=True)
class TubeOptions(Options):
    """Options of casting rays at spline tubes."""

    silhouettes: str = "auto"  # What covers the pixels whose rays are tried
    solver: str = "auto"  # How the first point of a tube on a ray is searched
    iterations: int | None = None  # Steps of one search at most; the solver's own number by default
    min_width: float = 1.0  # Pixels of the window that a tube takes at least, 0 to 64, however thin and far it is
    culling: str | None = "two-phase"  # How segments behind others are found out

    # It is a part of the style: another one is drawn by the same renderer.
    NOT_MADE_WITH: ClassVar[frozenset[str]] = frozenset({"min_width"})

    def _check(self) -> None:
        check_choices(self.silhouettes, self.solver, self.iterations, self.min_width, self.culling)


def tube_renderer(ctx: moderngl.Context, tubes: Any, **options: Any) -> TubeRenderer:
    """Make the engine's renderer of spline tubes; the default ``renderer_factory``."""
    from pvfiblets.engine.tubes import TubeRenderer

    return TubeRenderer(ctx, tubes, **options)


class TubeMapper(FilteredMapper[TubeOptions]):
    """Mapper that draws `SplineTubes` through VTK's own lights, passes, clipping planes and selection.

    Exceptions while drawing wait for `raise_pending`; GL objects are given back as `EngineMapper` says.

    Source: Russig, Gumhold and Salm, "GPU-based raycasting of Hermite spline tubes" (2020), section 3.2.
    """

    _NAME = "TubeMapper"
    _HAS_EDGES = True

    COPIED = (*FilteredMapper.COPIED, "_shape")

    def __init__(
        self,
        # What to draw. Without it, tubes around the lines of the PolyData that ``SetInputConnection`` or
        # ``SetInputData`` connects.
        tubes: SplineTubes | None = None,
        *,
        # By default tubes are white, and connected data are coloured as by any ``vtkMapper``: by their active
        # scalars, or in the colour of the actor's property
        colouring: Colouring | None = None,
        # Arguments of `pvfiblets.tubes.build.as_spline_tubes` for connected data, such as ``radius``: a number (mm),
        # or the name of an array
        shape: Mapping[str, Any] | None = None,
        options: TubeOptions | None = None,  # How rays are cast
        # Takes a moderngl context, the tubes, and as keywords those options that are not the defaults; returns a
        # renderer as of `pvfiblets.engine.tubes`
        renderer_factory: Callable[..., Any] = tube_renderer,
    ) -> None:
        self._shape = dict(shape or {})
        super().__init__(
            tubes,
            colouring=Colouring("solid") if colouring is None and tubes is not None else colouring,
            options=TubeOptions() if options is None else options,
            renderer_factory=renderer_factory,
        )
        self.set_effect("normals", SurfaceNormals())

    @property
    def tubes(self) -> SplineTubes:
        """The drawn tubes."""
        tubes: SplineTubes = self._drawn
        return tubes

    def set_tubes(self, tubes: SplineTubes) -> None:
        """Draw other tubes from the next frame on, if the colouring has no values for another number of them."""
        self._put(tubes)

    def pick_at(
        self, x: float, y: float, *, renderer: vtkRenderer | None = None, tolerance: int = 2
    ) -> tuple[int, float] | None:
        """Return the segment nearest to a pixel of the last frame, and its parameter, 0 to 1; None for no tube."""
        # x and y count from the window's lower left corner. The pixel shows the sphere at that parameter. Other actors
        # in front are not looked at.
        found = nearest_pixel(self, (x, y), ("owner", "position"), renderer=renderer, tolerance=tolerance)
        return None if found is None else (int(found.texels["owner"][0]), float(found.texels["position"][0]))

    @property
    def _empty(self) -> bool:
        return not self._drawn.n_segments

    def _readable_points(self) -> int | None:
        runs = len(segment_ids(self._drawn)[0])
        return SIDES * (STEPS * self._drawn.n_segments + runs)

    def _readable_data(self, budget: int, *, colours: bool, segments: bool) -> vtkPolyData:
        from pvfiblets.mappers.drawn_lines import tube_lines
        from pvfiblets.mappers.line_data import tube_surface

        shown = self._drawn if self._filtering is None else self._drawn.with_segments(self._filtering)
        lines = self._within_cuts(tube_lines(shown, self._colouring if colours else None, budget // SIDES))
        return lines.to_polydata(segments=True) if segments else tube_surface(lines)

    def _made_of(self, data: Any) -> tuple[Any, Colouring]:
        from pvfiblets.mappers.vtk_pipeline.vtk_lines import painted_tubes

        return painted_tubes(data, self._shape, self)

    def _style(self, renderer: vtkRenderer, pixel_scale: float) -> TubeStyle:  # noqa: ARG002
        return TubeStyle(min_width=self.options.min_width * pixel_scale)

    def _widened(self, style: TubeStyle, frame: Frame) -> bool:  # noqa: ARG002
        return style.min_width < 1.0
