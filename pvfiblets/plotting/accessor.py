"""``polydata.fiblets``: compress the lines of a PolyData."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import pyvista as pv

from pvfiblets.plotting.fiblets.sources import as_fiblets
from pvfiblets.streamlines import Streamlines

if TYPE_CHECKING:
    from pvfiblets.codec.encoding.compress import PerPoint
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.query.density.density_map import DensityMap


@pv.register_dataset_accessor("fiblets", pv.PolyData)
class FibletsAccessor:
    """Methods for a PolyData's lines.

    Parameters
    ----------
    dataset : pyvista.PolyData
        Lines; points in millimetres.

    Examples
    --------
    >>> import pyvista as pv
    >>> line = pv.Spline([(0, 0, 0), (10, 5, 0), (20, 0, 0)], 100)
    >>> line.fiblets.compress().n_streamlines
    1
    """

    def __init__(self, dataset: pv.PolyData) -> None:
        self._dataset = dataset

    def to_streamlines(self) -> Streamlines:
        """Return the lines with their point and cell data.

        Returns
        -------
        Streamlines
            Point data per point, cell data per streamline.
        """
        return Streamlines.from_polydata(self._dataset)

    def compress(
        self,
        *,
        per_point: PerPoint | Iterable[str] = (),
        max_error: float | None = None,
        progress: bool = False,
        **options: Any,
    ) -> FibletSet:
        """Compress the lines; cell data and named point data are kept.

        Parameters
        ----------
        per_point : iterable of str, or {'all', 'fit', 'none'}
            Point data arrays to keep; 'fit': in their order, each that still fits into 16 bytes a point.
        max_error : float, optional
            Greatest distance (mm) between a given and a decompressed point.
        progress : bool, default: False
            Show a progress bar.
        **options
            Further arguments of :func:`pvfiblets.codec.encoding.compress`.

        Returns
        -------
        FibletSet
            For ``plotter.add_fiblets`` or ``save``.
        """
        fiblets, _ = as_fiblets(
            self._dataset, per_point=per_point, max_error=max_error, progress=progress, **options
        )
        return fiblets

    def density(self, voxel_size: Any = None, **options: Any) -> DensityMap:
        """Add the lines up in the voxels of a grid, as they are; see :func:`pvfiblets.density`.

        Parameters
        ----------
        voxel_size : float or array_like, optional
            mm; either this or ``like``, an image whose grid it is.
        **options
            Further arguments of :func:`pvfiblets.density`; arrays go by the names of point and cell data.

        Returns
        -------
        DensityMap
            ``to_image()`` makes it a :class:`pyvista.ImageData`.
        """
        from pvfiblets.query.density.volume import density

        return density(self.to_streamlines(), voxel_size, **options)
