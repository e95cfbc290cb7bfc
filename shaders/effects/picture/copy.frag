// VTK's picture so far in one viewport, as single samples that shaders can read: the picture that effects change.
//
//   drawn      colour attachment of VTK's framebuffer
//   depths     its depth attachment
//   samples    per pixel, of both                     (FEATURE_PICTURE_SAMPLES); FEATURE_PICTURE_ALIKE: the first is all of them
//   origin     pixel of the attachments that becomes the target's pixel corner
//   corner     pixel of the target
//   shares     65536ths of each pixel of the target that it shows, in 17 bits    (FEATURE_PICTURE_SHARES)
//
// Colours are the mean of a pixel's samples, as VTK's own resolve makes them: of colours ^ 2.2, which are proportional to
// light. Of the depths the nearest counts: a pixel at an edge belongs to the front, or an edge in
// focus would be blurred with its background.

#version 430

#if FEATURE_PICTURE_SAMPLES
uniform sampler2DMS drawn;
uniform sampler2DMS depths;
uniform int samples;
const vec4 LIGHT = vec4(2.2, 2.2, 2.2, 1.0);
#else
uniform sampler2D drawn;
uniform sampler2D depths;
#endif
uniform ivec2 origin;
uniform ivec2 corner;
#if FEATURE_PICTURE_SHARES
uniform usampler2D shares;
#endif
layout(location = 0) out vec4 colour;
#if FEATURE_PICTURE_DEPTH
layout(location = 1) out float depth;
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - corner + origin;
#if FEATURE_PICTURE_SHARES
    float share = float(texelFetch(shares, ivec2(gl_FragCoord.xy), 0).x & 0x1FFFFu) / 65536.0;
    if (share == 0.0) discard;
#endif
#if FEATURE_PICTURE_SAMPLES && !FEATURE_PICTURE_ALIKE
    vec4 sum = vec4(0.0);
    for (int i = 0; i < samples; ++i) sum += pow(texelFetch(drawn, pixel, i), LIGHT);
    colour = pow(sum / float(samples), 1.0 / LIGHT);
#if FEATURE_PICTURE_DEPTH
    depth = 1.0;
    for (int i = 0; i < samples; ++i) depth = min(depth, texelFetch(depths, pixel, i).r);
#endif
#else
    colour = texelFetch(drawn, pixel, 0);
#if FEATURE_PICTURE_DEPTH
    depth = texelFetch(depths, pixel, 0).r;
#endif
#endif
#if FEATURE_PICTURE_SHARES
    colour *= share;
#endif
}
