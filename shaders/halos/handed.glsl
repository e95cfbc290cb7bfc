// What the vertex stage hands to the fragments of a strip or a disc; HANDED is "out" or "in".

HANDED vec4 handed_strip;          // x: across, -1..1; y: along, in half strips from the start; z: u of the mask; w: share of
                                   // the strip that is line
flat HANDED uint handed_item;      // segment or point
flat HANDED float handed_length;   // of the segment, in half strips
#if FEATURE_HALO_FILTER
HANDED vec2 handed_filter;         // the number that filters, and how much it changes per mm
#endif
