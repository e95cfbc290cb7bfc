// An opacity at every point (point_value.glsl). NaN is not to be seen.

//@ fragment after //VTK::Color::Impl
  opacity *= isnan(fibletValue) ? 0.0 : clamp(fibletValue, 0.0, 1.0);
