// The colour of a line before any light, of one mode (pvfiblets/colour_modes.py).
//
//   fibletValue        number or packed colour of the pixel, where the mode or an opacity reads one (point_value.glsl)

//@ fragment after //VTK::CustomUniforms::Dec
#include "colour/MODE.glsl"

//@ fragment after //VTK::Color::Impl
  float fibletValue = 0.0;
//pvfiblets::Value::Impl
  float fibletNumber = fibletValue;
//pvfiblets::Number::Impl
  vec4 fibletColour = line_colour(fibletIds.x, fibletTangent, fibletNumber);
  ambientColor = ambientIntensity * fibletColour.rgb;
  diffuseColor = diffuseIntensity * fibletColour.rgb;
  opacity = opacity * fibletColour.a;
