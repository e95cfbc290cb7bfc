// The decoding half of a record, the codes and the direction table, and the helpers that both ways to decode share:
// one fiblet by one invocation (fiblets/decode/sequential.glsl) or by a work group together (fiblets/decode/parallel.glsl).
//
// Symbols (paper, section 3.3.2 and appendices A and B)
//   X            (1, 0, 0)
//   q            frame as a unit quaternion (x, y, z, w): q turns X to the direction of the segment
//   T[cap][code] the rotation that a code stands for: the smallest one that turns X to its direction, hence without
//                an x component, which makes a product 12 multiplications instead of 16. A word holds y and z as 16-bit
//                integers times the cap angle's scale; w follows from the unit length

#include "fiblets/decode/record.glsl"
#include "fiblets/data/decoding.glsl"

uvec3 decoding_words(uint f) {
    uint at = FIBLET_DECODING_WORDS * f;
    return uvec3(decoding_word(at), decoding_word(at + 1u), decoding_word(at + 2u));
}

// First byte of a fiblet's codes, counted from the chunk's first.
uint first_code(uint f, uvec3 words) { return page_words(f >> FIBLET_PAGE_BITS).y + fiblet_code(words); }

uint code_at(uint byte) { return bitfieldExtract(code_word(byte >> 2), int(byte & 3u) * 8, 8); }

// Four bytes from any byte position, least significant first.
uint codes_at(uint byte) {
    uint word = byte >> 2, shift = (byte & 3u) * 8u;
    uint low = code_word(word);
    return shift == 0u ? low : (low >> shift) | (code_word(word + 1u) << (32u - shift));
}

float rotation_scale(uint cap) { return rotation_scales[cap >> 2][cap & 3u]; }

// T of a cap angle and a code, given the cap angle's scale.
vec4 rotation(uint cap, uint code, float scale) {
    int word = int(rotation_word((cap << 8u) + code));
    precise vec2 t = scale * vec2(bitfieldExtract(word, 0, 16), bitfieldExtract(word, 16, 16));
    precise float w = sqrt(1.0 - t.x * t.x - t.y * t.y);
    return vec4(0.0, t, w);
}

// A fiblet of splines is of the kind WIDE, with a width that no lattice has.
uint coded_kind(uvec3 words) {
#if FEATURE_SPLINE
    if (fiblet_kind(words) == KIND_WIDE && (fiblet_step(words) & 7u) == KIND_SPLINE) return KIND_SPLINE;
#endif
    return fiblet_kind(words);
}

float sign_of(int value) { return value < 0 ? -1.0 : 1.0; }

float step_length(uvec3 words) { return step_low + float(fiblet_step(words)) * (step_span / FIBLET_STEP_LEVELS); }

// The first direction's frame, M_0 of the paper. The octahedron's fold is decided on the integers, so that rounding
// cannot choose another frame than the encoder's.
vec4 first_frame(uint shape) {
    int u = bitfieldExtract(int(shape), 0, 16), v = bitfieldExtract(int(shape), 16, 16);
    bool forward = abs(u) + abs(v) <= int(FIBLET_DIRECTION_SCALE);
    precise vec2 s = vec2(float(u), float(v)) / FIBLET_DIRECTION_SCALE;
    precise float x = 1.0 - abs(s.x) - abs(s.y);
    precise vec3 d = forward ? vec3(x, s)
                             : vec3(x, (1.0 - abs(s.y)) * sign_of(u), (1.0 - abs(s.x)) * sign_of(v));
    d = d / sqrt(dot(d, d));
    precise vec3 h = forward ? vec3(1.0 + d.x, -d.z, d.y) : vec3(1.0 - d.x, d.z, -d.y);  // w, y, z
    h = h / sqrt(dot(h, h));
    return forward ? vec4(0.0, h.y, h.z, h.x) : vec4(h.y, 0.0, h.x, -h.z);
}

vec3 rotated_x(vec4 q) {
    precise vec3 d = vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    return d;
}

// a then, in its frame, a code's rotation t (t.x = 0).
vec4 turned(vec4 a, vec4 t) {
    precise vec4 q = vec4(a.x * t.w + a.y * t.z - a.z * t.y, a.w * t.y - a.x * t.z + a.y * t.w,
                          a.w * t.z + a.x * t.y + a.z * t.w, a.w * t.w - a.y * t.y - a.z * t.z);
    return q;
}

