"""Compression for studies: they are of coding, and small sets are coded for them too."""

from __future__ import annotations

from functools import partial

from pvfiblets.codec.encoding.compress import compress as _compress

compress = partial(_compress, exact=False)  # as `pvfiblets.compress`, without its default for small sets
