"""Tubes in float64: where the rays through the pixels' centres enter the union of all segments' capsules."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from .tangents import tangents_at


class Entry(NamedTuple):
    """What every pixel must show, row 0 at the bottom."""

    depth: np.ndarray  # (h, w) window depth, inf where nothing is
    normal: np.ndarray  # (h, w, 3)
    line: np.ndarray  # (h, w)
    place: np.ndarray  # (h, w) index of the point before, plus the part of the segment
    margin: np.ndarray  # (h, w) sine of the angle between surface and ray: 0 on a silhouette
    side: np.ndarray  # (h, w) bool, where the line goes on: no cut, and no round end


def rays(matrix, size):
    """(h, w, 3) points of all pixels' centres on the near plane, and unit directions."""
    w, h = size
    y, x = np.mgrid[:h, :w] + 0.5
    ends = []
    for z in (-1.0, 1.0):
        clip = np.stack([2 * x / w - 1, 2 * y / h - 1, np.full_like(x, z), np.ones_like(x)], -1)
        p = clip @ np.linalg.inv(matrix).T
        ends.append(p[..., :3] / p[..., 3:])
    d = ends[1] - ends[0]
    return ends[0], d / np.linalg.norm(d, axis=-1, keepdims=True)


def dot(a, b):
    return (a * b).sum(-1)


def sphere(o, d, r):
    """Distances at which rays enter and leave a ball around the origin; inf, -inf where they miss."""
    middle = -dot(o, d)
    h = r * r - dot(o, o) + middle**2
    s = np.sqrt(np.maximum(h, 0.0))
    return np.where(h >= 0, middle - s, np.inf), np.where(h >= 0, middle + s, -np.inf)


def capsule(o, d, a, b, r):
    """Distances at which rays enter and leave a capsule: the convex hull of two balls."""
    size = np.linalg.norm(b - a)
    o = o - a
    first, last = sphere(o, d, r)
    if size > 0.0:
        u = (b - a) / size
        other = sphere(o - (b - a), d, r)
        ou, du = o @ u, d @ u
        op, dp = o - ou[..., None] * u, d - du[..., None] * u
        dd = np.maximum(dot(dp, dp), 1e-30)
        middle = -dot(op, dp) / dd
        h = r * r - dot(op, op) + middle**2 * dd
        s = np.sqrt(np.maximum(h, 0.0) / dd)
        t = np.where(h >= 0, middle - s, np.nan), np.where(h >= 0, middle + s, np.nan)
        with np.errstate(invalid="ignore"):
            on = [(ou + v * du >= 0) & (ou + v * du <= size) for v in t]
        first = np.minimum(np.minimum(first, other[0]), np.where(on[0], t[0], np.inf))
        last = np.maximum(np.maximum(last, other[1]), np.where(on[1], t[1], -np.inf))
    return first, last


def entries(lines, radius, matrix, size, planes=()):
    """Return the nearest entry of every pixel's ray that lies in the view volume.

    What planes cut is closed; what the near plane cuts is open: a capsule that a ray enters before it shows nothing.
    """
    o, d = rays(matrix, size)
    found = Entry(
        np.full(o.shape[:2], np.inf), np.zeros(o.shape), np.full(o.shape[:2], -1), np.zeros(o.shape[:2]),
        np.zeros(o.shape[:2]), np.zeros(o.shape[:2], bool),
    )  # fmt: skip
    for number, line in enumerate(lines):
        for k, (a, b) in enumerate(pairwise(line) if len(line) > 1 else [(line[0], line[0])]):
            first, last = capsule(o, d, a, b, radius)
            face = np.zeros(o.shape)
            for plane in np.asarray(planes, float).reshape(-1, 4):
                plane = plane / np.linalg.norm(plane[:3])
                height, rise = o @ plane[:3] + plane[3], d @ plane[:3]
                with np.errstate(divide="ignore", invalid="ignore"):
                    at = -height / rise
                later = (rise > 0) & (at > first)
                face[later] = -plane[:3]
                first = np.where(rise > 0, np.maximum(first, at), first)
                last = np.where(rise < 0, np.minimum(last, at), last)
                last = np.where((rise == 0) & (height < 0), -np.inf, last)
            run = b - a
            hit = np.isfinite(first) & (first <= last)
            p = o + np.where(hit, first, 0.0)[..., None] * d
            clip = np.concatenate([p, np.ones((*p.shape[:2], 1))], -1) @ matrix.T
            with np.errstate(divide="ignore", invalid="ignore"):
                depth = (clip[..., 2] / clip[..., 3] + 1) / 2
            hit &= (clip[..., 3] > 0) & (depth >= 0) & (depth <= 1) & (depth < found.depth)
            if k > 0:  # the ball at a is the end of the segment before
                hit &= (p - a) @ run >= 0
            t = (p - a) @ run / max(run @ run, 1e-300)
            side = (len(line) > 1) & ~face.any(-1) & ((t >= 0) | (k > 0)) & ((t <= 1) | (k < len(line) - 2))
            t = np.clip(t, 0, 1)
            normal = p - a - t[..., None] * run
            normal = np.where(face.any(-1, keepdims=True), face, normal / radius)
            found.depth[hit] = depth[hit]
            found.normal[hit] = normal[hit]
            found.line[hit] = number
            found.place[hit] = (k + t)[hit]
            found.margin[hit] = -dot(normal, d)[hit]
            found.side[hit] = side[hit]
    return found


def smoothed(found, lines, per_fiblet=60):
    """Return the same with the normals of sides perpendicular to the lines' tangents, but at the sharpest bends."""
    there = found.side & np.isfinite(found.depth)
    normal = found.normal.copy()
    tangents = tangents_at(lines, found.line[there], found.place[there], per_fiblet)
    flat = normal[there]
    along = (tangents * flat).sum(1)[:, None]
    turned = flat - tangents * along * np.clip((0.9 - along**2) / 0.3, 0.0, 1.0)
    normal[there] = turned / np.linalg.norm(turned, axis=1)[:, None]
    return found._replace(normal=normal)
