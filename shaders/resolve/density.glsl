// Density: light adds up where lines lie on each other (pvfiblets/mappers/effects/density.py). A pixel shows the mean colour of its n
// lines; its opacity over the background depends on n:
//
//   log      log(1 + n) / log(1 + m)       m: lines in a pixel of full brightness
//   sqrt     sqrt(n / m)
//   linear   n / m
//
// The mean of directions' colours is brought to full brightness first: that of lines across each other would be dim.
// On black that is light added up and toned down; on white it is ink. No light of the scene's dims it.

//@ fragment after //VTK::CustomUniforms::Dec
uniform int fibletTone;            // 0: log; 1: sqrt; 2: linear; -1: none, as where VTK selects
uniform float fibletMost;          // m
uniform int fibletHue;             // 1: colours of directions

//@ fragment after //VTK::Color::Impl
  if (fibletTone >= 0)
  {
    vec4 fibletSum = fibletSumOf(fibletPixel, 0);
    if (fibletSum.a < 0.5)
    {
      discard;
    }
    float fibletBrightest = max(fibletSum.r, max(fibletSum.g, fibletSum.b));
    vec3 fibletMean = fibletSum.rgb / max(fibletHue == 1 ? fibletBrightest : 255.0 * fibletSum.a, 1.0);
    float fibletShare = min(fibletSum.a / fibletMost, 1.0);
    ambientColor = ambientIntensity * fibletMean;
    diffuseColor = diffuseIntensity * fibletMean;
    opacity *= fibletTone == 0 ? min(log(1.0 + fibletSum.a) / log(1.0 + fibletMost), 1.0) : fibletTone == 1 ? sqrt(fibletShare) : fibletShare;
  }
