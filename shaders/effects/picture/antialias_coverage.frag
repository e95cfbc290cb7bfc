// Smooth edges of lines: every pixel shows the share of a line that covers it.
//
// The picture holds one line a pixel. The other lines of a pixel are known from its neighbours: the edges of their lines
// (frame/edges.glsl) are known to a fraction of a pixel, and they go on through this pixel. So each of 16 samples of the pixel
// takes the colour of the nearest line whose band covers it: this pixel's own line, or one of the three pixels nearest to the
// sample's quarter. Light was computed once a pixel, and colours are the finished picture's.
//
//   . . .     Where no band covers
//   .[#]#       a pixel without a line    shows its own colour
//   # # .       a pixel with a line       shows the background: the three neighbours that show no line and are not in front of it;
//                                         if all show lines, those lines, as between lines there are others
//
// Only lines nearer than its own depth cover a pixel without a line: lines do not run over a mesh that hides them. A neighbour's
// band that covers the middle of a pixel with a line lies behind that line, however deep it is at the neighbour: halos and tubes
// are not equally deep across.
//
// Thin lines are drawn up to a pixel beside where they run (fiblets/segments/thin_line_rule.glsl): a pixel without a line whose
// middle the band of one next to it covers, a pixel wide at most, takes that one for its own in all four quarters.
//
//   shown      of visible_edges.frag, with a border of one texel
//   shift      from a pixel of the target to one of it
//
// Colours are averaged as they are displayed, as supersampling does. Shares are counted in twelfths of a sample, and a sample is
// a byte of a word: sums of all channels and samples are sums of words.

#version 430

#include "frame/edges.glsl"

uniform usampler2D shown;
uniform ivec2 shift;
out vec4 colour;

// In 16ths of a pixel, quarter by quarter: upper right, upper left, lower right, lower left.
const vec4 X0 = vec4(1.5, 2.5, 5.5, 6.5), X1 = vec4(-2.5, -1.5, -5.5, -7.5);
const vec4 Y0 = vec4(1.5, 5.5, 3.5, 7.5), Y1 = vec4(2.5, 6.5, 4.5, 0.5);
const vec4 X2 = vec4(4.5, 3.5, 0.5, 7.5), X3 = vec4(-0.5, -4.5, -3.5, -6.5);
const vec4 Y2 = vec4(-0.5, -4.5, -6.5, -3.5), Y3 = vec4(-2.5, -1.5, -5.5, -7.5);

const uint EVERY = 0x01010101u, SAMPLE = 12u, PIXEL = 16u * SAMPLE;
const int OWN = 4;

struct Band {
    vec2 n;         // across it, a 16th long
    float away;     // pixels from its middle to the pixel's centre
    float size;     // half its width; negative where there is none
};

uint bits(bvec4 inside) {
    return (inside.x ? 1u : 0u) | (inside.y ? 0x100u : 0u) | (inside.z ? 0x10000u : 0u) | (inside.w ? 0x1000000u : 0u);
}

uint count(uint samples) { return (samples * EVERY) >> 24u; }

// at: this pixel, from the one that shows the line; there: whether it counts. Beyond its end a line covers no other pixel.
Band band_of(Edges edges, vec2 at, bool there) {
    float along = edges.n.x * at.y - edges.n.y * at.x;
    bool beyond = edges.end == 7u || edges.end != 0u && (edges.end < 4u) == (along > edges.stop);
    return Band(edges.n / 16.0, dot(edges.n, at) - edges.e + 0.5 * edges.w, there && !beyond ? 0.5 * edges.w : -1.0);
}

uint covered(Band band, vec4 x, vec4 y) {
    return bits(lessThanEqual(abs(band.n.x * x + band.n.y * y + band.away), vec4(band.size)));
}

// The remaining part of the pixel's own line where that ends.
uint within(Edges edges, vec4 x, vec4 y) {
    vec4 along = (edges.n.x * y - edges.n.y * x) / 16.0;
    vec2 range = edges.end == 7u ? vec2(-0.5, 0.5)
               : vec2(edges.end < 4u ? -1.0 : edges.stop, edges.end > 0u && edges.end < 4u ? edges.stop : 1.0);
    return bits(lessThanEqual(abs(along - 0.5 * (range.x + range.y)), vec4(0.5 * (range.y - range.x))));
}

uvec4 around[9];      // bits of the depth | edges | colour
Band bands[9];
uint visible[9];      // samples, byte by byte
uint shares[9];
uint behind[9];       // 1 or 0
uint lines[9];

