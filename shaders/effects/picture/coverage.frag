// Smooth edges of lines: every pixel shows as much of a line as the line covers of it.
//
// The picture holds one line a pixel. What else a pixel would show is known from its neighbours: where the edges of their lines
// run (frame/edges.glsl) is known to a fraction of a pixel, and these go on through this pixel. So each of 16 samples of the
// pixel takes the colour of the nearest line, of the nine here and around it, whose band covers it. Light was computed once a
// pixel, and colours are those of the finished picture.
//
//   . . .     What is left open shows what is behind:
//   .[#]#       a pixel without a line     what it shows anyway
//   # # .       a pixel with one           what lies behind its neighbours on that side, where they have no line and are not
//                                          in front of it; else their lines, as between lines there are others
//
// Only what lies nearer than the pixel's own covers a pixel without a line: lines do not run over a mesh that hides them.
// Lines that no pixel of the nine shows are not known; this is what is wrong with it in dense bundles.
//
//   shown      of visible_edges.frag, with a border of one texel
//   colours    of the same
//   shift      from a pixel of the target to one of both
//
// Colours are averaged as they are displayed, as supersampling does.

#version 430

uniform usampler2D shown;
uniform sampler2D colours;
uniform ivec2 shift;
out vec4 colour;

const float EDGE_STEPS = 448.0, EDGE_LEAST = 2.0, WIDTH_STEPS = 32.0;      // of frame/edges.glsl
const uint WIDEST = 127u;
const float REACH = {{ reach }};   // pixels along a line up to which it is taken to go straight on

// Quarter by quarter of the pixel: right and left of the upper half, right and left of the lower one.
const vec4 SAMPLES_X[4] = vec4[4](vec4(1.5, 2.5, 5.5, 6.5), vec4(-2.5, -1.5, -5.5, -7.5),
                                  vec4(4.5, 3.5, 0.5, 7.5), vec4(-0.5, -4.5, -3.5, -6.5));
const vec4 SAMPLES_Y[4] = vec4[4](vec4(1.5, 5.5, 3.5, 7.5), vec4(2.5, 6.5, 4.5, 0.5),
                                  vec4(-0.5, -4.5, -6.5, -3.5), vec4(-2.5, -1.5, -5.5, -7.5));
const uint ALL = 0xFFFFu;

uint bits(bvec4 inside) {
    return (inside.x ? 1u : 0u) | (inside.y ? 2u : 0u) | (inside.z ? 4u : 0u) | (inside.w ? 8u : 0u);
}

float count(uint mask) {
#if __VERSION__ >= 400
    return float(bitCount(mask));
#else
    mask -= (mask >> 1u) & 0x5555u;
    mask = (mask & 0x3333u) + ((mask >> 2u) & 0x3333u);
    mask = (mask + (mask >> 4u)) & 0x0F0Fu;
    return float((mask + (mask >> 8u)) & 31u);
#endif
}

// Samples of this pixel, a bit each, that the band of a line covers; at: this pixel, from the one that shows the line.
uint covered(uint word, vec2 at) {
    if (word == 0u) return 0u;
    float turn = float(word & 2047u) / 512.0, x = turn < 2.0 ? 1.0 - turn : turn - 3.0;
    vec2 n = normalize(vec2(x, turn < 2.0 ? 1.0 - abs(x) : abs(x) - 1.0));
    float e = float((word >> 11u) & 2047u) / EDGE_STEPS - EDGE_LEAST;
    uint width = (word >> 22u) & 127u, end = word >> 29u;
    float half_width = width == WIDEST ? 64.0 : 0.5 / WIDTH_STEPS * float(width);
    float stop = (float(end > 3u ? end - 3u : end) - 2.0) / 3.0;
    float low = end == 7u ? -0.5 : end > 3u ? stop : -REACH, high = end == 7u ? 0.5 : end > 0u && end < 4u ? stop : REACH;
    float across = dot(n, at) - e + half_width, along = n.x * at.y - n.y * at.x - 0.5 * (low + high);
    float half_length = 0.5 * (high - low);
    n /= 16.0;
    uint mask = 0u;
    for (int quarter = 0; quarter < 4; ++quarter) {
        vec4 u = abs(across + n.x * SAMPLES_X[quarter] + n.y * SAMPLES_Y[quarter]) - half_width;
        vec4 s = abs(along + n.x * SAMPLES_Y[quarter] - n.y * SAMPLES_X[quarter]) - half_length;
        mask |= bits(lessThanEqual(max(u, s), vec4(0.0))) << uint(4 * quarter);
    }
    return mask;
}

