// Whether a closed surface holds a position of a pixel's ray: its winding number about it is not 0. By the surface's layers,
// of which the first, which is all that most pixels have, is fetched once.

#include "regions/rays.glsl"
#include "regions/layers.glsl"

#if FEATURE_PEEL
struct SurfaceHere {
    vec4 depths;   // of the first layer, see layers_ends()
    ivec4 tally;   // fragments of each
    int winding;   // at the near plane
    int layers;    // of this pixel, at most
};

SurfaceHere surface_at(int k, ivec2 pixel) {
    ivec4 surface = rays_surfaces[k], rectangle = ivec4(rays_centres[k]);
    SurfaceHere here = SurfaceHere(vec4(LAYERS_NONE), ivec4(0), 0, 0);
    if (any(lessThan(pixel, rectangle.xy)) || any(greaterThanEqual(pixel, rectangle.zw))) return here;
    vec4 ends;
    float end;
    layers_first(ivec3(pixel, surface.x), ends, end);
    ivec2 fragments = layers_counts(ends.w);
    here.winding = fragments.y - fragments.x;
    here.layers = min(surface.y, (max(fragments.x, fragments.y) + 1) / 2);
    here.depths = layers_ends(ends, end);
    here.tally = layers_there(here.depths);
    if (surface.z >= 0) here.tally *= ivec4(texelFetch(tallies, ivec3(pixel, surface.z), 0));
    return here;
}

void surface_pass(vec4 depths, ivec4 tally, float z, inout int winding, inout float next) {
    bvec4 later = greaterThan(depths, vec4(z));
    vec4 beyond = mix(vec4(LAYERS_BEYOND), depths, later);
    next = min(next, min(min(beyond.x, beyond.y), min(beyond.z, beyond.w)));
    ivec4 passed = tally * ivec4(not(later));
    winding += passed.x + passed.y - passed.z - passed.w;
}

// `next` becomes the nearest crossing beyond z, where it is nearer than what it was.
bool surface_holds(int k, SurfaceHere here, ivec2 pixel, float z, inout float next) {
    int winding = here.winding;
    surface_pass(here.depths, here.tally, z, winding, next);
    ivec4 surface = rays_surfaces[k];
    for (int layer = 1; layer < here.layers; ++layer) {
        vec4 ends;
        float end;
        layers_fetch(ivec3(pixel, surface.x + layer), ends, end);
        vec4 depths = layers_ends(ends, end);
        ivec4 tally = layers_there(depths);
        if (surface.z >= 0) tally *= ivec4(texelFetch(tallies, ivec3(pixel, surface.z + layer), 0));
        surface_pass(depths, tally, z, winding, next);
    }
    return winding != 0;
}
#endif
