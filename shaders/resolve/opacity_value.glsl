// An opacity at every point that is the number that colours it, too (colour_point_scalar.glsl). NaN is not to be seen.

//@ fragment after //VTK::Color::Impl
  opacity *= isnan(fibletValue) ? 0.0 : clamp(fibletValue, 0.0, 1.0);
