// Two-phase culling: from the number of listed items to drawing calls, one for each batch that an index buffer of 16 bits
// reaches. One invocation per call.

#version 430
layout(local_size_x = 64) in;

layout(std430, binding = {{ items_counts }}) readonly buffer Counts { uint counts[]; };
layout(std430, binding = {{ items_commands }}) writeonly buffer Commands { uint commands[]; };    // five words each, as OpenGL has them

uniform int calls;
uniform int batch;               // items of a call
uniform int quads;               // of an item, drawn with six indices and four vertices each

void main() {
    uint call = gl_GlobalInvocationID.x;
    if (call >= uint(calls)) return;
    uint before = call * uint(batch), count = counts[0] > before ? min(counts[0] - before, uint(batch)) : 0u;
    commands[5u * call] = 6u * uint(quads) * count;
    commands[5u * call + 1u] = 1u;
    commands[5u * call + 2u] = 0u;
    commands[5u * call + 3u] = 4u * uint(quads) * before;       // the base vertex: gl_VertexID counts on from it
    commands[5u * call + 4u] = 0u;
}
