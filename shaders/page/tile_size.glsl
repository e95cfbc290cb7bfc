// Size of the tiles; a page lights and smooths only tiles with lines.

const int TILE = 16;   // pixels; client/src/renderer.ts
