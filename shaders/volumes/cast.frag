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
#include "codec/layout.glsl"
#include "frame/tangent.glsl"
#if FEATURE_VOLUME_SURFACE
#include "volumes/surface.glsl"
#elif FEATURE_VOLUME_LIGHT
#include "volumes/light.glsl"
#else
#include "volumes/peak.glsl"
#endif
#if FEATURE_CLIP_REGION
#include "volumes/parts.glsl"
#endif
#if FEATURE_SCENE_DEPTH
uniform usampler2D outside;       // keys of what is opaque
#endif

layout(location = 0) out uint shown_depth;
layout(location = 1) out uint shown_owner;
layout(location = 2) out uvec2 shown_ids;
layout(location = 3) out vec2 shown_position;
#if FEATURE_VOLUME_SURFACE
layout(location = 4) out uint shown_normal;
#endif
#if FEATURE_VOLUME_LIGHT
layout(location = 4) out vec4 shown_colour;
#endif

// A number in 0..1 for each pixel that looks like noise.
float noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

uniform int ray_stride;
uniform ivec2 last_pixel;

void main() {
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) * ray_stride + ray_stride / 2, last_pixel);
    Ray ray = ray_of(vec2(pixel) + 0.5);
    shown_depth = shown_owner = 0xFFFFFFFFu;
    shown_ids = uvec2(0u);
    shown_position = vec2(0.0);
#if FEATURE_VOLUME_SURFACE
    shown_normal = 0u;
#elif FEATURE_VOLUME_LIGHT
    shown_colour = vec4(0.0);
#endif
#if FEATURE_SCENE_DEPTH
    uint key = texelFetch(outside, pixel, 0).x;
    if (key != 0xFFFFFFFFu) ray.last = min(ray.last, where_far(ray, float(0xFFFFFFFFu - key) / 4294967296.0));
#endif
    if (!(ray.last > ray.first)) return;
    float step = ray_low.w, start = ray.first;
#if FEATURE_VOLUME_JITTER
    start += step * noise(vec2(pixel));
    if (start >= ray.last) return;
#endif
    float hit, value = 0.0;
#if FEATURE_VOLUME_SURFACE
#if FEATURE_CLIP_REGION
    if (!find_surface_in_parts(pixel, ray, step, start - ray.first, hit, value)) return;
#else
    if (!find_surface(ray, step, start, hit, value)) return;
#endif
#if FEATURE_VOLUME_NEAREST
    vec3 g = gradient_at(floor(at(ray, hit) + 0.5));      // of the voxel, whichever of its sides shows
#else
    vec3 g = gradient_at(at(ray, hit));
#endif
    vec3 way = ray.d.x * ray_to_mm[0].xyz + ray.d.y * ray_to_mm[1].xyz + ray.d.z * ray_to_mm[2].xyz;
    float size = max(abs(g.x), max(abs(g.y), abs(g.z)));
    vec3 normal = size > 0.0 ? g / size : -way;
    shown_normal = packed_direction(dot(normal, way) > 0.0 ? -normal : normal);
    shown_ids.y = packed_tangent(way - normal * dot(way, normal) / dot(normal, normal), 0u);      // along the surface, away
#elif FEATURE_VOLUME_LIGHT
    vec4 light;
#if FEATURE_CLIP_REGION
    if (!gather_in_parts(pixel, ray, step, start - ray.first, hit, light)) return;
#else
    if (!gather(ray, step, start, hit, light)) return;
#endif
    shown_colour = vec4(light.rgb / light.a, light.a);
#else
#if FEATURE_CLIP_REGION
    if (!find_peak_in_parts(pixel, ray, step, start - ray.first, hit, value)) return;
#else
    if (!find_peak(ray, step, start, hit, value)) return;
#endif
#endif
    float far = farness(ray, hit);
    shown_depth = 0xFFFFFFFFu - uint(clamp(far * 4294967296.0, 1.0, 4294967040.0));
    ivec3 voxel = clamp(ivec3(floor(at(ray, hit) + 0.5)), ivec3(0), ivec3(ray_size.xyz) - 1);
    shown_owner = uint(voxel.x) + uint(ray_size.x) * (uint(voxel.y) + uint(ray_size.y) * uint(voxel.z));
    shown_position = vec2(hit, value);
}
