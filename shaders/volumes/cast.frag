// What each pixel shows of a volume: the textures of pvfiblets/engine/gbuffer.py.
// Paper: Lesar 2015, "Real-time ray casting of volumetric data", section III.
//
// One ray per pixel, through what planes, the box and opaque things in front leave of the volume. Steps are as long everywhere,
// from where the ray enters: what the octree skips changes no sample. With ray_stride pixels between rays, each is that of a pixel
// of the whole picture (sparse casting, section III.D, phase 1).
//
// Nothing is discarded: pixels without anything say so, and an early test of depth may leave pixels out (phase 2).

#version 430

#include "volumes/block.glsl"
#include "volumes/field.glsl"
#include "volumes/ray.glsl"
#include "volumes/nodes.glsl"
#if FEATURE_VOLUME_CELLS
#include "volumes/cells.glsl"
#endif
#include "codec/layout.glsl"
#include "frame/tangent.glsl"
#if FEATURE_CLIP_REGION
#include "volumes/parts.glsl"
#endif
#if FEATURE_SCENE_DEPTH
uniform usampler2D outside;       // keys of what is opaque
#endif

layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uvec2 out_ids;
layout(location = 3) out vec2 out_position;

// bool cast_ray(pixel, ray, step, start, out hit, out value): what the mode shows along a ray; false for nothing.
#if FEATURE_VOLUME_LAYERS
#include "volumes/cast_layers.glsl"
#elif FEATURE_VOLUME_SURFACE
#include "volumes/cast_surface.glsl"
#elif FEATURE_VOLUME_COMPOSITE
#include "volumes/cast_composite.glsl"
#else
#include "volumes/cast_projection.glsl"
#endif

// A number in 0..1 for each pixel that looks like noise.
float noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

uniform int ray_stride;
uniform ivec2 last_pixel;

void main() {
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) * ray_stride + ray_stride / 2, last_pixel);
    Ray ray = ray_of(vec2(pixel) + 0.5);
    out_depth = out_owner = 0xFFFFFFFFu;
    out_ids = uvec2(0u);
    out_position = vec2(0.0);
    clear_shown();
#if FEATURE_SCENE_DEPTH
    uint key = texelFetch(outside, pixel, 0).x;
    // All that a ray finds shows before what ends it, whose samples lie so much apart in the pixel.
    uint before_it = 2048u + uint(min(fwidth(float(key)), 1.6e7));
    if (key != 0xFFFFFFFFu) ray.last = min(ray.last, where_far(ray, float(0xFFFFFFFFu - key) / 4294967296.0));
#endif
    if (!(ray.last > ray.first)) return;
    float step = ray_step, start = ray.first;
#if FEATURE_VOLUME_JITTER
    start += step * noise(vec2(pixel));
    if (start >= ray.last) return;
#endif
    float hit, value;
    if (!cast_ray(pixel, ray, step, start, hit, value)) return;
    float far = reversed_depth(ray, hit);
    out_depth = 0xFFFFFFFFu - uint(clamp(far * 4294967296.0, 1.0, 4294967040.0));
#if FEATURE_SCENE_DEPTH
    if (key != 0xFFFFFFFFu) out_depth = min(out_depth, key - min(key, before_it));
#endif
    ivec3 voxel = clamp(ivec3(floor(at(ray, hit) + 0.5)), ivec3(0), ivec3(volume_shape) - 1);
    out_owner = uint(voxel.x) + uint(volume_shape.x) * (uint(voxel.y) + uint(volume_shape.y) * uint(voxel.z));
    out_position = vec2(hit, value);
}
