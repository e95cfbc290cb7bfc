// What a fragment stage behind a mesh stage asks for: what it is handed primitive by primitive. NVIDIA's compiler knows the word for it,
// and refuses the extension by its name in this stage ("not supported in profile gp5fp"), where Khronos' one wants it: `enable` warns only.

#if FEATURE_MESH_EXT
#extension GL_EXT_mesh_shader : require
#else
#extension GL_NV_mesh_shader : enable
#endif
