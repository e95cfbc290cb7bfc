// What the nearest fragment says of its pixel: the attachments of pvfiblets/engine/fiblets/pipelines/hardware_raster.py.

layout(location = 0) out uint out_depth;
layout(location = 1) out uint out_owner;
layout(location = 2) out uvec2 out_ids;
layout(location = 3) out vec2 out_position;
#if FEATURE_CROSS_LINE && FEATURE_TUBES
layout(location = 4) out uint out_across;
#elif FEATURE_CROSS_LINE
layout(location = 4) out float out_across;
#endif
#if FEATURE_EDGES && FEATURE_CROSS_LINE
layout(location = 5) out uint out_edges;
#elif FEATURE_EDGES
layout(location = 4) out uint out_edges;
#endif

Tangents varying_tangents() { return unpacked_tangents(uvec2(varying_ids.y, varying_tangent)); }

// s, of the part in the window, is for add_to_sums.glsl; t: position along the segment, of so many steps.
void write_fragment(float s, uint key, uint segment, float t, float steps) {
    gl_FragDepth = float(key >> 1u) / 2147483648.0;  // as coarse as the key, also below 2^-8 where float32 is finer
    out_depth = key;
    out_owner = varying_ids.z;
    out_ids = uvec2(varying_ids.x, packed_tangent(tangent_between(varying_tangents(), t), 0u));
    out_position = vec2(varying_first + float(segment) + t * steps, value_at(segment, t, steps));
}
