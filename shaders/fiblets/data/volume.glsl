// A volume that is sampled at points of a streamline; pvfiblets/engine/fiblets/data/sampled_volume.py declares and packs the
// block and makes the texture.
//
// Symbols
//   at           voxel indices; voxel centres lie at whole numbers, so that the volume reaches from -1/2 to n - 1/2
//   texel        of a normalised texture 0..1, else the value itself: value = volume_least + texel * volume_per_unit, of
//                which the product is rounded where values are whole
//
// Trilinear: the sum of eight voxels, each with the product of its three weights. It is not left to the texture unit, whose
// weights have eight bits, and which would let a NaN with no weight count. Coordinates carry float32's rounding: NaN counts
// from a weight of LIGHT on, or a point on a voxel's centre would be NaN because of a neighbour.

#include "uniforms/Sampling.glsl"

#if FEATURE_TEXTURE_DATA
uniform sampler3D sampled_volume;  // pvfiblets/engine/fiblets/data/data_textures.py says where
#else
layout(binding = {{ unit_sampled_volume }}) uniform sampler3D sampled_volume;
#endif

const float LIGHT = 1e-4;

bool is_nan(float v) { return (floatBitsToUint(v) & 0x7FFFFFFFu) > 0x7F800000u; }

float voxel_value(ivec3 at) {
    float v = texelFetch(sampled_volume, at, 0).x * volume_per_unit;
    return volume_least + (volume_whole != 0 ? floor(v + 0.5) : v);
}

// A voxel's part in a sum. Infinity times nothing would be NaN.
float voxel_part(ivec3 at, float weight) {
    float v = voxel_value(at);
    return weight <= 0.0 || (weight < LIGHT && is_nan(v)) ? 0.0 : weight * v;
}

// Value at a point in local millimetres; NaN outside.
float volume_at(vec3 p) {
    vec3 at = (voxel_from_local * vec4(p, 1.0)).xyz, top = volume_shape - 1.0;
    if (!(all(greaterThanEqual(at, vec3(-0.5))) && all(lessThanEqual(at, top + 0.5)))) return uintBitsToFloat(0x7FC00000u);
    at = clamp(at, vec3(0.0), top);
    if (volume_nearest != 0) return voxel_value(ivec3(min(floor(at + 0.5), top)));
    vec3 low = min(floor(at), max(top - 1.0, 0.0)), t = at - low;
    ivec3 first = ivec3(low), last = ivec3(min(low + 1.0, top));
    vec2 wx = vec2(1.0 - t.x, t.x), wy = vec2(1.0 - t.y, t.y), wz = vec2(1.0 - t.z, t.z);
    return voxel_part(first, wx.x * wy.x * wz.x) + voxel_part(ivec3(last.x, first.yz), wx.y * wy.x * wz.x)
         + voxel_part(ivec3(first.x, last.y, first.z), wx.x * wy.y * wz.x) + voxel_part(ivec3(last.xy, first.z), wx.y * wy.y * wz.x)
         + voxel_part(ivec3(first.xy, last.z), wx.x * wy.x * wz.y) + voxel_part(ivec3(last.x, first.y, last.z), wx.y * wy.x * wz.y)
         + voxel_part(ivec3(first.x, last.yz), wx.x * wy.y * wz.y) + voxel_part(last, wx.y * wy.y * wz.y);
}

// Between the values at two points.
float value_between(float a, float b, float t) {
    return volume_nearest != 0 || is_nan(a) || is_nan(b) ? (t < 0.5 ? a : b) : mix(a, b, t);
}

// On a segment that stands for so many steps from point to point, as if the points were evenly spread: `rest` of the way
// from point `step` to the next.
float volume_between(vec3 from, vec3 to, float steps, uint step, float rest) {
    if (steps <= 0.0) return volume_at(from);
    float a = float(step) / steps, b = min(float(step) + 1.0, steps) / steps;
    return value_between(volume_at(mix(from, to, a)), volume_at(mix(from, to, b)), rest);
}
