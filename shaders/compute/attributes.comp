// Second drawing pass: who owns each pixel. Candidates are decoded and drawn again; where a sample's depth is the one
// that the first pass kept, its streamline, tangent and place are written.
//
// Ties (equal depth keys in one pixel) go to the fiblet with the smallest index, so that a picture does not depend on
// the order in which a driver runs groups: every tied fiblet takes the minimum with `owner_image` and writes if it leads.
// Two of them may still write in the wrong order; then the one that no longer leads sees it and raises `unsettled`.
// Only in that case does this program, run once more with `settling`, do anything: owners are final by then, and each
// writes its pixels alone.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "raster/segments.glsl"

layout(std430, binding = 7) readonly buffer Candidates { uint candidates[]; };
layout(std430, binding = 6) buffer Status { uint unsettled; };
#if FEATURE_RANK_TO_ID
layout(std430, binding = 9) readonly buffer RankToId { uint rank_to_id[]; };
#endif
layout(r32ui, binding = 0) readonly uniform uimage2D depth_image;
layout(r32ui, binding = 1) coherent uniform uimage2D owner_image;
layout(rg32ui, binding = 2) writeonly uniform uimage2D ids_image;
layout(rg32f, binding = 3) writeonly uniform image2D position_image;

uniform bool settling;

uint bits_of(uint word) { return candidates[word]; }

#include "compute/bits.glsl"
#include "compute/place.glsl"
#include "compute/values.glsl"

uint owner;
uint streamline;
float first_point;   // index within the streamline of the fiblet's anchor
vec3 tangent;

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
    if (size > 0.0) tangent = normalize(delta / size);
    start_values(segment, delta);
}

void plot(ivec2 pixel, float z, float s, uint segment) {
    if (depth_key(z) != imageLoad(depth_image, pixel).x) return;
    bool leads = settling ? imageLoad(owner_image, pixel).x == owner : imageAtomicMin(owner_image, pixel, owner) >= owner;
    if (!leads) return;
    float t = along(s);
    imageStore(ids_image, pixel, uvec4(streamline, packed_direction(tangent), 0u, 0u));
    imageStore(position_image, pixel, vec4(first_point + float(segment) + t, value_at(segment, t), 0.0, 0.0));
    if (settling) return;
    memoryBarrierImage();
    if (imageLoad(owner_image, pixel).x != owner) unsettled = 1u;
}

void main() {
    if (settling && unsettled == 0u) return;
    for (uint k = gl_LocalInvocationIndex;; k += gl_WorkGroupSize.x) {
        uint f = nth_fiblet(k);
        if (f == NO_FIBLET) break;
        owner = chunk.y + f;
        streamline = streamline_of(f);
        first_point = float(points_before(f));
        tangent = vec3(1.0, 0.0, 0.0);
        begin_values(f);
        draw_fiblet(f);
    }
}
