// Streamlines that the user singled out: they take a colour of their own, or keep theirs, and all others fade.
//
//   fibletChosenMap    r32ui   a bit for each streamline, the lowest of a word first, row by row
//
//   chosen:  c' = mix(c, chosen colour, w)     w = fibletChosenColour.a, 0: keeps its own
//   others:  c' = mix(c, faded colour,  d)     d = fibletFaded.a, 0: as before
//
// After the colours, before the lights: what fades is still shaded.

//@ fragment after //VTK::CustomUniforms::Dec
uniform usampler2D fibletChosenMap;
uniform vec4 fibletChosenColour;
uniform vec4 fibletFaded;

//@ fragment after //VTK::Color::Impl
  uint fibletChosenWord = fibletIds.x >> 5u;
  uint fibletChosenRow = uint(textureSize(fibletChosenMap, 0).x);
  uint fibletChosenBits = fibletIds.x == 0xFFFFFFFFu ? 0u : texelFetch(fibletChosenMap,
    ivec2(int(fibletChosenWord % fibletChosenRow), int(fibletChosenWord / fibletChosenRow)), 0).r;
  vec4 fibletMark = ((fibletChosenBits >> (fibletIds.x & 31u)) & 1u) != 0u ? fibletChosenColour : fibletFaded;
  ambientColor = mix(ambientColor, ambientIntensity * fibletMark.rgb, fibletMark.a);
  diffuseColor = mix(diffuseColor, diffuseIntensity * fibletMark.rgb, fibletMark.a);
