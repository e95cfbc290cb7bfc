"""Depth of field and tones once more, in NumPy: written from the formulas, pixel by pixel."""

import numpy as np


def perspective(size, angle=30.0, near=10.0, far=1000.0):
    """Return the projection of a picture of (width, height) pixels."""
    width, height = size
    scale = 1.0 / np.tan(np.radians(angle) / 2.0)
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = scale * height / width, scale
    matrix[2, 2], matrix[2, 3] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
    matrix[3, 2] = -1.0
    return matrix


def parallel(size, tall=100.0, near=10.0, far=1000.0):
    """Return the projection of a picture of (width, height) pixels that shows so many mm of height."""
    width, height = size
    matrix = np.eye(4)
    matrix[0, 0], matrix[1, 1] = 2.0 / tall * height / width, 2.0 / tall
    matrix[2, 2], matrix[2, 3] = -2.0 / (far - near), -(far + near) / (far - near)
    return matrix


def depths_of(projection, distances):
    """Return window depths of distances (mm) from the viewer's plane; infinity is the background."""
    with np.errstate(invalid="ignore"):
        z = -np.asarray(distances, np.float64)
        depth = 0.5 + 0.5 * (projection[2, 2] * z + projection[2, 3]) / (projection[3, 2] * z + projection[3, 3])
    return np.where(np.isinf(z), 1.0, depth)


def radii_of(projection, distances, *, rows, focus, aperture, widest):
    """Return the radius (pixels) of each disc: the cone of light through the lens, cut by the plane in focus.

    In a parallel view the cone's angle is that of the lens seen from the plane in focus.
    """
    distances = np.asarray(distances, np.float64)
    per_mm = rows / 2.0 * projection[1, 1]  # at distance 1
    with np.errstate(invalid="ignore"):
        if projection[3, 2] != 0.0:
            wide = np.where(np.isinf(distances), 1.0, np.abs(distances - focus) / distances) * aperture
            radius = 0.5 * wide * per_mm / focus
        else:
            radius = 0.5 * aperture / focus * np.abs(distances - focus) * per_mm
    return np.minimum(radius, widest)


def covered(radius, apart):
    """Return the share of pixels so far from a disc's centre that it covers."""
    return np.clip(np.maximum(radius, 0.5) + 0.5 - apart, 0.0, 1.0)


def area(radius):
    """Return how many pixels a disc covers."""
    side = int(np.ceil(radius)) + 2
    y, x = np.mgrid[-side : side + 1, -side : side + 1]
    return covered(radius, np.hypot(x, y)).sum()


def gathered(colours, depths, radii, shade=None):
    """Return the picture out of focus, float64: each pixel looks at all others that may reach it."""
    reach = int(np.ceil(radii.max())) + 1
    height, width = depths.shape
    light = np.array(colours, np.float64)
    if shade is not None:
        light[..., :3] *= shade[..., None]
    known = {radius: area(radius) for radius in np.unique(radii)}
    areas = np.vectorize(known.get)(radii)
    y, x = np.mgrid[:height, :width]
    result = np.empty_like(light)
    for row in range(height):
        for column in range(width):
            near = slice(max(row - reach, 0), row + reach + 1), slice(max(column - reach, 0), column + reach + 1)
            apart = np.hypot(y[near] - row, x[near] - column)
            nearer = depths[near] < depths[row, column]
            front = np.where(nearer, covered(radii[near], apart) / areas[near], 0.0)
            back = np.where(nearer, 0.0, covered(radii[row, column], apart) / areas[row, column])
            if radii[row, column] <= 0.5:
                back = np.where(apart == 0.0, 1.0, 0.0)
            ahead = (front[..., None] * light[near]).sum((0, 1))
            behind = (back[..., None] * light[near]).sum((0, 1)) / back.sum()
            result[row, column] = ahead + (1.0 - front.sum()) * behind if front.sum() < 1.0 else ahead / front.sum()
    return result


def toned(colours, *, operator="none", exposure=1.0, white=None, brightness=0.0, contrast=1.0, gamma=1.0):
    """Return colours (in 0 to 1, alpha last and kept) as the formulas change them."""
    x = exposure * np.asarray(colours, np.float64)[..., :3]
    if operator == "reinhard":
        white = exposure if white is None else white
        x = x * (1 + x / white**2) / (1 + x)
    elif operator == "exponential":
        x = 1 - np.exp(-x)
    elif operator == "aces":
        x = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)
    elif operator == "hable":
        white = 11.2 if white is None else white
        a, b, c, d, e, f = 0.15, 0.50, 0.10, 0.20, 0.02, 0.30  # Hable's own letters
        x, top = ((v * (a * v + c * b) + d * e) / (v * (a * v + b) + d * f) - e / f for v in (x, white))
        x = x / top
    x = np.clip((x - 0.5) * contrast + 0.5 + brightness, 0.0, 1.0) ** (1 / gamma)
    return np.concatenate([x, np.asarray(colours, np.float64)[..., 3:]], axis=-1)
