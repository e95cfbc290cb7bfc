"""The actors that ``plotter.add_halo_lines`` and ``plotter.add_halo_points`` return."""

from __future__ import annotations

from typing import cast

from pvfiblets.halos import HaloLines, HaloPoints
from pvfiblets.plotting.halos.actor_base import HaloActor
from pvfiblets.plotting.halos.settings import HaloLineSettings, HaloPointSettings


class HaloLineActor(HaloLineSettings, HaloActor):
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


class HaloPointActor(HaloPointSettings, HaloActor):
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
