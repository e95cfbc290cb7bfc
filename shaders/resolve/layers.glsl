// Layers: lines behind the nearest one show through it (pvfiblets/engine/fiblets/gather/depth_peeling.py).
//
// Every layer (layers_geometry.glsl) has its own colour, light and depth.
//
//   fibletDepthLayers  r32ui   as fibletDepthMap, layer by layer
//   fibletIdLayers     rg32ui  as fibletIdMap
//
// Other pieces that look at a pixel's neighbours go on seeing the nearest lines alone.

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2DArray fibletDepthLayers;
uniform usampler2DArray fibletIdLayers;

//@ fragment after //pvfiblets::Key::Impl
  if (fibletLayer > 0 && fibletSize.x > 0)
  {
    fibletKey = texelFetch(fibletDepthLayers, ivec3(fibletPixel, fibletLayer), 0).r;
  }
  uint fibletLayerKey = fibletKey;

//@ fragment after //pvfiblets::Ids::Impl
  if (fibletLayer > 0)
  {
    fibletIds = texelFetch(fibletIdLayers, ivec3(fibletPixel, fibletLayer), 0).rg;
  }

// Without depth peeling VTK does not blend in any order: of all translucent fragments in a pixel it takes the mean, weighted by
// opacity a, and its alpha from all opacities (vtkOrderIndependentTranslucentPass; its text is below). Weighted also by the light
// that reaches the viewer, layer k by a (1 - a)^k, that mean is the layers' colour blended in order:
//
//   sum a (1 - a)^k c_k / sum a (1 - a)^k * (1 - (1 - a)^n) = sum a (1 - a)^k c_k
//
// exactly where all of them have the same opacity. Among other translucent things they then weigh as one thing does.
//@ fragment replace gl_FragData[1].r = gl_FragData[0].a;
float fibletReaching = fibletLayer == 0 ? 1.0 : pow(max(1.0 - gl_FragData[0].a, 0.0), float(fibletLayer));
  gl_FragData[0].rgb *= fibletReaching;
  gl_FragData[1].r = fibletReaching * gl_FragData[0].a;
