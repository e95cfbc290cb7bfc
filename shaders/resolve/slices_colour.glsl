// Colour and opacity of a slice (slices.glsl), in place of the nearest line's, whose opacity is there by now.

//@ fragment after //VTK::Color::Impl
  if (fibletLayer > 0)
  {
    float fibletThrough = 1.0 - opacity;
    float fibletUnit = fibletAbsorbance > 0.0 ? fibletAbsorbance : -log(max(fibletThrough, 1e-6));
    fibletReaching = fibletThrough;
    for (int k = 0; k < fibletLayer - 1; ++k)
    {
      fibletReaching *= exp(-fibletUnit * fibletWeightOf(fibletPixel, k));
    }
    fibletSlice = fibletSumOf(fibletPixel, fibletLayer - 1);
    vec3 fibletMean = fibletSlice.rgb / (255.0 * fibletSlice.a);
    ambientColor = ambientIntensity * fibletMean;
    diffuseColor = diffuseIntensity * fibletMean;
    opacity = 1.0 - exp(-fibletUnit * fibletSlice.a);
    fibletIds.x = 0xFFFFFFFFu;     // not a single streamline
  }

// It has its lines' light already: what falls on it is taken whole.
//@ fragment after //VTK::Normal::Impl
  if (fibletLayer > 0)
  {
    fibletTangentVC = vec3(0.70710678, 0.70710678, 0.0);
    normalVCVSOutput = fibletToViewer;
  }
