// What all passes over lines and points with halos share; pvfiblets/engine/halos/uniform_blocks.py packs it.
//
// Symbols
//   w_line, w_strip, d_max, f, n_tapered, t_tapered    of Everts et al. 2009, sections 3.2 to 3.4; here mm of the data
//   window       (X, Y, U, W), homogeneous: X / W and Y / W are pixels from the picture's middle, 1 - depth is U / W
//   reach        pixels times W: the length of a mm on the screen, times W, does not depend on where it is

layout(std140, binding = 9) uniform Halos {
    vec4 halo_widths;      // x: reach of w_line / 2; y: of (w_strip - w_line) / 2; z: pixels of half the least width of a
                           // line; w: mm per integer of a place
    vec4 halo_depth;       // x: d_max; 1 - depth falls by y per mm, and by z / (W (W + w mm)) per mm
    vec4 halo_cue;         // place p is narrower by the share xyz . p + w
    vec4 halo_filter;      // x, y: thresholds; z: mm of their taper; w: 1 where lines have smooth edges
    vec4 halo_mask;        // yz: half the picture's size in pixels; w: the largest share of halo_cue
    ivec4 halo_counts;     // x: items; y: which f; z: entries of its table
    mat4 halo_rows;        // rows: from local mm to (X, Y, U, W)
    vec4 halo_table[{{ displacement_words }}];
};