#define NINE(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(4, 0, 0) what(5, 1, 0) \
    what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define EIGHT(what) what(0, -1, -1) what(1, 0, -1) what(2, 1, -1) what(3, -1, 0) what(5, 1, 0) \
    what(6, -1, 1) what(7, 0, 1) what(8, 1, 1)
#define FETCH(k, right, up) around[k] = texelFetch(shown, pixel + ivec2(right, up), 0);

#define BEGIN(k, right, up) \
    bands[k] = band_of(unpacked_edges(around[k].y), -vec2(right, up), around[k].y != 0u && (line || around[k].x < around[OWN].x)); \
    behind[k] = line && around[k].y == 0u && around[k].x > around[OWN].x ? 1u : 0u; \
    if (line && abs(bands[k].away) <= bands[k].size) around[k].x = max(around[k].x, around[OWN].x); \
    lines[k] = line && around[k].y != 0u ? 1u : 0u; \
    visible[k] = shares[k] = 0u;

// The samples of one quarter, and the three neighbours that are nearest to them.
#define QUARTER(right, up, a, b, c) \
    { uint m = covered(bands[OWN], right, up) & within(own, right, up), ma = covered(bands[a], right, up), mb = covered(bands[b], right, up), \
           mc = covered(bands[c], right, up), open = EVERY & ~((m | ma) | (mb | mc)), left = count(open); \
      bool a_first = around[a].x < depth, b_first = around[b].x < depth, c_first = around[c].x < depth, \
           ab = around[a].x <= around[b].x, ac = around[a].x <= around[c].x, bc = around[b].x <= around[c].x; \
      visible[OWN] += m & ~((a_first ? ma : 0u) | (b_first ? mb : 0u) | (c_first ? mc : 0u)); \
      visible[a] += ma & ~((a_first ? 0u : m) | (ab ? 0u : mb) | (ac ? 0u : mc)); \
      visible[b] += mb & ~((b_first ? 0u : m) | (ab ? ma : 0u) | (bc ? 0u : mc)); \
      visible[c] += mc & ~((c_first ? 0u : m) | (ac ? ma : 0u) | (bc ? mb : 0u)); \
      uint backs = behind[a] + behind[b] + behind[c], fronts = lines[a] + lines[b] + lines[c], n = backs > 0u ? backs : fronts; \
      left *= n == 3u ? SAMPLE / 3u : n == 2u ? SAMPLE / 2u : SAMPLE; \
      shares[a] += left * (backs > 0u ? behind[a] : lines[a]); \
      shares[b] += left * (backs > 0u ? behind[b] : lines[b]); \
      shares[c] += left * (backs > 0u ? behind[c] : lines[c]); \
      shares[OWN] += n == 0u ? left : 0u; }
#define ADOPT(k) \
    if (abs(bands[k].away) <= bands[k].size && bands[k].size <= 0.5 && around[k].x < depth) { depth = around[k].x; bands[OWN] = bands[k]; of_own = around[k].z; }
#define SHARE(k, right, up) shares[k] += SAMPLE * count(visible[k]);
#define ADD(k, right, up) \
    red_blue += shares[k] * (around[k].z & 0xFF00FFu); \
    green_alpha += shares[k] * ((around[k].z >> 8u) & 0xFF00FFu);

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + shift;
    NINE(FETCH)
    if (((around[0].y | around[1].y | around[2].y) | (around[3].y | around[4].y | around[5].y)
         | (around[6].y | around[7].y | around[8].y)) == 0u) discard;
    Edges own = unpacked_edges(around[OWN].y);
    bool line = around[OWN].y != 0u;
    EIGHT(BEGIN)
    bands[OWN] = Band(own.n / 16.0, 0.5 * own.w - own.e, line ? 0.5 * own.w : -1.0);
    visible[OWN] = shares[OWN] = 0u;
    uint depth = around[OWN].x, of_own = around[OWN].z;
    if (!line) { ADOPT(1) ADOPT(3) ADOPT(5) ADOPT(7) }
    QUARTER(X0, Y0, 5, 7, 8)
    QUARTER(X1, Y1, 3, 7, 6)
    QUARTER(X2, Y2, 5, 1, 2)
    QUARTER(X3, Y3, 3, 1, 0)
    EIGHT(SHARE)
    uint mine = SAMPLE * count(visible[OWN]);
    if (shares[OWN] + (line ? mine : 0u) == PIXEL) discard;
    uint red_blue = mine * (of_own & 0xFF00FFu), green_alpha = mine * ((of_own >> 8u) & 0xFF00FFu);
    NINE(ADD)
    colour = vec4(red_blue & 0xFFFFu, green_alpha & 0xFFFFu, red_blue >> 16u, green_alpha >> 16u) / (255.0 * float(PIXEL));
}
