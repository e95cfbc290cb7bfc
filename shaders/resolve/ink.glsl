// One colour without any light, whatever the lines are coloured by: drawings in ink.

//@ fragment after //VTK::CustomUniforms::Dec
uniform vec3 fibletInk;

//@ fragment after //VTK::Light::Impl
  gl_FragData[0].rgb = fibletInk;
