// Slices: all lines behind the nearest show through it, added up in slices by distance (pvfiblets/engine/fiblets/gathering.py).
//
// VTK's geometry holds two triangles for the nearest lines and two for each slice, the farthest first, as of layers
// (layers.glsl, which says how VTK blends them). Layer 0 is the picture that is there anyway, layer k slice k - 1. A slice
// stands where it begins: there it is in front of all that is behind any of its lines.
//
// Symbols
//   W            weight of a slice, the number of its lines where all have the same opacity
//   A            absorbance of weight 1: a slice lets exp(-A W) through

//@ vertex after //VTK::CustomUniforms::Dec
uniform int fibletLayerCount;      // to be drawn; the geometry may have more
flat out int fibletLayer;

//@ vertex after //VTK::PositionVC::Impl
  int fibletCorner = gl_VertexID % 6;
  fibletLayer = fibletLayerCount - 1 - gl_VertexID / 6;
  fibletRight = fibletCorner == 1 || fibletCorner == 3 || fibletCorner == 5;
  fibletUpper = fibletCorner >= 2 && fibletCorner <= 4;
  gl_Position = fibletLayer < 0 ? vec4(2.0, 2.0, 2.0, 1.0) :
                vec4(fibletRight ? fibletRectangle.z : fibletRectangle.x,
                     fibletUpper ? fibletRectangle.w : fibletRectangle.y, 0.0, 1.0);

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletSliceKeys; // depth keys of the nearest line and of where the next slices begin
uniform float fibletAbsorbance;    // A; 0: that of the actor's opacity
flat in int fibletLayer;

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
