// Rays by cells: along a ray, the field within a cell of eight voxels is a cubic, whose crossings and peaks are found exactly.
// Paper: Lesar 2015, sections III.B and III.F, looks at places a step apart instead. That a product of three linear functions of t is a
// cubic, and its roots the surface, is well known (Parker and others, "Interactive ray tracing for isosurface rendering", 1998).
//
// Symbols
//   s            0 where the ray enters the cell, 1 where it leaves it
//   b            Bernstein coefficients of the field over s: the blossom of the trilinear interpolant. The field lies between
//                the least and the largest of them
//   sides        of surfaces, a bit for each isovalue: the field is below it (volumes/surface_cells.glsl)
//
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

// From first to where the walk is.
vec4 bernstein(Walk walk, float first) {
    vec3 enter = clamp(walk.o + first * walk.d - vec3(walk.cell), 0.0, 1.0);
    vec3 leave = clamp(walk.o + walk.t * walk.d - vec3(walk.cell), 0.0, 1.0);
    vec4 low = walk.low, high = walk.high;
    vec4 x0 = mix(low, high, enter.x), x1 = mix(low, high, leave.x);
    vec2 x0y0 = mix(x0.xz, x0.yw, enter.y), x0y1 = mix(x0.xz, x0.yw, leave.y);
    vec2 x1y0 = mix(x1.xz, x1.yw, enter.y), x1y1 = mix(x1.xz, x1.yw, leave.y);
    vec4 z0 = mix(vec4(x0y0.x, x1y0.x, x0y1.x, x1y1.x), vec4(x0y0.y, x1y0.y, x0y1.y, x1y1.y), enter.z);
    vec4 z1 = mix(vec4(x0y0.x, x1y0.x, x0y1.x, x1y1.x), vec4(x0y0.y, x1y0.y, x0y1.y, x1y1.y), leave.z);
    return vec4(z0.x, (z0.y + z0.z + z1.x) / 3.0, (z0.w + z1.y + z1.z) / 3.0, z1.w) * field_scale + field_shift;
}

// The node of the walk's cell, by cells of the walk.
float node_of_walk(Walk walk, float threshold, out ivec3 low, out ivec3 high) {
    ivec3 one, other, turned = ivec3(lessThan(walk.way, ivec3(0)));
    float number = node_of(walk.begin - turned + walk.way * walk.cell, threshold, one, other);
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

// Where a cubic turns, in order; 1 for nowhere.
vec2 turns_of(vec4 b) {
    float a = b.w - b.x - 3.0 * (b.z - b.y), h = b.x - 2.0 * b.y + b.z, c = b.y - b.x, square = h * h - a * c;
    if (!(square > 0.0)) return vec2(1.0);
    float r = -(h + (h < 0.0 ? -sqrt(square) : sqrt(square)));
    float one = a == 0.0 ? 1.0 : clamp(r / a, 0.0, 1.0), other = clamp(c / r, 0.0, 1.0);
    return vec2(min(one, other), max(one, other));
}

// A node is left out if its number is not above it.
float node_threshold();

// Whether nothing from a node of that number on shows.
bool ends_before(float number);

// Take what shows of a cell, from first to where the walk is; true if that is all. The field lies between bottom and top in it.
bool show_cell(Ray ray, inout Walk walk, float first, float bottom, float top);

// Go through all cells in which something may show, in order.
void walk_cells(Ray ray, float start) {
    Walk walk = walk_from(ray, start);
    ivec3 last_cell = ivec3(volume_shape) - 2;
    vec3 inverse = abs(ray.inverse);
    while (walk.t < ray.last && all(lessThanEqual(walk.cell, last_cell))) {
        ivec3 low, high;
        float threshold = node_threshold(), number = node_of_walk(walk, threshold, low, high);
        if (ends_before(number)) return;
        if (number <= threshold) {
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
            float first = walk.t;
            walk.t = clamp(end, first, ray.last);
            if (show_cell(ray, walk, first, bottom, top)) return;
            step_over(walk, end == out_of.x ? bvec3(true, false, false) : bvec3(false, end == out_of.y, end != out_of.y));
            walk.known = true;
        } while (walk.t < ray.last && all(lessThan(walk.cell, high)));
    }
}
