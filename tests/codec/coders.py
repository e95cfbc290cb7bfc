"""Either of the two ways in which streamlines are coded."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Literal

from pvfiblets.codec import decompress, encode, parameters


@contextmanager
def coded_by(way: Literal["kernels", "NumPy"]) -> Iterator[None]:
    """Code and decode by that, whatever the size."""

    @contextmanager
    def decided(*_: object) -> Iterator[bool]:
        yield way == "NumPy"

    before = encode.without_kernels
    modules = (decompress, encode, parameters)
    for module in modules:
        module.without_kernels = decided
    try:
        yield
    finally:
        for module in modules:
            module.without_kernels = before
