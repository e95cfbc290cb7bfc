"""The usable version of an OpenGL context.

The driver's version number counts, except with drivers that report exactly the requested version although they support
later ones: NVIDIA's. VTK asks EGL for OpenGL 3.2, so that without this cards on machines without a display would draw
nothing: every pipeline needs 3.3 at least. Such a context is tested, once: does it compile later GLSL, and has it
the extensions of later versions? Elsewhere the number decides, never the extensions: a driver configured to
show an older version (``MESA_GL_VERSION_OVERRIDE``) still lists those.
"""

from __future__ import annotations

import moderngl

GENEROUS = ("NVIDIA Corporation",)  # vendors whose older contexts have all of later versions

_TAKEN_IN: tuple[tuple[int, tuple[str, ...]], ...] = (
    (330, ("explicit_attrib_location", "sampler_objects", "timer_query")),
    (410, ("tessellation_shader", "gpu_shader5", "separate_shader_objects", "viewport_array")),
    (430, ("compute_shader", "shader_storage_buffer_object", "shader_image_load_store", "multi_draw_indirect",
           "clear_buffer_object", "texture_storage", "program_interface_query")),
    (450, ("direct_state_access", "clip_control", "buffer_storage", "enhanced_layouts")),
    (460, ("shader_draw_parameters", "indirect_parameters")),
)  # fmt: skip
"""ARB extensions that the engine needs, by the version that includes them."""

_known: dict[tuple[str, str], int] = {}


def version_of(ctx: moderngl.Context) -> int:
    """Return the version as a number, 430 for 4.3."""
    told = int(ctx.version_code)
    newest = _TAKEN_IN[-1][0]
    if told >= newest or ctx.info["GL_VENDOR"] not in GENEROUS:
        return told
    key = ctx.info["GL_RENDERER"], ctx.info["GL_VERSION"]
    if key not in _known:
        _known[key] = _tried(ctx, told)
    return _known[key]


def _tried(ctx: moderngl.Context, told: int) -> int:
    found = told
    for version, extensions in _TAKEN_IN:
        if version <= told:
            continue
        if not all(f"GL_ARB_{name}" in ctx.extensions for name in extensions) or not _compiles(ctx, version):
            break
        found = version
    return found


def _compiles(ctx: moderngl.Context, version: int) -> bool:
    head = f"#version {version} core\n"
    try:
        ctx.program(
            vertex_shader=head + "void main() { gl_Position = vec4(0.0); }",
            fragment_shader=head + "out vec4 colour; void main() { colour = vec4(1.0); }",
        ).release()
        if version >= 430:
            block = "layout(std430, binding = 0) buffer Words { uint words[]; };\n"
            body = "layout(local_size_x = 1) in;\nvoid main() { atomicAdd(words[gl_WorkGroupID.x], 1u); }"
            ctx.compute_shader(head + block + body).release()
    except moderngl.Error:
        return False
    return True
