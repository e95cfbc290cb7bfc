"""`SetQueries`: what a set of fiblets is asked that other rooms answer, which are loaded when they are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ..query.bundles.bundle_list import Bundles
    from ..query.bundles.clusters import Clusters
    from ..query.bundles.similar import Similar
    from ..query.connectome.matrix import Connectome
    from ..query.density.density_map import DensityMap
    from ..query.measures.table import Table
    from .fibletset import FibletSet

__all__ = ["Condition", "SetQueries"]


class Condition(Protocol):
    """A condition on streamlines, such as `pvfiblets.query.selection.predicates` makes; this room knows none itself."""

    def choose(self, fiblets: FibletSet, *, flags: Any = None) -> npt.NDArray[np.bool_]:
        """Return the streamlines for which it holds, ``(n_streamlines,)`` bool."""


class SetQueries:
    """The part of a `FibletSet` that chooses, counts and shows its streamlines."""

    def select(self: Any, predicate: Condition, *, flags: Any = None) -> npt.NDArray[np.bool_]:
        """Choose streamlines by where they lie; see :func:`pvfiblets.query.selection.predicates.select`.

        Parameters
        ----------
        predicate : Predicate
            Such as ``regions.passes(box) & ~regions.ends_in(sphere)`` (:mod:`pvfiblets.regions`).
        flags : callable, optional
            What answers for a region instead of the compiled kernels: the GPU.

        Returns
        -------
        numpy.ndarray
            ``(n_streamlines,)`` bool.
        """
        if not hasattr(predicate, "choose"):
            raise TypeError(
                f"a {type(predicate).__name__} is no condition on streamlines; "
                "ask passes(region), ends_in(region) or stays_in(region)"
            )
        chosen: npt.NDArray[np.bool_] = predicate.choose(self, flags=flags)
        return chosen

    def density(self: Any, voxel_size: Any = None, **options: Any) -> DensityMap:
        """Add the streamlines up in the voxels of a grid; see :func:`pvfiblets.density`.

        Parameters
        ----------
        voxel_size : float or array_like, optional
            mm; either this or `like`, an image whose grid it is.
        **options
            ``like, weights, contrast, ends_only, progress`` of that function.

        Returns
        -------
        DensityMap
        """
        from .. import density  # by the package's own name for it: this room knows nothing of questions

        return density(self, voxel_size, **options)

    def connectome(self: Any, labels: Any, **options: Any) -> Connectome:
        """Put a number to every pair of parcels of an atlas; see :func:`pvfiblets.connectome`.

        Parameters
        ----------
        labels : image
        **options
            ``weights, contrast, radius, statistic, names`` of that function.

        Returns
        -------
        Connectome
        """
        from .. import connectome

        return connectome(self, labels, **options)

    @property
    def bundles(self: Any) -> Bundles:
        """The set's groups as an ordered list that can be edited; see :class:`pvfiblets.bundles.Bundles`."""
        from .. import Bundles

        return Bundles(self)

    def recognise(self: Any, models: Any, **options: Any) -> dict[str, npt.NDArray[np.int64]]:
        """Recognise bundles by a folder of models, by dipy's RecoBundles; see :func:`pvfiblets.recognise`.

        Parameters
        ----------
        models : path or dict
            A folder with a tractogram for each bundle, or streamlines by name.
        **options
            Of that function.

        Returns
        -------
        dict of str to numpy.ndarray
            Streamlines of each bundle, which ``bundles.add_all`` takes.
        """
        from .. import recognise

        return recognise(self, models, **options)

    def clusters(self: Any, threshold: float = 10.0, **options: Any) -> Clusters:
        """Put streamlines that run alike into clusters; see :func:`pvfiblets.clusters`.

        Parameters
        ----------
        threshold : float, default: 10.0
            mm from a cluster's mean line.
        **options
            ``n_points, max_clusters, ids, progress`` of that function.

        Returns
        -------
        Clusters
        """
        from .. import clusters

        return clusters(self, threshold, **options)

    def similar(self: Any, like: Any, distance: float = 10.0, **options: Any) -> Similar:
        """Find streamlines that run near some others; see :func:`pvfiblets.similar`.

        Parameters
        ----------
        like : array_like, Streamlines or list of array_like
            Numbers of streamlines, or lines of their own.
        distance : float, default: 10.0
            mm from the nearest of them.
        **options
            ``n_points, ids, progress`` of that function.

        Returns
        -------
        Similar
        """
        from .. import similar

        return similar(self, like, distance, **options)

    def sample(self: Any, image: Any, statistic: Any = None, **options: Any) -> npt.NDArray[np.float64]:
        """Return the values of an image at the points, or a statistic of them; see :func:`pvfiblets.sample`.

        Parameters
        ----------
        image : image
        statistic : {'mean', 'median', 'min', 'max'}, optional
            Of each streamline.
        **options
            ``weights, nearest`` of that function.

        Returns
        -------
        numpy.ndarray
            ``(n_points,)`` in the order of the streamlines, or ``(n_streamlines,)``.
        """
        from .. import sample

        return sample(self, image, statistic, **options)

    def table(self: Any, ids: npt.ArrayLike | slice | None = None, **options: Any) -> Table:
        """Return a row for each streamline; see :func:`pvfiblets.table`.

        Parameters
        ----------
        ids : array_like or slice, optional
            Which; all by default.
        **options
            ``images, weights`` of that function.

        Returns
        -------
        Table
            Columns by name: a dict of arrays, which ``pandas.DataFrame`` and ``pyarrow.table`` take as it is.
        """
        from .. import table

        return table(self, ids, **options)

    def end_parcels(self: Any, atlas: Any, names: Mapping[int, str] | None = None) -> npt.NDArray[np.str_]:
        """Name the two parcels in which each streamline ends; see :func:`pvfiblets.end_parcels`.

        Parameters
        ----------
        atlas : image
            Whole numbers, 0 for no parcel.
        names : mapping of int to str, optional
            Of the parcels.

        Returns
        -------
        numpy.ndarray
            ``(n_streamlines,)`` text, which ``scalars`` takes.
        """
        from .. import end_parcels

        return end_parcels(self, atlas, names)

    def plot(self: Any, **options: Any) -> Any:
        """Show the streamlines in a window of their own; see :func:`pvfiblets.plot`.

        Parameters
        ----------
        **options
            Of ``plotter.add_fiblets``, and those of plotters that :func:`pyvista.plot` takes.
        """
        from .. import plot

        return plot(self, **options)
