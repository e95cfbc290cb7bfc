// Wide lines shaded as if they were round: the normal of resolve/normal.glsl, which is that of the line's middle, is turned about
// the tangent by where across the line the pixel lies.
//
//   fibletAcrossMap    r16f    a, distance from the line's axis over half its width, positive to the left of the tangent on
//                              the screen; a single texel where there are no wide lines
//   side               to the left of the tangent, perpendicular to it and to the direction to the viewer
//
// n = sqrt(1 - a^2) n_middle + a side. Depth stays that of the line.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletAcrossMap;

//@ fragment after //VTK::Normal::Impl
  float fibletAcross = texelFetch(fibletAcrossMap, min(fibletPixel, textureSize(fibletAcrossMap, 0) - 1), 0).r;
//pvfiblets::Across::Impl
  vec3 fibletSide = cross(fibletToViewer, fibletTangentVC);
  float fibletSideLength = length(fibletSide);
  if (fibletSideLength > 1e-3)
  {
    normalVCVSOutput = normalize(sqrt(max(1.0 - fibletAcross * fibletAcross, 0.0)) * normalVCVSOutput
      + fibletAcross / fibletSideLength * fibletSide);
  }
