// An opacity per streamline, in the alpha of a texture filled row by row.

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletOpacities;

//@ fragment after //VTK::Color::Impl
  uint fibletOpacityRow = uint(textureSize(fibletOpacities, 0).x);
  opacity *= texelFetch(fibletOpacities,
    ivec2(int(fibletIds.x % fibletOpacityRow), int(fibletIds.x / fibletOpacityRow)), 0).a;
