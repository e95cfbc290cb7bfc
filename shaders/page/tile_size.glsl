// How large the tiles are of which a page lights and smooths those alone that have lines.

const int TILE = 16;   // pixels; client/src/renderer.ts
