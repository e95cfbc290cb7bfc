"""A view as the shaders' uniform block ``Frame``, computed in float64.

Positions reach the shader as integers (anchors) relative to a reference anchor near the camera's target, and the
matrix is composed with that reference in float64: float32 then rounds relative to the visible part, not to the data's
place in the world. ``shaders/frame/blocks.glsl`` explains the symbols.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from .gl.uniform_struct import Field, UniformStruct
from .view import Style, View

FAR_SIZE = 4.0  # pixels up to which a fiblet is drawn as one segment (paper: Schertzer et al. 2022, section 3.4.4).

FRAME_BLOCK = UniformStruct(
    "Frame",
    Field("window_from_local", "mat4", "(X, Y, Z, W) of (local mm, 1)"),
    Field("view_planes", "vec4[6]", "left, right, bottom, top, near, far; moved outwards"),
    Field("reference", "uvec3", "anchor integers of local 0"),
    Field("half_line_width", "float", "pixels; 0 for lines of one pixel, which have no brush"),
    Field("viewport", "vec2", "width and height in pixels"),
    Field("line_reach", "float", "mm, over W, from a wide line's axis to its edge"),
    Field("plane_rounding", "float", "mm inside the planes from where on nothing can round outside"),
    Field("most_pixels_per_mm", "float", "times W, anywhere in the picture"),
    Field("w_per_mm", "float", "change of W, at most"),
    Field("segment_deviation", "float", "pixels of deviation up to which a fiblet is one segment"),
    Field("segment_size", "float", "pixels of size up to which it is"),
)

Array = npt.NDArray[np.float64]

EPSILON = float(np.finfo(np.float32).eps)
CORNERS = np.array(list(np.ndindex(2, 2, 2)))  # corners of a box from 0 to 1


def reference_anchor(matrix: Array, origin: Array, scale: Array, top: int) -> npt.NDArray[np.int64]:
    """Choose the anchor position that rounding is made relative to."""
    # The nearest point in front of the camera, along its middle ray, inside the box of all anchors.
    middle = np.full(3, top // 2, np.int64)
    try:
        ends = np.linalg.solve(matrix, np.array([[0.0, 0.0], [0.0, 0.0], [-1.0, 1.0], [1.0, 1.0]]))
    except np.linalg.LinAlgError:
        return middle  # a flattening matrix shows no depth: any reference serves
    if not np.isfinite(ends).all() or np.any(ends[3] == 0.0):
        return middle
    # Three numbers at a time: NumPy's calls would take ten times as long.
    axes = list(zip(*(ends[:3] / ends[3]).T.tolist(), origin.tolist(), scale.tolist(), strict=True))
    enter, leave = 0.0, 1.0
    for near, far, low, one in axes:
        if (ray := far - near) != 0.0:
            t = (low - near) / ray, (low + top * one - near) / ray
            enter, leave = max(enter, min(t)), min(leave, max(t))
    share = enter if enter <= leave else min(max((enter + leave) / 2, 0.0), 1.0)
    steps = [(near + (far - near) * share - low) / one if one > 0.0 else 0.0 for near, far, low, one in axes]
    if not all(map(math.isfinite, steps)):
        return middle
    return np.array([round(min(max(step, 0.0), float(top))) for step in steps], np.int64)


LocalFrame: TypeAlias = tuple[npt.NDArray[np.int64], Array, Array]


def local_frame(view: View, origin: Array, scale: Array, top: int) -> LocalFrame:
    """Choose local coordinates and compose what leads into and out of them."""
    return _local_frame(view.model_view_projection.tobytes(), origin.tobytes(), scale.tobytes(), top)


@lru_cache(maxsize=16)
def _local_frame(matrix: bytes, origin_: bytes, scale_: bytes, top: int) -> LocalFrame:
    """Return the local frame, cached by the bytes of its arrays: a picture needs it several times, at 100 µs each."""
    projection, origin, scale = np.frombuffer(matrix).reshape(4, 4), np.frombuffer(origin_), np.frombuffer(scale_)
    reference = reference_anchor(projection, origin, scale, top)
    to_data = np.eye(4)
    to_data[:3, 3] = origin + scale * reference
    to_clip = projection @ to_data
    to_clip /= np.abs(to_clip).max() or 1.0
    for array in (reference, to_data, to_clip):
        array.flags.writeable = False
    return reference, to_data, to_clip


def segment_pixels(view: View, origin: Array, scale: Array, top: int, length: float) -> float:
    """Estimate how many pixels a segment of some length (mm) takes where the anchors come nearest to the camera."""
    # At least 4, and at most 100: of longer ones few are in the picture at a time.
    reference, _, (x, y, _, w) = local_frame(view, origin, scale, top)
    corners = (CORNERS * top - reference) * scale
    nearest = float((corners @ w[:3] + w[3]).min())
    across = float(np.hypot(_length(x[:3]) * view.size[0], _length(y[:3]) * view.size[1])) / 2
    return min(max(length * across / nearest, 4.0), 100.0) if nearest > 0.0 else 100.0


def frame_block(view: View, style: Style, origin: Array, scale: Array, top: int) -> tuple[bytes, float]:
    """Pack the ``Frame`` uniform block (std140)."""
    reference, _, local = local_frame(view, origin, scale, top)
    width, height = view.size
    half = style.half_width
    guard = 1.0 + 2.0 * half / np.array(view.size, np.float64)
    x, y, z, w = local
    planes = np.array([guard[0] * w + x, guard[0] * w - x, guard[1] * w + y, guard[1] * w - y, w + z, w - z])
    lengths = np.linalg.norm(planes[:, :3], axis=1)
    planes /= np.where(lengths > 0.0, lengths, 1.0)[:, None]
    # Three products and their sum in float32 err by no more than this share of the largest of them.
    rounding, extent = 4.0 * EPSILON, _length(top * scale)
    planes[:, 3] += rounding * (extent + np.abs(planes[:, 3]))
    slack = rounding * (extent + np.abs(planes[:, 3]).max())
    planes[:, 3] += style.thickness
    window = np.array([width / 2 * (x + w), height / 2 * (y + w), (z + w) / 2, w])

    pixels_per_mm, w_per_mm = _pixels_per_length(window, view.size)
    block = FRAME_BLOCK.pack(
        window_from_local=window,
        view_planes=planes,
        reference=reference,
        half_line_width=half,
        viewport=view.size,
        line_reach=half * _length_per_pixel(local, view.size),
        plane_rounding=2.0 * slack,
        most_pixels_per_mm=pixels_per_mm,
        w_per_mm=w_per_mm,
        segment_deviation=style.detail,
        segment_size=FAR_SIZE,
    )
    # Distances to the planes are least at a corner of the anchors' box.
    corners = (CORNERS * top - reference) * scale
    least = float((corners @ planes[:, :3].T + planes[:, 3]).min())
    return block, least - 4.0 * slack


def _length(vector: Array) -> float:
    """Return what `numpy.linalg.norm` does, to the bit, in a fifth of its time."""
    return math.sqrt(vector.dot(vector))


def _length_per_pixel(local: Array, size: tuple[int, int]) -> float:
    """Return mm that a pixel takes at constant depth, over W; 0 for a matrix that shows no depth."""
    try:
        inverse = np.linalg.inv(local)
    except np.linalg.LinAlgError:
        return 0.0
    across, up = inverse[:3, :2].T * (2.0 / np.array(size, np.float64))[:, None]
    return _length(across) + _length(up)


def _pixels_per_length(window: Array, size: tuple[int, int]) -> tuple[float, float]:
    """Return pixels times W that a mm takes at most anywhere in the picture, and the change of W per mm."""
    across = [
        _length(row[:3] - place * window[3, :3])
        for row, pixels in zip(window[:2], size, strict=True)
        for place in (0.0, pixels)
    ]
    return max(across), _length(window[3, :3])
