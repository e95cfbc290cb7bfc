// The field between the voxels, by one of three reconstruction filters. Where the hardware interpolates too coarsely (8 bits of the
// place; pvfiblets/engine/volumes/interpolation.py), voxels are fetched and weighed here.
// Paper: Lesar 2015, section III.A; the third, tricubic, is Catmull and Rom's cubic along each axis.

#if FEATURE_VOLUME_BRICKS
#include "volumes/bricks.glsl"
#else
uniform sampler3D voxels;

float read_voxel(ivec3 voxel) { return texelFetch(voxels, voxel, 0).x; }
float sampled(vec3 p) { return textureLod(voxels, (p + 0.5) / volume_shape, 0.0).x; }

float fetched(vec3 p) {
    vec3 last = volume_shape - 1.0;
    p = clamp(p, vec3(0.0), last);
    ivec3 a = ivec3(p), b = min(a + 1, ivec3(last));
    vec3 x = p - vec3(a);
    vec4 low = vec4(read_voxel(a), read_voxel(ivec3(a.x, b.y, a.z)), read_voxel(ivec3(a.xy, b.z)), read_voxel(ivec3(a.x, b.yz)));
    vec4 high = vec4(read_voxel(ivec3(b.x, a.yz)), read_voxel(ivec3(b.xy, a.z)), read_voxel(ivec3(b.x, a.y, b.z)), read_voxel(b));
    vec4 edges = mix(low, high, x.x);
    vec2 faces = mix(edges.xz, edges.yw, x.y);
    return mix(faces.x, faces.y, x.z);
}
#endif

#if FEATURE_VOLUME_FETCHED
#define read_linear fetched
#else
#define read_linear sampled
#endif

#if FEATURE_VOLUME_NEAREST
float value_at(vec3 p) {
    return read_voxel(clamp(ivec3(floor(p + 0.5)), ivec3(0), ivec3(volume_shape) - 1)) * field_scale + field_shift;
}
#elif FEATURE_VOLUME_TRICUBIC
// Along an axis, four weights at three places: the middle two have one sign, and a linear texture weighs them.
void cubic(float p, out vec3 place, out vec3 weight) {
    float i = floor(p), x = p - i, y = 1.0 - x;
    float w0 = -0.5 * x * y * y, w3 = -0.5 * y * x * x, w2 = x * (0.5 + 2.0 * x - 1.5 * x * x), w1 = 1.0 - w0 - w2 - w3;
    place = vec3(i - 1.0, i + w2 / (w1 + w2), i + 2.0);
    weight = vec3(w0, w1 + w2, w3);
}

float value_at(vec3 p) {
    vec3 px, py, pz, wx, wy, wz;
    cubic(p.x, px, wx);
    cubic(p.y, py, wy);
    cubic(p.z, pz, wz);
    float sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) {
            vec3 row = vec3(read_linear(vec3(px.x, py[j], pz[k])), read_linear(vec3(px.y, py[j], pz[k])),
                            read_linear(vec3(px.z, py[j], pz[k])));
            sum += wz[k] * wy[j] * dot(row, wx);
        }
    }
    return sum * field_scale + field_shift;
}
#else
float value_at(vec3 p) { return read_linear(p) * field_scale + field_shift; }
#endif

// Good enough to see on which side of a surface a place is: what lies between two of them is then looked at closely.
#if FEATURE_VOLUME_NEAREST || FEATURE_VOLUME_TRICUBIC
#define value_along value_at
#else
float value_along(vec3 p) { return sampled(p) * field_scale + field_shift; }
#endif

// By mm, from central differences of one voxel (section III.A), one-sided at the box's faces.
vec3 gradient_at(vec3 p) {
    vec3 low = max(p - 1.0, 0.0), high = min(p + 1.0, volume_shape - 1.0);
    vec3 g = vec3(value_at(vec3(high.x, p.yz)) - value_at(vec3(low.x, p.yz)),
                  value_at(vec3(p.x, high.y, p.z)) - value_at(vec3(p.x, low.y, p.z)),
                  value_at(vec3(p.xy, high.z)) - value_at(vec3(p.xy, low.z))) / (high - low);
    return gradient_from_voxels * g;
}
