// Index of this work group where a dispatch is folded into rows, because drivers limit groups per axis.

uint group_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
