// A value at every point of a streamline through a look-up table, with vtkLookupTable's rules:
//
//   v < lo : below-range colour    v > hi : above-range colour    NaN : NaN colour
//   else   : entry min(floor((v - lo) * n / (hi - lo)), n - 1)
//
// The table's texture holds n colours and then those of below, above and NaN, row by row.
//
//   fibletPositionMap  rg32f   point index along the streamline | value

//@ fragment after //VTK::CustomUniforms::Dec
uniform sampler2D fibletPositionMap;
uniform sampler2D fibletTable;
uniform int fibletTableSize;           // n
uniform vec3 fibletTableRange;         // lo, hi, n / (hi - lo); logarithms of lo, hi on a log scale

//@ fragment after //VTK::Color::Impl
  float fibletValue = texelFetch(fibletPositionMap, fibletPixel, 0).g;
//pvfiblets::Value::Impl
  int fibletEntry;
  if (isnan(fibletValue))
  {
    fibletEntry = fibletTableSize + 2;
  }
  else
  {
//pvfiblets::Scale::Impl
    if (fibletValue < fibletTableRange.x)
    {
      fibletEntry = fibletTableSize;
    }
    else if (fibletValue > fibletTableRange.y)
    {
      fibletEntry = fibletTableSize + 1;
    }
    else
    {
      // min before int(): with lo = hi the scale is huge, and the product may not fit an int.
      fibletEntry = int(min((fibletValue - fibletTableRange.x) * fibletTableRange.z,
        float(fibletTableSize - 1)));
    }
  }
  int fibletTableRow = textureSize(fibletTable, 0).x;
  vec4 fibletColour = texelFetch(fibletTable,
    ivec2(fibletEntry % fibletTableRow, fibletEntry / fibletTableRow), 0);
  ambientColor = ambientIntensity * fibletColour.rgb;
  diffuseColor = diffuseIntensity * fibletColour.rgb;
  opacity = opacity * fibletColour.a;
