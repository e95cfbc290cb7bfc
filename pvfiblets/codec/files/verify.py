"""Check a compressed file against its checksums and its source."""

from __future__ import annotations

from collections import Counter
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from ...errors import FibletsError, FormatError
from ..fibletset import FibletSet
from ..parameters import DEFAULT_ANGLE
from ..progress import Progress
from .fiblets_format import verify_file
from .file_error import measure_file_error


class VerificationError(FibletsError):
    """A file is damaged, or farther from its original than it promises."""


def verified(
    path: str | PathLike[str],
    original: str | PathLike[str] | None = None,
    *,
    max_angle: float | None = DEFAULT_ANGLE,
    progress: Progress = False,
) -> dict[str, Any]:
    """Check every byte of a file and, with its source, measure all points and directions."""
    if Path(path).suffix.lower() != ".fiblets":
        raise ValueError(f"{path} is no .fiblets file; give the compressed file first, then its original")
    verify_file(path)
    fiblets = FibletSet.open(path)
    result: dict[str, Any] = {
        "file": fspath(path),
        "checksums": "good",
        "streamlines": fiblets.n_streamlines,
        "points": fiblets.n_points,
        "exact": fiblets.exact is not None,
        "promise_mm": fiblets.points_promise,
    }
    if original is not None:
        dropped: Counter[str] = Counter()
        try:
            error = measure_file_error(path, original, progress=progress, dropped=dropped)
        except FormatError:
            raise
        except ValueError as mismatch:
            raise VerificationError(f"{path} was not made from {original} as it is: {mismatch}") from mismatch
        result.update(original=fspath(original), **error.summary())
        result["kept"] = bool(error.max_mm <= result["promise_mm"])
        # Files do not record their bound of angles, so this is reported without failing.
        result["directions_kept"] = max_angle is None or not error.max_degrees > max_angle
        result["dropped"] = dict(dropped)  # of the original, by reading it
    return result


def refuse_broken_promise(result: dict[str, Any]) -> None:
    """Raise where :func:`verified` found a point farther from its original than the file promises."""
    if not result.get("kept", True):
        raise VerificationError(
            f"{result['file']}: a point is {result['error_mm']['max']:.3g} mm from its original in "
            f"{result['original']}, more than the {result['promise_mm']:.3g} mm that the file promises"
        )
