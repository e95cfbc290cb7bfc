"""Errors that the rooms share.

Every error of this package derives from :class:`FibletsError`, so that a caller (the command
line above all) can tell a plain statement about bad input from a programming mistake.
"""

from __future__ import annotations

from os import PathLike, fspath


class FibletsError(Exception):
    """Base of every error that the package raises on purpose."""


class FormatError(FibletsError, ValueError):
    """A file breaks its format.

    Parameters
    ----------
    path : str or PathLike
        The file.
    position : int or None
        Byte at which the file and the format disagree. For compressed files it counts
        decompressed bytes; ``None`` when the disagreement has no single place.
    found : str
        The found content.
    expected : str
        The content that the format requires, and the remedy if there is one.

    Examples
    --------
    >>> raise FormatError("a.tck", 0, "b'GIF89a'", "the magic line 'mrtrix tracks'")
    Traceback (most recent call last):
        ...
    pvfiblets.errors.FormatError: a.tck, byte 0: found b'GIF89a', expected the magic line \
'mrtrix tracks'
    """

    def __init__(self, path: str | PathLike[str], position: int | None, found: str, expected: str) -> None:
        self.path = fspath(path)
        self.position = position
        self.found = found
        self.expected = expected
        # The four facts stay in `args`, so that the error survives pickling between processes.
        super().__init__(self.path, position, found, expected)

    def __str__(self) -> str:
        place = "" if self.position is None else f", byte {self.position}"
        return f"{self.path}{place}: found {self.found}, expected {self.expected}"


EXPECTED = (FibletsError, OSError, ValueError, KeyError, TypeError, ImportError, MemoryError)
"""What bad input and a bad environment raise. Anything else is a mistake in this program, and its traceback is worth
more than a sentence."""


def sentence(error: BaseException) -> str:
    """Return an error's message as one line."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        text = f"{error.filename}: {error.strerror}"
    elif isinstance(error, KeyError) and error.args:
        text = str(error.args[0])
    else:
        text = str(error)
    return " ".join(text.split()) or type(error).__name__
