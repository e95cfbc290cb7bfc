// What all lines of a pixel add up to (pvfiblets/engine/fiblets/gathering.py): red, green, blue, each in 0..255 times weight, and
// weight, slice by slice.
//
//   fibletSumFloats    rgba32f  a layer a slice
//   fibletSumWords     r32ui    four layers a slice, or one of weights alone
//   fibletSumKind      0: floats; else layers of a slice

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2DArray fibletSumFloats;
uniform usampler2DArray fibletSumWords;
uniform int fibletSumKind;

vec4 fibletSumOf(ivec2 pixel, int slice)
{
  if (fibletSumKind == 0)
  {
    return texelFetch(fibletSumFloats, ivec3(min(pixel, textureSize(fibletSumFloats, 0).xy - 1), slice), 0);
  }
  if (fibletSumKind == 1)
  {
    return vec4(0.0, 0.0, 0.0, float(texelFetch(fibletSumWords, ivec3(pixel, slice), 0).r));
  }
  vec4 sum;
  for (int channel = 0; channel < 4; ++channel)
  {
    sum[channel] = float(texelFetch(fibletSumWords, ivec3(pixel, 4 * slice + channel), 0).r);
  }
  return sum;
}
