// Uniform blocks that every pass of the engine shares. pvfiblets/engine/frame.py packs the first, chunks.py the others.
//
// Symbols
//   local        millimetres relative to `reference`, an anchor position near what the camera looks at. Anchors are
//                integers, so `anchor - reference` is exact: float32 digits are spent where the picture is, and a
//                data set at 10^6 mm costs nothing.
//   clip         OpenGL clip coordinates of the caller's model-view-projection
//   plane        (n, d) with |n| = 1 per millimetre: n . p + d is the signed distance of p, positive inside

layout(std140, binding = 0) uniform Frame {
    mat4 clip_from_local;
    vec4 planes[6];        // left, right, bottom, top, near, far; the first four moved out by half a line's width
    uvec4 reference;       // xyz: anchor integers
    vec4 viewport;         // width, height, half line width (pixels), unused
    vec4 guard;            // xy: clip |x| <= guard.x w and |y| <= guard.y w, so that a wide line's edge is not cut;
                           // z: mm inside the planes at which nothing can round outside any more
};

layout(std140, binding = 1) uniform Coding {
    vec4 anchor_scale;     // xyz: mm per anchor integer; w: mm per unit of reach
    vec4 steps;            // x: least step, y: greatest minus least (mm); z: lattice edge (mm)
};

layout(std140, binding = 2) uniform Chunk {
    uvec4 chunk;           // x: fiblets here, y: index of the first, z: points of its streamline before it
    uvec4 chunk_bases;     // x: first rank here, y: bits per stored value, z: pages here
    vec4 chunk_values;     // x: value of code 0, y: value per code
};

// Index of this work group where a dispatch is folded into rows, because drivers limit groups per axis.
uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