uvec2 around[9];
uint masks[9];
uint hidden[9];
float shares[9];

#define FETCH(k, right, up) around[k] = texelFetch(shown, pixel + ivec2(right, up), 0).rg;
#define COVER(k, right, up) \
    masks[k] = line || around[k].x < own.x ? covered(around[k].y, -vec2(right, up)) : 0u; \
    hidden[k] = 0u;
#define NINE(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(4, 0, 0) what(5, 1, 0) \
    what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define PAIR(j, k) \
    { bool j_first = around[j].x <= around[k].x; \
      hidden[k] |= j_first ? masks[j] : 0u; \
      hidden[j] |= j_first ? 0u : masks[k]; }
#define SHARE(k, right, up) shares[k] = count(masks[k] & ~hidden[k]);
#define ADD(k, right, up) if (shares[k] > 0.0) sum += shares[k] * texelFetch(colours, pixel + ivec2(right, up), 0);

// What three neighbours on a side are good for: those that are behind, or if none is, those that have lines.
#define OPEN(quarter, a, b, c) \
    { float left = count((open >> uint(4 * quarter)) & 15u); \
      vec3 behind = vec3(around[a].y == 0u && around[a].x > own.x, around[b].y == 0u && around[b].x > own.x, \
                         around[c].y == 0u && around[c].x > own.x); \
      vec3 lines = vec3(around[a].y != 0u, around[b].y != 0u, around[c].y != 0u); \
      vec3 good = behind == vec3(0.0) ? lines : behind; \
      float sum = good.x + good.y + good.z; \
      good *= sum > 0.0 ? left / sum : 0.0; \
      shares[a] += good.x; shares[b] += good.y; shares[c] += good.z; \
      shares[4] += sum > 0.0 ? 0.0 : left; }

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + shift;
    NINE(FETCH)
    uint any = (around[0].y | around[1].y | around[2].y) | (around[3].y | around[4].y | around[5].y)
             | (around[6].y | around[7].y | around[8].y);
    if (any == 0u) discard;
    uvec2 own = around[4];
    bool line = own.y != 0u;
    NINE(COVER)
    PAIR(0, 1) PAIR(0, 2) PAIR(0, 3) PAIR(0, 4) PAIR(0, 5) PAIR(0, 6) PAIR(0, 7) PAIR(0, 8)
    PAIR(1, 2) PAIR(1, 3) PAIR(1, 4) PAIR(1, 5) PAIR(1, 6) PAIR(1, 7) PAIR(1, 8)
    PAIR(2, 3) PAIR(2, 4) PAIR(2, 5) PAIR(2, 6) PAIR(2, 7) PAIR(2, 8)
    PAIR(3, 4) PAIR(3, 5) PAIR(3, 6) PAIR(3, 7) PAIR(3, 8)
    PAIR(4, 5) PAIR(4, 6) PAIR(4, 7) PAIR(4, 8)
    PAIR(5, 6) PAIR(5, 7) PAIR(5, 8)
    PAIR(6, 7) PAIR(6, 8)
    PAIR(7, 8)
    NINE(SHARE)
    uint open = ALL & ~(((masks[0] | masks[1]) | (masks[2] | masks[3])) | ((masks[4] | masks[5]) | (masks[6] | masks[7])) | masks[8]);
    if (!line) {
        shares[4] += count(open);
    } else if (open != 0u) {
        OPEN(0, 5, 7, 8)
        OPEN(1, 3, 7, 6)
        OPEN(2, 5, 1, 2)
        OPEN(3, 3, 1, 0)
    }
    if (shares[4] == 16.0) discard;
    vec4 sum = vec4(0.0);
    NINE(ADD)
    colour = sum / 16.0;
}
