// Values and colours along a tube: cubic between the nodes of a segment, as places and radii are.
// Paper: Russig et al. 2020, section 3.1: two quadratics in place of each cubic.
//
// n, m   value of a node, and its derivative by the segment's parameter

#if FEATURE_TUBE_VALUES
uniform samplerBuffer value_texels;      // value and derivative of each node
#endif
#if FEATURE_TUBE_COLOURS
uniform samplerBuffer colour_texels;     // RGBA of each node, then its derivatives
#endif

#if FEATURE_TUBE_VALUES || FEATURE_TUBE_COLOURS
// A place on a segment, between two nodes.
struct Nodes {
    int i;
    int j;
    float chord;      // derivatives are per mm times this, or by the parameter times 1
    float t;          // of its half
    bool second;      // half
};

Nodes nodes_of(uint segment, Segment s, bool second, float t) {
    uvec4 nodes = texelFetch(segment_texels, int(segment));
    float chord = tube_by_length != 0 ? s.size * safe_length(s.b3.xyz - s.a1.xyz) : 1.0;
    return Nodes(int(nodes.x), int(nodes.y), chord, t, second);
}

// The same two quadratics as of positions and radii.
vec4 blended(vec4 n_i, vec4 m_i, vec4 n_j, vec4 m_j, Nodes at) {
    vec4 a2 = n_i + tube_control_share * at.chord * m_i, b2 = n_j - tube_control_share * at.chord * m_j, middle = 0.5 * (a2 + b2);
    return at.second ? quadratic(middle, b2, n_j, at.t) : quadratic(n_i, a2, middle, at.t);
}
#else
struct Nodes { bool none; };
Nodes nodes_of(uint segment, Segment s, bool second, float t) { return Nodes(true); }
#endif

float value_of(Nodes at) {
#if FEATURE_TUBE_VALUES
    vec2 i = texelFetch(value_texels, at.i).xy, j = texelFetch(value_texels, at.j).xy;
    return blended(vec4(i.x), vec4(i.y), vec4(j.x), vec4(j.y), at).x;
#else
    return 0.0;
#endif
}

#if FEATURE_TUBE_COLOURS
vec4 colour_of(Nodes at) {
    vec4 i = texelFetch(colour_texels, 2 * at.i), j = texelFetch(colour_texels, 2 * at.j);
    vec4 by_i = texelFetch(colour_texels, 2 * at.i + 1), by_j = texelFetch(colour_texels, 2 * at.j + 1);
    return clamp(blended(i, by_i, j, by_j, at), 0.0, 1.0);
}
#endif
