"""Lattice fiblets made by hand from the record's description, without the encoder."""

from types import SimpleNamespace

import numpy as np

from pvfiblets.codec import layout


def distances(points, a, b):
    """Distance of each point from the segment a b."""
    run = b - a
    t = ((points - a) @ run / max(run @ run, 1e-300)).clip(0.0, 1.0)
    return np.linalg.norm(points - a - t[:, None] * run, axis=1)


def fabricate(lines, *, per_fiblet=60, kind=1, halvings=0, low=False, lattice=None, rank_to_id=None):
    """Code polylines as lattice fiblets; kind 4 are plain ones, of the kind WIDE without a box.

    Returns the set as the engine reads it; ``.lines`` are the float64 points it decodes to, ``.starts`` the index
    within its streamline of each fiblet's first point.
    """
    plain = kind == 4
    if plain:
        per_fiblet, kind = min(per_fiblet, layout.PLAIN_POINTS), 3
    lines = [np.asarray(line, float).reshape(-1, 3) for line in lines]
    every = np.concatenate(lines)
    lo, hi = every.min(0), every.max(0)
    top = 2**32 - 1 if low else 65535
    scale = np.maximum(hi - lo, 1e-9) / top
    steps = np.concatenate([np.diff(line, axis=0) for line in lines])
    if lattice is None:
        extent = np.abs(steps).max() if steps.size else 1.0
        lattice = max(extent, 1e-12) / (2.0**20 if plain else {1: 2.5, 2: 15.0, 3: 900.0}[kind])
    lattice = lattice * 2.0**halvings
    edge = lattice * 0.5**halvings
    anchors, decodings, lows, codes, pages, starts = [], [], [], [], [], []
    code_at = point_at = 0
    pieces = []
    for rank, line in enumerate(lines):
        cuts = list(range(0, len(line), per_fiblet))
        pieces += [(rank, a, min(a + per_fiblet, len(line)), len(line)) for a in cuts]
    out = [np.empty_like(line) for line in lines]
    for index, (rank, a, b, n) in enumerate(pieces):
        if index % layout.PAGE == 0:
            pages.append((rank, code_at, point_at))
        base = pages[-1]
        points = lines[rank][a:b]
        q = np.clip(np.rint((points[0] - lo) / scale), 0, top).astype(np.int64)
        anchor = lo + q * scale
        k = np.rint((points - anchor) / edge).astype(np.int64)
        k[0] = 0
        delta = np.diff(k, axis=0)
        box_lo = delta.min(0) if len(delta) else np.zeros(3, np.int64)
        size = delta.max(0) - box_lo + 1 if len(delta) else np.ones(3, np.int64)
        cells = delta - box_lo
        value = cells[:, 0] + size[0] * (cells[:, 1] + size[1] * cells[:, 2])
        width = kind if kind < 3 else 4
        assert plain or value.size == 0 or value.max() < 256**width, "the steps do not fit this kind"
        body = value.astype("<u4").view(np.uint8).reshape(-1, 4)[:, :width].ravel()
        if plain:
            body, shape, step = delta.astype("<i4").view(np.uint8).ravel(), 0, 0
        elif kind == 3 and len(points) > 1:
            body = np.concatenate([box_lo.astype("<i4").view(np.uint8), size[:2].astype("<u4").view(np.uint8), body])
            shape, step = 0, width
        elif kind == 3:
            shape = step = 0
        else:
            assert np.abs(box_lo).max() < 128
            assert size.max() <= 256
            shape = sum((int(v) & 255) << s for v, s in zip(box_lo, (0, 8, 16), strict=True))
            shape |= (int(size[0]) - 1) << 24
            step = int(size[1]) - 1
        high = q >> 16 if low else q
        anchors.append((*high, rank - base[0], int(a == 0), int(b == n)))
        lows.append(q & 65535)
        decodings.append((shape, code_at - base[1], step, point_at - base[2], len(points) - 1))
        codes.append(body)
        code_at += len(body)
        point_at += len(points)
        out[rank][a:b] = anchor + edge * k
        starts.append(a)
    columns = zip(("anchor_x", "anchor_y", "anchor_z", "rank", "begin", "end"), np.array(anchors).T, strict=True)
    words = layout.pack("anchors", **dict(columns))
    columns = zip(("shape", "code", "step", "point", "last"), np.array(decodings).T, strict=True)
    decodings = layout.pack("decoding", cap=halvings, kind=kind, **dict(columns))
    # second round: a capsule needs the next fiblet's decoded anchor, or the streamline's rounded end
    tails = np.array([out[rank][b - 1] - out[rank][a] for rank, a, b, n in pieces if b == n])
    end_scale = max(np.abs(tails).max() / 511.0, 1e-12)
    ends = np.rint(tails / end_scale).astype(np.int64)
    radii, spheres = [], []
    for rank, a, b, n in pieces:
        points = out[rank][a : min(b + 1, n)]
        end = out[rank][a] + ends[rank] * end_scale if b == n else out[rank][b]
        radii.append(distances(points, out[rank][a], end).max())
        spheres.append(np.linalg.norm(end - out[rank][a]) / 2 + radii[-1])
    reach_scale = max(max(radii) / 65534 * 1.0001, 1e-12)
    reaches = np.ceil(np.array(radii) / reach_scale + 0.5).astype(np.uint16)
    n_pages = len(pages)
    pages.append((len(lines), code_at, point_at))
    assert n_pages == -(-len(pieces) // layout.PAGE)
    return SimpleNamespace(
        anchors=words,
        decoding=decodings,
        reach=reaches,
        ends=((ends & 1023) << [0, 10, 20]).sum(1).astype(np.uint32),
        parameters=SimpleNamespace(end_scale=end_scale, largest_radius=1.001 * max(spheres) + 2 * reach_scale),
        codes=np.concatenate(codes) if codes else np.empty(0, np.uint8),
        pages=np.array(pages, np.int64),
        anchors_low=np.array(lows, np.uint16) if low else None,
        rank_to_id=rank_to_id,
        origin=lo,
        anchor_scale=scale,
        step=float(np.linalg.norm(steps, axis=1).mean()) if steps.size else 0.0,
        step_lo=0.0,
        step_hi=0.0,
        lattice=lattice,
        reach_scale=reach_scale,
        per_point={},
        n_fiblets=len(pieces),
        n_points=point_at,
        n_streamlines=len(lines),
        lines=out,
        starts=np.array(starts),
    )
