// Baseline `tessellated`: level of detail of one segment by its size on the screen (Russig et al. 2020, section 4; Nunes
// et al. 2012).
//
// A patch is a segment, two nodes. It becomes a grid: around the tube (u) and along it (v). On the screen neither the
// polygon of a cross section nor the polyline of the axis and of the outline may stray from the curve by more than TOLERANCE:
//
//   around: a circle of R pixels and a polygon of n corners differ by R (1 - cos(pi / n))
//   along:  a curve whose second derivative is at most D and k chords of it differ by D / (8 k^2) (paper's limit: k <= 6)
//
// OpenGL makes two steps along of one wherever a quad has more than one step around, except at the seam.
//
// The number of corners at a node depends on that node alone, so that segments meet without cracks. Segments outside of
// the picture get level 0.

#version 430

layout(vertices = 2) out;

const float PI = 3.14159265358979;
const float TOLERANCE = {{ tolerance }};  // pixels
const float LEAST_SIDES = {{ least_sides }};
const float MOST_SIDES = {{ most_sides }};
const float MOST_STEPS = {{ most_steps }};

uniform int scaled;           // slopes are per mm, to be multiplied with the chord
uniform vec4 depth_row;       // . (x, y, z, 1): distance in front of the eye, mm
uniform float nearest;        // of the near plane, mm
uniform float pixels;         // that 1 mm takes at a distance of 1 mm
uniform vec4 planes[5];       // of the view volume, inwards, unit normals, without the far one

in Node { vec4 place; vec4 slope; vec3 across; } nodes[];

out Node { vec4 place; vec4 slope; vec3 across; } ends[];

float distance_to(vec4 place) {
    return max(dot(depth_row, vec4(place.xyz, 1.0)) - place.w, nearest);
}

float corners(vec4 place) {
    float radius = pixels * place.w / distance_to(place);
    if (radius <= TOLERANCE) return LEAST_SIDES;
    return clamp(ceil(PI / acos(1.0 - TOLERANCE / radius)), LEAST_SIDES, MOST_SIDES);
}

void main() {
    float chord = scaled != 0 ? distance(nodes[0].place.xyz, nodes[1].place.xyz) : 1.0;
    ends[gl_InvocationID].place = nodes[gl_InvocationID].place;
    ends[gl_InvocationID].slope = nodes[gl_InvocationID].slope * chord;
    ends[gl_InvocationID].across = nodes[gl_InvocationID].across;
    if (gl_InvocationID != 0) return;

    vec4 controls[4] = vec4[](nodes[0].place, nodes[0].place + nodes[0].slope * (chord / 3.0),
                              nodes[1].place - nodes[1].slope * (chord / 3.0), nodes[1].place);
    bool outside = false;
    for (int p = 0; p < 5; ++p) {
        bool behind = true;
        for (int c = 0; c < 4; ++c)
            behind = behind && dot(planes[p], vec4(controls[c].xyz, 1.0)) < -controls[c].w;
        outside = outside || behind;
    }
    float depth = min(min(distance_to(controls[0]), distance_to(controls[1])),
                      min(distance_to(controls[2]), distance_to(controls[3])));
    float bend = 6.0 * max(length(controls[0] - 2.0 * controls[1] + controls[2]),
                           length(controls[1] - 2.0 * controls[2] + controls[3]));
    float steps = clamp(ceil(sqrt(pixels * bend / (8.0 * TOLERANCE * depth))), 1.0, MOST_STEPS);
    float first = corners(controls[0]), last = corners(controls[3]);
    if (outside) steps = first = last = 0.0;
    gl_TessLevelOuter[0] = gl_TessLevelOuter[2] = gl_TessLevelInner[1] = steps;
    gl_TessLevelOuter[1] = first;
    gl_TessLevelOuter[3] = last;
    gl_TessLevelInner[0] = max(first, last);
}
