// Four boundaries of a pixel (regions/boundaries.glsl), from the first that this pass is to give on: all leaves' crossings
// along the ray in ascending order, of which those are boundaries where the region's expression turns.
//
// FEATURE_PEEL: closed surfaces are among the leaves, with their crossings in layers (regions/layers.glsl).

#version 430

#include "regions/rays.glsl"
#if FEATURE_PEEL
#include "regions/layers.glsl"
#endif

uniform int first;  // number of the first boundary to give

out vec4 boundaries;

const float NO_MORE = 2.0;
const float START = 0.0;  // what begins at the near plane or before it, begins here

vec2 spans[{{ max_region_leaves }}];

// Bits of the leaves that hold z; `next` is the nearest crossing of any leaf beyond z.
uint leaves_at(float z, out float next) {
    uint bits = 0u;
    next = NO_MORE;
    for (int k = 0; k < rays_info.y; ++k) {
        bool inside;
#if FEATURE_PEEL
        if (rays_leaves[k].x == RAYS_SURFACE) {
            inside = layers_hold(k, ivec2(gl_FragCoord.xy), z, next);
        } else
#endif
        {
            vec2 span = spans[k];
            inside = span.x <= z && z < span.y;
            if (span.x > z) next = min(next, span.x);
            else if (span.y > z) next = min(next, span.y);
        }
        if (inside) bits |= 1u << uint(k);
    }
    return bits;
}

bool evaluate(uint bits) {
    uint stack = 0u;  // the top is the lowest bit
    for (int i = 0; i < rays_info.x; ++i) {
        int word = rays_program[i >> 2][i & 3];
        if (word >= 0) stack = (stack << 1) | ((bits >> uint(word)) & 1u);
        else if (word == RAYS_NOT) stack ^= 1u;
        else if (word == RAYS_AND) stack = (stack >> 1) & (stack | ~1u);
        else stack = (stack >> 1) | (stack & 1u);
    }
    return (stack & 1u) == 1u;
}

void main() {
    for (int k = 0; k < rays_info.y; ++k) {
        ivec4 leaf = rays_leaves[k];
        spans[k] = leaf.x == RAYS_PLANES ? rays_planes(leaf, rays_centres[k].xyz, gl_FragCoord.xy)
                 : leaf.x == RAYS_SPHERE ? rays_sphere(leaf, rays_centres[k].xyz, gl_FragCoord.xy) : RAYS_NOWHERE;
    }
    float z = START, next;
    boundaries = vec4(NO_MORE);
    int place = -first;
    bool kept = evaluate(leaves_at(z, next));
    if (kept) {
        if (place == 0) boundaries.x = -1.0;
        ++place;
    }
    while (next <= 1.0 && place < 4) {
        z = next;
        bool now = evaluate(leaves_at(z, next));
        if (now == kept) continue;
        kept = now;
        boundaries = mix(boundaries, vec4(z), equal(ivec4(place), ivec4(0, 1, 2, 3)));
        ++place;
    }
}
