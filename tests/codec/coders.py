"""Either of the two ways in which streamlines are coded."""

from contextlib import contextmanager

from pvfiblets.codec import decompress, parameters
from pvfiblets.codec.encoding import encode


@contextmanager
def coded_by(way):
    """Code and decode by that, whatever the size."""

    @contextmanager
    def decided(*_):
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
