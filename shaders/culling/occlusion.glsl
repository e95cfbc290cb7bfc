// bool hidden(Capsule c): whether nothing of a fiblet can show, by what the program was made to test against.

#include "culling/bounds.glsl"
#include "frame/project.glsl"

#if FEATURE_CULL_COVERAGE
#include "culling/coverage.glsl"
#else
#include "culling/hidden.glsl"
#endif
