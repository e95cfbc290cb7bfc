// A direction in 32 bits: octahedral map about +x, two snorm16, as the codec packs a first direction.

uint packed_direction(vec3 d) {
    float norm = abs(d.x) + abs(d.y) + abs(d.z);
    vec2 s = d.yz / norm;
    if (d.x < 0.0) s = (1.0 - abs(s.yx)) * vec2(s.x < 0.0 ? -1.0 : 1.0, s.y < 0.0 ? -1.0 : 1.0);
    ivec2 i = ivec2(round(clamp(s, -1.0, 1.0) * FIBLET_DIRECTION_SCALE));
    return uint(i.x & 0xFFFF) | (uint(i.y) << 16u);
}

// Packed direction of a vector of any length; `before` for the zero vector.
uint packed_tangent(vec3 delta, uint before) {
    float size = max(abs(delta.x), max(abs(delta.y), abs(delta.z)));
    return size > 0.0 ? packed_direction(delta / size) : before;
}
