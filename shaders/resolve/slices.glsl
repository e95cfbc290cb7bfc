// Slices: all lines behind the nearest show through it, added up in slices by distance (pvfiblets/engine/fiblets/gather/gathering.py).
//
// Layer k (layers_geometry.glsl; layers.glsl says how VTK blends them) is slice k - 1. A slice stands where it begins: there
// it is in front of all that is behind any of its lines.
//
// Symbols
//   W            weight of a slice, the number of its lines where all have the same opacity
//   A            absorbance of weight 1: a slice lets exp(-A W) through

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletSliceKeys; // depth keys of the nearest line and of where the next slices begin
uniform float fibletAbsorbance;    // A; 0: that of the actor's opacity

//@ fragment after //pvfiblets::Key::Impl
  vec4 fibletSlice = vec4(0.0);
  float fibletReaching = 1.0;
  if (fibletLayer > 0 && fibletKey != fibletEmpty)
  {
    float fibletHeld = fibletWeightOf(fibletPixel, fibletLayer - 1);
    uint fibletBehind = texelFetch(fibletSliceKeys, fibletPixel, 0)[fibletLayer - 1];
    // Behind the nearest, in steps that a depth buffer tells apart.
    uint fibletLeast = fibletKey + min(1024u * uint(fibletLayer), fibletEmpty - 1u - fibletKey);
    fibletKey = fibletHeld < 0.5 ? fibletEmpty : max(fibletLeast, fibletBehind);
  }
  uint fibletLayerKey = fibletKey;

//@ fragment replace gl_FragData[1].r = gl_FragData[0].a;
gl_FragData[0].rgb *= fibletReaching;
  gl_FragData[1].r = fibletReaching * gl_FragData[0].a;
