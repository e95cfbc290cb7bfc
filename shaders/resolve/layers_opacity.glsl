// The opacity at a point of a line that is seen through others (layers.glsl, opacity_point.glsl).
//
//   fibletPositionLayers  rg32f   as fibletPositionMap, layer by layer

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2DArray fibletPositionLayers;

//@ fragment after //pvfiblets::PointOpacity::Impl
  if (fibletLayer > 0)
  {
    fibletPointOpacity = texelFetch(fibletPositionLayers, ivec3(fibletPixel, fibletLayer), 0).g;
  }
