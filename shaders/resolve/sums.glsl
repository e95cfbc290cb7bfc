// What all lines of a pixel add up to (pvfiblets/engine/fiblets/gathering.py): red, green, blue, each in 0..255 times weight, and
// weight, slice by slice.
//
//   fibletSumFloats    rgba32f  a layer a slice
//   fibletSumWords     r32ui    a layer a slice, of weights alone; or twice as wide and high: below red and green, above blue
//                               and weight
//   fibletSumKind      0: floats; 1: weights alone; 4: words with colours

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2DArray fibletSumFloats;
uniform usampler2DArray fibletSumWords;
uniform int fibletSumKind;

vec4 fibletSumOf(ivec2 pixel, int slice)
{
  ivec3 fibletWord = ivec3(2 * pixel, slice);
  if (fibletSumKind == 0)
  {
    return texelFetch(fibletSumFloats, ivec3(min(pixel, textureSize(fibletSumFloats, 0).xy - 1), slice), 0);
  }
  if (fibletSumKind == 1)
  {
    return vec4(0.0, 0.0, 0.0, float(texelFetch(fibletSumWords, ivec3(pixel, slice), 0).r));
  }
  return vec4(texelFetch(fibletSumWords, fibletWord, 0).r, texelFetch(fibletSumWords, fibletWord + ivec3(1, 0, 0), 0).r,
    texelFetch(fibletSumWords, fibletWord + ivec3(0, 1, 0), 0).r, texelFetch(fibletSumWords, fibletWord + ivec3(1, 1, 0), 0).r);
}
