"""Pools of processes and threads work after kernels ran in the parent: fork, spawn, joblib's and dask's."""

import importlib
import multiprocessing
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import pytest

pytestmark = pytest.mark.more


@pytest.fixture(scope="module")
def work():
    """Return the work; its module is found by name in other processes, too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(Path(__file__).parent))
        yield importlib.import_module("pool_work").work


def _executor(work, kind, **options):
    with kind(2, **options) as pool:
        return list(pool.map(work, range(3)))


def _joblib(work, backend):
    joblib = pytest.importorskip("joblib")
    return joblib.Parallel(2, backend=backend)(joblib.delayed(work)(i) for i in range(3))


def _dask(work, scheduler):
    dask = pytest.importorskip("dask")
    return list(dask.compute(*[dask.delayed(work)(i) for i in range(3)], scheduler=scheduler, num_workers=2))


POOLS = {
    "fork": lambda work: _executor(work, ProcessPoolExecutor, mp_context=multiprocessing.get_context("fork")),
    "spawn": lambda work: _executor(work, ProcessPoolExecutor, mp_context=multiprocessing.get_context("spawn")),
    "threads": lambda work: _executor(work, ThreadPoolExecutor),
    "joblib loky": lambda work: _joblib(work, "loky"),
    "joblib threads": lambda work: _joblib(work, "threading"),
    "joblib multiprocessing": lambda work: _joblib(work, "multiprocessing"),
    "dask threads": lambda work: _dask(work, "threads"),
    "dask processes": lambda work: _dask(work, "processes"),
}
SLOW = ("spawn", "joblib loky", "joblib multiprocessing", "dask processes")


@pytest.mark.timeout(120)
@pytest.mark.parametrize(
    "pool", [pytest.param(name, marks=pytest.mark.exhaustive) if name in SLOW else name for name in POOLS]
)
def test_pools_give_what_the_parent_gives(pool, work):
    wanted = [work(seed) for seed in range(3)]  # kernels have run in the parent then
    assert POOLS[pool](work) == wanted
