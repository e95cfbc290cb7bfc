// Surfaces by cells: along a ray, the field within a cell of eight voxels is a cubic, whose crossings are found exactly.
// Paper: Lesar 2015, section III.B, looks at places a step apart instead. That a product of three linear functions of t is a
// cubic, and its roots the surface, is well known (Parker and others, "Interactive ray tracing for isosurface rendering", 1998).
//
// Symbols
//   s            0 where the ray enters the cell, 1 where it leaves it
//   b            Bernstein coefficients of the field over s: the blossom of the trilinear interpolant. The field lies between
//                the least and the largest of them
//   sides        a bit for each isovalue: the field is below it
//
// Cells that share a face share its voxels, so a surface that crosses a face by rounding alone is found by the side that the
// last cell ended on. Where nodes are skipped, no value is met: the side begins anew behind them.

// A walk goes forward along every axis: axes along which the ray goes back are mirrored.

struct Walk {
    vec3 o;          // voxels
    vec3 d;
    ivec3 begin;     // of the volume's voxels, and which way they go
    ivec3 way;
    ivec3 cell;
    vec4 low;        // field at its corners, at x, where y goes before z, then at x + 1
    vec4 high;
    float t;
    uint sides;
    bool known;      // low, high and sides hold: the walk came from the cell beside this one
};

struct Stretch {
    float first;     // mm
    float last;
    vec4 b;
    uint sides;      // before it
};

uint sides_of(float value) {
    uint sides = 0u;
    for (int k = 0; k < isovalue_count; ++k) sides |= value < isovalues[k] ? 1u << k : 0u;
    return sides;
}

Walk walk_from(Ray ray, float t) {
    Walk walk;
    bvec3 back = lessThan(ray.d, vec3(0.0));
    walk.begin = ivec3(back) * (ivec3(volume_shape) - 1);
    walk.way = 1 - 2 * ivec3(back);
    walk.o = vec3(walk.way) * (ray.o - vec3(walk.begin));
    walk.d = abs(ray.d);
    walk.cell = clamp(ivec3(floor(walk.o + t * walk.d)), ivec3(0), ivec3(volume_shape) - 2);
    walk.t = t;
    walk.known = false;
    return walk;
}

float voxel_of(Walk walk, ivec3 at) { return read_voxel(walk.begin + walk.way * at); }

// Go on to the cell behind a face: four of its voxels are those of the face.
void step_over(inout Walk walk, bvec3 axis) {
    ivec3 over = ivec3(axis), u = axis.x ? ivec3(0, 1, 0) : ivec3(1, 0, 0), v = axis.z ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
    walk.cell += over;
    ivec3 far = min(walk.cell + over, ivec3(volume_shape) - 1);      // beyond the volume, where the walk ends
    vec4 f = vec4(voxel_of(walk, far), voxel_of(walk, far + u), voxel_of(walk, far + v), voxel_of(walk, far + u + v));
    vec4 low = walk.low, high = walk.high;
    walk.low = axis.x ? high : axis.y ? vec4(low.y, f.x, low.w, f.z) : vec4(low.zw, f.xz);
    walk.high = axis.x ? f : axis.y ? vec4(high.y, f.y, high.w, f.w) : vec4(high.zw, f.yw);
}

vec4 bernstein(vec4 low, vec4 high, vec3 enter, vec3 leave) {
    vec4 x0 = mix(low, high, enter.x), x1 = mix(low, high, leave.x);
    vec2 x0y0 = mix(x0.xz, x0.yw, enter.y), x0y1 = mix(x0.xz, x0.yw, leave.y);
    vec2 x1y0 = mix(x1.xz, x1.yw, enter.y), x1y1 = mix(x1.xz, x1.yw, leave.y);
    vec4 z0 = mix(vec4(x0y0.x, x1y0.x, x0y1.x, x1y1.x), vec4(x0y0.y, x1y0.y, x0y1.y, x1y1.y), enter.z);
    vec4 z1 = mix(vec4(x0y0.x, x1y0.x, x0y1.x, x1y1.x), vec4(x0y0.y, x1y0.y, x0y1.y, x1y1.y), leave.z);
    return vec4(z0.x, (z0.y + z0.z + z1.x) / 3.0, (z0.w + z1.y + z1.z) / 3.0, z1.w);
}

// The node of the walk's cell, by cells of the walk.
float node_of_walk(Walk walk, out ivec3 low, out ivec3 high) {
    ivec3 one, other, turned = ivec3(lessThan(walk.way, ivec3(0)));
    float number = node_of(walk.begin - turned + walk.way * walk.cell, 0.5, one, other);
    low = walk.way * ((one + turned * (other - one)) - walk.begin);
    high = low + other - one;
    return number;
}

// Value and slope.
vec2 cubic_at(vec4 b, float s) {
    vec3 c = mix(b.xyz, b.yzw, s);
    vec2 d = mix(c.xy, c.yz, s);
    return vec2(mix(d.x, d.y, s), 3.0 * (d.y - d.x));
}

