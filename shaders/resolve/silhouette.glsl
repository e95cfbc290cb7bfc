// The outline of chosen streamlines (effects/outline.frag), in one colour without any light, over whatever line is there.
// It lies as deep as the chosen streamline that it goes around, unless something nearer was drawn in the pixel.

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletOutlineMap;   // r32ui keys, fibletEmpty where there is no outline
uniform vec3 fibletOutlineColour;

//@ fragment after //pvfiblets::Key::Impl
  uint fibletOutlineKey = fibletSize.x > 0 ? texelFetch(fibletOutlineMap, fibletPixel, 0).r : fibletEmpty;
  bool fibletInOutline = fibletOutlineKey != fibletEmpty;
  fibletKey = min(fibletKey, fibletOutlineKey);

//@ fragment after //VTK::PositionVC::Impl
  if (fibletInOutline)
  {
    fibletIds = uvec2(0u);
  }

//@ fragment after //VTK::Light::Impl
  if (fibletInOutline)
  {
    gl_FragData[0] = vec4(fibletOutlineColour, opacityUniform);
  }
