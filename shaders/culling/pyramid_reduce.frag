// One level of the depth pyramid (pvfiblets/engine/culling/pyramid.py): the farthest of 2 x 2 depth keys of the level before.
// In the first level the nearer of fiblets and of other things in the scene hides (FEATURE_SCENE_DEPTH).
//
// Texels beyond the picture's edge hold the nearest of all depths, which hides everything. An empty pixel is the farthest.

#version 430

uniform usampler2D source;
#if FEATURE_SCENE_DEPTH
uniform usampler2D outside;
#endif
uniform ivec2 last;  // pixel of the source

out uint farthest;

void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    uint key = 0u;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = first + ivec2(i & 1, i >> 1);
        if (at.x > last.x || at.y > last.y) continue;
        uint here = texelFetch(source, at, 0).x;
#if FEATURE_SCENE_DEPTH
        here = min(here, texelFetch(outside, at, 0).x);
#endif
        key = max(key, here);
    }
    farthest = key;
}
