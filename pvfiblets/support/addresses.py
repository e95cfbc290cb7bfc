"""Addresses such as ``https://host/a.fiblets``, told from paths, which they must not become: a path has no ``//``."""

from __future__ import annotations

import os
from os import PathLike
from pathlib import Path
from urllib.parse import urlsplit


def is_url(place: str | PathLike[str]) -> bool:
    """Whether a place is an address such as ``https://...`` or ``s3://...`` rather than a path."""
    text = os.fspath(place)
    return "://" in text and len(urlsplit(text).scheme) > 1  # one letter is a drive of Windows


def path_of(place: str | PathLike[str]) -> Path:
    """Return a path, its ``~`` expanded."""
    if is_url(place):
        raise ValueError(
            f"{os.fspath(place)} is an address; of these only sets in shards (.fiblets, as "
            "`pvfiblets convert --shards` makes them) are read: fetch the file first"
        )
    return Path(place).expanduser()
