// Sums of all lines of a pixel (pvfiblets/engine/fiblets/gather/gathering.py): red, green, blue, each in 0..255 times weight, and
// weight, slice by slice.
//
//   fibletSumFloats    rgba32f  a layer a slice
//   fibletSumWords     r32ui    a layer a slice, of weights alone; or four words a pixel, side by side
//   fibletSumShape     columns and rows of a pixel's words; 0: floats

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2DArray fibletSumFloats;
uniform usampler2DArray fibletSumWords;
uniform ivec2 fibletSumShape;

vec4 fibletSumOf(ivec2 pixel, int slice)
{
  if (fibletSumShape.x == 0)
  {
    return texelFetch(fibletSumFloats, ivec3(min(pixel, textureSize(fibletSumFloats, 0).xy - 1), slice), 0);
  }
  if (fibletSumShape == ivec2(1))
  {
    return vec4(0.0, 0.0, 0.0, float(texelFetch(fibletSumWords, ivec3(pixel, slice), 0).r));
  }
  vec4 sum;
  for (int channel = 0; channel < 4; ++channel)
  {
    ivec2 at = pixel * fibletSumShape + ivec2(channel % fibletSumShape.x, channel / fibletSumShape.x);
    sum[channel] = float(texelFetch(fibletSumWords, ivec3(at, slice), 0).r);
  }
  return sum;
}

float fibletWeightOf(ivec2 pixel, int slice)
{
  if (fibletSumShape.x == 0)
  {
    return fibletSumOf(pixel, slice).a;
  }
  return float(texelFetch(fibletSumWords, ivec3((pixel + 1) * fibletSumShape - 1, slice), 0).r);
}
