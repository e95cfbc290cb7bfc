// Samples of one set more, where they are nearer than those of the sets before (fiblets/samples/entries.frag): by OpenGL's depth
// test, as VTK has it for what it draws one after the other.
//
//   drawn_depth, _owner, _ids, _position    of this set
//   corner                                  texel of the sets' samples where those of this set begin
//   set, sets                               its number, and how many sets there are: owners of all are told apart by it

#version 430

uniform usampler2D drawn_depth;
uniform usampler2D drawn_owner;
uniform usampler2D drawn_ids;
uniform sampler2D drawn_position;
uniform ivec2 corner;
uniform uint set;
uniform uint sets;

layout(location = 0) out uint depth;
layout(location = 1) out uint owner;
layout(location = 2) out uvec2 ids;
layout(location = 3) out vec2 position;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) - corner;
    depth = texelFetch(drawn_depth, at, 0).x;
    if (depth == 0xFFFFFFFFu) discard;
    gl_FragDepth = float(depth) / 4294967295.0;
    owner = texelFetch(drawn_owner, at, 0).x * sets + set;
    ids = texelFetch(drawn_ids, at, 0).xy;
    position = texelFetch(drawn_position, at, 0).xy;
}
