// Claims places in a list (fiblets/compute/visibility_bits.glsl), and the work groups that process it. Arguments only grow.

uniform uint slots;        // dispatches of a class
uniform uint slot_groups;  // work groups of one

void want_groups(uint which, uint first, uint end) {
    uint at = arguments_at(which, slots);
    for (uint slot = first / slot_groups; slot * slot_groups < end; ++slot) {
        atomicMax(visibility_bits[at + 4u * slot], min(end - slot * slot_groups, slot_groups));
    }
}

// The first of `count` places in a class's list; a work group serves `served` of them.
uint claim(uint which, uint count, uint served) {
    uint start = atomicAdd(visibility_bits[length_at(which)], count), end = start + count;
    if (end <= list_room()) want_groups(which, start / served, (end + served - 1u) / served);
    else if (start <= list_room()) want_groups(which, 0u, (chunk_words() + {{ group_words }}u - 1u) / {{ group_words }}u);
    return start;
}
