// Ambient occlusion by rays through a volume: the colour times how open a pixel is (raycast/occlusion.frag), lit or not.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletRayOcclusionMap;  // r16f: share of the rays that meets nothing
uniform float fibletRayOcclusion;         // strength

//@ fragment after //VTK::Light::Impl
  gl_FragData[0].rgb *= mix(1.0, texelFetch(fibletRayOcclusionMap, fibletPixel, 0).r, fibletRayOcclusion);
