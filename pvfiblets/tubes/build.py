"""Spline tubes from whatever line data there is: lines, radii, values, and derivatives given or found."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..images.sources import as_image, is_image
from ..lines import Lines, flat, gather, joined, numbers_or_colours, numbers_or_rgba, refuse_words
from .spline_tubes import Doubles, NodeValues, SplineTubes, chord_lengths
from .tangents import METHODS, Steps, derivatives

RADIUS_NAMES = ("radius", "Radius", "MaximumInscribedSphereRadius")
"""Point data that is taken for the radius when none is given; the last is VMTK's."""

RADIUS_SHARE = 0.005  # radius when there is none: this share of the diagonal of the points' bounds


def as_spline_tubes(
    source: Any,
    *,
    radius: float | str | npt.ArrayLike | None = None,
    tangents: str | npt.ArrayLike | None = None,
    radius_slopes: float | str | npt.ArrayLike | None = None,
    scalars: str | npt.ArrayLike | None = None,
    scalar_slopes: str | npt.ArrayLike | None = None,
    rgb: bool | None = None,
    method: str = "finite",
    scaled: bool | None = None,
) -> SplineTubes:
    """Make spline tubes of line data.

    Parameters
    ----------
    source : PolyData, Streamlines, FibletSet, array_like, tuple or SplineTubes
        A PolyData (VTK or PyVista) with lines; a tractogram; one ``(n, 3)`` array in mm for one tube, or a list of
        arrays; ``(points, segments)`` with ``(n_points, 3)`` positions in mm and ``(n_segments, 2)`` point indices.
        Two segments (or line cells, if all have two points) form one smooth tube if one starts where the other ends
        and no third uses that point; the order of the list does not matter. A line of one point becomes a sphere; a
        line without points becomes a tube without segments. SplineTubes are returned unchanged.
    radius : float, str, array_like or image, optional
        Radius in mm: one for all, the name of a point or line array of the source, ``(n_points,)`` numbers or
        ``(n_lines,)`` numbers, or an image, sampled at the points. By default the first point array among
        `RADIUS_NAMES`, else 0.5 % of the diagonal of the points' bounds (1 mm if all points coincide).
    tangents : str or array_like, optional
        ``(n_points, 3)`` derivatives of the position, or the name of such a point array. Lines that share a point
        then share its node. By default derivatives are computed for each line, which gives each line its own node.
    radius_slopes : float, str or array_like, optional
        ``(n_points,)`` derivatives of the radius. Computed by default.
    scalars : str, array_like or image, optional
        Values to colour by: the name of a point or line array, ``(n_points,)`` numbers, an image, ``(n_points, 3)``
        or ``(n_points, 4)`` colours (uint8, or floats 0..1 with `rgb`), or one row for each line. Point values are
        stored in ``values`` under their name, or ``"scalars"``; line values in ``tube_values``. ``"radius"`` needs
        no array.
    scalar_slopes : str or array_like, optional
        Derivatives of `scalars`, in the same shape (of colours: of 0..1). Computed by default.
    rgb : bool, optional
        True: `scalars` of three or four columns are colours. False: they are vectors, coloured by magnitude. By
        default uint8 columns are colours, and so are arrays whose names end in ``"_rgb"`` or ``"_rgba"``.
    method : {'finite', 'catmull-rom', 'natural'}, default: 'finite'
        Method for missing derivatives: finite differences by length, half the difference of the two neighbours, or
        natural cubic splines.
    scaled : bool, optional
        True: derivatives are by length (mm/mm; unit tangents fit). False: they are by the segment's parameter from
        0 to 1 (the paper's t_i; a straight segment's tangents are its chord). By default False if `tangents` are
        given or the method is ``'catmull-rom'``, else True. It holds for computed derivatives too.

    Returns
    -------
    SplineTubes
        Line arrays of the source are its ``tube_values``; `scalars` at points are its ``values``.

    Raises
    ------
    TypeError
        If `source` has an unsupported type, or SplineTubes come with another argument.
    ValueError
        If there are no lines in a PolyData, an array has the wrong shape, a name is unknown, a radius or derivative
        is not finite, or a radius is negative. The message names array, row, line and value.

    Notes
    -----
    Based on Russig et al. 2020, section 3.1: nodes with values and derivatives, segments as pairs of nodes. A point
    that stands twice in a row in a line is a sharp corner, as in the paper. A point with NaN or infinity ends its line:
    each piece is a tube with the data of the whole, and a warning counts them.

    With a list of lines, arguments may be lists too: one array for each line.

    Examples
    --------
    >>> import numpy as np
    >>> from pvfiblets.tubes.build import as_spline_tubes
    >>> t = np.linspace(0, 6, 30)
    >>> tubes = as_spline_tubes(np.stack([10 * np.cos(t), 10 * np.sin(t), t], axis=1), radius=0.5 + 0.1 * t)
    >>> tubes.n_tubes, tubes.n_segments
    (1, 29)
    """
    if isinstance(source, SplineTubes):
        given = {"radius": radius, "tangents": tangents, "radius_slopes": radius_slopes, "scalars": scalars,
                 "scalar_slopes": scalar_slopes, "scaled": scaled}
        if names := [name for name, value in given.items() if value is not None]:
            raise TypeError(f"SplineTubes have their own values, but with them came {', '.join(names)}; leave it out")
        return source
    if method not in METHODS:
        raise ValueError(f"method is {method!r}, expected one of {', '.join(map(repr, METHODS))}")
    if scaled is None:
        scaled = tangents is None and method != "catmull-rom"
    if scaled and method == "catmull-rom":
        raise ValueError("method 'catmull-rom' finds derivatives by the segment's parameter; give scaled=False or "
                         "method='finite', which is the same by length")
    if scalars is None and scalar_slopes is not None:
        raise ValueError("scalar_slopes came without scalars; give the values that they are the slopes of")
    return _Builder(gather(source), scaled, method, own_nodes=tangents is None).build(
        radius, tangents, radius_slopes, scalars, scalar_slopes, rgb
    )


