"""What test_pools.py has pools do: a module that their processes can import."""

import numpy as np

import pvfiblets
from pvfiblets import regions


def work(seed):
    """Code, decode and question a small set, the last by compiled kernels."""
    random = np.random.default_rng(seed)
    lines = [np.cumsum(random.normal(size=(40, 3)) * 0.3 + [1, 0, 0], axis=0) for _ in range(10)]
    fiblets = pvfiblets.compress(pvfiblets.Streamlines.from_list(lines), exact=False)
    ball = regions.Sphere((20.0, 0.0, 0.0), 3.0)
    return fiblets.decompress().n_points, int(np.count_nonzero(fiblets.select(regions.passes(ball))))
