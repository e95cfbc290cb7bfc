// One colour for all streamlines.

//@ fragment after //VTK::CustomUniforms::Dec
uniform vec3 fibletColour;

//@ fragment after //VTK::Color::Impl
  ambientColor = ambientIntensity * fibletColour;
  diffuseColor = diffuseIntensity * fibletColour;
