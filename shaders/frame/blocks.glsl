// Uniform blocks that every pass of the engine shares. pvfiblets/engine/frame.py packs the first, chunks.py the others.
//
// Symbols
//   local        millimetres relative to `reference`, an anchor position near what the camera looks at. Anchors are
//                integers, so `anchor - reference` is exact: float32 digits are spent where the picture is, and a
//                data set at 10^6 mm costs nothing.
//   window       (X, Y, Z, W), homogeneous: X / W and Y / W are pixels from the lower left corner, Z / W is the depth in
//                0..1, W is the clip w of the caller's model-view-projection
//   plane        (n, d) with |n| = 1 per millimetre: n . p + d is the signed distance of p, positive inside

layout(std140, binding = 0) uniform Frame {
    mat4 window_from_local;
    vec4 planes[6];        // left, right, bottom, top, near, far; the first four moved out by half a line's width,
                           // all by the radius of tubes
    uvec4 reference;       // xyz: anchor integers
    vec4 viewport;         // width, height, half line width (pixels), unused
    vec4 guard;            // x: mm, over W, from a wide line's axis to its edge; z: mm inside the planes at which nothing can round outside any more
    vec4 detail;           // x: pixels times W that a millimetre takes at most; y: change of W per mm;
                           // z, w: pixels of deviation, and of size, up to which a fiblet is one segment
};

layout(std140, binding = 1) uniform Coding {
    vec4 anchor_scale;     // xyz: mm per anchor integer; w: mm per unit of a capsule's radius
    vec4 steps;            // x: least step, y: greatest minus least (mm); z: lattice edge (mm);
                           // w: mm per unit of an end vector
    vec4 rotation_scales[4];
};

layout(std140, binding = 2) uniform Chunk {
    uvec4 chunk;           // x: fiblets here, y: index of the first, z: points of its streamline before it
    uvec4 chunk_bases;     // x: first rank here, y: bits per stored value, z: pages here, w: where end vectors start
    vec4 chunk_values;     // x: value of code 0, y: value per code
};

#include "frame/tubes.glsl"
