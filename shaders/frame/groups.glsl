// Index of this work group where a dispatch is folded into rows, because drivers limit groups per axis, or is one of several.

uniform uint first_group;  // of this dispatch; 0 where it is the only one

uint group_index() { return first_group + gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
