// What a mesh stage writes: vertices, the lines or triangles between them, and, primitive by primitive, what the fragments are
// handed (fiblets/raster/varyings.glsl). Tests put storage buffers in the place of this file and run the same stages as compute
// shaders.

#define HANDED perprimitiveNV out
#define EACH []
#define TO(name) name[handed_primitive]

uint handed_primitive;

#include "fiblets/raster/write_varyings.glsl"

void put_vertex(uint vertex, vec4 at) { gl_MeshVerticesNV[vertex].gl_Position = at; }

void put_index(uint slot, uint vertex) { gl_PrimitiveIndicesNV[slot] = vertex; }

void put_handed(uint primitive, Handed handed, Piece piece, vec3 from, vec3 to) {
    handed_primitive = primitive;
    hand_over(handed, piece, from, to);
}

void put_count(uint primitives) { gl_PrimitiveCountNV = primitives; }
