// Depth of field (Lesar, Bohak & Marolt 2015, section III.G), gathered: each pixel p collects the light of all discs of
// effects/picture/blur.frag that cover it.
//
//   front    pixels q nearer than p, whose discs cover p:            a = sum w(r_q, |p - q|) / A(r_q)
//   back     p, and farther pixels, as far as p's own disc reaches:  b = sum w(r_p, |p - q|) / A(r_p)
//
//   colour = sum of front + (1 - a) * sum of back / b               where a > 1: sum of front / a
//
// w is the disc, A the pixels in it. Nearer pixels spread over p; farther ones shine through p only as far as p is
// blurred itself. So a sharp pixel neither bleeds nor is bled into from behind, and a blurred edge in front lets the pixels
// behind it through. A wall at one depth, however rounding sorts its pixels into front and back, gets the plain mean over
// the disc; a lone point spreads into a disc of all its light; a pixel that no disc reaches stays exactly the same.
//
//   colours    the copy of effects/picture/copy.frag
//   blurs      depth | signed radius | 1 / A | light left
//   reaches    of squares of TILE x TILE pixels, from effects/picture/reach.frag; -1 where all light is the same
//   shift      from a pixel of the target to one of the copy

#version 430

#include "effects/picture/disc.glsl"
#if FEATURE_PICTURE_TONE
#include "effects/picture/tone.glsl"
#endif

uniform sampler2D colours;
uniform sampler2D blurs;
uniform sampler2D reaches;
uniform ivec2 shift;
out vec4 colour;

const int TILE = {{ tile }};

vec4 light(ivec2 pixel, vec4 blur)
{
    vec4 found = texelFetch(colours, pixel, 0);
    return vec4(found.rgb * blur.a, found.a);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) + shift, last = textureSize(colours, 0) - 1;
    vec4 own = texelFetch(blurs, pixel, 0);
    float radius = abs(own.g), reach = texelFetch(reaches, pixel / TILE, 0).r;
    reach = reach < 0.0 ? 0.0 : max(radius, reach);
    vec4 front = vec4(0.0), back = own.b * light(pixel, own);
    float covered = 0.0, seen = own.b;
    if (reach > 0.5)
    {
        int side = int(reach + 0.5);
        for (int y = max(-side, -pixel.y); y <= min(side, last.y - pixel.y); ++y)
        {
            int across = int(sqrt(max((reach + 0.5) * (reach + 0.5) - float(y * y), 0.0)));
            for (int x = max(-across, -pixel.x); x <= min(across, last.x - pixel.x); ++x)
            {
                if (x == 0 && y == 0) continue;
                ivec2 other = pixel + ivec2(x, y);
                vec4 blur = texelFetch(blurs, other, 0);
                bool nearer = blur.r < own.r;
                float d = length(vec2(x, y));
                float share = nearer ? blur.b * disc(abs(blur.g), d) : own.b * disc(radius, d);
                if (share == 0.0) continue;
                vec4 there = share * light(other, blur);
                if (nearer)
                {
                    front += there;
                    covered += share;
                }
                else
                {
                    back += there;
                    seen += share;
                }
            }
        }
    }
    colour = covered < 1.0 ? front + (1.0 - covered) * back / seen : front / covered;
#if FEATURE_PICTURE_TONE
    colour = toned(colour);
#endif
}
