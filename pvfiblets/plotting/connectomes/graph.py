"""The nodes and edges that ``plotter.add_connectome`` returns: actors of tubes, lines and meshes, kept in step."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkCellPicker

from pvfiblets.plotting.active_view import active_view
from pvfiblets.plotting.settings.settings import number
from pvfiblets.query.connectome.graph import Graph, mean_streamlines
from pvfiblets.slices.labels import LabelTable, as_label_table
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.real_numbers import real_numbers

NODES = ("spheres", "meshes", None)
EDGES = ("tubes", "lines", "streamlines", None)
THICKNESS = 0.01  # radius of the strongest edge, of the diagonal of the nodes' bounds
LINE_WIDTH = 3.0  # pixels
BEND = 4  # power of the share along a streamline by which its end is moved to its node
SMOOTHING = 0.5  # voxels by which a surface of labels may be moved
TOLERANCE = 0.002  # of a pick, of the window's diagonal
WEIGHT = "weight"
THRESHOLD = "threshold"


@dataclass(frozen=True)
class ConnectomePick:
    """A node or an edge of a connectome.

    Attributes
    ----------
    nodes : tuple of int
        Row of the node in the matrix, or of both nodes of the edge.
    names : tuple of str
        Of the nodes.
    weight : float
        Of the edge; NaN for a node.
    """

    nodes: tuple[int, ...]
    names: tuple[str, ...]
    weight: float


class ConnectomeGraph:
    """A connectome in a plotter: an actor of its nodes and one of its edges.

    Attributes
    ----------
    name : str
        Under which the plotter knows it; its actors are called ``"NAME nodes"`` and ``"NAME edges"``.
    weights : numpy.ndarray
        ``(n, n)`` float64, symmetric; 0 where there is no edge.
    positions : numpy.ndarray
        ``(n, 3)`` float64, mm; NaN of a node that the labels lack.
    names : list of str
        Of the nodes.
    pairs : numpy.ndarray
        ``(m, 2)`` int64 nodes of each edge, the lower number first.
    pair_weights : numpy.ndarray
        ``(m,)`` float64.
    node_actor : TubeActor, pyvista.Actor or None
        Draws the nodes.
    edge_actor : TubeActor, FibletActor or None
        Draws the edges, coloured by the array ``"weight"``; its ``cmap``, ``clim``, filters and more are live.
    """

    def __init__(
        self,
        graph: Graph,
        settings: Mapping[str, Any],
        *,
        nodes: str | None,
        edges: str | None,
        threshold: float,
        names: Any,
        streamlines: Any,
        radius: float | None,
        node_radius: Any,
    ) -> None:
        self._graph, self._table, self._streamlines = graph, _table(names, graph), streamlines
        self.weights, self.positions, self.pairs = graph.weights, graph.positions, graph.pairs
        self.names = [self._table.name(label) for label in graph.labels.tolist()]
        self.pair_weights = self.weights[tuple(self.pairs.T)]
        self._placed = np.flatnonzero(np.isfinite(self.positions).all(axis=1))
        lost = np.count_nonzero(np.triu(self.weights)) - len(self.pairs)
        if lost:
            missing = [name for row, name in enumerate(self.names) if row not in self._placed]
            warnings.warn(
                f"{lost} edges are left out: nodes {', '.join(missing[:5])} have no voxels or no position",
                UserWarning,
                stacklevel=5,
            )
        places = self.positions[self._placed]
        size = float(np.linalg.norm(np.ptp(places, axis=0))) if len(places) else 0.0
        self._radius = number("radius", (THICKNESS * size or 1.0) if radius is None else radius, 0.0, None)
        self._node_radius = _radii(1.5 * self._radius if node_radius is None else node_radius, len(self.names))
        self._look = dict(settings)
        if (self.pair_weights < 0.0).any() and not isinstance(self._look["cmap"], pv.LookupTable):
            strongest = abs(self.pair_weights).max()
            self._look = {
                **self._look,
                "cmap": "coolwarm" if self._look["cmap"] is None else self._look["cmap"],
                "clim": (-strongest, strongest) if self._look["clim"] is None else self._look["clim"],
            }
        self._threshold = number(THRESHOLD, threshold, 0.0, None)
        self._nodes, self._edges = _chosen("nodes", nodes, NODES), _chosen("edges", edges, EDGES)
        self._surfaces = self._surfaces_of_labels() if nodes == "meshes" else None
        self._lines = self._lines_of_edges(edges)
        self.name = ""
        self.node_actor: Any = None
        self.edge_actor: Any = None
        self._plotter: Any = None
        self._renderer: Any = None
        self._common: dict[str, Any] = {}

    def __repr__(self) -> str:
        shown = f"{int(self.shown.sum())} of {len(self.pairs)} edges"
        return f"<{type(self).__name__} {self.name!r}: {len(self.names)} nodes, {shown}>"

    # Live properties ----------------------------------------------------------------------------

    @property
    def threshold(self) -> float:
        """Edges whose absolute weight is less are not shown; they are filtered, not made anew."""
        return self._threshold

    @threshold.setter
    def threshold(self, threshold: float) -> None:
        self._threshold = number(THRESHOLD, threshold, 0.0, None)
        if self.edge_actor is None:
            return
        if self._threshold > 0.0:
            self.edge_actor.criterion(abs(self.pair_weights), (self._threshold, None), name=THRESHOLD)
        elif THRESHOLD in self.edge_actor.criteria:
            self.edge_actor.remove_criterion(THRESHOLD)

    @property
    def nodes(self) -> str | None:
        """How nodes are drawn: ``"spheres"``, ``"meshes"`` or not, ``None``."""
        return self._nodes

    @nodes.setter
    def nodes(self, nodes: str | None) -> None:
        if _chosen("nodes", nodes, NODES) == "meshes" and self._surfaces is None:
            self._surfaces = self._surfaces_of_labels()
        self._nodes = nodes
        self._draw_nodes()

    @property
    def edges(self) -> str | None:
        """How edges are drawn: as ``"tubes"``, ``"lines"``, ``"streamlines"`` or not, ``None``."""
        return self._edges

    @edges.setter
    def edges(self, edges: str | None) -> None:
        self._lines = self._lines_of_edges(_chosen("edges", edges, EDGES))
        self._edges = edges
        self._draw_edges()

    @property
    def shown(self) -> np.ndarray:
        """Which edges are shown, (m,) bool: by the threshold, and by filters of the edges' actor."""
        strong: np.ndarray = abs(self.pair_weights) >= self._threshold
        return strong if self.edge_actor is None else strong & self.edge_actor.shown

    # Picks --------------------------------------------------------------------------------------

    def pick_at(self, x: int, y: int) -> ConnectomePick | None:
        """Return the node or edge at a window pixel.

        Parameters
        ----------
        x, y : int
            Pixel, counted from the lower left corner.

        Returns
        -------
        ConnectomePick or None
            ``None`` where nothing of the connectome is, or another actor that can be picked is in front of it.
        """
        if self._renderer is None:
            return None
        picker = vtkCellPicker()
        picker.SetTolerance(TOLERANCE)
        picker.Pick(x, y, 0.0, self._renderer)
        actor, cell = picker.GetActor(), picker.GetCellId()
        if actor is None or actor not in (self.node_actor, self.edge_actor):
            return None
        arrays = pv.wrap(picker.GetDataSet()).cell_data
        if actor is self.edge_actor:
            edge = int(arrays["streamline"][cell])
            return self._picked(*self.pairs[edge].tolist(), weight=float(self.pair_weights[edge]))
        node = arrays["node"][cell] if "node" in arrays else self._placed[int(arrays["streamline"][cell])]
        return self._picked(int(node))

    def _picked(self, *nodes: int, weight: float = np.nan) -> ConnectomePick:
        return ConnectomePick(nodes, tuple(self.names[node] for node in nodes), weight)

    # Life cycle ---------------------------------------------------------------------------------

    def enter(self, plotter: pv.BasePlotter, name: str, common: Mapping[str, Any]) -> None:
        """Add the actors to a plotter's active renderer; a component calls it once."""
        self._plotter, self._renderer, self.name = plotter, plotter.renderer, name
        self._common = dict(common)
        self._draw_nodes()
        self._draw_edges()

    @property
    def is_shown(self) -> bool:
        """Whether the connectome is in the plotter."""
        actors = [actor for actor in (self.node_actor, self.edge_actor) if actor is not None]
        there = any(self._renderer.HasViewProp(actor) for actor in actors)
        return there or (self._renderer is not None and not actors)

    def remove(self) -> None:
        """Remove nodes, edges and the scalar bar from the plotter."""
        if self._renderer is not None:
            with self._in_its_view():
                self._take_away(self.node_actor)
                self._take_away(self.edge_actor)
        self.node_actor = self.edge_actor = self._renderer = None

    @contextmanager
    def _in_its_view(self) -> Iterator[dict[str, Any]]:
        """Activate its renderer for a while; yield arguments for actors that are added there."""
        # PyVista also removes scalar bars of the active renderer only.
        if self._renderer is None:
            raise RuntimeError(f"{self.name!r} was removed from its plotter; add the connectome again")
        given = {word: self._common[word] for word in ("pickable", "user_matrix")}
        with active_view(self._plotter, self._renderer):
            yield {**given, "reset_camera": False, "render": False}

    # Inside -------------------------------------------------------------------------------------

    def _draw_nodes(self) -> None:
        name = f"{self.name} nodes"
        with self._in_its_view() as where:
            self._take_away(self.node_actor)
            self.node_actor = None
            if self._nodes == "meshes":
                self.node_actor = self._plotter.add_mesh(
                    self._surfaces, scalars="color", rgb=True, smooth_shading=True, name=name, **where
                )
            elif self._nodes == "spheres" and len(self._placed):
                self.node_actor = self._plotter.add_spline_tubes(
                    Streamlines(self.positions[self._placed], np.arange(len(self._placed) + 1)),
                    radius=self._node_radius[self._placed],
                    scalars=self._colours()[self._placed],
                    rgb=True,
                    name=name,
                    **where,
                )

    def _draw_edges(self) -> None:
        if self.edge_actor is not None:
            self._look |= {word: getattr(self.edge_actor, word) for word in ("cmap", "clim", "log_scale")}
        bar = {word: self._common[word] for word in ("show_scalar_bar", "scalar_bar_args")}
        with self._in_its_view() as where:
            self._take_away(self.edge_actor)
            self.edge_actor = None
            if self._lines is None:
                return
            given = {"scalars": WEIGHT, "name": f"{self.name} edges", **self._look, **bar, **where}
            if self._edges == "lines":
                self.edge_actor = self._plotter.add_fiblets(self._lines, line_width=LINE_WIDTH, **given)
            else:
                strengths = abs(self.pair_weights)
                self.edge_actor = self._plotter.add_spline_tubes(
                    self._lines, radius=self._radius * strengths / strengths.max(), **given
                )
        self.threshold = self._threshold

    def _take_away(self, actor: Any) -> None:
        if actor is not None:
            self._plotter.remove_actor(actor, reset_camera=False, render=False)

    def _lines_of_edges(self, edges: str | None) -> Streamlines | None:
        """Return a line for each edge, from its first node to its second; None without edges."""
        if edges is None or not len(self.pairs):
            return None
        ends = self.positions[self.pairs]
        found = Streamlines(ends.reshape(-1, 3), 2 * np.arange(len(ends) + 1))
        if edges == "streamlines":
            if self._streamlines is None:
                raise ValueError("edges='streamlines' needs streamlines; give streamlines=, such as a FibletSet")
            means, counts = mean_streamlines(self._graph, self._streamlines)
            ways = zip(ends, means, counts, strict=True)
            found = Streamlines.from_list(bent(mean, *pair) if count else pair for pair, mean, count in ways)
            if not counts.all():
                warnings.warn(
                    f"{np.count_nonzero(counts == 0)} of {len(counts)} edges have no streamlines; they are straight",
                    UserWarning,
                    stacklevel=6,
                )
        found.per_streamline = {WEIGHT: self.pair_weights}
        return found

    def _surfaces_of_labels(self) -> pv.PolyData:
        """Return the surfaces of all parcels, with the node and the colour of each triangle."""
        atlas, labels = self._graph.atlas, self._graph.labels
        if atlas is None:
            raise ValueError("nodes='meshes' needs labels as an image; there are only positions")
        rows = np.minimum(np.searchsorted(labels, atlas.labels), len(labels) - 1)
        numbers = np.where(labels[rows] == atlas.labels, rows + 1, 0)
        grid = pv.ImageData(dimensions=numbers.shape)
        grid["node"] = numbers.ravel(order="F").astype(np.int32)
        surfaces = grid.contour_labels(scalars="node", smoothing_distance=SMOOTHING)
        surfaces = surfaces.transform(atlas.affine, inplace=False)
        surfaces["node"] = np.asarray(surfaces.cell_data["boundary_labels"]).reshape(surfaces.n_cells, -1)[:, 0] - 1
        surfaces["color"] = self._colours()[surfaces["node"].astype(np.int64)]
        return surfaces

    def _colours(self) -> np.ndarray:
        return self._table.rows(self._graph.labels)


