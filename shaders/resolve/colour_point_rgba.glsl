// A colour at every point, which the engine has interpolated for each pixel.
//
//   fibletColourMap    rgba8

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletColourMap;

//@ fragment after //VTK::Color::Impl
  vec4 fibletColour = texelFetch(fibletColourMap, fibletPixel, 0);
  ambientColor = ambientIntensity * fibletColour.rgb;
  diffuseColor = diffuseIntensity * fibletColour.rgb;
  opacity = opacity * fibletColour.a;
