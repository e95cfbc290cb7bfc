// The farthest depth in rectangles of pixels, from the pyramid of pvfiblets/engine/culling/pyramid.py.

uniform usampler2D pyramid;
uniform int pyramid_levels;

const int SPAN = 4;        // squares of the pyramid each way

// What a key stands for at most: depths up to the next key; all ones stand for everything.
float depth_of(uint key) { return key == 0xFFFFFFFFu ? 3.0e38 : (float(key) + 512.0) / 4294967296.0; }

// Farthest depth in a rectangle of pixels, at the level at which it spans no more than SPAN squares each way.
float farthest_in(ivec2 low, ivec2 high) {
    int level = 0;
    ivec2 span = (high >> 1) - (low >> 1);
    while (level + 1 < pyramid_levels && max(span.x, span.y) >= SPAN) {
        ++level;
        span = (high >> (level + 1)) - (low >> (level + 1));
    }
    ivec2 first = low >> (level + 1), last = high >> (level + 1);
    uint key = 0u;
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) key = max(key, texelFetch(pyramid, ivec2(x, y), level).x);
    }
    return depth_of(key);
}

// The same at the level at which four loads suffice; a rectangle too large for the pyramid counts as open.
float farthest_around(ivec2 low, ivec2 high) {
    ivec2 size = high - low + 1;
    int wanted = max(findMSB(max(size.x, size.y) * 2 - 1) - 1, 0), level = min(wanted, pyramid_levels - 1);
    ivec2 first = low >> (level + 1), last = high >> (level + 1);
    uint a = texelFetch(pyramid, first, level).x, b = texelFetch(pyramid, last, level).x;
    uint c = texelFetch(pyramid, ivec2(first.x, last.y), level).x, d = texelFetch(pyramid, ivec2(last.x, first.y), level).x;
    return wanted > level ? 3.0e38 : depth_of(max(max(a, b), max(c, d)));  // squares between the corners were not looked at
}
