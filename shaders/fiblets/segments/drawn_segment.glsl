// A segment of a fiblet, and the part of it that is drawn.

#include "fiblets/segments/clipped_segment.glsl"

struct Segment {
    uint index;      // within the fiblet; of several merged into one, the first's
    Vertex from;
    Vertex to;
    ClippedSegment piece;
    float steps;     // from point to point that it stands for
    vec3 ahead;      // the next one's run
    bool goes_on;    // whether the line does
};

#if FEATURE_TUBES
// The run of what follows a segment, where that is drawn.
vec3 next_run(Segment segment) {
#if FEATURE_CLIP_REGION
    return segment.piece.cap || !segment.goes_on ? vec3(0.0) : segment.ahead;
#else
    return vec3(0.0);
#endif
}
#endif
