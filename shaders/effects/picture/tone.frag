// The picture with other tones, back where VTK drew it: effects/picture/tone.glsl says how.
//
//   colours    the copy of effects/picture/copy.frag
//   shift      from a pixel of the target to one of the copy

#version 430

#include "effects/picture/tone.glsl"

uniform sampler2D colours;
uniform ivec2 shift;
out vec4 colour;

void main()
{
    colour = toned(texelFetch(colours, ivec2(gl_FragCoord.xy) + shift, 0));
}
