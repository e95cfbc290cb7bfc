// What a mesh stage writes: vertices, the lines or triangles between them, and, primitive by primitive, what the fragments are
// handed (fiblets/hardware_raster/varyings.glsl). Tests put storage buffers in the place of this file and run the same stages as compute
// shaders.
//
// put_counts comes first, from all invocations alike: GL_EXT_mesh_shader makes room by it.

#if FEATURE_MESH_EXT
#define VARYING perprimitiveEXT out
#else
#define VARYING perprimitiveNV out
#endif
#define EACH []
#define TO(name) name[varying_primitive]

uint varying_primitive;

#include "fiblets/hardware_raster/write_varyings.glsl"

void put_varyings(uint primitive, Varyings varyings, ClippedSegment piece, vec3 from, vec3 to) {
    varying_primitive = primitive;
    write_varyings(varyings, piece, from, to);
}

#if FEATURE_MESH_EXT
void put_counts(uint vertices, uint primitives) { SetMeshOutputsEXT(vertices, primitives); }

void put_vertex(uint vertex, vec4 at) { gl_MeshVerticesEXT[vertex].gl_Position = at; }

#if FEATURE_WIDE_LINES
void put_triangle(uint primitive, uvec3 vertices) { gl_PrimitiveTriangleIndicesEXT[primitive] = vertices; }
#else
void put_line(uint primitive, uvec2 vertices) { gl_PrimitiveLineIndicesEXT[primitive] = vertices; }
#endif
#else
void put_counts(uint vertices, uint primitives) { gl_PrimitiveCountNV = primitives; }

void put_vertex(uint vertex, vec4 at) { gl_MeshVerticesNV[vertex].gl_Position = at; }

void put_triangle(uint primitive, uvec3 vertices) {
    gl_PrimitiveIndicesNV[3u * primitive] = vertices.x;
    gl_PrimitiveIndicesNV[3u * primitive + 1u] = vertices.y;
    gl_PrimitiveIndicesNV[3u * primitive + 2u] = vertices.z;
}

void put_line(uint primitive, uvec2 vertices) {
    gl_PrimitiveIndicesNV[2u * primitive] = vertices.x;
    gl_PrimitiveIndicesNV[2u * primitive + 1u] = vertices.y;
}
#endif
