"""Kernels code and decode here, small as the sets are: what they are compared with is for them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from .coders import coded_by


@pytest.fixture(scope="module", autouse=True)
def by_kernels() -> Iterator[None]:
    with coded_by("kernels"):
        yield
