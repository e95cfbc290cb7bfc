// Which item, segment or point, a vertex is of: four for each, in the order of halos/strips.vert.

#if FEATURE_HALO_LISTED
uniform usamplerBuffer listed_texels;    // items of 1 << ITEM_SHIFT quads that may show; OpenGL is told how many
const int ITEM_SHIFT = {{ item_shift }};
#endif
uniform int first_shape;

int item_of_vertex() {
    int quad = first_shape + (gl_VertexID >> 2);
#if FEATURE_HALO_LISTED
    return int(texelFetch(listed_texels, quad >> ITEM_SHIFT).x << uint(ITEM_SHIFT)) + (quad & ((1 << ITEM_SHIFT) - 1));
#else
    return quad;
#endif
}
