// Light through a volume has been shaded where it comes from, by the scene's lights or not at all: what the actor's property reflects
// does not count again.

//@ fragment after //VTK::Color::Impl
  ambientColor = vec3(0.0);
  diffuseColor = fibletColour.rgb;
