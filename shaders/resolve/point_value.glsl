// The number at a point of a line, which colours it or is its opacity.
//
//   fibletPositionMap  rg32f   point index along the streamline | number

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletPositionMap;

//@ fragment after //pvfiblets::Value::Impl
  fibletValue = texelFetch(fibletPositionMap, fibletPixel, 0).g;
