// The nearer of two pictures of parts of one set (pvfiblets/engine/fiblets/parts/part_pictures.py): what parts show together
// is what the whole shows. Depth compositing of Molnar et al. 1994 ("sort last"), for G-buffers.
//
// kept    the parts so far; its owner is the order of the part that a pixel is of, or, by streamline, the streamline
// drawn   one part more; `order` is that part's
//
// At one depth the lower order is in front, as within a set the fiblet of the lower index is.

#version 430

uniform usampler2D kept_depth;
uniform usampler2D kept_owner;
uniform usampler2D kept_ids;
uniform sampler2D kept_position;
uniform usampler2D drawn_depth;
uniform usampler2D drawn_ids;
uniform sampler2D drawn_position;

uniform uint order;
uniform int by_streamline;

layout(location = 0) out uint nearer_depth;
layout(location = 1) out uint nearer_owner;
layout(location = 2) out uvec2 nearer_ids;
layout(location = 3) out vec2 nearer_position;

#if FEATURE_CROSS_LINE
#if FEATURE_TUBES
uniform usampler2D kept_across;
uniform usampler2D drawn_across;
layout(location = 4) out uint nearer_across;
#else
uniform sampler2D kept_across;
uniform sampler2D drawn_across;
layout(location = 4) out float nearer_across;
#endif
#endif
#if FEATURE_EDGES
uniform usampler2D kept_edges;
uniform usampler2D drawn_edges;
#if FEATURE_CROSS_LINE
layout(location = 5) out uint nearer_edges;
#else
layout(location = 4) out uint nearer_edges;
#endif
#endif

const uint EMPTY = 0xFFFFFFFFu;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint before = texelFetch(kept_depth, at, 0).x, depth = texelFetch(drawn_depth, at, 0).x;
    uint owner = texelFetch(kept_owner, at, 0).x;
    uvec2 ids = texelFetch(drawn_ids, at, 0).xy;
    uint mine = by_streamline != 0 ? ids.x : order;
    bool nearer = depth < before || (depth == before && depth != EMPTY && mine < owner);
    nearer_depth = nearer ? depth : before;
    nearer_owner = nearer ? mine : owner;
    nearer_ids = nearer ? ids : texelFetch(kept_ids, at, 0).xy;
    nearer_position = nearer ? texelFetch(drawn_position, at, 0).xy : texelFetch(kept_position, at, 0).xy;
#if FEATURE_CROSS_LINE
    nearer_across = nearer ? texelFetch(drawn_across, at, 0).x : texelFetch(kept_across, at, 0).x;
#endif
#if FEATURE_EDGES
    nearer_edges = nearer ? texelFetch(drawn_edges, at, 0).x : texelFetch(kept_edges, at, 0).x;
#endif
}
