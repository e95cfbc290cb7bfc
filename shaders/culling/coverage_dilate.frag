// The last picture's depth, dilated by a ball of radius R (paper: Schertzer et al. 2022, section 3.4.2, figure 6, equation (4)
// and appendix C).
//
// Symbols
//   s, t         texels of 16 x 16 pixels of the last picture: the one whose depth counts, and the one it counts for
//   zeta         depth in mm along the view; `eye` more is the distance from the camera's plane
//   y            the farthest zeta in s (a max filter of four levels): something may show in s in front of y, nothing behind
//   T            a point in t. It must not count as hidden while a point that may show is within R of it
//   u, v         directions of t and s with an increase of zeta of 1 per unit, taken where the two texels come nearest
//   delta        u - v in a perspective view, and v's shift to u in a parallel one
//
// Algorithm. The buffer holds the greatest zeta of all T that must not count as hidden. Those that s allows lie on the ray u
// within R of
//   the point y v            |a u + y delta| = R, zeta = y + a: the carved hemisphere of appendix C, which solves the same
//                            quadratic (there, -X^2 belongs outside of the root)
//   the line x v, x <= y     R |v| / |delta x v| from the eye, where the foot of the perpendicular lies in front of y
// The paper has the first only; its figure 6 shows that case. The second is the shape of edges in a perspective view:
// next to a background far away, a hemisphere there has no width on the screen, but a fiblet at the edge reaches over it
// all the same.
//
// Equation (4) widens the ball by half a texel's opening, R + z tan(gamma / 2), for the depth of s may be anywhere in s. So may
// T in t, and t is looked up for points up to a texel away, once the buffer has been moved to the next camera
// (culling/coverage_grid.vert). The widening is across the view only, so that here the gap between s and t is
// measured from edge to edge and a texel less.
//
// The paper draws the hemispheres as sprites with the depth test GREATER. That is a maximum over texels nearby, and is taken
// as one here: in front of a far background sprites would have to be as large as the nearest object needs, this loop is
// as large as t needs. A loop longer than REACH texels steps to coarser levels of the same max filter.
//
// What lies beyond the picture's edge is unknown: it counts as empty, which hides nothing.

#version 430

uniform usampler2D pyramid;
uniform int first_level;     // of the texels
uniform int last_level;
uniform ivec2 texels;        // in the picture
uniform vec4 depth_terms;    // window depth m to zeta: (m x - y) / (z - m w)
uniform float eye;           // zeta 0 is this far from the camera's plane
uniform vec3 ray;            // v of the corner of texel (0, 0)
uniform vec3 ray_x;          // change of v per texel; in a parallel view, of where v starts (mm)
uniform vec3 ray_y;
uniform vec2 pitch;          // least distance of neighbours' rays, per mm of distance from the eye in perspective
uniform int perspective;
uniform vec2 radius;         // x: R (mm); y: by how many texels a gap is less
uniform float far;           // zeta of the far plane: a depth allowed behind it is not limited

out float farthest;

const float EMPTY = 3.0e38;
const float REACH = 8.0;

float zeta_of(ivec2 texel, int level) {
    uint key = texelFetch(pyramid, texel, level).x;
    if (key == 0xFFFFFFFFu) return EMPTY;
    float m = (float(key) + 512.0) / 4294967296.0;  // a key stands for depths up to the next
    float below = depth_terms.z - m * depth_terms.w - 2.4e-7 * abs(depth_terms.z);  // rounding must not bring it nearer
    return below > 0.0 ? (m * depth_terms.x - depth_terms.y) / below : EMPTY;
}

// The greatest zeta that a texel at `place` with depth y allows, `gap` texels away.
float allowed(float y, vec2 place, vec2 gap) {
    if (gap == vec2(0.0)) return y == EMPTY ? EMPTY : y + radius.x;
    vec3 delta = gap.x * ray_x + gap.y * ray_y, u = ray;
    if (perspective != 0) {
        vec3 v = ray + place.x * ray_x + place.y * ray_y;
        u = v + delta;
        float side = radius.x * length(v) / length(cross(delta, v)), foot = side * dot(u, v) / dot(v, v);
        if (y == EMPTY || foot <= y + eye) return side - eye;
        delta *= y + eye;
    }
    float p = dot(u, delta), uu = dot(u, u), root = p * p - uu * (dot(delta, delta) - radius.x * radius.x);
    if (root < 0.0) return -EMPTY;
    return y == EMPTY ? EMPTY : y + (sqrt(root) - p) / uu;
}

void main() {
    ivec2 t = ivec2(gl_FragCoord.xy);
    float most = zeta_of(t, first_level);
    if (most == EMPTY) {
        farthest = EMPTY;
        return;
    }
    most += radius.x;
    vec2 low = vec2(t) - radius.y, high = vec2(t + 1) + radius.y, middle = vec2(t) + 0.5;
    // beyond the four edges
    most = max(most, allowed(EMPTY, vec2(0.0, middle.y), vec2(max(low.x, 0.0), 0.0)));
    most = max(most, allowed(EMPTY, vec2(texels.x, middle.y), vec2(min(high.x - float(texels.x), 0.0), 0.0)));
    most = max(most, allowed(EMPTY, vec2(middle.x, 0.0), vec2(0.0, max(low.y, 0.0))));
    most = max(most, allowed(EMPTY, vec2(middle.x, texels.y), vec2(0.0, min(high.y - float(texels.y), 0.0))));
    // Farther ones allow no more than is allowed already.
    vec2 reach = radius.x / (pitch * (perspective != 0 ? most + eye : 1.0)) + 1.0 + radius.y;
    int coarser = 0;
    while (max(reach.x, reach.y) > REACH * float(1 << coarser) && first_level + coarser < last_level) ++coarser;
    ivec2 last = (texels - 1) >> coarser, from = max(ivec2(floor(vec2(t) - reach)) >> coarser, ivec2(0));
    ivec2 to = min(ivec2(floor(vec2(t) + reach)) >> coarser, last);
    for (int y = from.y; y <= to.y && most < EMPTY; ++y) {
        for (int x = from.x; x <= to.x; ++x) {
            ivec2 s = ivec2(x, y);
            float zeta = zeta_of(s, first_level + coarser);
            if (zeta + radius.x <= most) continue;
            vec2 s_low = vec2(s << coarser), s_high = vec2((s + 1) << coarser);
            vec2 gap = max(low - s_high, 0.0) + min(high - s_low, 0.0);
            most = max(most, allowed(zeta, clamp(middle, s_low, s_high), gap));
        }
    }
    farthest = most > far ? EMPTY : most;
}
