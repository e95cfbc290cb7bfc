// Tone mapping, brightness and contrast, gamma correction (Lesar, Bohak & Marolt 2015, section III.G), in this order:
//
//   x  = exposure * c                                                     c: the drawn colour, red, green, blue apart
//   y  = operator(x)
//   z  = (y - 1/2) * contrast + 1/2 + brightness
//   c' = clamp(z, 0, 1) ^ (1 / gamma)
//
//   operator
//     none          x
//     reinhard      x (1 + x / white^2) / (1 + x)             Reinhard et al. 2002, equation 4; white becomes 1
//     exponential   1 - exp(-x)
//     aces          x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)      Narkowicz 2016, fitted to the ACES film curve
//     hable         h(x) / h(white),  h(x) = (x (0.15 x + 0.05) + 0.004) / (x (0.15 x + 0.5) + 0.06) - 1/15    Hable 2010
//
// Alpha is left as it is.

uniform float exposure;
uniform float white;
uniform float brightness;
uniform float contrast;
uniform float gamma;
uniform float brightest;                    // white by every operator

#if FEATURE_TONE_HABLE
vec3 film(vec3 x)
{
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 1.0 / 15.0;
}
#endif

vec4 toned(vec4 colour)
{
    vec3 x = min(exposure * colour.rgb, brightest);      // so that squares stay below infinity
#if FEATURE_TONE_REINHARD
    x = x * (1.0 + x / (white * white)) / (1.0 + x);
#elif FEATURE_TONE_EXPONENTIAL
    x = 1.0 - exp(-x);
#elif FEATURE_TONE_ACES
    x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
#elif FEATURE_TONE_HABLE
    x = film(x) / film(vec3(white));
#endif
    x = clamp((x - 0.5) * contrast + (0.5 + brightness), 0.0, 1.0);
    return vec4(gamma == 1.0 ? x : pow(x, vec3(1.0 / gamma)), colour.a);
}
