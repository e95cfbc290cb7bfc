// Mask of squares of TILE x TILE pixels with a line of one drawable, or one right beside them: pixels that smooth edges may change.
// It runs once for each drawable, and leaves squares alone that have none of its lines.
//
//   keys       of the drawable's G-buffer (pvfiblets/engine/gbuffer.py)

#version 430

uniform usampler2D keys;
out float lines;

const int TILE = {{ tile }};
const uint EMPTY = 0xFFFFFFFFu;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE, low = max(corner - 1, 0), high = min(corner + TILE, textureSize(keys, 0) - 1);
    uint nearest = EMPTY;
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) nearest = min(nearest, texelFetch(keys, ivec2(x, y), 0).r);
    }
    if (nearest == EMPTY) discard;
    lines = 1.0;
}
