// How many pixels an invocation may test for tubes. Software OpenGL leaves all loops of a shader after some count of iterations and
// says nothing, and nobody knows beforehand how many pixels a tube near the camera takes. So that an invocation counts,
// stops in time, and says so in a word of the marks; pvfiblets/engine/pipelines/compute.py then draws in smaller shares.

#if FEATURE_TUBES
uniform uint budget;      // pixels
uniform uint unfinished;  // which word of the marks

uint spent = 0u;

bool affordable() {
    if (++spent <= budget) return true;
    marks[unfinished] = 1u;
    return false;
}
#endif
