"""Gzipped TrackVis tracks (``.trk.gz``): read by :mod:`pvfiblets.formats.trackvis.trk`, not written.

Writing them is left out on purpose: trx holds more in less space, and can be memory-mapped.
"""

from __future__ import annotations

from pvfiblets.formats.trackvis.trk import info, iter_chunks, read

__all__ = ["info", "iter_chunks", "read"]
