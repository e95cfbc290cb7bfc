// Mean of the occlusion over squares of 4 x 4 pixels; each of the 16 sampled other directions
// (effects/ssao.frag). Pixels whose lines lie apart in depth by half the radius or more do not mix.

#version 430

#include "effects/view_position.glsl"

uniform sampler2D rough;
uniform float radius;
uniform float strength;
out float open;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(keys, 0) - 1;
    uint key = texelFetch(keys, pixel, 0).r;
    open = 1.0;
    if (key == EMPTY) return;
    float distance = view_position(pixel, key).z;
    vec2 sum = vec2(0.0);
    for (int y = -1; y <= 2; ++y)
    {
        for (int x = -1; x <= 2; ++x)
        {
            ivec2 other = clamp(pixel + ivec2(x, y), ivec2(0), last);
            uint there = texelFetch(keys, other, 0).r;
            if (there == EMPTY) continue;
            float apart = abs(view_position(other, there).z - distance);
            float weight = max(0.0, 1.0 - 2.0 * apart / radius);
            sum += weight * vec2(texelFetch(rough, other, 0).r, 1.0);
        }
    }
    open = mix(1.0, sum.x / sum.y, strength);
}
