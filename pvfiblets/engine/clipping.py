"""The caller's clip planes: the uniform block ``ClipPlanes``, whose symbols ``shaders/frame/clip_planes.glsl`` has.

Planes cut before the nearest segment is chosen, so a cut reveals the lines behind it. The cull pass drops fiblets
beyond a plane and separates fiblets that a plane touches from the others, which are drawn by the same programs as in a
view without planes. A segment that crosses is shortened to its kept part, and the pixels of a wide line's brush beyond
a plane are left out: no pixel shows, or stands for, a position that a plane cuts away.
"""

from __future__ import annotations

import numpy as np

from .frame import Array, local_frame
from .gl.uniform_struct import Field, UniformStruct
from .view import MAX_CLIP_PLANES, View

CLIP_PLANES_BLOCK = UniformStruct(
    "ClipPlanes",
    Field("clip_planes", f"vec4[{MAX_CLIP_PLANES}]", "(n, d)"),
    Field("clip_tilts", f"vec2[{MAX_CLIP_PLANES}]", "tilt of each"),
    Field("clip_brushes", f"float[{MAX_CLIP_PLANES}]", "its length times half a line's width, 0 for thin lines"),
    Field("clip_plane_count", "int", "of clip_planes"),
    Field("clip_rounding", "float", "mm that rounding may cost a height"),
)
_HUGE = 1e30  # in float32, and so is its double


def clip_planes_block(
    view: View, half_width: float, origin: Array, scale: Array, top: int, reach: float
) -> bytes | None:
    """Pack the ``ClipPlanes`` uniform block (std140) with the planes that matter."""
    planes = np.asarray(view.clip_planes, np.float64)
    if not len(planes):
        return None
    reference, to_data, to_clip = local_frame(view, origin, scale, top)
    local = _normalised(planes) @ to_data
    tilts = _tilts(local, to_clip, view.size)
    brush = half_width * np.linalg.norm(tilts, axis=1)
    slope = float(np.linalg.norm(to_clip[3, :3]))
    corners = (np.array(list(np.ndindex(2, 2, 2))) * top - reference) * scale
    heights = corners @ local[:, :3].T + local[:, 3]
    w = max(float((corners @ to_clip[3, :3] + to_clip[3, 3]).max()) + 2 * reach * slope, 0.0)
    # Three products and their sum in float32 err by no more than this share of the largest of them.
    slack = 4.0 * np.finfo(np.float32).eps * (np.linalg.norm(top * scale) + np.abs(local[:, 3]))
    # A sphere's centre lies between anchors, hence in their box.
    near = heights.min(axis=0) < reach + 4.0 * slack + w * brush
    if not near.any():
        return None
    return CLIP_PLANES_BLOCK.pack(
        clip_planes=np.clip(local[near], -_HUGE, _HUGE),
        clip_tilts=np.clip(tilts[near], -_HUGE, _HUGE),
        clip_brushes=np.clip(brush[near], -_HUGE, _HUGE),
        clip_plane_count=int(near.sum()),
        clip_rounding=min(slack[near].max(), _HUGE),
    )


def _normalised(planes: Array) -> Array:
    """Scale to normals of length one; a plane without a normal keeps everything or nothing and stays as it is."""
    with np.errstate(over="ignore"):
        planes = planes / np.maximum(np.abs(planes[:, :3]).max(axis=1), np.finfo(float).tiny)[:, None]
    lengths = np.linalg.norm(planes[:, :3], axis=1)
    scaled: Array = planes / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    return np.clip(scaled, -_HUGE, _HUGE)


def _tilts(local: Array, to_clip: Array, size: tuple[int, int]) -> Array:
    """Return (k, 2): change of (height / clip w) per pixel to the right and upwards, at constant depth."""
    try:
        moved = local @ np.linalg.inv(to_clip)
    except np.linalg.LinAlgError:
        return np.zeros((len(local), 2))  # a flattening matrix: brushes stay whole
    tilts: Array = moved[:, :2] * (2.0 / np.array(size, np.float64))
    return tilts
