// The per-point value that a fragment shows, if the style asks for one: looked up, or interpolated between the segment's ends.

#if FEATURE_VALUES_STORED || FEATURE_VALUES_VOLUME
#include "fiblets/decode/sequential.glsl"
#include "fiblets/attributes/streamline_index.glsl"
#include "fiblets/attributes/values.glsl"
#endif

// A segment that stands for a whole fiblet finds it step by step.
float value_at(uint segment, float t, float steps) {
    float at = t * steps, whole = floor(clamp(at, 0.0, max(steps - 1.0, 0.0)));
#if FEATURE_VALUES_STORED
    begin_values(varying_ids.x - chunk_first);
    return value_along(segment, t, uint(whole), at - whole);
#elif FEATURE_VALUES_VOLUME
    if (steps > 1.0) return value_along_capsule(varying_ids.x - chunk_first, steps, uint(whole), at - whole);
    return value_between(varying_values.x, varying_values.y, at);
#elif FEATURE_VALUES_ARC_LENGTH
    return mix(varying_values.x, varying_values.y, t);
#else
    return 0.0;
#endif
}
