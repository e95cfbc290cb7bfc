// Walks and covers apart: each invocation of a work group walks along a fiblet of its own, and then all cover the segments that have pixels.
//
// Seen from afar two of three segments begin and end in the same pixel. Where an invocation covers its own, those of a warp wait for
// each other at every segment, a third of them at work; here all but the last ones of a batch are. Software OpenGL pays more for barriers.
//
// The including pass defines
//   void begin_cover(uint f), void end_cover(uint f)    called around the pixels of each segment
// and all invocations call draw_together().

const uint JOBS = 768u, AT_ONCE = JOBS / {{ group_size }}u;   // segments of a batch, and of each fiblet
#if FEATURE_ONE_SEGMENT
const uint MOST_SEGMENTS = 1u;
#else
const uint MOST_SEGMENTS = FIBLET_MAX_POINTS;
#endif

struct Job { uint fiblet; uint a; uint b; float z0; float z1; };   // pixels and depths of the ends; ~fiblet: the line ends there

shared uint job_count;
shared Job jobs[JOBS];

uint walked;

uint packed_pixel(ivec2 pixel) { return uint(pixel.x & 0xFFFF | pixel.y << 16); }

vec2 middle_of(uint pixel) { return vec2(bitfieldExtract(int(pixel), 0, 16), bitfieldExtract(int(pixel), 16, 16)) + 0.5; }

void take(Segment segment) {
    ivec2 a = ivec2(pixel_of(segment.piece.a)), b = ivec2(pixel_of(segment.piece.b));
    if (a == b && !segment.piece.cap) return;
    uint fiblet = segment.piece.cap ? ~walked : walked;
    jobs[atomicAdd(job_count, 1u)] = Job(fiblet, packed_pixel(a), packed_pixel(b), segment.piece.a.z, segment.piece.b.z);
}

void cover_job(Job job) {
    bool cap = job.fiblet > 0x7FFFFFFFu;
    uint f = cap ? ~job.fiblet : job.fiblet;
    Segment segment;
    segment.index = 0u;
    segment.piece.a = vec4(middle_of(job.a), job.z0, 1.0);
    segment.piece.b = vec4(middle_of(job.b), job.z1, 1.0);
    segment.piece.cap = cap;
    begin_cover(f);
    cover(segment);
    end_cover(f);
}

void draw_together() {
    for (uint k = 0u; nth_fiblet(k) != NO_FIBLET; k += gl_WorkGroupSize.x) {
        walked = nth_fiblet(k + gl_LocalInvocationIndex);
        polyline.count = 0u;
        if (walked != NO_FIBLET) begin_drawing(walked);
        for (uint end = AT_ONCE;; end += AT_ONCE) {
            if (gl_LocalInvocationIndex == 0u) job_count = 0u;
            barrier();
            if (walked != NO_FIBLET) draw_until(end);
            barrier();
            for (uint j = gl_LocalInvocationIndex; j < job_count; j += gl_WorkGroupSize.x) cover_job(jobs[j]);
            barrier();
            if (end >= MOST_SEGMENTS) break;
        }
    }
}
