"""Volumes in files that nibabel reads: its complaints become errors, and headers are not taken at their word."""

from __future__ import annotations

import gzip
import math
import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.errors import FormatError
from pvfiblets.support.memory import check_room

__all__ = ["opened"]

PIECE = 1 << 18  # bytes
LIKELY = 8
"""Compressed data that should swell by more are counted before memory is taken for them."""


@contextmanager
def opened(path: Path) -> Iterator[Any]:
    """Open an image; what its data raise while they are read inside the ``with`` block are its errors, too."""
    import nibabel as nib
    from nibabel.filebasedimages import ImageFileError
    from nibabel.freesurfer.mghformat import MGHError
    from nibabel.spatialimages import HeaderDataError

    errors = (
        ImageFileError, HeaderDataError, MGHError, EOFError, OSError, OverflowError, KeyError, struct.error, zlib.error,
    )  # fmt: skip

    def told(error: Exception) -> FormatError:
        return FormatError(path, None, f"what nibabel cannot read ({error})", "a whole NIfTI or MGH image")

    with path.open("rb"), np.errstate(all="ignore"):
        try:
            image = nib.load(path)
        except (*errors, ValueError, TypeError) as error:
            raise told(error) from None
        if not hasattr(image, "dataobj"):
            raise told(TypeError(f"as {type(image).__name__}, which is no volume"))
        _check_size(path, image.dataobj)
        try:
            yield image
        except errors as error:
            raise told(error) from None


def _check_size(path: Path, data: Any) -> None:
    """Compare what the header says with what there is, before memory is taken for it."""
    shape = [int(n) for n in data.shape]
    if any(n < 1 for n in shape):
        raise FormatError(path, None, f"the shape {tuple(shape)}", "one voxel or more along each axis")
    needed = int(data.offset) + math.prod(shape) * data.dtype.itemsize
    size = path.stat().st_size
    if path.name.lower().endswith((".gz", ".mgz")):
        check_room(needed)
        size = needed if needed <= LIKELY * size else _inflated_size(path, needed)
    if size < needed:
        raise FormatError(path, None, f"{size} bytes", f"{needed}, as the header's sizes and type say")


def _inflated_size(path: Path, most: int) -> int:
    """Return how many bytes a compressed file holds, or more than `most`, without keeping them."""
    size = 0
    try:
        with gzip.open(path) as stream:
            while size < most and (piece := stream.read(PIECE)):
                size += len(piece)
    except (OSError, EOFError, zlib.error):
        pass  # nibabel says so when it reads them
    return size
