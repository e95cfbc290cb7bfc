// The surface normal of tubes that are seen through others (layers.glsl, tube_normal.glsl).
//
//   fibletNormalLayers  r32ui   as fibletNormalMap, layer by layer

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2DArray fibletNormalLayers;

//@ fragment after //pvfiblets::NormalWord::Impl
  if (fibletLayer > 0)
  {
    fibletNormalWord = texelFetch(fibletNormalLayers, ivec3(fibletPixel, fibletLayer), 0).r;
  }
