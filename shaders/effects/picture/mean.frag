// The mean of pictures that were added up, back where VTK drew them.
//
//   colours    their sum, or one picture
//   share      1 by the number of pictures
//   shift      from a pixel of the target to one of the sum

#version 430

uniform sampler2D colours;
uniform ivec2 shift;
uniform float share;
out vec4 colour;

void main()
{
    colour = share * texelFetch(colours, ivec2(gl_FragCoord.xy) + shift, 0);
}
