// The coverage buffer on its way to the next camera: a grid of its texels' centres, each at its depth, is drawn from there
// (paper: Schertzer et al. 2022, section 3.4.2 and 4.4).
//
// Six vertices a cell of the grid, which lies between the centres of four texels. Each of the four values holds for points up
// to a texel away from its own texel (culling/coverage_dilate.frag), hence for every point that is looked up in this
// cell, as long as a texel does not grow to more than twice its size from one camera to the next.
//
//   - A cell with an empty corner hides nothing: it is not drawn.
//   - A cell across a jump in depth is stretched by the next camera over places that the last one did not see. It hides what
//     is behind its farthest corner only.
//   - A cell seen from behind hides nothing: the depth it was made from lies behind it then.
//   - Of cells on top of each other the farthest counts. Where there is none, nothing is hidden.

#version 430

uniform sampler2D dilated;
uniform ivec2 texels;       // in the last picture
uniform int perspective;    // was the last view
uniform float eye;
uniform mat4 clip_from_texel;   // of the next camera, from (X d, Y d, d, 1), or in a parallel view from (X, Y, zeta, 1)
uniform vec4 zeta_from_texel;   // zeta of the next camera, likewise
uniform float jump;         // mm

out float zeta;
flat out float zeta_flat;

const float EMPTY = 3.0e38;
const ivec2 CORNERS[6] = ivec2[6](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 0), ivec2(1, 1), ivec2(0, 1));

vec4 place(ivec2 texel, float depth) {
    vec2 at = vec2(texel) + 0.5;
    return perspective != 0 ? vec4(at * (depth + eye), depth + eye, 1.0) : vec4(at, depth, 1.0);
}

void main() {
    int cell = gl_VertexID / 6, columns = texels.x - 1;
    ivec2 corner = ivec2(cell % columns, cell / columns);
    float least = EMPTY, most = -EMPTY;
    zeta_flat = -EMPTY;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = corner + ivec2(i & 1, i >> 1);
        float depth = texelFetch(dilated, texel, 0).x;
        least = min(least, depth);
        most = max(most, depth);
        zeta_flat = max(zeta_flat, dot(zeta_from_texel, place(texel, depth)));
    }
    ivec2 texel = corner + CORNERS[gl_VertexID % 6];
    vec4 here = place(texel, texelFetch(dilated, texel, 0).x);
    zeta = dot(zeta_from_texel, here);
    if (most - least <= jump) zeta_flat = -EMPTY;
    gl_Position = most >= EMPTY ? vec4(2.0, 2.0, 2.0, 1.0) : clip_from_texel * here;
    gl_Position.z = 0.0;  // only points behind the camera are clipped
}
