// Place across a wide line of a pixel that shows through others (layers.glsl, tube_shading.glsl).
//
//   fibletAcrossLayers  r16f    as fibletAcrossMap, layer by layer

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2DArray fibletAcrossLayers;

//@ fragment after //pvfiblets::Across::Impl
  if (fibletLayer > 0)
  {
    ivec3 fibletAcrossTop = textureSize(fibletAcrossLayers, 0) - 1;
    fibletAcross = texelFetch(fibletAcrossLayers, min(ivec3(fibletPixel, fibletLayer), fibletAcrossTop), 0).r;
  }
