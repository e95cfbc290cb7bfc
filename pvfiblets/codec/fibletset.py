"""FibletSet: a whole tractogram in compressed form, in memory or mapped from a ``.fiblets`` file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from ..streamlines import Streamlines
from ..support.addresses import is_url
from .layout import PAGE, PAGE_BITS, unpack
from .parameters import LEAST, Parameters
from .point_values import PointValues

if TYPE_CHECKING:
    from ..query.bundles.bundle_list import Bundles
    from ..query.bundles.clusters import Clusters
    from ..query.bundles.similar import Similar
    from ..query.connectome.matrix import Connectome
    from ..query.density.density_map import DensityMap
    from ..query.measures.table import Table


class Condition(Protocol):
    """A condition on streamlines, such as `pvfiblets.query.selection.predicates` makes; this room knows none itself."""

    def choose(self, fiblets: FibletSet, *, flags: Any = None) -> npt.NDArray[np.bool_]:
        """Return the streamlines that satisfy it, ``(n_streamlines,)`` bool."""


@dataclass(eq=False)
class FibletSet:
    """Compressed streamlines (paper: Schertzer et al. 2022, section 3.2; record: :mod:`pvfiblets.codec.layout`).

    :func:`pvfiblets.compress` and :meth:`open` make such a set. Do not write to its arrays.

    Attributes
    ----------
    parameters : Parameters
        Values that all fiblets share: origin, anchor grid, steps, lattice, error bound.
    anchors : numpy.ndarray
        ``(n_fiblets, 2)`` uint32: the input of culling.
    decoding : numpy.ndarray
        ``(n_fiblets, 3)`` uint32: the input of decoding.
    reach : numpy.ndarray
        ``(n_fiblets,)`` uint16: radii of the capsules about the fiblets' chords, in units of ``reach_scale``
        (:mod:`pvfiblets.codec.capsules`).
    codes : numpy.ndarray
        ``(n_bytes,)`` uint8.
    ends : numpy.ndarray
        ``(n_ranks,)`` uint32: the chord of each streamline's last fiblet, three signed 10-bit integers in units of
        ``end_scale``.
    pages : numpy.ndarray
        ``(n_pages + 1, 3)`` int64: rank, code byte and point at which each page of 16384 fiblets starts.
    bounds : tuple of float
        True bounds of the original points ``(xmin, xmax, ymin, ymax, zmin, zmax)``, mm.
    n_streamlines : int
        Streamlines, those without points included.
    anchors_low : numpy.ndarray or None
        ``(n_fiblets, 3)`` uint16: lower halves of 32-bit anchors, only where the error bound asks for them.
    rank_to_id : numpy.ndarray or None
        ``(n_ranks,)`` int64: streamline of each rank where some streamlines have no points, or are coded in another
        order than their own; else None, and both are the same.
    exact : numpy.ndarray or None
        ``(n_points, 3)`` float32 or float64, mm, in the order of ranks: the points themselves, of a set that keeps
        every bit of them (:mod:`pvfiblets.codec.encoding.exact`). Its records are for drawing, and are not stored.
    per_point : dict of str to PointValues
        Values kept for every point, in the order of ranks (:meth:`in_coded_order`).
    per_streamline, groups, per_group : dict
        As in :class:`~pvfiblets.Streamlines`, whole.
    affine : numpy.ndarray
        ``(4, 4)`` voxel to RAS mm of the source; identity if unknown.
    space : dict
        Further header values of the source, for writers.
    dropped : dict of str to int
        Number of parts that reading the source omitted, by reason.
    """

    parameters: Parameters
    anchors: npt.NDArray[np.uint32]
    decoding: npt.NDArray[np.uint32]
    reach: npt.NDArray[np.uint16]
    codes: npt.NDArray[np.uint8]
    ends: npt.NDArray[np.uint32]
    pages: npt.NDArray[np.int64]
    bounds: tuple[float, float, float, float, float, float]
    n_streamlines: int
    anchors_low: npt.NDArray[np.uint16] | None = None
    rank_to_id: npt.NDArray[np.int64] | None = None
    exact: npt.NDArray[Any] | None = None
    per_point: dict[str, PointValues] = field(default_factory=dict)
    per_streamline: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    groups: dict[str, npt.NDArray[Any]] = field(default_factory=dict)
    per_group: dict[str, dict[str, Any]] = field(default_factory=dict)
    affine: npt.NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    space: dict[str, Any] = field(default_factory=dict)
    dropped: dict[str, int] = field(default_factory=dict)

    # ------------------------------------------------------------------------------------------------ contents

    def __len__(self) -> int:
        return self.n_streamlines

    def __repr__(self) -> str:
        kept = "exact" if self.exact is not None else f"promise {self.promise:g} mm"
        return (
            f"FibletSet({self.n_streamlines} streamlines, {self.n_points} points, {self.n_fiblets} fiblets, "
            f"{self.nbytes} bytes, {kept})"
        )

    def _repr_html_(self) -> str:
        from ..support.summary import summary_html

        error = "none: exact" if self.exact is not None else f"{self.promise:.3g} mm"
        more = {"Bytes": f"{self.nbytes:,}", "Greatest error": error}
        return summary_html("FibletSet", self, more)

    @property
    def n_points(self) -> int:
        """Points of all streamlines."""
        return int(self.pages[-1, 2])

    @property
    def n_fiblets(self) -> int:
        """Fiblets of all streamlines."""
        return len(self.anchors)

    @property
    def n_ranks(self) -> int:
        """Streamlines that have points."""
        return int(self.pages[-1, 0])

    @property
    def origin(self) -> npt.NDArray[np.float64]:
        """``(3,)`` origin of the anchors, mm."""
        return np.array(self.parameters.origin)

    @property
    def anchor_scale(self) -> npt.NDArray[np.float64]:
        """``(3,)`` unit of the anchors, mm."""
        return np.array(self.parameters.anchor_scale)

    @property
    def step(self) -> float:
        """Median distance between points, mm."""
        return self.parameters.step

    @property
    def step_lo(self) -> float:
        """Least step that a direction fiblet can name, mm."""
        return self.parameters.step_lo

    @property
    def step_hi(self) -> float:
        """Greatest step that a direction fiblet can name, mm."""
        return self.parameters.step_hi

    @property
    def lattice(self) -> float:
        """Edge of the lattice of the lattice kinds, mm."""
        return self.parameters.lattice

    @property
    def reach_scale(self) -> float:
        """Unit of ``reach``, mm."""
        return self.parameters.reach_scale

    @property
    def end_scale(self) -> float:
        """Unit of ``ends``, mm."""
        return self.parameters.end_scale

    @property
    def largest_radius(self) -> float:
        """Radius of a sphere about the middle of a fiblet's chord that holds any fiblet, mm."""
        return self.parameters.largest_radius

    @property
    def promise(self) -> float:
        """No decoded point is farther than this from its original, mm; of an exact set, no drawn one.

        Of a set that was resampled (``parameters.resampled``), no decoded line from its original. 0 where that is all
        that a float64 can say: of points at the origin.
        """
        promise = self.parameters.promise
        return promise if promise > LEAST or any(self.bounds) else 0.0

    @property
    def points_promise(self) -> float:
        """No point that is given back is farther than this from its original, mm: 0 of an exact set."""
        return 0.0 if self.exact is not None else self.promise

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes of every array; of an exact set's points, not of the records that are made of them."""
        arrays: dict[str, Any] = {
            "anchors": self.anchors,
            "anchors_low": self.anchors_low,
            "decoding": self.decoding,
            "reach": self.reach,
            "codes": self.codes,
            "ends": self.ends,
            "pages": self.pages,
            "rank_to_id": self.rank_to_id,
        }
        if self.exact is not None:
            arrays = {"points": self.exact, "counts": np.empty(self.n_streamlines, np.uint32)}
        arrays |= {f"per_point/{k}": v for k, v in self.per_point.items()}
        arrays |= {f"per_streamline/{k}": v for k, v in self.per_streamline.items()}
        arrays |= {f"groups/{k}": v for k, v in self.groups.items()}
        return {name: int(a.nbytes) for name, a in arrays.items() if a is not None}

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays together."""
        return sum(self.sizes.values())

    # ---------------------------------------------------------------------------------------- records, whole columns

    def fiblet_ranks(self) -> npt.NDArray[np.int64]:
        """``(n_fiblets,)`` rank of each fiblet's streamline."""
        return unpack("rank", self.anchors).astype(np.int64) + self._base(0)

    def fiblet_streamlines(self) -> npt.NDArray[np.int64]:
        """``(n_fiblets,)`` index of each fiblet's streamline."""
        ranks = self.fiblet_ranks()
        ids = ranks if self.rank_to_id is None else self.rank_to_id[ranks]
        # Numbers from a damaged file must not size an array.
        if len(ids) and not 0 <= int(ids.min()) <= int(ids.max()) < self.n_streamlines:
            raise IndexError(f"fiblets of streamlines {ids.min()} to {ids.max()}, in a set of {self.n_streamlines}")
        return ids

    @property
    def in_order(self) -> bool:
        """Whether fiblets stand in the order of their streamlines."""
        ids = self.rank_to_id
        return ids is None or bool((np.diff(ids) >= 0).all())

    def in_coded_order(self, values: npt.ArrayLike) -> npt.NDArray[Any]:
        """Values of all points, in the order in which points are coded.

        Parameters
        ----------
        values : array_like
            ``(n_points, ...)`` in the order of the streamlines.

        Returns
        -------
        numpy.ndarray
            The same rows as a per-point array of this set holds them.
        """
        if self.in_order:
            return np.asarray(values)
        from .streamline_ranges import coded_rows

        return np.asarray(values)[coded_rows(self)]

    def value_reference(self, name: Any) -> float:
        """Return what graphics cards subtract from the values of an array (`pvfiblets.support.value_reference`)."""
        stored = self.per_point.get(name) if isinstance(name, str) else None
        return 0.0 if stored is None else stored.reference

    def fiblet_points(self) -> npt.NDArray[np.int64]:
        """``(n_fiblets,)`` index of each fiblet's first point among all points."""
        return unpack("point", self.decoding).astype(np.int64) + self._base(2)

    def fiblet_counts(self) -> npt.NDArray[np.int64]:
        """``(n_fiblets,)`` number of points of each fiblet."""
        return unpack("last", self.decoding).astype(np.int64) + 1

    def _base(self, column: int) -> npt.NDArray[np.int64]:
        return self.pages[:-1, column].repeat(PAGE)[: self.n_fiblets]

    def offsets(self) -> npt.NDArray[np.int64]:
        """``(n_streamlines + 1,)`` int64: where each streamline's points start; the last is ``n_points``."""
        counts = np.bincount(self.fiblet_streamlines(), self.fiblet_counts(), minlength=self.n_streamlines)
        lengths = counts.astype(np.int64)  # float64 sums of whole numbers are exact below 2 ** 53
        return np.concatenate([[0], np.cumsum(lengths)])

    # ------------------------------------------------------------------------------------------------- parts of a set

    def __getitem__(self, ids: Any) -> FibletSet:
        """Some streamlines as a set of their own: ``fiblets[5]``, ``fiblets[10:20]``, ``fiblets[mask]``.

        See :meth:`extract`; one number gives a set of one streamline.
        """
        return self.extract(ids)

    def __iter__(self) -> Iterator[npt.NDArray[np.floating]]:
        """Go through the points of each streamline, ``(k, 3)`` mm, decoded a chunk at a time."""
        for chunk in self.iter_chunks():
            yield from chunk

    def __add__(self, other: object) -> FibletSet:
        """Both sets' streamlines, one set behind the other; see :func:`pvfiblets.codec.editing.join.concatenate`."""
        return FibletSet.concatenate([self, other]) if isinstance(other, FibletSet) else NotImplemented

    @classmethod
    def concatenate(cls, sets: Iterable[FibletSet]) -> FibletSet:
        """Join sets; see :func:`pvfiblets.codec.editing.join.concatenate`.

        Parameters
        ----------
        sets : iterable of FibletSet
            Parts of one set keep every bit; others are coded again, within twice the coarsest of their error bounds.

        Returns
        -------
        FibletSet

        Raises
        ------
        ValueError
            If ``sets`` is empty, or one set has data that another lacks.
        """
        from .editing.join import concatenate

        return concatenate(sets)

    def extract(self, ids: npt.ArrayLike | slice) -> FibletSet:
        """Return some streamlines as a new set, without coding them again.

        Parameters
        ----------
        ids : array_like or slice
            As for :meth:`decompress`. They become streamlines 0, 1, ... of the new set; one that is named again is
            taken once.
        """
        from .editing.extract import extract

        return extract(self, ids)

    # ----------------------------------------------------------------------------------------------------- decoding

    def decompress(self, ids: npt.ArrayLike | None = None, *, dtype: npt.DTypeLike | None = None) -> Streamlines:
        """Decode streamlines to points.

        Parameters
        ----------
        ids : array_like, optional
            Streamlines to decode: indices (any order, repeats allowed; negative ones count from the end), a boolean
            mask ``(n_streamlines,)``, or a slice. All by default.
        dtype : {float32, float64}, optional
            Type of the points; by default float32 where its rounding is far below the error bound.

        Returns
        -------
        Streamlines
            With all stored values, groups and headers. Groups refer to the returned streamlines.

        Raises
        ------
        IndexError
            If an index is out of range or a mask has the wrong length.
        """
        from .decompress import decompress

        return decompress(self, ids, dtype)

    def point_dtype(self) -> npt.DTypeLike:
        """Type of decoded points: float32 where its rounding at these bounds stays below 2 % of the error bound.

        Of an exact set, that of the originals.
        """
        if self.exact is not None:
            return self.exact.dtype
        largest = np.float32(np.abs(self.bounds).max() if self.n_points else 0.0)
        return np.float32 if float(np.spacing(largest)) <= 0.02 * self.promise else np.float64

    def lengths(self) -> npt.NDArray[np.float64]:
        """Length of each streamline as decoded, ``(n_streamlines,)``, mm, without holding all points at once."""
        parts = [chunk.lengths() for chunk in self.iter_chunks()]
        return np.concatenate(parts) if parts else np.zeros(0)

    def rank_at(self, fiblet: int) -> int:
        """Rank of one fiblet's streamline, without reading the others."""
        return int(self.pages[fiblet >> PAGE_BITS, 0]) + int(unpack("rank", self.anchors[fiblet]))

    def iter_chunks(self, max_points: int = 2_000_000) -> Iterator[Streamlines]:
        """Decode consecutive streamlines, at most `max_points` points at a time but for a single streamline of more."""
        from .decompress import iter_chunks

        return iter_chunks(self, max_points)

    # ---------------------------------------------------------------------------------- what other rooms answer

    # By the package's own names, which load the room that answers: this one knows none above it.

    def select(self, predicate: Condition, *, flags: Any = None) -> npt.NDArray[np.bool_]:
        """Return the streamlines that satisfy a condition; see :func:`pvfiblets.query.selection.predicates.select`.

        Parameters
        ----------
        predicate : Predicate
            Such as ``regions.passes(box) & ~regions.ends_in(sphere)`` (:mod:`pvfiblets.regions`).
        flags : callable, optional
            Replaces the compiled kernels that test regions, for instance by the GPU.

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

    def density(self, voxel_size: Any = None, **options: Any) -> DensityMap:
        """Sum streamlines in the voxels of a grid; see :func:`pvfiblets.density`.

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
        from .. import density

        return density(self, voxel_size, **options)

    def connectome(self, labels: Any, **options: Any) -> Connectome:
        """Compute the connectivity matrix of an atlas; see :func:`pvfiblets.connectome`.

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
    def bundles(self) -> Bundles:
        """The set's groups as an ordered list that can be edited; see :class:`pvfiblets.bundles.Bundles`."""
        from .. import Bundles

        return Bundles(self)

    def recognise(self, models: Any, **options: Any) -> dict[str, npt.NDArray[np.int64]]:
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

    def clusters(self, threshold: float = 10.0, **options: Any) -> Clusters:
        """Cluster similar streamlines; see :func:`pvfiblets.clusters`.

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

    def similar(self, like: Any, distance: float = 10.0, **options: Any) -> Similar:
        """Find streamlines similar to given ones; see :func:`pvfiblets.similar`.

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

    def sample(self, image: Any, statistic: Any = None, **options: Any) -> npt.NDArray[np.float64]:
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

    def table(self, ids: npt.ArrayLike | slice | None = None, **options: Any) -> Table:
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
            Columns by name: a dict of arrays, which ``pandas.DataFrame`` and ``pyarrow.table`` accept.
        """
        from .. import table

        return table(self, ids, **options)

    def end_parcels(self, atlas: Any, names: Mapping[int, str] | None = None) -> npt.NDArray[np.str_]:
        """Return the names of the two parcels that each streamline connects; see :func:`pvfiblets.end_parcels`.

        Parameters
        ----------
        atlas : image
            Whole numbers, 0 for no parcel.
        names : mapping of int to str, optional
            Names of the parcels.

        Returns
        -------
        numpy.ndarray
            ``(n_streamlines,)`` text, which ``scalars`` takes.
        """
        from .. import end_parcels

        return end_parcels(self, atlas, names)

    def plot(self, **options: Any) -> Any:
        """Show the streamlines in a window of their own; see :func:`pvfiblets.plot`.

        Parameters
        ----------
        **options
            Arguments of ``plotter.add_fiblets``, and of :func:`pyvista.plot`'s plotter.
        """
        from .. import plot

        return plot(self, **options)

    # ---------------------------------------------------------------------------------------------------- to disk

    def save(self, path: str | PathLike[str], *, shards: int | None = None, small: bool = False) -> list[str]:
        """Write a ``.fiblets`` file, or, by the suffix, a file of another format (``.trk``, ``.tck``, ``.trx``, ...).

        Parameters
        ----------
        path : str or PathLike
            Without a known suffix, a ``.fiblets`` file is written.
        shards : int, optional
            Write a folder of ``.fiblets`` files of at most this number of bytes each, every one with neighbouring
            streamlines (:class:`pvfiblets.ShardedSet` reads parts of it).
        small : bool
            Write a ``.fiblets`` file, or shards, of 0.55 to 0.75 times the bytes, to send or to keep. Opening it
            decodes it into memory, in about 20 ns of processor time a byte; other files are mapped.

        Returns
        -------
        list of str
            What the format cannot hold and was left out, such as ``"groups"`` in a trk file.

        Raises
        ------
        OSError
            If the place cannot be written to.
        UnknownFormatError
            If no format has this suffix, or it can only be read, such as ``.trk.gz``.
        ValueError
            If shards, or a small file, are requested for another format.
        """
        from ..formats import registry
        from .files.fiblets_file import save

        path = Path(path).expanduser()
        if shards is not None:
            from .shards.write import write_shards

            write_shards(self, path, shards, small=small)
            return []
        if path.suffix and registry.suffix_of(path) != ".fiblets":
            from .editing.extract import save_as

            if small:
                raise ValueError(f"{path}: only .fiblets files can be small; give such a name, or leave small out")
            return save_as(self, path)
        save(self, path, small=small)
        return []

    @classmethod
    def open(cls, path: str | PathLike[str]) -> FibletSet:
        """Map a ``.fiblets`` file into memory; data are read when they are needed.

        Parameters
        ----------
        path : str or PathLike
            A file; or a folder of shards or the address of one, which are read when something asks for them
            (:mod:`pvfiblets.codec.shards.unread_set`).

        Raises
        ------
        FormatError
            If the file at `path` is damaged, or of another version.
        """
        from .files.fiblets_file import open_fiblets

        return open_fiblets(path if is_url(path) else Path(path).expanduser(), cls)

    def verify(self) -> None:
        """Check all records for consistency.

        The bytes of a file are checked by :func:`pvfiblets.codec.files.fiblets_format.verify_file`.

        Raises
        ------
        FormatError
            If a fiblet is damaged. The message names the first one and the fault.
        """
        from .check import check_records

        check_records(self)
