"""`HaloMapper`: lines and points with depth-dependent halos as geometry of an ordinary VTK actor.

The engine (`pvfiblets.engine.halos`) draws lines and their halos into one G-buffer, each at its own depth, and says how
much of a pixel is line; the resolve that serves fiblets gives lines their colours and halos theirs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.halos import HaloLines
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.line_tubes import thickened
from pvfiblets.mappers.effects.shader_effects import Draw, ShaderEffect
from pvfiblets.mappers.effects.shading import background
from pvfiblets.mappers.engine_mapper import FilteredMapper
from pvfiblets.mappers.engine_options import Options
from pvfiblets.mappers.frames.scene import Frame
from pvfiblets.mappers.picking import nearest_pixel

if TYPE_CHECKING:
    from collections.abc import Sequence

    import moderngl
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from pvfiblets.engine.halos import HaloDrawStyle, HaloRenderer
    from pvfiblets.halos import HaloPoints, HaloStyle

    Drawn = HaloLines | HaloPoints

Colour = tuple[float, float, float]

WHITE: Colour = (1.0, 1.0, 1.0)
BLACK: Colour = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class HaloOptions(Options):
    """Options of drawing lines and points with halos that do not change the picture."""

    culling: str | None = "two-phase"  # How those behind others are found out

    def _check(self) -> None:
        if self.culling not in (None, "two-phase"):
            raise ValueError(f"culling is {self.culling!r}; use 'two-phase' or None")


def halo_renderer(ctx: moderngl.Context, drawn: Any, **options: Any) -> HaloRenderer:
    """Make the engine's renderer of lines and points with halos; the default ``renderer_factory``."""
    from pvfiblets.engine.halos import HaloRenderer

    return HaloRenderer(ctx, drawn, **options)


