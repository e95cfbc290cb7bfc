// Halos of strips and discs (pvfiblets/engine/halos): the engine has put line and halo into one picture, each at its depth.
// Where a pixel is of a halo it shows the halo's colour, without any light; on the smooth edge of a line it shows some of both.
//
//   fibletInkMap   r16f   1 line, 0 halo, in between on a smooth edge
//
// Colours are mixed weighted by alpha, so that a line that is seen through has no dark edge. What the line would have lent to a
// pixel that is all halo is not looked at.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletInkMap;
uniform vec3 fibletStripLower;     // colour at the lower edge of the viewport, and at the upper
uniform vec3 fibletStripUpper;

//@ fragment after //VTK::Light::Impl
  float fibletShare = texelFetch(fibletInkMap, fibletPixel, 0).r;
  if (fibletShare < 1.0)
  {
    vec4 fibletStrip = vec4(mix(fibletStripLower, fibletStripUpper, 0.5 * fibletNDC.y + 0.5), opacityUniform);
    if (fibletShare > 0.0)
    {
      float fibletInked = fibletShare * gl_FragData[0].a;
      float fibletAlpha = mix(fibletStrip.a, gl_FragData[0].a, fibletShare);
      fibletStrip = vec4(mix(fibletStrip.rgb, gl_FragData[0].rgb, fibletInked / max(fibletAlpha, 1e-6)), fibletAlpha);
    }
    gl_FragData[0] = fibletStrip;
  }
