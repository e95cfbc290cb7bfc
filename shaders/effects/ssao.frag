// Ambient occlusion in screen space: how much of a pixel's surroundings stands over it.
//
//   occlusion = gain * 1/n sum_i  max(0, 1 - |v_i|^2 / r^2) * max(0, n.v_i / |v_i| - bias)
//
// over n pixels of the disc that a ball of radius r (mm) covers, spread evenly (a spiral of golden angles); v_i (mm)
// goes from the pixel's place to that of pixel i. The first factor is the range check: pixels farther than r do not
// count, however near they look. n is the surface's normal, or a line's nearest to the viewer, so that a line does not darken
// itself, whichever way it runs. Pixels without a line, and pixels beyond the picture's edge, are open.
//
// The spiral is turned in steps of 1/16 over squares of 4 x 4 pixels; the mean over such a square, which
// effects/ssao_blur.frag takes, has seen 16 n directions. The same picture always gives the same occlusion.
//
//   ids           rg32ui: streamline | unit tangent, data coordinates, octahedral about +x, 2 x snorm16
//   data_to_view  directions: data -> view coordinates
//   normals       r32ui: unit normal, data coordinates, packed in the same way
//   parallel      the viewer is infinitely far away
//
// Out: 1 - occlusion, in 0..1.

#version 430

#include "effects/view_position.glsl"

#if FEATURE_SURFACE_NORMALS
uniform usampler2D normals;
uniform mat3 normals_to_view;
#else
uniform usampler2D ids;
uniform mat3 data_to_view;
#endif
uniform int parallel;
uniform float radius;
uniform int samples;
out float open;

const float GOLDEN = 2.39996323, TURN = 6.28318531;
const float GAIN = {{ gain }}, BIAS = {{ bias }};

vec3 direction_of(uint word)
{
    ivec2 s = ivec2(int(word << 16) >> 16, int(word) >> 16);
    vec2 p = vec2(s) / 32767.0;
    float x = 1.0 - abs(p.x) - abs(p.y);
    if (abs(s.x) + abs(s.y) > 32767) p = (1.0 - abs(p.yx)) * vec2(s.x < 0 ? -1.0 : 1.0, s.y < 0 ? -1.0 : 1.0);
    return normalize(vec3(x, p));
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), size = textureSize(keys, 0);
    uint key = texelFetch(keys, pixel, 0).r;
    open = 1.0;
    if (key == EMPTY) return;
    vec3 place = view_position(pixel, key);
#if FEATURE_SURFACE_NORMALS
    vec3 normal = normalize(normals_to_view * direction_of(texelFetch(normals, pixel, 0).r));
#else
    vec3 viewer = parallel != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-place);
    vec3 tangent = normalize(data_to_view * direction_of(texelFetch(ids, pixel, 0).g));
    vec3 normal = viewer - tangent * dot(tangent, viewer);
    float size_of_normal = length(normal);
    normal = size_of_normal > 1e-3 ? normal / size_of_normal : viewer;
#endif
    float reach = radius * pixels_per_mm(-place.z);
    int phase = (pixel.x & 3) + 4 * ((pixel.y * 3 + pixel.x * 2) & 3);
    float turn = TURN * float(phase) / 16.0;
    float sum = 0.0;
    for (int i = 0; i < samples; ++i)
    {
        float angle = GOLDEN * float(i) + turn;
        vec2 offset = reach * sqrt((float(i) + 0.5) / float(samples)) * vec2(cos(angle), sin(angle));
        ivec2 other = ivec2(floor(gl_FragCoord.xy + offset));
        if (other == pixel || any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size))) continue;
        uint there = texelFetch(keys, other, 0).r;
        if (there == EMPTY) continue;
        vec3 v = view_position(other, there) - place;
        float squared = dot(v, v);
        float near = 1.0 - squared / (radius * radius);
        sum += near <= 0.0 || squared == 0.0 ? 0.0 : near * max(0.0, dot(normal, v) * inversesqrt(squared) - BIAS);
    }
    open = clamp(1.0 - GAIN * sum / float(samples), 0.0, 1.0);
}
