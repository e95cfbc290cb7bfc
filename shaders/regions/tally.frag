// Counts the fragments that share each depth of one layer (regions/layers.glsl), by adding up.

#version 430

#include "regions/layers.glsl"

uniform int layer;

out vec4 tally;

void main() {
    float z = min(gl_FragCoord.z, 1.0), end;
    vec4 ends;
    layers_fetch(ivec3(gl_FragCoord.xy, layer), ends, end);
    vec4 depths = layers_ends(ends, end);
    bvec4 same = equal(depths, vec4(z));
    tally = gl_FrontFacing ? vec4(same.xy, 0.0, 0.0) : vec4(0.0, 0.0, same.zw);
}
