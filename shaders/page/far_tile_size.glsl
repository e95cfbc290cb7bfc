// How large the tiles are whose farthest depth is known (far_tiles.frag).

const int FAR_TILE = 4;   // pixels; client/src/renderer.ts
