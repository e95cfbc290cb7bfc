// A colour at every point of a tube or a line with a halo, interpolated in the G-buffer (shaders/resolve/gbuffer.glsl).

uniform sampler2D fibletColourMap;     // rgba8

vec4 line_colour(uint streamline, vec3 tangent, float value) {
    return texelFetch(fibletColourMap, ivec2(gl_FragCoord.xy) - fibletOrigin, 0);
}
