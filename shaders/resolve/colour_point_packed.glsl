// A colour at every point of a streamline, which the engine has interpolated and packed into a number
// (fiblets/attributes/packed_colour.glsl).
//
//   fibletPositionMap  rg32f   point index along the streamline | colour

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletPositionMap;

vec4 fibletUnpacked(float value)
{
  bool opaque = value >= 0.0;
  int n = int(opaque ? value : -1.0 - value), bits = opaque ? 8 : 6, most = (1 << bits) - 1;
  vec4 c = vec4(n & most, (n >> bits) & most, (n >> (2 * bits)) & most, (n >> (3 * bits)) & most) / float(most);
  return vec4(c.rgb, opaque ? 1.0 : c.a);
}

//@ fragment after //VTK::Color::Impl
  float fibletValue = texelFetch(fibletPositionMap, fibletPixel, 0).g;
//pvfiblets::Value::Impl
  vec4 fibletColour = fibletUnpacked(fibletValue);
  ambientColor = ambientIntensity * fibletColour.rgb;
  diffuseColor = diffuseIntensity * fibletColour.rgb;
  opacity = opacity * fibletColour.a;
