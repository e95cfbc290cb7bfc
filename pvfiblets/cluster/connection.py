"""Workers: a cluster of processes on this machine, or one that runs already."""

from __future__ import annotations

import logging
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from pvfiblets.errors import FibletsError
from pvfiblets.support import memory

if TYPE_CHECKING:
    from distributed import Client

SHARE = 0.8  # of the machine's memory, for all workers together
DEATHS = 10  # workers that may die with a task before it is given up
DASHBOARD = 8787
ANSWER_WITHIN = 30.0  # seconds


class ClusterError(FibletsError):
    """The cluster is unreachable, or its packages are not installed."""


def default_workers(n_files: int) -> int:
    """Return how many processes go through so many files: a core each."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(min(cores, n_files), 1)


@contextmanager
def connected(cluster: Any, workers: int, size: int | None, *, dashboard: bool = True) -> Iterator[Client]:
    """Have workers meanwhile."""
    try:
        import dask
        import distributed
    except ImportError as error:
        raise ClusterError(f"{error}; a batch needs dask: pip install 'pvfiblets[cluster]'") from None
    if isinstance(cluster, distributed.Client):
        yield cluster
        return
    if cluster is not None:
        where = {"scheduler_file": cluster} if str(cluster).endswith(".json") else {"address": cluster}
        try:
            client = distributed.Client(**where, timeout=ANSWER_WITHIN, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise ClusterError(
                f"no scheduler of dask answers at {cluster} ({error}); start one by dask scheduler, or leave the "
                "address out to use this machine"
            ) from None
        with client:
            yield client
        return
    threads = max(default_workers(1 << 30) // workers, 1)
    with (
        dask.config.set({
            "distributed.scheduler.allowed-failures": DEATHS,
            "distributed.worker.multiprocessing-method": "spawn",  # compiled kernels have threads, which fork loses
        }),
        distributed.LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=True, memory_limit=size or 0,
            dashboard_address=_dashboard() if dashboard else "127.0.0.1:0",  # with None dask takes the usual port
            env={"NUMBA_NUM_THREADS": str(threads), **memory.ENVIRONMENT}, silence_logs=logging.CRITICAL,
            preload=["pvfiblets.cluster.worker_setup"],
        ) as local,
        distributed.Client(local, set_as_default=False) as client,
    ):  # fmt: skip
        yield client


def _dashboard() -> str:
    """The usual address of a dashboard, or any that is free."""
    with socket.socket() as probe:
        try:
            probe.bind(("127.0.0.1", DASHBOARD))
        except OSError:
            return "127.0.0.1:0"
    return f"127.0.0.1:{DASHBOARD}"
