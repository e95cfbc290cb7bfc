// A work group of 32 invocations decodes one fiblet together (paper: Schertzer et al. 2022, section 3.3.2 and figure 5):
// a prefix product of rigid motions in shared memory. Serves compute shaders and, unchanged, mesh shaders.
//
// Symbols (frames: see words.glsl)
//   A_i          motion of point i >= 1: x -> r_i x + step r_i X, where r_1 is the first frame and r_i = T[cap][code];
//                (r, t) stands for it, with t = step r X. A_0 is no motion
//   W_i          A_1 A_2 .. A_i (equation 3); the translation of W_i is P_i - P_0
//   product      (r_a, t_a) (r_b, t_b) = (r_a r_b, t_a + r_a t_b)
//
// The paper multiplies 4 x 4 matrices without their constant entries; a quaternion and a vector are 7 numbers, not 12.
// Lattice fiblets need no product: the same passes add up integers, without a rounding. Of splines each invocation finds the piece
// of its points, of at most nine.
//
// Algorithm (Sklansky's network): in pass p, every block of 2^(p+1) elements multiplies its upper half by the last
// element of its lower half. Each pass is 32 products for 64 elements, in place, with one barrier:
//
//       element  0 1 2 3 4 5 6 7
//       p = 0    +->   +->   +->        (0 into 1, 2 into 3, ..)
//       p = 1      +->->     +->->      (1 into 2 and 3, ..)
//       p = 2          +->->->->        (3 into 4 to 7)
//
// Use: all invocations of the group call decode_together(f); then prefix_point[0 .. last] are local millimetres, and
// prefix_point[last + 1] the next fiblet's anchor unless the streamline ends. Of splines prefix_frame has the curve's points. The
// call begins and ends with a barrier.

#include "fiblets/decode/words.glsl"

const uint PREFIX_THREADS = 32u;
const uint PREFIX_PASSES = 6u;

shared vec4 prefix_frame[2u * PREFIX_THREADS];
shared vec3 prefix_point[2u * PREFIX_THREADS];
#if FEATURE_LATTICE
shared ivec3 prefix_lattice[2u * PREFIX_THREADS];
#endif

vec3 rotated(vec4 q, vec3 v) {
    vec3 u = 2.0 * cross(q.xyz, v);
    return v + q.w * u + cross(q.xyz, u);
}

vec4 product(vec4 a, vec4 b) {
    return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}

void decode_together(uint f) {
    uvec3 words = decoding_words(f);
    uint last = fiblet_last(words), byte = first_code(f, words), thread = gl_LocalInvocationIndex;
    uint kind = coded_kind(words);
    bool moves = kind == KIND_DIRECTION;
    float unit = 0.0;
    barrier();  // whatever an earlier call left has been read

    // (b) every invocation makes two motions
    for (uint i = thread; i < 2u * PREFIX_THREADS && thread < PREFIX_THREADS; i += PREFIX_THREADS) {
        bool held = i >= 1u && i <= last;
        prefix_frame[i] = vec4(0.0, 0.0, 0.0, 1.0);
        prefix_point[i] = vec3(0.0);
#if FEATURE_DIRECTION
        if (held && moves) {
            uint code = i >= 2u ? code_at(byte + i - 2u) : 0u;
            vec4 r = i == 1u ? first_frame(fiblet_shape(words)) : rotation(fiblet_cap(words), code, rotation_scale(fiblet_cap(words)));
            prefix_frame[i] = r;
            prefix_point[i] = step_length(words) * rotated_x(r);
        }
#endif
#if FEATURE_LATTICE
        prefix_lattice[i] = ivec3(0);
        if (held && !moves && kind != KIND_SPLINE) {
            uint at = byte, width;
            uvec2 n;
            ivec3 lo;
            lattice_box(words, at, lo, n, width);
            prefix_lattice[i] = lattice_cell(at + (i - 1u) * width, width, lo, n);
        }
#endif
    }
    barrier();

    // (c) the prefix product
    for (uint p = 0u; p < PREFIX_PASSES; ++p) {
        if (thread < PREFIX_THREADS) {
            uint block = (thread >> p) << (p + 1u), low = block + (1u << p) - 1u;
            uint high = low + 1u + (thread & ((1u << p) - 1u));
            vec4 r = prefix_frame[low];
            prefix_point[high] = prefix_point[low] + rotated(r, prefix_point[high]);
            prefix_frame[high] = product(r, prefix_frame[high]);
#if FEATURE_LATTICE
            prefix_lattice[high] += prefix_lattice[low];
#endif
        }
        barrier();
    }

    // (d) positions
#if FEATURE_LATTICE || FEATURE_SPLINE
    unit = lattice_edge * exp2(-float(fiblet_cap(words)));
#endif
    vec3 anchor = anchor_local(f);
    bool end = ends(f);
    for (uint i = thread; i < 2u * PREFIX_THREADS && thread < PREFIX_THREADS; i += PREFIX_THREADS) {
        vec3 point = anchor + prefix_point[i];
#if FEATURE_LATTICE
        if (!moves) point = anchor + unit * vec3(prefix_lattice[i]);
#endif
#if FEATURE_SPLINE
        if (kind == KIND_SPLINE) {
            vec3 local = i > 0u && last > 0u ? spline_at(words, byte, min(i, last)) : vec3(0.0);
            prefix_frame[i] = vec4(local, 0.0);
            point = anchor + unit * local;
        }
#endif
        if (i == last + 1u && !end) point = anchor_local(f + 1u);
        prefix_point[i] = point;
    }
    barrier();
}
