// One RGBA colour per streamline, in a texture filled row by row.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletStreamlineColours;

//@ fragment after //VTK::Color::Impl
  uint fibletColourRow = uint(textureSize(fibletStreamlineColours, 0).x);
  vec4 fibletColour = texelFetch(fibletStreamlineColours,
    ivec2(int(fibletIds.x % fibletColourRow), int(fibletIds.x / fibletColourRow)), 0);
  ambientColor = ambientIntensity * fibletColour.rgb;
  diffuseColor = diffuseIntensity * fibletColour.rgb;
  opacity = opacity * fibletColour.a;