def bent(line: np.ndarray, start: np.ndarray, stop: np.ndarray) -> np.ndarray:
    """Return a line whose ends are moved to two places, and its middle by a 16th of that."""
    t = np.linspace(0.0, 1.0, len(line))[:, None]
    moved: np.ndarray = line + (1.0 - t) ** BEND * (start - line[0]) + t**BEND * (stop - line[-1])
    return moved


def _table(names: Any, graph: Graph) -> LabelTable:
    """Return names and colours of labels."""
    given = graph.names if names is None else names
    if given is None:
        return LabelTable()
    if isinstance(given, (str, os.PathLike, Mapping, LabelTable)):
        return as_label_table(given)
    words = [str(name) for name in given]
    if len(words) != len(graph.labels):
        raise ValueError(f"there are {len(words)} names for {len(graph.labels)} nodes; give one for each")
    return LabelTable(dict(zip(graph.labels.tolist(), words, strict=True)))


def _radii(given: Any, n: int) -> np.ndarray:
    radii = real_numbers(given, "radii of nodes")
    if radii.shape not in ((), (n,)) or not (np.isfinite(radii) & (radii >= 0.0)).all():
        raise ValueError(f"node_radius is {given!r}; give mm, 0 or more: one number, or one for each of {n} nodes")
    return np.broadcast_to(radii, n)


def _chosen(what: str, value: Any, choices: tuple[Any, ...]) -> Any:
    if value not in choices:
        raise ValueError(f"{what} is {value!r}; choose one of {', '.join(map(repr, choices))}")
    return value
