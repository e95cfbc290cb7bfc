// Intersections of a pixel's ray with the convex shapes of a region: planes, slabs, boxes and spheres, placed by any
// affine map. pvfiblets/engine/regions/convex_rays.py declares and packs the block, pvfiblets/query/regions/shapes.py says what the shapes are.
//
// Symbols
//   q            window coordinates (x, y, z) of a position: pixels, and depth in 0..1
//   c            q about which a leaf's numbers are expanded: that of its centre, as far as the picture shows it
//   d            q - c
//   span         (enter, leave): the shape holds z where enter <= z < leave; enter > leave: nowhere
//
// Algorithm. A plane in space is one in q, that is, a row (fx, fy, fz, f0) with f . (d, 1) >= 0 on the kept side; along a ray
// that is linear in z. Boxes are six planes, slabs two. A sphere is a quadric in q, (d, 1) Q (d, 1) <= 0, hence a quadratic
// in z, solved without cancellation (Press et al., Numerical Recipes, section 5.6). Its leading coefficient belongs to the
// eye: where it is negative, the eye is inside, and the ray before the lesser root is held.
//
//   rows of a sphere   Qxx, Qyy, 2 Qxy, Q11 | 2 Qx1, 2 Qy1, Qxz, Qyz | Qzz, Qz1

#include "uniforms/Rays.glsl"

const int RAYS_PLANES = 0, RAYS_SPHERE = 1, RAYS_SURFACE = 2;

const vec2 RAYS_NOWHERE = vec2(3.0, -3.0);
const float RAYS_FAR = 3.0;  // beyond any depth

float rays_bounded(float z) { return clamp(z, -RAYS_FAR, RAYS_FAR); }

vec2 rays_planes(int leaf, int planes, vec2 pixel) {
    vec3 centre = rays_centres[leaf];
    vec2 d = pixel - centre.xy, span = vec2(-RAYS_FAR, RAYS_FAR);
    for (int k = 0; k < planes; ++k) {
        vec4 row = rays_rows[6 * leaf + k];
        float height = dot(row.xy, d) + row.w;
        if (row.z == 0.0) {
            if (height < 0.0) return RAYS_NOWHERE;
            continue;
        }
        float z = rays_bounded(centre.z - height / row.z);
        if (row.z > 0.0) span.x = max(span.x, z);
        else span.y = min(span.y, z);
    }
    return span.x <= span.y ? span : RAYS_NOWHERE;
}

vec2 rays_sphere(int leaf, vec2 pixel) {
    vec3 centre = rays_centres[leaf];
    vec2 d = pixel - centre.xy;
    vec4 xy = rays_rows[6 * leaf], slope = rays_rows[6 * leaf + 1], along = rays_rows[6 * leaf + 2];
    float a = along.x, b = along.y + slope.z * d.x + slope.w * d.y;
    float c = xy.w + d.x * (slope.x + xy.x * d.x + xy.z * d.y) + d.y * (slope.y + xy.y * d.y);
    float discriminant = b * b - a * c;
    if (!(discriminant >= 0.0)) return a < 0.0 ? vec2(-RAYS_FAR, RAYS_FAR) : RAYS_NOWHERE;
    float q = -(b + (b < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
    float one = q == 0.0 ? 0.0 : c / q, other = a == 0.0 ? (b < 0.0 ? RAYS_FAR : -RAYS_FAR) : q / a;
    one = rays_bounded(centre.z + one);
    other = rays_bounded(centre.z + other);
    return vec2(a < 0.0 ? -RAYS_FAR : min(one, other), a < 0.0 ? min(one, other) : max(one, other));
}
