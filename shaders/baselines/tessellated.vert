// Baseline `tessellated`: hands a node on. Positions are local: relative to the middle of the set, mm.

#version 430

in vec4 node_place;   // x, y, z, radius
in vec4 node_slope;   // their derivatives
in vec3 node_across;  // unit, across the tangent, carried along the tube

out Node { vec4 place; vec4 slope; vec3 across; } node;

void main() {
    node.place = node_place;
    node.slope = node_slope;
    node.across = node_across;
}
