// Edges of the line that a pixel shows, in 32 bits: GBuffer.edges, from which pixels' shares are found
// (shaders/effects/picture/antialias_coverage.frag). Near a pixel, the line is taken for a band:
//
//          e < 0 beyond the edge
//     ------------------------------  nearest edge     n   unit vector of the window across the band, out of the nearest edge
//            ^ e         |                              e   pixels from the pixel's centre to that edge
//            * centre    | w                            w   pixels from that edge to the other one
//     ------------------------------                    s   direction along the band: n turned to the left
//
// n may have any length. Bits, from the lowest: 11 the direction of n, as the way around a square (0 is +x, 512 +y); 11 e; 7 w; 3 where the band ends:
// 0 nowhere, 1 to 3 up to s = -1/3, 0, 1/3, 4 to 6 from there on, 7 half a pixel to both sides, a dot. A word is never 0: w is
// at least its least step.

const float EDGE_STEPS = 448.0;     // of e, per pixel
const float EDGE_LEAST = 2.0;       // -e, at most
const float WIDTH_STEPS = 32.0;     // of w, per pixel; its largest value stands for all greater ones

uint packed_edges(vec2 n, float e, float w, uint end) {
    vec2 q = n / max(abs(n.x) + abs(n.y), 1e-30);
    int turn = int((q.y >= 0.0 ? 1.0 - q.x : 3.0 + q.x) * 512.0 + 0.5) & 2047;
    int inside = int(clamp((e + EDGE_LEAST) * EDGE_STEPS + 0.5, 0.0, 2047.0));
    int across = int(clamp(w * WIDTH_STEPS + 0.5, 1.0, 127.0));
    return uint(turn | (inside << 11) | (across << 22)) | (end << 29u);
}

struct Edges {
    vec2 n;         // unit vector
    float e;
    float w;
    uint end;
    float stop;     // where on s the band ends
};

Edges unpacked_edges(uint word) {
    float turn = float(int(word & 2047u)) / 512.0, x = abs(turn - 2.0) - 1.0;
    int width = int((word >> 22u) & 127u), end = int(word >> 29u);
    return Edges(normalize(vec2(x, turn < 2.0 ? 1.0 - abs(x) : abs(x) - 1.0)),
                 float(int((word >> 11u) & 2047u)) / EDGE_STEPS - EDGE_LEAST, width == 127 ? 128.0 : float(width) / WIDTH_STEPS,
                 uint(end), float(end > 3 ? end - 5 : end - 2) / 3.0);
}
