// Measures fiblets (fiblets/attributes/measure.glsl): one invocation per fiblet of a batch.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/attributes/measure.glsl"
#include "frame/groups.glsl"

layout(std430, binding = {{ storage_measures }}) writeonly buffer Measures { float measures[]; };

uniform uint batch_first;
uniform uint batch_size;

void main() {
    uint slot = group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
    if (slot < batch_size) measures[slot] = length_of(batch_first + slot);
}
