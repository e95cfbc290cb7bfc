"""OpenGL's functions and integers that moderngl lacks, as :mod:`.moderngl_extras` calls and asks for them."""

from __future__ import annotations

import ctypes
from typing import Any

_UINT, _INT, _POINTER = ctypes.c_uint, ctypes.c_int, ctypes.c_void_p

# Name: types of the arguments, and requirements beyond OpenGL 3.3.
FUNCTIONS: dict[str, tuple[tuple[Any, ...], int | str]] = {
    "glActiveTexture": ((_UINT,), 330),
    "glAttachShader": ((_UINT, _UINT), 330),
    "glBeginQuery": ((_UINT, _UINT), 330),
    "glBindBuffer": ((_UINT, _UINT), 330),
    "glBindFramebuffer": ((_UINT, _UINT), 330),
    "glBindTexture": ((_UINT, _UINT), 330),
    "glBindTextures": ((_UINT, _INT, _POINTER), 440),
    "glBindVertexArray": ((_UINT,), 330),
    "glBlitFramebuffer": ((*[_INT] * 8, _UINT, _UINT), 330),
    "glClearBufferfv": ((_UINT, _INT, _POINTER), 330),
    "glClearBufferuiv": ((_UINT, _INT, _POINTER), 330),
    "glClearBufferSubData": ((_UINT, _UINT, *[ctypes.c_ssize_t] * 2, _UINT, _UINT, _POINTER), 430),
    "glClientWaitSync": ((_POINTER, _UINT, ctypes.c_uint64), 330),
    "glCompileShader": ((_UINT,), 330),
    "glCreateProgram": ((), 330),
    "glCreateShader": ((_UINT,), 330),
    "glDeleteProgram": ((_UINT,), 330),
    "glDeleteShader": ((_UINT,), 330),
    "glDeleteSync": ((_POINTER,), 330),
    "glDeleteTextures": ((_INT, _POINTER), 330),
    "glDeleteVertexArrays": ((_INT, _POINTER), 330),
    "glDrawMeshTasksEXT": ((_UINT, _UINT, _UINT), "GL_EXT_mesh_shader"),
    "glDrawMeshTasksNV": ((_UINT, _UINT), "GL_NV_mesh_shader"),
    "glEndQuery": ((_UINT,), 330),
    "glFenceSync": ((_UINT, _UINT), 330),
    "glFramebufferTexture2D": ((_UINT, _UINT, _UINT, _UINT, _INT), 330),
    "glFramebufferTextureLayer": ((_UINT, _UINT, _UINT, _INT, _INT), 330),
    "glGenTextures": ((_INT, _POINTER), 330),
    "glGenVertexArrays": ((_INT, _POINTER), 330),
    "glGetActiveUniform": ((_UINT, _UINT, _INT, _POINTER, _POINTER, _POINTER, ctypes.c_char_p), 330),
    "glGetFramebufferAttachmentParameteriv": ((_UINT, _UINT, _UINT, _POINTER), 330),
    "glGetInteger64v": ((_UINT, _POINTER), 330),
    "glGetProgramInfoLog": ((_UINT, _INT, _POINTER, ctypes.c_char_p), 330),
    "glGetProgramiv": ((_UINT, _UINT, _POINTER), 330),
    "glGetShaderInfoLog": ((_UINT, _INT, _POINTER, ctypes.c_char_p), 330),
    "glGenQueries": ((_INT, _POINTER), 330),
    "glDeleteQueries": ((_INT, _POINTER), 330),
    "glQueryCounter": ((_UINT, _UINT), 330),
    "glGetQueryObjectui64v": ((_UINT, _UINT, _POINTER), 330),
    "glGetShaderiv": ((_UINT, _UINT, _POINTER), 330),
    "glGetUniformBlockIndex": ((_UINT, ctypes.c_char_p), 330),
    "glGetUniformLocation": ((_UINT, ctypes.c_char_p), 330),
    "glLinkProgram": ((_UINT,), 330),
    "glShaderSource": ((_UINT, _INT, _POINTER, _POINTER), 330),
    "glTexBuffer": ((_UINT, _UINT, _UINT), 330),
    "glTexImage2D": ((_UINT, _INT, _INT, _INT, _INT, _INT, _UINT, _UINT, _POINTER), 330),
    "glTexParameteri": ((_UINT, _UINT, _INT), 330),
    "glUniform1i": ((_INT, _INT), 330),
    "glUniformBlockBinding": ((_UINT, _UINT, _UINT), 330),
    "glUseProgram": ((_UINT,), 330),
    **{
        f"glProgramUniform{n}{kind}v": ((_UINT, _INT, _INT, _POINTER), 410)
        for n in range(1, 5)
        for kind in ("f", "i", "ui")
    },
}

