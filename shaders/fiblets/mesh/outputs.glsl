// What a mesh stage writes: vertices, the lines or triangles between them, and, primitive by primitive, what the fragments are
// handed (fiblets/hardware_raster/varyings.glsl). Tests put storage buffers in the place of this file and run the same stages as compute
// shaders.

#define VARYING perprimitiveNV out
#define EACH []
#define TO(name) name[varying_primitive]

uint varying_primitive;

#include "fiblets/hardware_raster/write_varyings.glsl"

void put_vertex(uint vertex, vec4 at) { gl_MeshVerticesNV[vertex].gl_Position = at; }

void put_index(uint slot, uint vertex) { gl_PrimitiveIndicesNV[slot] = vertex; }

void put_varyings(uint primitive, Varyings varyings, ClippedSegment piece, vec3 from, vec3 to) {
    varying_primitive = primitive;
    write_varyings(varyings, piece, from, to);
}

void put_count(uint primitives) { gl_PrimitiveCountNV = primitives; }
