// Ambient occlusion by rays through a volume: the colour times how open a pixel is (volumes/ray_occlusion.frag), lit or not.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletRayOcclusionMap;  // r16f: how many rays meet nothing
uniform vec2 fibletRayOcclusion;          // strength, strength over the number of rays

//@ fragment after //VTK::Light::Impl
  gl_FragData[0].rgb *= 1.0 - fibletRayOcclusion.x + fibletRayOcclusion.y * texelFetch(fibletRayOcclusionMap, fibletPixel, 0).r;