RETURNS: dict[str, Any] = {
    "glClientWaitSync": _UINT, "glCreateProgram": _UINT, "glCreateShader": _UINT, "glFenceSync": _POINTER,
    "glGetUniformBlockIndex": _UINT, "glGetUniformLocation": _INT,
}  # fmt: skip

INTEGERS: dict[str, tuple[int, int | str]] = {
    "GL_DRAW_FRAMEBUFFER_BINDING": (0x8CA6, 330),
    "GL_READ_FRAMEBUFFER_BINDING": (0x8CAA, 330),
    "GL_SAMPLES": (0x80A9, 330),
    "GL_MAX_TEXTURE_BUFFER_SIZE": (0x8C2B, 330),
    "GL_MAX_TEXTURE_SIZE": (0x0D33, 330),
    "GL_MAX_UNIFORM_BLOCK_SIZE": (0x8A30, 330),
    "GL_MAX_GEOMETRY_OUTPUT_VERTICES": (0x8DE0, 330),
    "GL_MAX_GEOMETRY_TOTAL_OUTPUT_COMPONENTS": (0x8DE1, 330),
    "GL_MAX_GEOMETRY_TEXTURE_IMAGE_UNITS": (0x8C29, 330),
    "GL_MAX_GEOMETRY_SHADER_INVOCATIONS": (0x8E5A, 400),
    "GL_MAX_PATCH_VERTICES": (0x8E7D, 400),
    "GL_MAX_TESS_GEN_LEVEL": (0x8E7E, 400),
    "GL_MAX_TESS_CONTROL_OUTPUT_COMPONENTS": (0x8E83, 400),
    "GL_MAX_TESS_PATCH_COMPONENTS": (0x8E84, 400),
    "GL_MAX_TESS_CONTROL_TOTAL_OUTPUT_COMPONENTS": (0x8E85, 400),
    "GL_MAX_TESS_CONTROL_TEXTURE_IMAGE_UNITS": (0x8E81, 400),
    "GL_MAX_TESS_EVALUATION_TEXTURE_IMAGE_UNITS": (0x8E82, 400),
    "GL_MAX_SHADER_STORAGE_BLOCK_SIZE": (0x90DE, 430),
    "GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS": (0x90DD, 430),
    "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS": (0x90DB, 430),
    "GL_MAX_COMPUTE_SHARED_MEMORY_SIZE": (0x8262, 430),
    "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS": (0x90EB, 430),
    "GL_MAX_MESH_OUTPUT_VERTICES_NV": (0x9538, "GL_NV_mesh_shader"),
    "GL_MAX_MESH_OUTPUT_PRIMITIVES_NV": (0x9539, "GL_NV_mesh_shader"),
    "GL_MAX_MESH_TOTAL_MEMORY_SIZE_NV": (0x9536, "GL_NV_mesh_shader"),
    "GL_MAX_MESH_WORK_GROUP_INVOCATIONS_NV": (0x95A2, "GL_NV_mesh_shader"),
    "GL_MAX_TASK_TOTAL_MEMORY_SIZE_NV": (0x9537, "GL_NV_mesh_shader"),
    "GL_MAX_TASK_OUTPUT_COUNT_NV": (0x953A, "GL_NV_mesh_shader"),
    "GL_MAX_TASK_WORK_GROUP_INVOCATIONS_NV": (0x95A3, "GL_NV_mesh_shader"),
    "GL_MAX_DRAW_MESH_TASKS_COUNT_NV": (0x953D, "GL_NV_mesh_shader"),
    "GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX": (0x9049, "GL_NVX_gpu_memory_info"),
    "GL_VBO_FREE_MEMORY_ATI": (0x87FB, "GL_ATI_meminfo"),
    "GL_SUBGROUP_SIZE_KHR": (0x9532, "GL_KHR_shader_subgroup"),
    "GL_SUBGROUP_SUPPORTED_STAGES_KHR": (0x9533, "GL_KHR_shader_subgroup"),
    "GL_SUBGROUP_SUPPORTED_FEATURES_KHR": (0x9534, "GL_KHR_shader_subgroup"),
}
"""Limits of :meth:`.GLExtras.get_integer`: enum, and least version (330 is 3.3) or extension."""
