// Whether a fiblet lies behind the coverage buffer: what the last picture hid, moved to this camera (paper: Schertzer et al.
// 2022, sections 3.4.1 and 3.4.2, figure 6). pvfiblets/engine/culling/coverage.py makes the buffer.
//
// Symbols
//   zeta(p)      depth of a point in mm along the view, coverage_axis.xyz . p
//   R            coverage_axis.w, the radius that the buffer is dilated by: of a ball of radius R whose centre has a greater
//                zeta than the buffer's texel, nothing shows
//   a, b, r      the fiblet's capsule (culling/bounds.glsl); r is that of its body
//
// The paper's R is N delta, so that the ball around a fiblet's first point holds all of it, and so does the ball around the
// next fiblet's; to find either hidden is enough. A capsule is a hundredth of that ball. Here R is about a third of N delta,
// and balls on the segment from the anchor to the next fiblet's anchor, both included, cover the capsule together:
//
//       a---------b      m + 1 balls, |b - a| / m apart: all points are within |b - a| / 2m + r <= R of a centre
//      (o    o    o)     m = ceil(|b - a| / 2(R - r)): one texel fetch each, and the first one not hidden ends the test
//
// The buffer shrinks by R from every edge of what hides, so that a small R is worth two more fetches.
//
// A fiblet thicker than R, or one that takes more than MOST balls, is never hidden; nor is one that leaves the picture.

uniform sampler2D coverage;
uniform vec4 coverage_axis;
uniform float coverage_side;  // pixels of a texel

const float MOST = 8.0;
const float UNCOVERED = -1.0e38;  // below this: nothing was there to be moved here

bool covered(vec3 p) {
    vec4 c = to_homogeneous(p);
    if (c.w <= 0.0) return false;
    vec2 at = c.xy / c.w;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, viewport))) return false;
    float limit = texelFetch(coverage, ivec2(at / coverage_side), 0).x;
    return limit > UNCOVERED && dot(coverage_axis.xyz, p) > limit;
}

bool hidden(Capsule c) {
    float r = body_of(c), pieces = max(ceil(0.5 * distance(c.a, c.b) / max(coverage_axis.w - r, 1e-20)), 1.0);
    if (r >= coverage_axis.w || pieces > MOST) return false;
    for (float i = 0.0; i <= pieces; ++i) {
        if (!covered(mix(c.a, c.b, i / pieces))) return false;
    }
    return true;
}