// Where a cubic changes sides between places that it does not turn between: steps of Newton, halves where these leave the bracket.
float crossing_between(vec4 b, float first, float last, bool below) {
    float s = 0.5 * (first + last);
    for (int k = 0; k < 24; ++k) {
        vec2 value = cubic_at(b, s);
        if ((value.x < 0.0) == below) first = s;
        else last = s;
        float next = s - value.x / (value.y == 0.0 ? 1e-30 : value.y);
        if (!(next > first && next < last)) next = 0.5 * (first + last);
        if (abs(next - s) < 1e-7) break;
        s = next;
    }
    return s;
}

// Places where a cubic changes sides, in order; 2 for none. At 0 if it begins on another side than the stretch before ended on.
vec3 crossings(vec4 b, bool below) {
    vec3 found = vec3(2.0);
    int count = 0;
    bool side = b.x < 0.0;
    if (side != below) found[count++] = 0.0;
    if (all(equal(lessThan(b, vec4(0.0)), bvec4(side)))) return found;
    float a = b.w - b.x - 3.0 * (b.z - b.y), h = b.x - 2.0 * b.y + b.z, c = b.y - b.x, square = h * h - a * c;
    float turns[3];
    turns[0] = turns[1] = turns[2] = 1.0;
    if (square > 0.0) {
        float r = -(h + (h < 0.0 ? -sqrt(square) : sqrt(square)));
        float one = a == 0.0 ? 1.0 : clamp(r / a, 0.0, 1.0), other = clamp(c / r, 0.0, 1.0);
        turns[0] = min(one, other);
        turns[1] = max(one, other);
    }
    float from = 0.0;
    for (int k = 0; k < 3 && count < 3; ++k) {
        bool next = cubic_at(b, turns[k]).x < 0.0;
        if (next != side) found[count++] = crossing_between(b, from, turns[k], side);
        side = next;
        from = turns[k];
    }
    return found;
}

float place_of(Stretch found, float s) { return mix(found.first, found.last, s); }

// Take from a stretch what shows; true if that is all. Defined beside it.
bool show_stretch(Ray ray, Stretch found);

// Go through all cells in which there may be a surface, in order.
void walk_cells(Ray ray, float start) {
    Walk walk = walk_from(ray, start);
    ivec3 last_cell = ivec3(volume_shape) - 2;
    vec3 inverse = abs(ray.inverse);
    float lowest = isovalues[0], highest = isovalues[0];
    for (int k = 1; k < isovalue_count; ++k) {
        lowest = min(lowest, isovalues[k]);
        highest = max(highest, isovalues[k]);
    }
    uint all_sides = (1u << isovalue_count) - 1u;
    while (walk.t < ray.last && all(lessThanEqual(walk.cell, last_cell))) {
        ivec3 low, high;
        if (node_of_walk(walk, low, high) <= 0.5) {
            vec3 out_of = (vec3(high) - walk.o) * inverse;
            float end = min(out_of.x, min(out_of.y, out_of.z));
            walk.t = max(walk.t, end);
            walk.known = false;
            ivec3 inside = clamp(ivec3(floor(walk.o + walk.t * walk.d)), low, high - 1);
            walk.cell = ivec3(mix(vec3(inside), vec3(high), equal(out_of, vec3(end))));
            continue;
        }
        high = min(high, last_cell + 1);
        if (!walk.known) {
            for (int k = 0; k < 4; ++k) {
                walk.low[k] = voxel_of(walk, walk.cell + ivec3(0, k & 1, k >> 1));
                walk.high[k] = voxel_of(walk, walk.cell + ivec3(1, k & 1, k >> 1));
            }
        }
        do {
            vec3 out_of = (vec3(walk.cell + 1) - walk.o) * inverse;
            float end = min(out_of.x, min(out_of.y, out_of.z));
            vec4 least = min(walk.low, walk.high), most = max(walk.low, walk.high);
            least.xy = min(least.xy, least.zw);
            most.xy = max(most.xy, most.zw);
            float bottom = min(least.x, least.y) * field_scale + field_shift, top = max(most.x, most.y) * field_scale + field_shift;
            uint sides = top < lowest ? all_sides : 0u;
            float first = walk.t;
            walk.t = clamp(end, first, ray.last);
            if ((top >= lowest && bottom < highest) || (walk.known && sides != walk.sides)) {
                vec3 enter = walk.o + first * walk.d - vec3(walk.cell), leave = walk.o + walk.t * walk.d - vec3(walk.cell);
                vec4 b = bernstein(walk.low, walk.high, clamp(enter, 0.0, 1.0), clamp(leave, 0.0, 1.0)) * field_scale + field_shift;
                uint before = walk.known ? walk.sides : sides_of(b.x);
#if FEATURE_VOLUME_CLOSED && !FEATURE_VOLUME_LAYERS
                if (first == box_enter) before = all_sides;
#endif
                if (show_stretch(ray, Stretch(first, walk.t, b, before))) return;
                sides = sides_of(b.w);
            }
            step_over(walk, end == out_of.x ? bvec3(true, false, false) : bvec3(false, end == out_of.y, end != out_of.y));
            walk.sides = sides;
            walk.known = true;
        } while (walk.t < ray.last && all(lessThan(walk.cell, high)));
    }
}
