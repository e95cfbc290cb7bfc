// Depth of VTK's picture so far, as keys of the G-buffer, for occlusion culling.
//
// A fiblet is hidden at a pixel only if it is behind every sample of it, so the farthest sample counts. A blit would keep
// whichever sample the driver likes. MARGIN is two units of a 24-bit depth buffer: VTK rounds the fiblet's depth as it
// writes it and lets equal depths pass, so a fiblet behind by less may still be visible.
//
//   source    depth attachment of VTK's framebuffer
//   origin    lower left pixel of the viewport in it
//   SAMPLES   per pixel; 0 for a plain texture

#version 330

#if SAMPLES > 0
uniform sampler2DMS source;
#else
uniform sampler2D source;
#endif
uniform ivec2 origin;
out uint key;

const float MARGIN = 1.0 / 8388608.0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) + origin;
    float farthest = 0.0;
#if SAMPLES > 0
    for (int i = 0; i < SAMPLES; ++i) farthest = max(farthest, texelFetch(source, pixel, i).r);
#else
    farthest = texelFetch(source, pixel, 0).r;
#endif
    farthest += MARGIN;
    // Below 1, 4294967296 * farthest is exact in float and at most 4294967040: no overflow, and no key is EMPTY.
    key = farthest < 1.0 ? uint(farthest * 4294967296.0) : 0xFFFFFFFFu;
}
