"""The actors that ``plotter.add_halo_lines`` and ``plotter.add_halo_points`` return."""

from __future__ import annotations

from typing import cast

from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.plotting.halos.actor_base import HaloActor


class HaloLineActor(HaloActor):
    """Lines with depth-dependent halos.

    Everything of :class:`pyvista.Actor` works (``visibility``, ``position``, ``user_matrix``,
    ``pickable``, ``prop``). The properties below may be set at any time and take effect at the next
    render. Lengths are mm of the data: a ``user_matrix`` that scales the lines scales their widths.

    Notes
    -----
    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009).
    """

    _KIND = HaloLines

    @property
    def lines(self) -> HaloLines:
        """What is drawn; others may be put in their place.

        Widths that were not given are measured anew. What colours and filters must be there, too.
        """
        return cast("HaloLines", self._held.drawn)

    @lines.setter
    def lines(self, lines: HaloLines) -> None:
        self._draw_others(lines)

    @property
    def line_width(self) -> float:
        """Width (mm) of the lines; ``None`` sets what suits the data."""
        return self.look.line_width

    @line_width.setter
    def line_width(self, mm: float | None) -> None:
        self._change(line_width=mm)

    @property
    def strip_width(self) -> float:
        """Width (mm) of a line with the halos on both its sides; ``None`` sets what suits ``line_width``."""
        return self.look.strip_width

    @strip_width.setter
    def strip_width(self, mm: float | None) -> None:
        self._change(strip_width=mm)

    @property
    def tapering(self) -> tuple[int, float]:
        """How ends of lines narrow: over so many vertices, which go so far along the mask, up to 0.5.

        The mask is as wide as the strip from 0.2 on. ``True`` sets the paper's (2, 0.2), ``False``
        (0, 0.2): square ends.
        """
        return self.look.n_tapered, self.look.t_tapered

    @tapering.setter
    def tapering(self, tapering: bool | tuple[int, float]) -> None:
        self._change(tapering=tapering)

    @property
    def n_tapered(self) -> int:
        """Vertices over which ends of lines narrow; 0 leaves them square."""
        return self.look.n_tapered

    @n_tapered.setter
    def n_tapered(self, n: int) -> None:
        self._change(tapering=(n, self.t_tapered))

    @property
    def t_tapered(self) -> float:
        """How far along the mask those vertices go."""
        return self.look.t_tapered

    @t_tapered.setter
    def t_tapered(self, t: float) -> None:
        self._change(tapering=(self.n_tapered, t))

    @property
    def filter_taper(self) -> float:
        """Length (mm) over which lines narrow where the filter ends them; ``None`` sets two mean segments."""
        return self.look.filter_taper

    @filter_taper.setter
    def filter_taper(self, mm: float | None) -> None:
        self._change(filter_taper=mm)

    def pick_at(self, x: int, y: int) -> tuple[int, float] | None:
        """Return the line at a window pixel, and where along it the pixel lies.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        tuple of (int, float) or None
            Line, and place along it: the index of the point before plus the fraction of the segment.
            ``None`` where no line of this actor is within two pixels; halos are none.
        """
        return self._mapper.pick_at(x, y)

    @property
    def _counted(self) -> str:
        return f"{self.lines.n_lines} lines of {self.lines.n_points} points"

    @property
    def _totals(self) -> dict[str, int]:
        lines = self.lines
        return {
            "lines_total": lines.n_lines, "segments_total": lines.n_segments, "points_total": lines.n_points,
        }  # fmt: skip


class HaloPointActor(HaloActor):
    """Points with depth-dependent halos: discs that face the viewer, in cones that lead away from him.

    Everything of :class:`pyvista.Actor` works. The properties below may be set at any time and take
    effect at the next render. Lengths are mm of the data.

    Notes
    -----
    Source: Everts, Bekker, Roerdink and Isenberg, "Depth-dependent halos" (2009), section 3.5.
    """

    _KIND = HaloPoints

    @property
    def points(self) -> HaloPoints:
        """What is drawn; others may be put in their place.

        Sizes that were not given are measured anew. What colours and filters must be there, too.
        """
        return cast("HaloPoints", self._held.drawn)

    @points.setter
    def points(self, points: HaloPoints) -> None:
        self._draw_others(points)

    @property
    def point_size(self) -> float:
        """Diameter of the points, mm; ``None`` sets what suits the data."""
        return self.look.line_width

    @point_size.setter
    def point_size(self, mm: float | None) -> None:
        self._change(line_width=mm)

    @property
    def halo_size(self) -> float:
        """Diameter of a point with its halo, mm; ``None`` sets what suits ``point_size``."""
        return self.look.strip_width

    @halo_size.setter
    def halo_size(self, mm: float | None) -> None:
        self._change(strip_width=mm)

    def pick_at(self, x: int, y: int) -> int | None:
        """Return the point at a window pixel.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        int or None
            ``None`` where no point of this actor is within two pixels; halos are none.
        """
        return self._mapper.pick_at(x, y)

    @property
    def _counted(self) -> str:
        return f"{self.points.n_points} points"

    @property
    def _totals(self) -> dict[str, int]:
        return {"points_total": self.points.n_points}
