// Size of the tiles of farthest depths (far_tiles.frag).

const int FAR_TILE = 4;   // pixels; client/src/renderer.ts
