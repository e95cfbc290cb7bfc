// Direction-encoded colour: |tangent| in data coordinates as red (left-right), green (back-front),
// blue (down-up). The tangent is a unit vector, so the brightest channel is never below 0.57.

//@ fragment after //VTK::Color::Impl
  ambientColor = ambientIntensity * abs(fibletTangent);
  diffuseColor = diffuseIntensity * abs(fibletTangent);
