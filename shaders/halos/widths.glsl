// How wide lines and strips are.

// Reaches (halos/block.glsl) of half a line and of half a strip: x, y. A line that would be thinner than the least width is
// widened, and its halos keep theirs. Where edges are smoothed, it is drawn a pixel wide at least, and the reach of half its own
// width may be less.
vec2 reaches(float cue, float w) {
    float line = halo_line_reach * (1.0 - cue), wider = max(halo_least_half_width * w - line, 0.0);
    return vec2(line + wider, halo_line_reach + halo_border_reach + wider);
}

float own_reach(float cue, float w) { return max(halo_line_reach * (1.0 - cue), halo_own_least_half_width * w); }
