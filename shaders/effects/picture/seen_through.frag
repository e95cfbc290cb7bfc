// Depths of what one sees something through, but which is what one looks at: fog, peaks of volumes, lines of glass. VTK's depths lack
// them, for translucent things hide nothing. Each pixel of the copy takes the nearest (blending by the least).
//
//   found      keys of window depth of pvfiblets/engine/gbuffer.py, where the thing begins
//   lights     colour and opacity of light through a volume       (FEATURE_SEEN_LIGHT)
//   positions  place on the ray, and value of a peak              (FEATURE_SEEN_PEAK)
//   values     least and greatest value that shows
//   faintest   opacity from which on light counts
//   corner     pixel of the copy at which the thing's lower left one comes

#version 430

uniform usampler2D found;
#if FEATURE_SEEN_LIGHT
uniform sampler2D lights;
uniform float faintest;
#endif
#if FEATURE_SEEN_PEAK
uniform sampler2D positions;
uniform vec2 values;
#endif
uniform ivec2 corner;
out float depth;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner;
    uint key = texelFetch(found, pixel, 0).r;
    bool shows = key != 0xFFFFFFFFu;
#if FEATURE_SEEN_LIGHT
    shows = shows && texelFetch(lights, pixel, 0).a >= faintest;
#endif
#if FEATURE_SEEN_PEAK
    float value = texelFetch(positions, pixel, 0).g;
    shows = shows && value >= values.x && value <= values.y;
#endif
    if (!shows) discard;
    depth = float(key) / 4294967295.0;
}
