// How many lines a pixel holds, in place of a number at a point of the nearest (sums.glsl, colour_point_scalar.glsl).

//@ fragment after //pvfiblets::Value::Impl
  if (fibletSumShape.x > 0 || textureSize(fibletSumFloats, 0).x > 1)
  {
    fibletValue = fibletWeightOf(fibletPixel, 0);
  }
