// Surfaces by cells (volumes/cells.glsl), all those in a cell.
//
// Cells that share a face share its voxels, so a surface that crosses a face by rounding alone is found by the side that the
// last cell ended on. Where nodes are skipped, no value is met: the side begins anew behind them.

struct Stretch {
    float first;     // mm
    float last;
    vec4 b;
    uint sides;      // before it
};

float place_of(Stretch found, float s) { return mix(found.first, found.last, s); }

// Take from a stretch what shows; true if that is all. Defined beside it.
bool show_stretch(Ray ray, Stretch found);

float node_threshold() { return 0.5; }
bool ends_before(float number) { return false; }

uint sides_of(float value) {
    uint sides = 0u;
    for (int k = 0; k < isovalue_count; ++k) sides |= value < isovalues[k] ? 1u << k : 0u;
    return sides;
}

// Places where a cubic changes sides, in order; 2 for none. At 0 if it begins on another side than the stretch before ended on.
vec3 crossings(vec4 b, bool below) {
    vec3 found = vec3(2.0);
    int count = 0;
    bool side = b.x < 0.0;
    if (side != below) found[count++] = 0.0;
    if (all(equal(lessThan(b, vec4(0.0)), bvec4(side)))) return found;
    vec3 turns = vec3(turns_of(b), 1.0);
    float from = 0.0;
    for (int k = 0; k < 3 && count < 3; ++k) {
        bool next = cubic_at(b, turns[k]).x < 0.0;
        if (next != side) found[count++] = crossing_between(b, from, turns[k], side);
        side = next;
        from = turns[k];
    }
    return found;
}

float lowest, highest;      // of isovalues

bool show_cell(Ray ray, inout Walk walk, float first, float bottom, float top) {
    uint all_sides = (1u << isovalue_count) - 1u, before = walk.sides;
    walk.sides = top < lowest ? all_sides : 0u;
    if (!((top >= lowest && bottom < highest) || (walk.known && walk.sides != before))) return false;
    vec4 b = bernstein(walk, first);
    if (!walk.known) before = sides_of(b.x);
#if FEATURE_VOLUME_CLOSED && !FEATURE_VOLUME_LAYERS
    if (first == box_enter) before = all_sides;
#endif
    walk.sides = sides_of(b.w);
    return show_stretch(ray, Stretch(first, walk.t, b, before));
}

void walk_surfaces(Ray ray, float start) {
    lowest = highest = isovalues[0];
    for (int k = 1; k < isovalue_count; ++k) {
        lowest = min(lowest, isovalues[k]);
        highest = max(highest, isovalues[k]);
    }
    walk_cells(ray, start);
}
