// Chooses, from clusters that the last picture does not hide, fiblets that were not visible in it, but will probably show.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/choose.glsl"
#include "culling/visibility_prediction.glsl"

bool wanted(Capsule c) { return predicted_visible(c); }

void main() { choose(2u); }
