// Between the two rounds of two-phase culling: keeps depth key and owner of what the first has drawn, and moves its depth up
// by the last digit, so that in the second round a fragment of the same depth is nearer, for fiblets/hardware_raster/shade.glsl to decide
// by the fiblets' indices.

#version 430

uniform sampler2D depth;
uniform usampler2D depth_key;
uniform usampler2D owner;

out uvec2 first_round;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    first_round = uvec2(texelFetch(depth_key, at, 0).x, texelFetch(owner, at, 0).x);
    float z = texelFetch(depth, at, 0).x;
    gl_FragDepth = z < 1.0 ? uintBitsToFloat(max(floatBitsToUint(z), 0x00800000u) + 1u) : 1.0;
}
