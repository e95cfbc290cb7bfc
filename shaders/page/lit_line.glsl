// Appearance of the nearest line of a pixel, of one layer: its colours, and the light that falls on lines
// (shaders/resolve/line_light.glsl; lights.glsl is the same in one piece).
//
//   light    0 colours as they are, 1 the light on lines, 2 illuminated lines

#include "codec/layout.glsl"
#include "frame/tangent.glsl"
#include "fiblets/attributes/tangent.glsl"
#include "page/lights.glsl"
// First what several modes share: a page switches between them after includes are pasted.
#include "colour/rows.glsl"
#include "page/missing.glsl"
#include "page/rows.glsl"
#include "colour/line_colour.glsl"

uniform highp usampler2D texels;
uniform highp sampler2D depths;
uniform uint layer;
uniform int light;
uniform vec4 reflects;                 // ambient, diffuse, specular, power
uniform vec3 sheen;                    // colour of highlights
uniform highp usampler2D chosen;       // by streamline: whether it is selected (shaders/resolve/highlight.glsl)
uniform vec4 chosen_colour;            // of those selected, and how much of it
uniform vec4 faded;                    // of all others
uniform uint marked;                   // the streamline that was picked; all ones: none
uniform mat3 data_to_view;
uniform mat4 pixel_to_view;
uniform vec2 picture;                  // its size

// The texel of the pixel; without one of the layer the pixel is left out.
uvec4 nearest_line(ivec2 pixel) {
    uvec4 word = texelFetch(texels, pixel, 0);
    if (word.y == 0xFFFFFFFFu && word.x == 0xFFFFFFFFu || (word.x & 0xF0000000u) != layer) discard;
    return word;
}

vec3 lit(ivec2 pixel, vec3 own, vec3 tangent) {
    if (light == 0) return own;
    vec2 ndc = 2.0 * (vec2(pixel) + 0.5) / picture - 1.0;
    vec4 place = pixel_to_view * vec4(ndc, 2.0 * texelFetch(depths, pixel, 0).r - 1.0, 1.0);
    return light_on_line(own, tangent, place.xyz / place.w, light == 2, reflects, sheen);
}

// Its colour with light, and its own opacity.
vec4 lit_line(ivec2 pixel, uvec4 word) {
    uint streamline = word.x & 0x0FFFFFFFu;
    vec3 tangent = unpacked_tangent(word.y);
    vec4 own = line_colour(streamline, tangent, uintBitsToFloat(word.w));
    if (chosen_colour.a + faded.a > 0.0) {
        uint is_chosen = texelFetch(chosen, texel(streamline), 0).r;
        vec4 mark = is_chosen != 0u ? chosen_colour : faded;
        own.rgb = mix(own.rgb, mark.rgb, mark.a);
    }
    own.rgb = lit(pixel, own.rgb, normalize(data_to_view * tangent));
    if (streamline == marked) own.rgb = mix(own.rgb, vec3(1.0, 0.9, 0.2), 0.75);
    return own;
}
