// Chooses, from clusters that this picture does not hide so far, fiblets not drawn yet and not hidden as a whole; refine.comp goes on.

#version 430
layout(local_size_x = {{ group_size }}) in;

#include "fiblets/compute/choose.glsl"
#include "culling/hidden.glsl"

bool wanted(Capsule c) { return !hidden_as_a_whole(c); }

void main() { choose(3u); }
