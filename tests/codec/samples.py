"""Lines that codec tests share: plain, noisy, and extreme."""

import numpy as np

from pvfiblets.streamlines import Streamlines


def assert_equal_streamlines(found, wanted):
    """Points, values and members of groups, whatever their order in a group."""
    np.testing.assert_array_equal(found.points, wanted.points)
    np.testing.assert_array_equal(found.offsets, wanted.offsets)
    for kept in ("per_point", "per_streamline", "groups"):
        ours, theirs = getattr(found, kept), getattr(wanted, kept)
        assert ours.keys() == theirs.keys()
        for name in theirs:
            ordered = np.sort if kept == "groups" else np.asarray
            np.testing.assert_array_equal(ordered(ours[name]), ordered(theirs[name]))


def smooth(n=40, points=150, step=0.5, seed=0):
    """Helices and circles of many radii: constant step, slowly turning."""
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(n):
        turn = rng.normal(size=3) * 0.06
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        line = np.empty((points, 3))
        line[0] = rng.uniform(-60, 60, 3)
        for i in range(1, points):
            direction = direction + np.cross(turn, direction) + rng.normal(size=3) * 0.01
            direction /= np.linalg.norm(direction)
            line[i] = line[i - 1] + step * direction
        lines.append(line)
    return Streamlines.from_list(lines)


def noisy(n=40, points=150, step=0.2, degrees=5.0, seed=1):
    """Probabilistic tracking: an independent random turn at every step, at most 18 degrees."""
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(n):
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        line = np.empty((points, 3))
        line[0] = rng.uniform(-60, 60, 3)
        for i in range(1, points):
            kick = rng.normal(size=3) * np.radians(degrees)
            kick *= min(1.0, np.radians(18.0) / np.linalg.norm(kick))
            direction = direction + np.cross(kick, direction)
            direction /= np.linalg.norm(direction)
            line[i] = line[i - 1] + step * direction
        lines.append(line)
    return Streamlines.from_list(lines)


def wandering(n=60, points=40, seed=2):
    """Random walks: every step another length and direction."""
    rng = np.random.default_rng(seed)
    return Streamlines.from_list(
        [np.cumsum(rng.normal(size=(points, 3)), axis=0) + rng.uniform(-50, 50, 3) for _ in range(n)]
    )


def extremes():
    """Stiff and extreme cases by name."""
    rng = np.random.default_rng(3)
    one = Streamlines.from_list
    base = smooth(6, 130)
    points = np.asarray(base.points, np.float64)
    i = np.arange(500)
    return {
        "turns of 180 degrees": one([np.stack([i % 2, 0 * i, 0 * i], 1).astype(float)]),
        "exactly straight": one([np.stack([i * 0.5, 0 * i, 0 * i], 1)]),
        "straight, backwards": one([np.stack([-i * 0.5, 0 * i, 0 * i], 1)]),
        "helix near Nyquist": one([np.stack([np.cos(3.1384 * i), np.sin(3.1384 * i), 0.01 * i], 1)]),
        "zero-length steps": one([np.repeat(rng.normal(size=(30, 3)), 4, axis=0)]),
        "all points the same": one([np.full((100, 3), 7.25)]),
        "one-point streamlines": one([rng.normal(size=(1, 3)) for _ in range(100)]),
        "two-point streamlines": one([rng.normal(size=(2, 3)) for _ in range(500)]),
        "no streamlines": Streamlines(np.empty((0, 3)), [0]),
        "only empty streamlines": Streamlines(np.empty((0, 3)), [0, 0, 0]),
        "empty among others": Streamlines(points[:10], [0, 0, 4, 4, 10, 10]),
        "a million mm away": Streamlines(points + 1e6, base.offsets),
        "ten million mm away, negative": Streamlines(points - 1e7, base.offsets),
        "float32 a million mm away": Streamlines((points - 1e6).astype(np.float32), base.offsets),
        "a millionth of a mm": Streamlines(points * 1e-6, base.offsets),
        "a million mm in size": Streamlines(points * 1e6, base.offsets),
        "steps from 1e-6 to 1e6": one(
            [np.cumsum(10.0 ** rng.uniform(-6, 6, (400, 1)) * rng.normal(size=(400, 3)), axis=0)]
        ),
        "one long step": one([np.concatenate([np.zeros((1, 3)), points[:80] + 1e5])]),
        "denormal coordinates": one([rng.normal(size=(70, 3)) * 1e-310]),
        "coordinates with denormal squares": one([np.cumsum(rng.normal(size=(70, 3)), axis=0) * 1e-170]),
        "huge coordinates": one([rng.normal(size=(70, 3)) * 1e30]),
        "flat": Streamlines(points * [1, 1, 0], base.offsets),
    }
