// Copies a picture into one layer of the array that keeps them all (pvfiblets/engine/fiblets/gather/depth_peeling.py).

#version 430

uniform usampler2D drawn_depth;
uniform usampler2D drawn_ids;
uniform sampler2D drawn_position;
#if FEATURE_CROSS_LINE
#if FEATURE_TUBES
uniform usampler2D drawn_across;
layout(location = 3) out uint layer_across;
#else
uniform sampler2D drawn_across;
layout(location = 3) out float layer_across;
#endif
#endif

layout(location = 0) out uint layer_depth;
layout(location = 1) out uvec2 layer_ids;
layout(location = 2) out vec2 layer_position;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    layer_depth = texelFetch(drawn_depth, at, 0).x;
    layer_ids = texelFetch(drawn_ids, at, 0).xy;
    layer_position = texelFetch(drawn_position, at, 0).xy;
#if FEATURE_CROSS_LINE
    layer_across = texelFetch(drawn_across, at, 0).x;
#endif
}
