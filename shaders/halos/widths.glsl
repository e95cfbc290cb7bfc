// How wide lines and strips are.

// Reaches (halos/block.glsl) of half a line and of half a strip: x, y. A line that would be thinner than the least width is
// widened, and its halos keep theirs.
vec2 reaches(float cue, float w) {
    float line = halo_widths.x * (1.0 - cue), wider = max(halo_widths.z * w - line, 0.0);
    return vec2(line + wider, halo_widths.x + halo_widths.y + wider);
}
