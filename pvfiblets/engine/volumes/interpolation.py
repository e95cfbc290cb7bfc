"""Whether a graphics card interpolates between voxels as exactly as shaders do.

OpenGL leaves it to the hardware how finely a place between two texels is told, and to how many bits a mean is rounded.
Cards take 8 bits of the place, and round means of 16-bit texels to 16 bits: values lie on stairs of 1/256 of what
neighbours differ by, surfaces and their normals show them, and tables of opacity that are steep multiply them.
"""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
import numpy.typing as npt

from ..gl.bindings import VOLUMES
from ..gl.moderngl_extras import GLExtras
from ..gl.passes import nowhere

PLACES = 509
TEXELS: dict[str, tuple[npt.NDArray[Any], float]] = {
    "f1": (np.array([100, 101], np.uint8), 255.0),
    "nu2": (np.array([1000, 1001], np.uint16), 65535.0),
    "f4": (np.array([0.0, 1.0], np.float32), 1.0),
}
"""Two of each kind, and what takes what a shader reads to their values."""

LARGEST_ERROR = 1e-3  # of what the texels differ by: between the 1/512 of 8 bits, and what shaders do

SOURCE = """
#version 330
uniform sampler3D voxels;
out float value;
void main() {
    float place = 0.5 + float(gl_VertexID) / float(PLACES - 1);
    value = textureLod(voxels, vec3(0.5 * place, 0.5, 0.5), 0.0).x;
}
""".replace("PLACES", str(PLACES))

_known: dict[tuple[str, str, str], bool] = {}


def interpolates_finely(ctx: moderngl.Context, gl: GLExtras, kind: str) -> bool:
    """Try it, once for each driver."""
    key = (ctx.info["GL_RENDERER"], ctx.info["GL_VERSION"], kind)
    if key not in _known:
        texels, scale = TEXELS[kind]
        texture = ctx.texture3d((2, 1, 1), 1, texels.tobytes(), alignment=1, dtype=kind)
        texture.filter = moderngl.LINEAR, moderngl.LINEAR
        program = ctx.program(vertex_shader=SOURCE, varyings=("value",))
        program["voxels"] = VOLUMES["voxels"]
        told = ctx.buffer(reserve=4 * PLACES)
        array = ctx.vertex_array(program, [])
        try:
            texture.use(VOLUMES["voxels"])
            with nowhere(ctx, gl):
                array.transform(told, moderngl.POINTS, vertices=PLACES)
            found = np.frombuffer(told.read(), "f4") * scale
        finally:
            for made in (array, told, program, texture):
                made.release()
        wanted = float(texels[0]) + np.arange(PLACES) / (PLACES - 1.0)
        _known[key] = bool(np.abs(found - wanted).max() < LARGEST_ERROR)
    return _known[key]
