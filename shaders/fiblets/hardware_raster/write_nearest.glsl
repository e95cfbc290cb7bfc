// What the nearest fragment says of its pixel: the attachments of pvfiblets/engine/fiblets/pipelines/hardware_raster.py. The rest of a pixel is
// found by fiblets/hardware_raster/resolve.frag.

layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uint out_segment;

// s, of the part in the window, and ratio are for add_to_sums.glsl.
void write_fragment(float s, float ratio, uint key, uint segment) {
    gl_FragDepth = float(key >> 1u) / 2147483648.0;  // as coarse as the key, also below 2^-8 where float32 is finer
    out_depth = key;
    out_owner = varying_ids.x;
    out_segment = segment;
}
