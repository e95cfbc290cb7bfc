// One layer of a closed surface's crossings (regions/layers.glsl): the nearest and the farthest of front and of back faces,
// and how many fragments there are, strictly within the layer before (FEATURE_PEEL).
//
// This work is based on: Bavoil and Myers 2008, "Order independent transparency with dual depth peeling", which takes the
// nearest and the farthest at once by blending with MAX. Front and back faces apart, four crossings go at a time. The
// count is added up, as the blend equation of alpha is another.

#version 430

layout(location = 0) out vec4 ends;
layout(location = 1) out float end;

#if FEATURE_PEEL
uniform sampler2DArray before, before_end;
uniform int layer;  // of `before`
#endif

const float NONE = -3.0, BACK = 4096.0;  // as in layers.glsl

void main() {
    float z = min(gl_FragCoord.z, 1.0);
    if (!(z > 0.0)) discard;
#if FEATURE_PEEL
    ivec3 at = ivec3(gl_FragCoord.xy, layer);
    vec4 outer = texelFetch(before, at, 0);
    float outer_end = texelFetch(before_end, at, 0).x;
    vec2 span = gl_FrontFacing ? vec2(-outer.x, outer.y) : vec2(-outer.z, outer_end);
    if (!(span.x < z && z < span.y)) discard;
#endif
    ends = gl_FrontFacing ? vec4(-z, z, NONE, 1.0) : vec4(NONE, NONE, -z, BACK);
    end = gl_FrontFacing ? NONE : z;
}
