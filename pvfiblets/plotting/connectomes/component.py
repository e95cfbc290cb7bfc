"""``plotter.add_connectome(...)`` and ``plotter.connectomes``.

PyVista finds this module by two entry points and imports it when a plotter is first asked for either name.
"""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np
import pyvista as pv

from pvfiblets.plotting.components import register
from pvfiblets.plotting.connectomes.settings import ConnectomeCommon, EdgeSettings
from pvfiblets.plotting.settings.call_signature import document, plotter_method, refuse_unknown, split_arguments
from pvfiblets.plotting.settings.settings import Given

if TYPE_CHECKING:
    from os import PathLike

    from pvfiblets.images.image import Image
    from pvfiblets.plotting.connectomes.graph import ConnectomeGraph
    from pvfiblets.query.connectome.matrix import Connectome

    Matrix: TypeAlias = str | PathLike[str] | Connectome | np.ndarray | list[Any]
    Labels: TypeAlias = str | PathLike[str] | Image | np.ndarray | list[Any] | tuple[Any, Any] | pv.ImageData


@register("connectomes")
class ConnectomesComponent:
    """The connectomes of one plotter.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> graph = pl.connectomes.add([[0, 2], [2, 0]], [(0, 0, 0), (10, 0, 0)])
    >>> list(pl.connectomes) == [graph]
    True
    """

    _SETTINGS: ClassVar[type[EdgeSettings]] = EdgeSettings
    COMMON: ClassVar[type[ConnectomeCommon]] = ConnectomeCommon
    NAME: ClassVar[str] = "connectomes"
    ADD: ClassVar[str] = "add_connectome"
    OWN: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter: Any = weakref.proxy(plotter)
        self._graphs: list[ConnectomeGraph] = []

    def __iter__(self) -> Iterator[ConnectomeGraph]:
        self._graphs = [graph for graph in self._graphs if graph.is_shown]
        return iter(tuple(self._graphs))

    def __len__(self) -> int:
        return len(tuple(iter(self)))

    def add(self, /, matrix: Any, labels: Any, **arguments: Any) -> ConnectomeGraph:
        """Make a graph and add it to the plotter."""
        common, given, own = split_arguments(self, self.COMMON, arguments)
        refuse_unknown(self, own)
        reset_camera, render, name = (common.pop(word) for word in ("reset_camera", "render", "name"))
        taken = {graph.name for graph in self}
        if name is None:
            names = ("connectome", *(f"connectome {number}" for number in range(2, len(taken) + 2)))
            name = next(one for one in names if one not in taken)
        graph = self._make(matrix, labels, given, **own)
        for other in self:
            if other.name == name:
                other.remove()
        if reset_camera is None:
            reset_camera = not self._plotter.camera_set
        graph.enter(self._plotter, name, common)
        self._graphs.append(graph)
        if reset_camera:
            self._plotter.reset_camera(render=False)
        if render:
            self._plotter.render()
        return graph

    def _make(
        self,
        matrix: Matrix,
        labels: Labels,
        settings: Given,
        *,
        nodes: str | None = "spheres",
        edges: str | None = "tubes",
        threshold: float = 0.0,
        names: Any = None,
        streamlines: Any = None,
        radius: float | None = None,
        node_radius: float | np.ndarray | None = None,
    ) -> ConnectomeGraph:
        """Add a connectome to the scene: a node for each parcel, and an edge for each pair with a weight.

        An edge's colour shows its weight, and the radius of its tube the absolute weight. Edges have no direction, and
        none joins a node to itself; 0 and NaN are no edges.

        Parameters
        ----------
        matrix : (n, n) array, path or Connectome
            Weights, symmetric or one triangle: numbers, a ``.csv``, ``.tsv``, ``.txt`` or ``.npy`` file such as
            MRtrix's ``tck2connectome`` writes, or what ``fiblets.connectome(...)`` returns.
        labels : image or (n, 3) array
            Labels, 0 for no parcel: a path, an image of nibabel, ``(array, affine)`` or an ImageData. Rows of the
            matrix are its labels in rising order, or the numbers from 1 to the highest label. Nodes lie at the mean
            of the centres of a label's voxels. Or the nodes' positions, mm.
        nodes : {"spheres", "meshes", None}, default: "spheres"
            How nodes are drawn; meshes are the surfaces of the labels.
        edges : {"tubes", "lines", "streamlines", None}, default: "tubes"
            How edges are drawn: straight tubes, straight lines, or tubes along the mean of the streamlines that
            connect two nodes, with its ends bent to the nodes.
        threshold : float, default: 0
            Edges whose absolute weight is less are not shown.
        names : path, mapping, LabelTable or sequence of str, optional
            Names and colours of labels, as for ``add_slices``, or a name for each node. By default the matrix' own
            names, or the labels.
        streamlines : FibletSet, Streamlines, FibletActor or path, optional
            For ``edges="streamlines"``. Their ends belong to the labels within 4 mm, or as in the Connectome.
        radius : float, optional
            Radius of the edge with the largest absolute weight, mm; that of others is proportional. By default 1 %
            of the diagonal of the nodes' bounds.
        node_radius : float or (n,) array, optional
            Radius of spheres, mm; by default 1.5 times that of the strongest edge.

        Returns
        -------
        ConnectomeGraph
            ``threshold``, ``nodes`` and ``edges`` are live; ``remove()`` takes all away.

        Raises
        ------
        FormatError
            If a file is damaged.
        TypeError
            If an argument is of an unknown kind.
        ValueError
            If the matrix is not symmetric, has another number of rows than there are nodes, or an argument has no
            meaning.

        Examples
        --------
        >>> import numpy as np
        >>> import pyvista as pv
        >>> weights = np.array([[0.0, 3.0, -1.0], [3.0, 0.0, 0.5], [-1.0, 0.5, 0.0]])
        >>> pl = pv.Plotter(off_screen=True)
        >>> graph = pl.add_connectome(weights, [(0, 0, 0), (30, 0, 0), (0, 30, 0)], names=["left", "right", "front"])
        >>> graph.threshold = 1.0
        >>> graph.pairs[graph.shown].tolist()
        [[0, 1], [0, 2]]
        """
        from pvfiblets.plotting.connectomes.graph import ConnectomeGraph
        from pvfiblets.query.connectome.graph import as_graph

        return ConnectomeGraph(
            as_graph(matrix, labels),
            settings,
            nodes=nodes,
            edges=edges,
            threshold=threshold,
            names=names,
            streamlines=streamlines,
            radius=radius,
            node_radius=node_radius,
        )


document(ConnectomesComponent)
AddConnectome = plotter_method(ConnectomesComponent)
