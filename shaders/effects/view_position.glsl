// Position of a pixel of the G-buffer in view coordinates (mm, the viewer at the origin, looking along -z), and back.
//
// The way from a pixel to its place is projective, so for the pixel at n (in [-1, 1]) with f = 1 - window depth
//
//   (x, y, z, w) = pixel_to_view (n, f, 1)           distance = -z / w = -(A f + B) / (C f + D)
//
// with A to D linear in n. f is formed on the integers: in a perspective view 1 / distance is linear in it, and the
// distance of far points would lose all its digits to the cancellation in 1 - depth, had that been formed in float.
//
//   keys             r32ui; window depth * 4294967295, EMPTY where nothing was drawn
//   picture          pixels
//   lens             (k, w0, w1): a mm at a distance is k / (w0 + w1 * distance) pixels

uniform usampler2D keys;
uniform mat4 pixel_to_view;
uniform vec3 lens;

const uint EMPTY = 0xFFFFFFFFu;
const float NOTHING = 3.0e38;      // farther than every line

vec2 normalized(ivec2 pixel)
{
    return 2.0 * (vec2(pixel) + 0.5) / vec2(textureSize(keys, 0)) - 1.0;
}

vec3 view_position(ivec2 pixel, uint key)
{
    vec4 place = pixel_to_view * vec4(normalized(pixel), float(EMPTY - key) / 4294967295.0, 1.0);
    return place.xyz / place.w;
}

float pixels_per_mm(float distance)
{
    return lens.x / max(lens.y + lens.z * distance, 1.0e-20);
}

// Depth key of a pixel at a distance: f = (B + distance * D) / (-A - distance * C).
uint key_at(ivec2 pixel, float distance)
{
    vec4 flat_part = pixel_to_view * vec4(normalized(pixel), 0.0, 1.0);
    vec4 deep_part = pixel_to_view[2];
    float f = -(flat_part.z + distance * flat_part.w) / (deep_part.z + distance * deep_part.w);
    return EMPTY - uint(clamp(f, 6.0e-8, 0.99999994) * 4294967295.0);
}