#if FEATURE_SPLINE
// A fiblet of cubic pieces end to end (this program's own; pvfiblets/codec/kernels/spline_kernels.py has the symbols): from a place
// and a slope, points m = 1 .. n at place + m slope + x^2 (d - 2 e) + 2 e x^3, with x = m / n. In powers of m a point takes three
// products.
struct Spline {
    vec3 place;    // in units of the lattice's edge, from the anchor
    vec3 slope;    // a point
    vec3 square;   // (d - 2 e) / n^2
    vec3 cube;     // 2 e / n^3
    uint n;
    uint byte;     // where the next node stands
};

vec3 signed_bits(int word, int low, int count) {
    return vec3(bitfieldExtract(word, low, count), bitfieldExtract(word, low + count, count),
                bitfieldExtract(word, low + 2 * count, count));
}

void load_node(inout Spline s) {
    int low = int(codes_at(s.byte)), high = int(codes_at(s.byte + 2u));
    s.n = max(uint(low) & 63u, 1u);
    vec3 d = signed_bits(low, 6, FIBLET_NODE_BITS), e = signed_bits(high, 11, FIBLET_NODE_BITS);
    precise float share = 1.0 / float(s.n);
    precise vec3 square = (d - 2.0 * e) * share * share, cube = 2.0 * e * share * share * share;
    s.square = square;
    s.cube = cube;
    s.byte += FIBLET_NODE_BYTES;
}

Spline begin_spline(uvec3 words, uint byte) {
    int shape = int(fiblet_shape(words));
    float scale = exp2(float(2u * (uint(shape) >> 30u)) - float(FIBLET_SLOPE_SHIFT));
    Spline s;
    s.place = vec3(0.0);
    s.slope = scale * signed_bits(shape, 0, FIBLET_SLOPE_BITS);
    s.byte = byte;
    load_node(s);
    return s;
}

vec3 spline_point(Spline s, uint m) {
    float t = float(m);
    precise vec3 p = s.place + t * (s.slope + t * (s.square + t * s.cube));
    return p;
}

void next_piece(inout Spline s) {
    float n = float(s.n);
    precise vec3 slope = s.slope + n * (2.0 * s.square + 3.0 * n * s.cube);
    s.place = spline_point(s, s.n);
    s.slope = slope;
    load_node(s);
}

// Point i >= 1 of a fiblet.
vec3 spline_at(uvec3 words, uint byte, uint i) {
    Spline s = begin_spline(words, byte);
    for (; i > s.n; next_piece(s)) i -= s.n;
    return spline_point(s, i);
}
#endif

#if FEATURE_LATTICE
// The box of a lattice fiblet: its least corner, its size, bytes per code, and where the codes start.
void lattice_box(uvec3 words, inout uint byte, out ivec3 lo, out uvec2 n, out uint width) {
    int shape = int(fiblet_shape(words));
    lo = ivec3(bitfieldExtract(shape, 0, 8), bitfieldExtract(shape, 8, 8), bitfieldExtract(shape, 16, 8));
    n = uvec2((uint(shape) >> 24u) + 1u, (fiblet_step(words) & 255u) + 1u);
    width = fiblet_kind(words);
#if FEATURE_WIDE_LATTICE
    if (fiblet_kind(words) == KIND_WIDE && fiblet_last(words) > 0u) {
        width = fiblet_step(words) & 7u;
        if (width == 0u) {  // plain: no box, three whole numbers a code
            lo = ivec3(0);
            width = FIBLET_PLAIN_BYTES;
            return;
        }
        lo = ivec3(codes_at(byte), codes_at(byte + 4u), codes_at(byte + 8u));
        n = uvec2(codes_at(byte + 12u), codes_at(byte + 16u));
        byte += FIBLET_WIDE_HEADER;
    }
#endif
}

ivec3 lattice_cell(uint byte, uint width, ivec3 lo, uvec2 n) {
#if FEATURE_WIDE_LATTICE
    if (width == FIBLET_PLAIN_BYTES) return lo + ivec3(codes_at(byte), codes_at(byte + 4u), codes_at(byte + 8u));
#endif
    uint code = codes_at(byte) & (0xFFFFFFFFu >> (32u - 8u * width));
    uint row = code / n.x;
    return lo + ivec3(code - row * n.x, row % n.y, row / n.y);
}
#endif
