// Distance from the viewer's plane, in mm, of every pixel; NOTHING where nothing was drawn.

#version 430

#include "effects/view_position.glsl"

out float distance_out;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint key = texelFetch(keys, pixel, 0).r;
    distance_out = key == EMPTY ? NOTHING : -view_position(pixel, key).z;
}
