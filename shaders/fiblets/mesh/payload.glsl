// What the task stage hands to its mesh work groups: `task.survivors`. The task stage defines PAYLOAD_OUT first.

#include "fiblets/mesh/survivors.glsl"

#if FEATURE_MESH_EXT
struct Task { Survivors survivors; };
taskPayloadSharedEXT Task task;
#elif defined(PAYLOAD_OUT)
taskNV out Task { Survivors survivors; } task;
#else
taskNV in Task { Survivors survivors; } task;
#endif
