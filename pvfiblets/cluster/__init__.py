"""Many files at once, on the cores of one machine or on many machines, by dask (``pip install pvfiblets[cluster]``).

``pvfiblets.cluster.batch`` and ``pvfiblets batch`` do one thing to each file of a cohort. Each file is one task
(:mod:`.task`); what a task makes appears whole, and is written down with its checksum (:mod:`.record`), so that a
second run skips it. Numbers become one Parquet table (:mod:`.tables`), with the subject, the session and whatever else
a BIDS name says in columns of their own (:mod:`.bids`). What can be done to a file stands in :mod:`.operations`.

Nothing here is imported unless it is used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..support.lazy_imports import names_from

if TYPE_CHECKING:
    from .cohort import BatchResult, batch
    from .operations import OPERATIONS

__all__ = ["OPERATIONS", "BatchResult", "batch"]

_HOME = {"BatchResult": "cohort", "OPERATIONS": "operations", "batch": "cohort"}

__getattr__, __dir__ = names_from(__name__, _HOME)