@dataclass(frozen=True)
class Strips(ShaderEffect):
    """A `pvfiblets.mappers.effects.shader_effects.MapperEffect` that colours the halos in the G-buffer."""

    color: Colour | None = WHITE  # RGB between 0 and 1; None for the renderer's background, which may be a gradient
    features = frozenset({"strip"})

    def __post_init__(self) -> None:
        if self.color is None:
            return
        channels = tuple(float(channel) for channel in self.color)
        if len(channels) != 3 or not all(0.0 <= channel <= 1.0 for channel in channels):
            raise ValueError(f"color of halos is {self.color!r}; expected 3 numbers between 0 and 1")
        object.__setattr__(self, "color", channels)

    def prepare(self, kept: None, draw: Draw) -> Mapping[str, Any]:  # noqa: ARG002 - as of all effects
        """Return the engine's texture."""
        return {"fibletInkMap": draw.buffer.across}

    def set_uniforms(self, kept: None, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the colours at the lower and the upper edge."""
        lower, upper = _behind(draw) if self.color is None else (self.color, self.color)
        program.SetUniform3f("fibletStripLower", lower)
        program.SetUniform3f("fibletStripUpper", upper)


class HaloMapper(FilteredMapper[HaloOptions]):
    """Mapper that draws `HaloLines` or `HaloPoints` through VTK's own passes, clipping planes and selection.

    Exceptions while drawing wait for `raise_pending`; GL objects are given back as `EngineMapper` says.

    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), section 3.
    """

    _NAME = "HaloMapper"
    _HAS_EDGES = True

    COPIED = (*FilteredMapper.COPIED, "_look", "_measured")

    def __init__(
        self,
        # What to draw. Without it, the lines of the PolyData that ``SetInputConnection`` or ``SetInputData``
        # connects, or its points, if it has no lines.
        drawn: Drawn | None = None,
        # Widths, depths and other settings. By default the widths of connected data follow the distance between its
        # lines.
        look: HaloStyle | None = None,
        *,
        # Of lines and points. By default they are black, and connected data are coloured as by any ``vtkMapper``: by
        # its active scalars, or in the colour of the actor's property.
        colouring: Colouring | None = None,
        # RGB between 0 and 1; None for the renderer's background. When left out, halos are white; around connected
        # lines they have the background's colour.
        halo_color: Colour | Literal["usual"] | None = "usual",
        options: HaloOptions | None = None,  # What does not show
        # Takes a moderngl context, the data, and as keywords the options that differ from the defaults; returns a
        # renderer as of `pvfiblets.engine.halos`
        renderer_factory: Callable[..., Any] = halo_renderer,
    ) -> None:
        if drawn is not None and look is None:
            raise TypeError("HaloMapper has lines or points but no look; give a HaloStyle, their widths in mm")
        self._look: Any = look
        self._measured = look is None
        super().__init__(
            drawn,
            colouring=Colouring("solid", color=BLACK) if colouring is None and drawn is not None else colouring,
            options=HaloOptions() if options is None else options,
            renderer_factory=renderer_factory,
        )
        usual = None if drawn is None else WHITE
        self.halo_color = usual if halo_color == "usual" else halo_color

    @property
    def drawn(self) -> Drawn:
        """The drawn data."""
        drawn: Drawn = self._drawn
        return drawn

    def set_drawn(self, drawn: Drawn, look: HaloStyle | None = None) -> None:
        """Draw something else from the next frame on, and differently where a look comes with it."""
        before = self._look
        self._look = before if look is None else look
        try:
            self._put(drawn)
        except ValueError:
            self._look = before
            raise
        self._link.modified()

    @property
    def look(self) -> HaloStyle:
        """Widths and depths, and what else shows; set another `HaloStyle` to change them from the next frame on."""
        look: HaloStyle = self._look
        return look

    @look.setter
    def look(self, look: HaloStyle) -> None:
        wider = self._look is None or look.strip_width != self._look.strip_width
        self._look, self._measured = look, False
        if wider:
            self._set_proxy()
        self._link.modified()

    @property
    def halo_color(self) -> Colour | None:
        """RGB of the halos, 0 to 1; None for the renderer's background."""
        strips = self._effects["strips"]
        return strips.color if isinstance(strips, Strips) else None

    @halo_color.setter
    def halo_color(self, color: Colour | None) -> None:
        self.set_effect("strips", Strips(color))

    def pick_at(
        self, x: float, y: float, *, renderer: vtkRenderer | None = None, tolerance: int = 2
    ) -> tuple[int, float] | int | None:
        """Return the line and the position along it, or the point, nearest to a pixel of the last frame; None for none.

        x and y count from the window's lower left corner. The position is the index of the point before plus the
        fraction of the segment. Other actors in front are not looked at. Halos occlude objects behind them, and are
        never picked.
        """
        found = nearest_pixel(self, (x, y), ("owner", "ids", "position"), renderer=renderer, tolerance=tolerance)
        if found is None:
            return None
        if isinstance(self._drawn, HaloLines):
            return int(found.texels["ids"][0]), float(found.texels["position"][0])
        return int(found.texels["owner"][0])

    @property
    def _empty(self) -> bool:
        return not (self._drawn.n_segments if isinstance(self._drawn, HaloLines) else self._drawn.n_points)

    @property
    def _extent(self) -> Sequence[float]:
        """Bounds that hold the strips too."""
        return thickened(self._drawn.bounds, self._look.strip_width / 2.0)

    def _readable_points(self) -> int | None:
        return int(self._drawn.n_points)

    def _readable_data(self, budget: int, *, colours: bool, segments: bool) -> vtkPolyData:
        from pvfiblets.mappers.drawn_lines import halo_lines, thinned

        lines = isinstance(self._drawn, HaloLines)
        counts = np.diff(self._drawn.offsets) if lines else np.ones(self._drawn.n_points, np.int64)
        ids = thinned(counts, budget)
        colouring = self._colouring if colours else None
        found = halo_lines(self._drawn, self._look, colouring, ids, self._filtering, self.ink)
        return self._within_cuts(found).to_polydata(segments=segments and lines, vertices=not lines)

    def _made_of(self, data: Any) -> tuple[Any, Colouring]:
        from pvfiblets.mappers.vtk_pipeline.vtk_lines import measured_look, painted_halos

        drawn, colouring = painted_halos(data, self)
        if self._measured:
            self._look = measured_look(drawn)
        return drawn, colouring

    def _style(self, renderer: vtkRenderer, pixel_scale: float) -> HaloDrawStyle:  # noqa: ARG002
        from pvfiblets.engine.halos import HaloDrawStyle

        return HaloDrawStyle(look=replace(self._look, min_width=self._look.min_width * pixel_scale))

    def _widened(self, style: HaloDrawStyle, frame: Frame) -> bool:  # noqa: ARG002
        return style.look.min_width < 1.0


def _behind(draw: Draw) -> tuple[Colour, Colour]:
    """Return the colours that the renderer's background has at the lower and the upper edge of a draw."""
    lower, upper = (np.array(colour) for colour in background(draw.renderer))
    _, low, _, high = draw.renderer.GetViewport()
    _, first, _, last = draw.renderer.GetRenderWindow().GetTileViewport()
    # A tile shows a part of a gradient.
    ends = [(np.clip(end, low, high) - low) / max(high - low, 1e-9) for end in (first, last)]
    begin, end = (tuple(float(part) for part in lower + share * (upper - lower)) for share in ends)
    return (begin[0], begin[1], begin[2]), (end[0], end[1], end[2])
