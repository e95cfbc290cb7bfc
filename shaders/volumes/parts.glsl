// A ray's parts inside the caller's region, from the eye on; volumes/cast_*.glsl find what each mode shows of them.
//
// This work is based on: Schertzer et al. 2022, section 5.1, which cuts by one front and one back depth of a mesh. Here the region
// may begin and end any number of times along a ray: pvfiblets/engine/regions/ray_intervals.py draws the depths at which it does.
//
// Symbols
//   boundary     window depth from which on the region holds, or no longer holds (regions/boundaries.glsl)
//   part         from a boundary where it begins to hold to the next; a ray's samples begin anew in each
//
// Light is that of the parts, one behind the other; a peak is the highest of all; a surface is the first. Where a part begins or
// ends there is no surface: as with planes, one sees into the volume.

#include "regions/boundaries.glsl"

float boundary_of(ivec2 pixel, int number) {
    if ((number >> 2) >= region_layers) return 2.0;
    return texelFetch(region_boundaries, ivec3(pixel, number >> 2), 0)[number & 3];
}

// Places at which the part begins that has this number or is the first behind it that is longer than nothing, and where it ends.
bool next_part(ivec2 pixel, Ray whole, inout int number, out float begin, out float end) {
    for (;;) {
        float enter = boundary_of(pixel, 2 * number), leave = boundary_of(pixel, 2 * number + 1);
        begin = enter < 0.0 ? whole.first : enter > 1.0 ? 3e38 : max(where_far(whole, 1.0 - enter), whole.first);
        end = leave > 1.0 ? whole.last : min(where_far(whole, 1.0 - leave), whole.last);
        ++number;
        if (!(begin < whole.last)) return false;
        if (begin < end) return true;
    }
}
