"""pvfiblets: massive line data, such as brain tractograms, compressed, culled and rendered in VTK and PyVista.

This package itself imports only NumPy; each name below loads its module on first use.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .support.version import __version__

_HOME = {
    "Bundles": "query.bundles.bundle_list",
    "CodingError": "codec.error",
    "DensityMap": "query.density.density_map",
    "FibletSet": "codec.fibletset",
    "FormatError": "errors",
    "ShardedSet": "codec.shards.sharded_set",
    "SplineTubes": "tubes.spline_tubes",
    "Streamlines": "streamlines",
    "UnreadSet": "codec.shards.unread_set",
    "clusters": "query.bundles.clusters",
    "compress": "codec.encoding.compress",
    "compress_file": "codec.files.convert",
    "connectome": "query.connectome.matrix",
    "density": "query.density.volume",
    "iter_chunks": "formats",
    "end_parcels": "query.connectome.parcels",
    "measure_error": "codec.error",
    "nifti_space": "support.nifti_space",
    "plot": "plotting.plot",
    "read": "formats",
    "read_volume": "plotting.read_volume",
    "recognise": "query.bundles.recognise",
    "sample": "query.measures.samples",
    "similar": "query.bundles.similar",
    "table": "query.measures.table",
    "write": "formats",
}

_ROOMS = ("synthetic",)

__all__ = ["__version__", *_HOME, *_ROOMS]

if TYPE_CHECKING:
    from . import synthetic
    from .codec.encoding.compress import compress as compress
    from .codec.error import CodingError, measure_error
    from .codec.fibletset import FibletSet as FibletSet
    from .codec.files.convert import compress_file as compress_file
    from .codec.shards.sharded_set import ShardedSet as ShardedSet
    from .codec.shards.unread_set import UnreadSet as UnreadSet
    from .errors import FormatError
    from .formats import iter_chunks, read, write
    from .plotting.plot import plot as plot
    from .plotting.read_volume import read_volume as read_volume
    from .query.bundles.bundle_list import Bundles as Bundles
    from .query.bundles.clusters import clusters as clusters
    from .query.bundles.recognise import recognise as recognise
    from .query.bundles.similar import similar as similar
    from .query.connectome.matrix import connectome as connectome
    from .query.connectome.parcels import end_parcels as end_parcels
    from .query.density.density_map import DensityMap
    from .query.density.volume import density as density
    from .query.measures.samples import sample as sample
    from .query.measures.table import table as table
    from .streamlines import Streamlines
    from .support.nifti_space import nifti_space as nifti_space
    from .tubes.spline_tubes import SplineTubes


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(import_module(f".{_HOME[name]}", __name__), name)
        globals()[name] = value
        return value
    if name in _ROOMS:
        return import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOME, *_ROOMS])
