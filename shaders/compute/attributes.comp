// Last drawing pass: what each pixel shows. Only fiblets that own a pixel are drawn, and each writes its own pixels: no
// two invocations write the same one.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "raster/segments.glsl"

#include "compute/marks.glsl"

layout(r32ui, binding = 0) readonly uniform uimage2D depth_image;
layout(r32ui, binding = 1) readonly uniform uimage2D owner_image;
layout(rg32ui, binding = 2) writeonly uniform uimage2D ids_image;
layout(rg32f, binding = 3) writeonly uniform image2D position_image;

uniform uint part;  // of the plan: which class

uint bits_of(uint word) {
    return marks[word * 8u + SEEN] & (marks[word * 8u + part] | marks[word * 8u + part + 3u]);
}

#include "compute/bits.glsl"
#include "compute/place.glsl"
#include "compute/values.glsl"

uint owner;
uint streamline;
float first_point;  // index within the streamline of the fiblet's anchor
uint tangent;

// Octahedral map about +x, two snorm16, as the codec packs a first direction.
uint packed_direction(vec3 d) {
    float norm = abs(d.x) + abs(d.y) + abs(d.z);
    vec2 s = d.yz / norm;
    if (d.x < 0.0) s = (1.0 - abs(s.yx)) * vec2(s.x < 0.0 ? -1.0 : 1.0, s.y < 0.0 ? -1.0 : 1.0);
    ivec2 i = ivec2(round(clamp(s, -1.0, 1.0) * FIBLET_DIRECTION_SCALE));
    return uint(i.x & 0xFFFF) | (uint(i.y) << 16u);
}

// A segment of no length keeps the tangent of the one before it.
void start_segment(uint segment, vec3 delta) {
    float size = max(abs(delta.x), max(abs(delta.y), abs(delta.z)));
    if (size > 0.0) tangent = packed_direction(delta / size);
    start_values(segment, delta);
}

void plot(ivec2 pixel, float z, float s, uint segment) {
    if (imageLoad(owner_image, pixel).x != owner || depth_key(z) != imageLoad(depth_image, pixel).x) return;
    float t = along(s);
    imageStore(ids_image, pixel, uvec4(streamline, tangent, 0u, 0u));
    imageStore(position_image, pixel, vec4(first_point + float(segment) + t, value_at(segment, t), 0.0, 0.0));
}

void main() {
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        owner = chunk.y + f;
        streamline = streamline_of(f);
        first_point = float(points_before(f));
        tangent = 0u;  // +x, where a streamline has no length
        begin_values(f);
        draw_fiblet(f);
    }
}
