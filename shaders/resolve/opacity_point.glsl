// An opacity at every point of a streamline, where no number at points colours it. NaN is not to be seen.
//
//   fibletPositionMap  rg32f   point index along the streamline | opacity

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletPositionMap;

//@ fragment after //VTK::Color::Impl
  float fibletPointOpacity = texelFetch(fibletPositionMap, fibletPixel, 0).g;
//pvfiblets::PointOpacity::Impl
  opacity *= isnan(fibletPointOpacity) ? 0.0 : clamp(fibletPointOpacity, 0.0, 1.0);