class _Builder:
    """Tubes in the making: rows are the points of all lines, one line after the other; nodes are the kept points."""

    def __init__(self, lines: Lines, scaled: bool, method: str, own_nodes: bool) -> None:
        self.lines, self.scaled, self.method = lines, scaled, method
        self.places = lines.points[lines.ids]
        self.single = np.repeat(lines.counts, lines.counts) == 1
        # By parameter, a tangent would lead a one-point line's segment away from its point: it needs a node of its own.
        self.own_nodes = own_nodes or bool(self.single.any())
        steps = Steps.between(self.places, lines.offsets)
        self.steps = steps if scaled else steps.uniform()

    def build(self, radius: Any, tangents: Any, radius_slopes: Any, scalars: Any, scalar_slopes: Any,
              rgb: bool | None) -> SplineTubes:
        """Gather every array, in rows, and bring them to nodes."""
        radii, name = self._radius(radius)
        segments, tubes = self.lines.segments()
        values, tube_values = self._scalars(scalars, scalar_slopes, rgb, name)
        return SplineTubes(
            self._nodes(self.places) if self.own_nodes else self.lines.points,
            segments if self.own_nodes else self.lines.ids[segments],
            self._nodes(radii),
            self._nodes(self._derivatives(self.places, tangents, "tangents", "derivative of the position")),
            self._nodes(self._derivatives(radii, radius_slopes, "radius_slopes", "derivative of the radius")),
            self.scaled,
            tubes,
            self.lines.n_tubes,
            values,
            tube_values,
        )

    # ------------------------------------------------------------------ rows and nodes

    def _nodes(self, rows: Doubles) -> Doubles:
        """Bring rows to nodes; where lines share a node, it has the mean of their rows."""
        if self.own_nodes:
            return rows
        n, ids = len(self.lines.points), self.lines.ids
        nodes = np.zeros((n, *rows.shape[1:]))
        if not self.lines.shared:
            nodes[ids] = rows
            return nodes
        uses = np.maximum(np.bincount(ids, minlength=n), 1)
        flat, sums = rows.reshape(len(rows), -1), nodes.reshape(n, -1)
        last = np.zeros_like(sums)
        last[ids] = flat
        for k in range(flat.shape[1]):
            # Around one of the values: equal ones, the usual case, stay the same to the last digit.
            with np.errstate(invalid="ignore"):
                sums[:, k] = last[:, k] + np.bincount(ids, flat[:, k] - last[ids, k], n) / uses
        return nodes

    def _derivatives(self, rows: Doubles, given: Any, what: str, meaning: str) -> Doubles:
        """Derivatives of rows: those given, or found."""
        if given is None:
            return derivatives(rows, self.steps, self.method)
        result = self._per_row(given, what, rows.shape[1:], meaning)
        self._check(result, what, "finite numbers; leave them out to have them computed")
        result[self.single] = 0.0
        return result

    # ------------------------------------------------------------------ input

    def _radius(self, radius: Any) -> tuple[Doubles, str | None]:
        """Return the radius of each row, and the name of the array it is from."""
        if radius is None:
            radius = next((name for name in RADIUS_NAMES if name in self.lines.point_data), None)
        if radius is None:
            extent = np.ptp(self.places, axis=0) if len(self.places) else np.zeros(3)
            radius = RADIUS_SHARE * float(chord_lengths(extent[None])[0]) or 1.0
        rows = self._per_row(radius, "radius", (), "radius in mm")
        expected = "finite numbers in mm, 0 or more"
        if is_image(radius):
            expected += ": the point lies outside of the image or at a voxel without one; give an array of radii"
        self._check(rows, "radius", expected, least=0.0)
        return rows, radius if isinstance(radius, str) else None

    def _scalars(self, scalars: Any, slopes: Any, rgb: bool | None, radius_name: str | None) -> tuple[
        dict[str, NodeValues], dict[str, npt.NDArray[Any]]]:
        """Return node values and tube values: the values of colours, and the source's line data."""
        tube_values = dict(self.lines.line_data)
        if scalars is None:
            return {}, tube_values
        name = scalars if isinstance(scalars, str) else "scalars"
        if name == "radius" and name == scalars and (radius_name == name or not self._known(name)):
            if slopes is not None:
                raise ValueError("scalar_slopes of the radius are its own: give them as radius_slopes")
            return {}, tube_values
        array, per_line = self._find(scalars, "scalars", words=True)
        refuse_words(array, f"scalars {name!r}", per_line)
        array = numbers_or_colours(array, name, rgb)
        if per_line:
            if slopes is not None:
                raise ValueError(f"scalar_slopes came with {name!r} of whole lines, which have none; leave them out")
            return {}, {**tube_values, name: array}
        values = numbers_or_rgba(array[self.lines.ids], name, rgb, self._where).astype(np.float64, copy=False)
        if slopes is None:
            found = derivatives(values, self.steps, self.method)
        else:
            found = self._per_row(slopes, "scalar_slopes", array.shape[1:], f"derivative of {name!r}")
            if values.ndim == 2 and found.shape[1] == 3:
                found = np.concatenate([found, np.zeros((len(found), 1))], axis=1)
            self._check(found, "scalar_slopes", "finite numbers; leave them out to have them computed")
            found[self.single] = 0.0
        return {name: NodeValues(self._nodes(values), self._nodes(found))}, tube_values

    def _per_row(self, given: Any, what: str, shape: tuple[int, ...], meaning: str) -> Doubles:
        """A float64 array with a row of this shape for each row, of a number, a name, or an array."""
        if shape == () and (isinstance(given, (int, float, np.number)) or getattr(given, "shape", None) == ()):
            return np.full(len(self.places), float(given))
        array, per_line = self._find(given, what)
        if array.shape[1:] != shape:
            columns = "".join(f", {k}" for k in shape)
            raise ValueError(
                f"{what} has the shape {array.shape}, expected (n_points{columns}): a {meaning} for each point"
            )
        if per_line:
            return self._spread(array.astype(np.float64))
        return array[self.lines.ids].astype(np.float64)

    def _spread(self, array: Doubles) -> Doubles:
        """Values of tubes, for each row: the mean where two tubes meet, as cells of two points do."""
        if self.lines.tube_of is None:
            return np.repeat(array, self.lines.counts, axis=0)
        segments, tubes = self.lines.segments()
        result = np.zeros((len(self.places), *array.shape[1:]))
        for end in segments.T:
            np.add.at(result, end, array[tubes])
        uses = np.bincount(segments.ravel(), minlength=len(result))
        return result / uses.reshape(-1, *(1,) * (array.ndim - 1))

    def _known(self, name: str) -> bool:
        return name in self.lines.point_data or name in self.lines.line_data

    def _find(self, given: Any, what: str, words: bool = False) -> tuple[npt.NDArray[Any], bool]:
        """Return the array given, by itself or by name, and whether it has a row for each line, not each point."""
        lines = self.lines
        n_points, n_lines = len(lines.points), lines.n_rows
        if is_image(given) and not (isinstance(given, str) and self._known(given)):
            return as_image(given).at(lines.points), False
        if isinstance(given, str):
            if given in lines.point_data:
                return flat(lines.point_data[given], f"{what} {given!r}", words=words), False
            if given in lines.line_data:
                return flat(lines.line_data[given], f"{what} {given!r}", words=words), True
            known = [f"{title} {', '.join(map(repr, data))}" for title, data in (
                ("point data", lines.point_data), ("line data", lines.line_data)) if data]
            has = " and ".join(known) or "no data"
            raise ValueError(f"{what} is {given!r}, which the source does not have; it has {has}")
        array = flat(joined(given, (n_points, n_lines)), what, words=words)
        if array.ndim and len(array) == n_points:
            return array, False
        if array.ndim and len(array) == n_lines:
            return lines.of_tubes(array), True
        raise ValueError(
            f"{what} has the shape {array.shape}, expected a row for each of {n_points} points or of {n_lines} lines"
        )

    # ------------------------------------------------------------------ checks

    def _where(self, row: int) -> str:
        line = "" if self.lines.order is not None else f" (line {self.lines.line_of(row)})"
        return f"{self.lines.ids[row]}{line}"

    def _check(self, rows: Doubles, what: str, expected: str, least: float = -np.inf) -> None:
        good = np.isfinite(rows) & (rows >= least)
        if not good.all():
            row = int(np.argmin(good.reshape(len(rows), -1).all(axis=1)))
            raise ValueError(f"{what} {self._where(row)} is {rows[row].tolist()}, expected {expected}")
