// One invocation decodes one fiblet, point after point, in registers (paper: Schertzer et al. 2022, section 3.3.1 and
// appendix B; the lattice kinds are this program's own).
//
// Symbols (frames: see words.glsl)
//   P            position, local millimetres; P_0 is the anchor
//   delta        P_i - P_(i-1), exact where P itself has lost digits
//   K            position on the integer lattice of edge h around the anchor
//   lo, n        a lattice code counts the cells of a box of n.x * n.y * n.z steps whose least corner is lo
//
// Algorithm
//   direction:   q <- q T[cap][code] from the third point on; P <- P + step (q X)
//   splines:     P = P_0 + h times the curve's point, its pieces one after the other
//   lattice:     c = code; K <- K + lo + (c mod n.x, c / n.x mod n.y, c / (n.x n.y)); P = P_0 + h K
//
// Use: walk_begin(f), then walk_next(i) for i = 1, 2, ... walk.last, in order. Everything is `precise`: the pass that
// finds the nearest depth and the pass that looks for it again must compute the very same bits.

#include "fiblets/decode/words.glsl"

struct Walk {
    uint last;     // index of the last point
    uint kind;
    uint byte;     // where the next code stands
    uint cap;      // cap angle, and the scale of its rotations
    float scale;
    float step;    // mm; of the lattice: its edge
    uint width;    // bytes per lattice code
    uvec2 n;
    ivec3 lo;
    ivec3 k;
    uint m;        // point of the spline's piece
    float path;    // mm from point to point, along a spline
};

Walk walk;
#if FEATURE_SPLINE
Spline walk_spline;
vec3 walk_local;
#if __VERSION__ >= 400
precise walk_local;
#endif
#endif
vec3 walk_anchor;
vec3 walk_point;
vec3 walk_delta;
vec4 walk_frame;
// Qualified afterwards: glslang takes `precise vec3 name;` for a variable of the next function.
#if __VERSION__ >= 400
precise walk_anchor;
precise walk_point;
precise walk_delta;
precise walk_frame;
#endif

void walk_begin(uint f) {
    uvec3 words = decoding_words(f);
    walk_anchor = anchor_local(f);
    walk_point = walk_anchor;
    walk_delta = vec3(0.0);
    walk.last = fiblet_last(words);
    walk.kind = coded_kind(words);
    walk.byte = first_code(f, words);
#if FEATURE_DIRECTION
    walk.cap = fiblet_cap(words);
    walk.scale = rotation_scale(walk.cap);
    walk.step = step_length(words);
    walk_frame = first_frame(fiblet_shape(words));
#endif
#if FEATURE_SPLINE
    if (walk.kind == KIND_SPLINE) {
        walk.step = lattice_edge * exp2(-float(fiblet_cap(words)));
        walk.m = 0u;
        walk.path = 0.0;
        walk_local = vec3(0.0);
        if (walk.last > 0u) walk_spline = begin_spline(words, walk.byte);
        return;
    }
#endif
#if FEATURE_LATTICE
    if (walk.kind != KIND_DIRECTION) {
        walk.k = ivec3(0);
        walk.step = lattice_edge * exp2(-float(fiblet_cap(words)));
        lattice_box(words, walk.byte, walk.lo, walk.n, walk.width);
    }
#endif
}

// Moves to point i.
void walk_next(uint i) {
#if FEATURE_SPLINE
    if (walk.kind == KIND_SPLINE) {
        if (walk.m == walk_spline.n) {
            next_piece(walk_spline);
            walk.m = 0u;
        }
        walk.m += 1u;
        vec3 local = spline_point(walk_spline, walk.m);
        walk_delta = walk.step * (local - walk_local);
        walk_local = local;
        walk_point = walk_anchor + walk.step * local;
        walk.path += length(walk_delta);
        return;
    }
#endif
#if FEATURE_LATTICE
    if (walk.kind != KIND_DIRECTION) {
        ivec3 cell = lattice_cell(walk.byte, walk.width, walk.lo, walk.n);
        walk.byte += walk.width;
        walk.k += cell;
        walk_delta = walk.step * vec3(cell);
        walk_point = walk_anchor + walk.step * vec3(walk.k);
        return;
    }
#endif
#if FEATURE_DIRECTION
    if (i > 1u) {
        walk_frame = turned(walk_frame, rotation(walk.cap, code_at(walk.byte + i - 2u), walk.scale));
    }
    walk_delta = walk.step * rotated_x(walk_frame);
    walk_point += walk_delta;
#endif
}
