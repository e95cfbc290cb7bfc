// Whether a closed surface holds a position of a pixel's ray: its winding number about it is not 0. Computed from the surface's
// layers; the first, which is all that most pixels have, is fetched once.

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
    ivec4 rectangle = rays_rectangles[k];
    int first_layer = rays_first_layers[k], first_tallies = rays_first_tallies[k];
    SurfaceHere here = SurfaceHere(vec4(LAYERS_NONE), ivec4(0), 0, 0);
    if (any(lessThan(pixel, rectangle.xy)) || any(greaterThanEqual(pixel, rectangle.zw))) return here;
    vec4 ends;
    float end;
    layers_first(ivec3(pixel, first_layer), ends, end);
    ivec2 fragments = layers_counts(ends.w);
    here.winding = fragments.y - fragments.x;
    here.layers = min(rays_layer_counts[k], (max(fragments.x, fragments.y) + 1) / 2);
    here.depths = layers_ends(ends, end);
    here.tally = layers_there(here.depths);
    if (first_tallies >= 0) here.tally *= ivec4(texelFetch(tallies, ivec3(pixel, first_tallies), 0));
    return here;
}

void surface_pass(vec4 depths, ivec4 tally, float z, inout int winding, inout float next) {
    bvec4 later = greaterThan(depths, vec4(z));
    vec4 beyond = mix(vec4(LAYERS_BEYOND), depths, later);
    next = min(next, min(min(beyond.x, beyond.y), min(beyond.z, beyond.w)));
    ivec4 passed = tally * ivec4(not(later));
    winding += passed.x + passed.y - passed.z - passed.w;
}

// `next` becomes the nearest crossing beyond z, if that is nearer than `next`.
bool surface_holds(int k, SurfaceHere here, ivec2 pixel, float z, inout float next) {
    int winding = here.winding;
    surface_pass(here.depths, here.tally, z, winding, next);
    int first_layer = rays_first_layers[k], first_tallies = rays_first_tallies[k];
    for (int layer = 1; layer < here.layers; ++layer) {
        vec4 ends;
        float end;
        layers_fetch(ivec3(pixel, first_layer + layer), ends, end);
        vec4 depths = layers_ends(ends, end);
        ivec4 tally = layers_there(depths);
        if (first_tallies >= 0) tally *= ivec4(texelFetch(tallies, ivec3(pixel, first_tallies + layer), 0));
        surface_pass(depths, tally, z, winding, next);
    }
    return winding != 0;
}
#endif
