// A mesh work group of {{ mesh_threads }} invocations draws one fiblet, or a share of it (paper: Schertzer et al. 2022, section 3.3.2 and figure
// 5): all decode it together (fiblets/decode/parallel.glsl), then every invocation writes two of its segments, the one to the next
// fiblet's first point included.
//
// What a walk along the fiblet would carry from one segment to the next is found for each of them here: the length of all before, the
// next one's run.
//
// From far enough a fiblet is one segment, between the ends of its capsule, and is not decoded (section 3.4.4).

#include "fiblets/decode/parallel.glsl"
#include "culling/bounds.glsl"
#include "fiblets/data/point_mask.glsl"
#include "fiblets/attributes/neighbours.glsl"
#include "fiblets/hardware_raster/handed.glsl"
#include "fiblets/data/values.glsl"
#if FEATURE_VALUES_VOLUME
#include "fiblets/data/volume.glsl"
#endif
#include "fiblets/mesh/draw_segment.glsl"

struct Group {
    uint f;
    uint last;       // last point
    uint count;      // segments; a single point is a segment of no length
    bool begin;      // the streamline begins here
    bool end;        // and ends here
    bool whole;      // one segment for the fiblet
    float spans;     // steps from point to point of a segment
    vec3 far_from;   // that segment
    vec3 far_to;
    float unit;      // mm that decoded steps are in units of: the step of a direction fiblet, or the lattice's edge
    bool moves;      // of direction codes
    bool curved;
#if FEATURE_WIDE_LINES
    vec3 beyond;     // the run after its last segment, where the line goes on there as it does here
#endif
};

Group group;

vec3 point_of(uint i) {
    if (group.whole) return i == 0u ? group.far_from : group.far_to;
    return prefix_point[i];
}

// From point i to the next: exact where points have lost digits.
vec3 delta_of(uint i) {
    if (group.whole) return group.far_to - group.far_from;
    if (i < group.last) {
#if FEATURE_DIRECTION
        if (group.moves) return group.unit * rotated_x(prefix_frame[i + 1u]);
#endif
#if FEATURE_SPLINE
        if (group.curved) return group.unit * (prefix_frame[i + 1u].xyz - prefix_frame[i].xyz);
#endif
#if FEATURE_LATTICE
        if (!group.moves) return group.unit * vec3(prefix_lattice[i + 1u] - prefix_lattice[i]);
#endif
    }
    return prefix_point[i + 1u] - prefix_point[i];
}

// The run of the segment after one, where the line goes on as it says.
vec3 ahead_of(uint segment) {
#if FEATURE_WIDE_LINES
    return segment + 1u < group.count ? delta_of(segment + 1u) : group.beyond;
#else
    return vec3(0.0);
#endif
}

#if FEATURE_VALUES_ARC_LENGTH
shared float prefix_length[2u * PREFIX_THREADS];  // of the segments before each point

// The prefix sum of lengths, by the network of fiblets/decode/parallel.glsl.
void add_lengths() {
    uint thread = gl_LocalInvocationIndex;
    for (uint i = thread; i < 2u * PREFIX_THREADS && thread < PREFIX_THREADS; i += PREFIX_THREADS) {
        prefix_length[i] = i > 0u && i <= group.count ? length(delta_of(i - 1u)) : 0.0;
    }
    barrier();
    for (uint p = 0u; p < PREFIX_PASSES; ++p) {
        if (thread < PREFIX_THREADS) {
            uint low = ((thread >> p) << (p + 1u)) + (1u << p) - 1u;
            prefix_length[low + 1u + (thread & ((1u << p) - 1u))] += prefix_length[low];
        }
        barrier();
    }
}
#endif

// The per-point value at both ends of a segment, where it is not looked up by the fragments.
vec2 values_of(uint segment) {
#if FEATURE_VALUES_ARC_LENGTH
    float start = start_value(group.f);
    if (group.whole) {
        float length = distance(group.far_from, group.far_to);
        if (group.spans <= 1.0) return vec2(start, start + length);
        // longer than the segment: its length is that of the fiblet's steps
        if (!group.end) return vec2(start, start_value(group.f + 1u));
        float walked = group.moves ? float(group.last) * group.unit : 0.0;
        return vec2(start, start + max(length, walked));
    }
    return start + vec2(prefix_length[segment], prefix_length[segment + 1u]);
#elif FEATURE_VALUES_VOLUME
    if (group.whole && group.spans > 1.0) return vec2(0.0);
    return vec2(volume_at(point_of(segment)), volume_at(point_of(segment + 1u)));
#else
    return vec2(0.0);
#endif
}

void draw_share(uint f, uint share) {
    begin_point_mask(f);
    uvec3 words = decoding_words(f);
    uint last = fiblet_last(words);
    group.f = f;
    group.last = last;
    group.begin = begins(f);
    group.end = ends(f);
    group.whole = false;
    group.moves = coded_kind(words) == KIND_DIRECTION;
    group.curved = coded_kind(words) == KIND_SPLINE;
    group.spans = group.end && last == 0u ? 0.0 : 1.0;
    group.count = last + (group.end && last > 0u ? 0u : 1u);
    group.unit = group.moves ? step_length(words) : lattice_edge * exp2(-float(fiblet_cap(words)));
#if FEATURE_LEVEL_OF_DETAIL
    Capsule capsule = capsule_of(f);
    if (is_one_segment(capsule) && all_points_shown()) {
        group.spans = float(last + (group.end ? 0u : 1u));
        group.count = 1u;
        group.whole = true;
        group.far_from = capsule.a;
        group.far_to = capsule.b;
    }
#endif
    uint first = (SHARES - 1u - share) * SHARE, end = min(group.count, first + SHARE);
    if (first >= end) {
        put_counts(0u, 0u);
        return;
    }
    put_counts(vertices_of(end - first), PRIMITIVES * (end - first));
#if FEATURE_WIDE_LINES
    group.beyond = alike_after(f, group.whole) ? direction_after(f, group.whole) : vec3(0.0);
#endif
    if (!group.whole) decode_together(f);
#if FEATURE_VALUES_ARC_LENGTH
    if (!group.whole) add_lengths();
#endif
    uint streamline = handed_streamline(f);
    float first_point = handed_first(f);
    for (uint i = first + gl_LocalInvocationIndex; i < end; i += PREFIX_THREADS) {
        Varyings varyings = Varyings(streamline, chunk_first + f, first_point, i, group.spans, values_of(i), ahead_of(i));
        bool start = i == 0u && group.begin, cap = i + 1u == group.count && group.end;
        draw_segment(i - first, end - first, varyings, point_of(i), point_of(i + 1u), start, cap);
    }
}
