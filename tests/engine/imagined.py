"""Sets of fiblets of which only the numbers are there."""

from types import SimpleNamespace

import numpy as np

from pvfiblets.codec import layout


def imagined(n_fiblets, codes, points, streamlines=1000, **more):
    """A set of which only the numbers are there: that many fiblets, with so many bytes of codes and points each."""
    starts = np.minimum(np.arange(-(-n_fiblets // layout.PAGE) + 1) * layout.PAGE, n_fiblets)
    ranks = starts * streamlines // n_fiblets
    ranks[-1] = streamlines
    columns = {"anchors": 2, "decoding": 3, "anchors_low": 3}
    arrays = {name: np.broadcast_to(np.zeros(width, np.uint32), (n_fiblets, width)) for name, width in columns.items()}
    return SimpleNamespace(
        pages=np.stack([ranks, codes * starts, points * starts], axis=1), n_fiblets=n_fiblets, per_point={},
        rank_to_id=None, reach=np.broadcast_to(np.uint16(0), n_fiblets), ends=np.zeros(streamlines, np.uint32),
        n_points=int(points) * n_fiblets, **(arrays | {"anchors_low": None} | more),
    )  # fmt: skip
