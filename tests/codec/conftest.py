"""Kernels code and decode here, small as the sets are: what they are compared with is for them."""

import pytest

from .coders import coded_by


@pytest.fixture(scope="module", autouse=True)
def by_kernels():
    with coded_by("kernels"):
        yield
