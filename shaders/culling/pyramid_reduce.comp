// Up to six levels of the depth pyramid (pvfiblets/engine/culling/pyramid.py), as culling/pyramid_reduce.frag makes one: the farthest of
// 2 x 2 depth keys of the level before. A work group reduces a square of 64 x 64 of the source in shared memory.
//
// Texels beyond the picture's edge hold the nearest of all depths, which hides everything. An empty pixel is the farthest.

#version 430
layout(local_size_x = 16, local_size_y = 16) in;

uniform usampler2D source;
uniform int source_level;
#if FEATURE_SCENE_DEPTH
uniform usampler2D outside;
#endif
uniform ivec2 last;    // pixel of the source
uniform int levels;    // to be made

layout(r32ui, binding = 0) writeonly uniform uimage2D level_0;
layout(r32ui, binding = 1) writeonly uniform uimage2D level_1;
layout(r32ui, binding = 2) writeonly uniform uimage2D level_2;
layout(r32ui, binding = 3) writeonly uniform uimage2D level_3;
layout(r32ui, binding = 4) writeonly uniform uimage2D level_4;
layout(r32ui, binding = 5) writeonly uniform uimage2D level_5;

shared uint keys[32][32];

uint key_at(ivec2 at) {
    if (at.x > last.x || at.y > last.y) return 0u;
    uint key = texelFetch(source, at, source_level).x;
#if FEATURE_SCENE_DEPTH
    key = min(key, texelFetch(outside, at, 0).x);
#endif
    return key;
}

void main() {
    ivec2 me = ivec2(gl_LocalInvocationID.xy), group = ivec2(gl_WorkGroupID.xy);
    for (int i = 0; i < 4; ++i) {
        ivec2 at = me + 16 * ivec2(i & 1, i >> 1), from = 2 * (32 * group + at);
        uint key = max(max(key_at(from), key_at(from + ivec2(1, 0))), max(key_at(from + ivec2(0, 1)), key_at(from + ivec2(1, 1))));
        keys[at.y][at.x] = key;
        imageStore(level_0, 32 * group + at, uvec4(key));
    }
    for (int level = 1; level < levels; ++level) {
        int side = 32 >> level;
        bool mine = me.x < side && me.y < side;
        uint key = 0u;
        barrier();
        if (mine) key = max(max(keys[2 * me.y][2 * me.x], keys[2 * me.y][2 * me.x + 1]), max(keys[2 * me.y + 1][2 * me.x], keys[2 * me.y + 1][2 * me.x + 1]));
        barrier();
        if (!mine) continue;
        keys[me.y][me.x] = key;
        ivec2 at = side * group + me;
        if (level == 1) imageStore(level_1, at, uvec4(key));
        else if (level == 2) imageStore(level_2, at, uvec4(key));
        else if (level == 3) imageStore(level_3, at, uvec4(key));
        else if (level == 4) imageStore(level_4, at, uvec4(key));
        else imageStore(level_5, at, uvec4(key));
    }
}
