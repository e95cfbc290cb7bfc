"""Bundles of streamlines: found by similarity, listed, named, measured.

``clusters(fiblets)`` puts streamlines that run alike together, ``similar(fiblets, ids)`` finds more like some, and
``recognise(fiblets, folder)`` finds the bundles of models. ``fiblets.bundles`` is the editable list of a set's groups.
``tract_profile`` averages values along a bundle, ``values_along`` gives its points the values of their positions, and
``bundle_table`` measures all bundles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .support.lazy_imports import names_from

if TYPE_CHECKING:
    from .query.bundles.along import values_along
    from .query.bundles.bundle_list import Bundle, Bundles
    from .query.bundles.clusters import Cluster, Clusters, clusters
    from .query.bundles.recognise import recognise
    from .query.bundles.similar import Similar, mdf, similar
    from .query.bundles.statistics import bundle_table
    from .query.bundles.tract_profile import TractProfile, average_profiles, core_weights, profile_table, tract_profile

__all__ = [
    "Bundle",
    "Bundles",
    "Cluster",
    "Clusters",
    "Similar",
    "TractProfile",
    "average_profiles",
    "bundle_table",
    "clusters",
    "core_weights",
    "mdf",
    "profile_table",
    "recognise",
    "similar",
    "tract_profile",
    "values_along",
]

_HOME = {
    "Bundle": ".query.bundles.bundle_list",
    "Bundles": ".query.bundles.bundle_list",
    "Cluster": ".query.bundles.clusters",
    "Clusters": ".query.bundles.clusters",
    "Similar": ".query.bundles.similar",
    "TractProfile": ".query.bundles.tract_profile",
    "average_profiles": ".query.bundles.tract_profile",
    "bundle_table": ".query.bundles.statistics",
    "clusters": ".query.bundles.clusters",
    "core_weights": ".query.bundles.tract_profile",
    "mdf": ".query.bundles.similar",
    "profile_table": ".query.bundles.tract_profile",
    "recognise": ".query.bundles.recognise",
    "similar": ".query.bundles.similar",
    "tract_profile": ".query.bundles.tract_profile",
    "values_along": ".query.bundles.along",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
