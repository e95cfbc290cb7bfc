// Blur of each pixel: the circle of confusion of a thin lens (Lesar, Bohak & Marolt 2015, section III.G,
// whose interpolation factor is the distance from the focal point).
//
// All that is at distance z reaches a lens of diameter A as a cone, which the plane in focus, at z_f, cuts in a disc of
// diameter A |z - z_f| / z. A mm there is k / z_f pixels, so the disc's radius in the picture is
//
//   r = A k / 2 * |1 / z_f - 1 / z|                    perspective; k A / (2 z_f) at infinite distance
//   r = A k / (2 z_f) * |z - z_f|                      parallel: the lens is as far away as the viewer, its cones do not narrow
//
// and r, signed so that it is negative nearer than z_f, is linear in window depth for both:
//
//   s = line.x + line.y * (1 - depth)
//
//   depths     window depths; 1 where nothing was drawn
//   line       pixels
//   backdrop   s at infinite distance
//   widest     pixels; r is no greater
//   areas      pixels that a disc of radius i / STEPS covers, see effects/picture/disc.glsl
//   darkening  share of light lost by the widest disc; the background stays as it is
//
// Out: depth | s | 1 / pixels of the disc | remaining share of the light.

#version 430

uniform sampler2D depths;
uniform sampler2D areas;
uniform vec2 line;
uniform float backdrop;
uniform float widest;
uniform float darkening;
out vec4 blur;

const float STEPS = {{ steps }};

void main()
{
    float depth = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
    bool empty = depth >= 1.0;
    float s = clamp(empty ? backdrop : line.x + line.y * (1.0 - depth), -widest, widest);
    float place = max(abs(s), 0.5) * STEPS;
    int low = int(place);
    float area = mix(texelFetch(areas, ivec2(low, 0), 0).r, texelFetch(areas, ivec2(low + 1, 0), 0).r, fract(place));
    // A disc within its pixel is sharp; darkness begins beyond, so that pixels in focus are left alone.
    float dark = darkening * max(abs(s) - 0.5, 0.0) / (widest - 0.5);
    blur = vec4(depth, s, 1.0 / area, empty ? 1.0 : 1.0 - dark);
}
