// Task and mesh shaders by either of two extensions: GL_NV_mesh_shader, or GL_EXT_mesh_shader (OpenGL's form of Vulkan's). What
// differs between them stands here, in fiblets/mesh/payload.glsl and in fiblets/mesh/outputs.glsl. To be included first.

#if FEATURE_MESH_EXT
#extension GL_EXT_mesh_shader : require
#else
#extension GL_NV_mesh_shader : require
#endif
