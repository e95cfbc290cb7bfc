// What the passes of one picture tell each other about fiblets: eight bits each, in one buffer, because OpenGL promises no
// more than eight storage buffers to a shader. For 32 fiblets stand, one word each:
//
//   0, 1, 2      plan: seen in the last picture; inside the view volume, crossing its sides, crossing more
//   3, 4, 5      plan: not seen in it; the same three classes
//   6            candidates: came nearest in some pixel, or tied
//   7            seen: may own a pixel

layout(std430, binding = 5) buffer Marks { uint marks[]; };

const uint CANDIDATES = 6u, SEEN = 7u;
