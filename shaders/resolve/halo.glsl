// Depth-dependent halos (effects/halo.frag): where a halo is nearer than the pixel's own line, or there is no line, the
// pixel shows the halo's colour, without any light, and lies at the halo's depth.

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletHaloMap;  // r32ui keys, fibletEmpty where there is no halo
uniform vec3 fibletHaloLower;      // colour at the lower edge of the viewport, and at the upper
uniform vec3 fibletHaloUpper;

//@ fragment after //pvfiblets::Key::Impl
  uint fibletHaloKey = fibletSize.x > 0 ? texelFetch(fibletHaloMap, fibletPixel, 0).r : fibletEmpty;
  bool fibletInHalo = fibletHaloKey < fibletKey;
  fibletKey = min(fibletKey, fibletHaloKey);

// The line that would have been there, if any, lends nothing.
//@ fragment after //VTK::PositionVC::Impl
  if (fibletInHalo)
  {
    fibletIds = uvec2(0u);
  }

//@ fragment after //VTK::Light::Impl
  if (fibletInHalo)
  {
    gl_FragData[0] = vec4(mix(fibletHaloLower, fibletHaloUpper, 0.5 * fibletNDC.y + 0.5), opacityUniform);
  }
