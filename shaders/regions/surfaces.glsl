// Whether a closed surface holds a position of a pixel's ray: its winding number about it is not 0. By the surface's layers.

#include "regions/rays.glsl"
#include "regions/layers.glsl"

#if FEATURE_PEEL
// `next` becomes the nearest crossing beyond z, where it is nearer than what it was.
bool surface_holds(int k, ivec2 pixel, float z, inout float next) {
    ivec4 surface = rays_surfaces[k];
    ivec4 rectangle = ivec4(rays_centres[k]);
    if (any(lessThan(pixel, rectangle.xy)) || any(greaterThanEqual(pixel, rectangle.zw))) return false;
    int winding = 0;
    for (int layer = 0; layer < surface.y; ++layer) {
        vec4 ends;
        float end;
        layers_fetch(ivec3(pixel, surface.x + layer), ends, end);
        if (layer == 0) {
            ivec2 fragments = layers_counts(ends.w);
            winding = fragments.y - fragments.x;
        }
        vec4 depths = layers_ends(ends, end);
        ivec4 there = layers_there(depths);
        if (there == ivec4(0)) break;
        vec4 beyond = mix(vec4(LAYERS_BEYOND), depths, greaterThan(depths, vec4(z)));
        next = min(next, min(min(beyond.x, beyond.y), min(beyond.z, beyond.w)));
        ivec4 passed = there * ivec4(lessThanEqual(depths, vec4(z)));
        if (surface.z >= 0) passed *= ivec4(texelFetch(tallies, ivec3(pixel, surface.z + layer), 0));
        winding += passed.x + passed.y - passed.z - passed.w;
    }
    return winding != 0;
}
#endif
