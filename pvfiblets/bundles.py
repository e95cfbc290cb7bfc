"""Bundles of streamlines: found by similarity, listed, named, measured.

``clusters(fiblets)`` puts streamlines that run alike together, ``similar(fiblets, ids)`` finds more like some.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .lazy_imports import names_from

if TYPE_CHECKING:
    from .query.bundles.clusters import Cluster, Clusters, clusters
    from .query.bundles.similar import Similar, mdf, similar

__all__ = ["Cluster", "Clusters", "Similar", "clusters", "mdf", "similar"]

_HOME = {
    "Cluster": ".query.bundles.clusters",
    "Clusters": ".query.bundles.clusters",
    "Similar": ".query.bundles.similar",
    "clusters": ".query.bundles.clusters",
    "mdf": ".query.bundles.similar",
    "similar": ".query.bundles.similar",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
