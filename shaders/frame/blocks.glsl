// The uniform block of the camera, which all passes share; pvfiblets/engine/frame.py declares and packs it.
//
// Symbols
//   local        millimetres relative to `reference`, an anchor position near what the camera looks at. Anchors are
//                integers, so `anchor - reference` is exact: float32 digits are spent where the picture is, and a
//                data set at 10^6 mm costs nothing.
//   window       (X, Y, Z, W), homogeneous: X / W and Y / W are pixels from the lower left corner, Z / W is the depth in
//                0..1, W is the clip w of the caller's model-view-projection
//   plane        (n, d) with |n| = 1 per millimetre: n . p + d is the signed distance of p, positive inside. Those of the view's
//                sides are moved out by half a line's width, and all by the radius of tubes

#include "uniforms/Frame.glsl"
#include "frame/tubes.glsl"
