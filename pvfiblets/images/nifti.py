"""Images in files that nibabel reads: its complaints become errors, and headers are not taken at their word."""

from __future__ import annotations

import gzip
import math
import struct
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.errors import FormatError
from pvfiblets.support.memory import check_room
from pvfiblets.support.nifti_space import affine_of, code_of

from .image import Image

LABEL_INTENT = 1002  # NIFTI_INTENT_LABEL

FINE = 0.01  # tolerance of scaled numbers, as a part of a stored step

PIECE = 1 << 18  # bytes
LIKELY = 8  # compressed data that should swell by more are counted before memory is taken for them


def read_nifti(path: Path) -> Image:
    """Read an image of NIfTI or MGH."""
    import nibabel

    with path.open("rb"), _damage_as_format_error(path):
        loaded: Any = nibabel.load(path)
        if not hasattr(loaded, "dataobj"):
            raise TypeError(f"as {type(loaded).__name__}, which is no image")
        _check_size(path, loaded.dataobj)

    def read() -> npt.NDArray[Any]:
        with _damage_as_format_error(path):
            return _values(loaded)

    return _image(loaded, read)


def of_nibabel(image: Any, what: str) -> Image:
    """Return an image of nibabel's, in memory only as far as it must be."""
    return _image(image, lambda: _values(image), what)


def _values(image: Any) -> npt.NDArray[Any]:
    """Return the numbers of an image of nibabel's, with the scaling of its header."""
    data = image.dataobj
    kind = getattr(data, "dtype", np.dtype(np.float32))
    scaled = getattr(data, "slope", 1.0) not in (1.0, None) or getattr(data, "inter", 0.0) not in (0.0, None)
    if scaled and kind.kind in "iuf":
        # Half of what float64 takes, unless that would lose steps beside a large offset.
        coarse = float(np.spacing(np.float32(abs(data.inter or 0.0)))) > FINE * abs(data.slope or 1.0)
        return np.asarray(data, np.float64 if coarse else np.float32)
    return np.asarray(data)


def _image(image: Any, read: Callable[[], npt.NDArray[Any]], what: str = "the image") -> Image:
    """Return an image with what a header of NIfTI says of labels and of the space."""
    affine = affine_of(image)
    if affine is None:
        raise ValueError(f"{what} has no affine; give (array, affine)")
    try:
        intent = int(image.header["intent_code"])
    except (AttributeError, KeyError, TypeError, ValueError, IndexError):
        intent = 0
    return Image(tuple(image.shape), affine, read, "", what, intent == LABEL_INTENT, code_of(image))


@contextmanager
def _damage_as_format_error(path: Path) -> Iterator[None]:
    """Turn what nibabel raises of a damaged file into a FormatError."""
    from nibabel.filebasedimages import ImageFileError
    from nibabel.freesurfer.mghformat import MGHError
    from nibabel.spatialimages import HeaderDataError

    errors = (
        ImageFileError, HeaderDataError, MGHError, EOFError, OSError, OverflowError, KeyError, TypeError, ValueError,
        struct.error, zlib.error,
    )  # fmt: skip
    try:
        with np.errstate(all="ignore"):
            yield
    except FormatError:
        raise
    except errors as error:
        raise FormatError(path, None, f"what nibabel cannot read ({error})", "a whole NIfTI or MGH image") from None


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
        pass  # nibabel reports it
    return size
