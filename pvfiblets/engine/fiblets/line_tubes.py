"""Tubes of a radius in millimetres: the uniform block ``Tubes``, computed in float64.

``shaders/frame/tubes.glsl`` says what the symbols are.

A pixel of a tube is where the ray through the pixel's centre enters the body
(``shaders/fiblets/segments/line_tube.glsl``). Rays are described in local millimetres, by what a step of one pixel
moves them: a shader then begins each ray beside the segment that it is tested against, and float32 rounds relative to
the tube, not to its distance from the camera.
"""

from __future__ import annotations

import numpy as np

from ..frame import Array, local_frame
from ..gl.uniform_struct import Field, UniformStruct
from ..view import View

TUBES_BLOCK = UniformStruct(
    "Tubes",
    Field("tube_radius", "float", "r"),
    Field("tube_w_reach", "float", "change of W over r, at most"),
    Field("tube_near_w", "float", "W of the near plane or less; 0 if unknown"),
    Field("tube_perspective", "float", "1 in perspective, 0 in a parallel view"),
    Field("tube_ray", "vec3", "D_0"),
    Field("tube_ray_x", "vec3", "D_x"),
    Field("tube_ray_y", "vec3", "D_y"),
    Field("tube_eye", "vec3", "E"),
)


def tubes_block(view: View, radius: float, origin: Array, scale: Array, top: int) -> bytes:
    """Pack the ``Tubes`` uniform block (std140)."""
    _, _, local = local_frame(view, origin, scale, top)
    width, height = view.size
    x, y, z, w = local
    window = np.array([width / 2 * (x + w), height / 2 * (y + w), (z + w) / 2, w])
    slope = float(np.linalg.norm(w[:3]))
    perspective = slope > 0.0
    along = w if perspective else window[2]
    eye, rays = np.zeros(3), np.zeros((3, 3))
    try:
        inverse = np.linalg.inv(np.array([window[0, :3], window[1, :3], along[:3]]))
    except np.linalg.LinAlgError:
        inverse = rays
    if np.isfinite(inverse).all():
        rays = inverse.T[[2, 0, 1]]
        if perspective:
            eye = -inverse @ window[[0, 1, 3], 3]
    return TUBES_BLOCK.pack(
        tube_radius=radius,
        tube_w_reach=radius * slope,
        tube_near_w=_least_w(window, perspective),
        tube_perspective=float(perspective),
        tube_ray=rays[0],
        tube_ray_x=rays[1],
        tube_ray_y=rays[2],
        tube_eye=eye,
    )


def _least_w(window: Array, perspective: bool) -> float:
    """Return W of the near plane, below which nothing shows; 0 where it changes along that plane."""
    z, w = window[2], window[3]
    if not perspective:
        return 0.5 * float(w[3])
    share = float(z[:3] @ w[:3] / (w[:3] @ w[:3]))
    if share <= 0.0 or np.abs(z[:3] - share * w[:3]).max() > 1e-9 * np.abs(z[:3]).max():
        return 0.0
    return max(0.999 * float(w[3] - z[3] / share), 0.0)
