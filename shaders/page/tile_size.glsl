const int TILE = 16;   // pixels; client/src/renderer.ts
