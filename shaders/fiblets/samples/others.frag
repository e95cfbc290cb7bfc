// What all that is drawn beside lines adds to each pixel: the mean of its colours in those samples that show no line.
//
//   other_colours   4 x 4 pictures, each of one sample of every pixel
//   picture         size of one of them
//   lines           whether this is a part of the picture that may show lines
//   drawn_set       sets of that part (fiblets/samples/claim.frag)
//   corner          pixel of the picture where it begins

#version 430

uniform sampler2D other_colours;
uniform ivec2 picture;
uniform int lines;
uniform usampler2D drawn_set;
uniform ivec2 corner;

out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    colour = vec4(0.0);
    for (int i = 0; i < 16; ++i) {
        ivec2 place = ivec2(i & 3, i >> 2);
        if (lines != 0 && texelFetch(drawn_set, 4 * (pixel - corner) + place, 0).x != 0x7FFFu) continue;
        colour += texelFetch(other_colours, place * picture + pixel, 0) / 16.0;
    }
}
