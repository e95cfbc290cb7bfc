// Number of lines of a pixel, in place of a number at a point of the nearest (sums.glsl, colour.glsl).

//@ fragment after //pvfiblets::Number::Impl
  if (fibletSumShape.x > 0 || textureSize(fibletSumFloats, 0).x > 1)
  {
    fibletNumber = fibletWeightOf(fibletPixel, 0);
  }
