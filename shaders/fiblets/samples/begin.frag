// Depths of all that is drawn beside lines, as keys of the G-buffer, where samples of a part of the picture begin.
//
//   other_depths   window depths: 4 x 4 pictures, each of one sample of every pixel
//   corner         pixel of the picture where the part begins
//   picture        its size

#version 430

uniform sampler2D other_depths;
uniform ivec2 corner;
uniform ivec2 picture;

out uint depth;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 pixel = min(corner + at / 4, picture - 1);
    float nearest = texelFetch(other_depths, at % 4 * picture + pixel, 0).r;
    depth = nearest < 1.0 ? uint(nearest * 4294967296.0) : 0xFFFFFFFFu;
}
