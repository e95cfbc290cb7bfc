// Whether something lies wholly in the region, wholly outside of it, or neither for sure: 1, -1, 0.
//
// A capsule is all points within a radius of the segment a b, local millimetres; a ball is a capsule of no length. Each leaf
// is classified by itself, and the expression evaluated in Kleene's logic (1952, section 64): of "and" the least, of "or"
// the greatest, of "not" the negative.
//
// Invariant: never 1 or -1 where one point of the capsule, or one that float32 rounding puts there, lies on the other side.
// What is not finite makes the slack so, which compares false with everything: undecided.

#include "regions/block.glsl"
#include "regions/fields.glsl"

int region_side(bool inside, bool outside) { return inside ? 1 : outside ? -1 : 0; }

int region_leaf(int leaf, vec3 a, vec3 b, float radius) {
    int kind = region_kinds[leaf];
#if FEATURE_REGION_FIELDS
    if (kind >= REGION_SURFACE) return region_field_capsule(leaf, a, b, radius);
#endif
    vec3 sa, sb, ua = region_unit(leaf, a, sa), ub = region_unit(leaf, b, sb);
    vec3 slack = sa + sb, low = min(ua, ub), high = max(ua, ub), reach = slack + radius * region_slopes[leaf];
    if (kind == REGION_PLANE) return region_side(low.z > reach.z, high.z < -reach.z);
    if (kind == REGION_SLAB) {
        return region_side(max(-low.z, high.z) + reach.z < 1.0, low.z - reach.z > 1.0 || high.z + reach.z < -1.0);
    }
    if (kind == REGION_BOX) {
        return region_side(all(lessThan(max(-low, high) + reach, vec3(1.0))),
                           any(greaterThan(low - reach, vec3(1.0))) || any(lessThan(high + reach, vec3(-1.0))));
    }
    if (kind == REGION_SPHERE) {
        vec3 d = ub - ua;
        float t = clamp(-dot(ua, d) / max(dot(d, d), 1.0e-37), 0.0, 1.0);
        float la = length(ua), lb = length(ub), far = max(la, lb);
        float margin = radius * region_whole_slopes[leaf] + length(slack) + 4.0 * REGION_ROUNDING * (1.0 + far);
        return region_side(far + margin < 1.0, length(ua + t * d) - margin > 1.0);
    }
    return 0;
}

int region_of_capsule(vec3 a, vec3 b, float radius) {
    radius *= 1.0 + REGION_ROUNDING;
    uint inside = 0u, outside = 0u;  // two stacks of bits, the top in bit 0
    for (int k = 0; k < region_words; ++k) {
        int word = region_program[k >> 2][k & 3];
        uint i = inside & 1u, o = outside & 1u;
        if (word >= 0) {
            int side = region_leaf(word, a, b, radius);
            inside = inside << 1 | uint(side > 0);
            outside = outside << 1 | uint(side < 0);
        } else if (word == REGION_NOT) {
            inside ^= i ^ o;
            outside ^= i ^ o;
        } else {
            inside >>= 1;
            outside >>= 1;
            if (word == REGION_AND) {
                inside &= i | ~1u;
                outside |= o;
            } else {
                inside |= i;
                outside &= o | ~1u;
            }
        }
    }
    return int(inside & 1u) - int(outside & 1u);
}

int region_of_ball(vec3 centre, float radius) { return region_of_capsule(centre, centre, radius); }
