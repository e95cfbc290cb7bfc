// Ambient occlusion: the colour times how open a pixel is (effects/ssao.frag), lit or not.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletOcclusionMap;  // r8: 1 is open

//@ fragment after //VTK::Light::Impl
  gl_FragData[0].rgb *= texelFetch(fibletOcclusionMap, fibletPixel, 0).r;
