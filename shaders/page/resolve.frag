// From the page's G-buffer to colours, of one layer: its colours, as shaders/resolve has them, and the light that falls on lines
// (shaders/resolve/line_light.glsl, of which this is the same in one piece).
//
//   mode     0 direction, 1 one colour, 2 a colour for each streamline, 3 values of points through a table, 4 colours of points
//   light    0 colours as they are, 1 the light on lines, 2 illuminated lines

#version 430

#include "codec/layout.glsl"
#include "frame/tangent.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "page/lights.glsl"
#include "page/table.glsl"

uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform highp sampler2D colours;       // rgba8, by streamline
uniform uint layer;
uniform int mode;
uniform vec3 one_colour;
uniform int light;
uniform vec4 reflects;                 // ambient, diffuse, specular, power
uniform vec3 sheen;                    // colour of highlights
uniform highp usampler2D chosen;       // by streamline: whether it is selected (shaders/resolve/highlight.glsl)
uniform vec4 chosen_colour;            // of those selected, and how much of it
uniform vec4 faded;                    // of all others
uniform uint marked;                   // the streamline that was picked; all ones: none
uniform mat3 data_to_view;
uniform mat4 pixel_to_view;
uniform float parallel;
uniform vec2 picture;                  // its size

layout(location = 0) out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 word = texelFetch(texels, pixel, 0);
    if (word.y == 0xFFFFFFFFu && word.x == 0xFFFFFFFFu || (word.x & 0xF0000000u) != layer) discard;
    uint streamline = word.x & 0x0FFFFFFFu;
    vec3 tangent = unpacked_tangent(word.y);
    vec4 own = vec4(one_colour, 1.0);
    if (mode == 0) own = vec4(abs(tangent), 1.0);
    else if (mode == 2) own = texelFetch(colours, ivec2(int(streamline & 4095u), int(streamline >> 12u)), 0);
    else if (mode == 3) own = of_value(uintBitsToFloat(word.w));
    else if (mode == 4) own = unpackUnorm4x8(word.w);
    if (own.a == 0.0) discard;
    if (chosen_colour.a + faded.a > 0.0) {
        uint is_chosen = texelFetch(chosen, ivec2(int(streamline & 4095u), int(streamline >> 12u)), 0).r;
        vec4 mark = is_chosen != 0u ? chosen_colour : faded;
        own.rgb = mix(own.rgb, mark.rgb, mark.a);
    }
    vec3 lit = own.rgb;
    if (light != 0) {
        vec2 ndc = 2.0 * (vec2(pixel) + 0.5) / picture - 1.0;
        vec4 place = pixel_to_view * vec4(ndc, 2.0 * texelFetch(depths, pixel, 0).r - 1.0, 1.0);
        lit = light_on_line(own.rgb, normalize(data_to_view * tangent), place.xyz / place.w, light == 2, reflects, sheen);
    }
    if (streamline == marked) lit = mix(lit, vec3(1.0, 0.9, 0.2), 0.75);
    colour = vec4(lit, 1.0);
}
