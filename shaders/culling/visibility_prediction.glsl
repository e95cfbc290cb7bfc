// Whether a fiblet that was not seen in the last picture will probably show in this one: it is then drawn before others are
// tested.
//
// A camera that moves opens gaps between lines, and gaps hide nothing: if only the fiblets of the last picture were drawn
// first, the depth so far would be full of them. Points of a fiblet are compared with the last picture's depth pyramid as
// if the camera had not moved, at a level coarse enough to include fiblets a little behind. The quality of the prediction
// decides how long a picture takes, not its pixels.
//
// A square with an empty pixel hides nothing. There a finer level decides: else all that lies behind the silhouette would be drawn.

#include "culling/bounds.glsl"
#include "frame/project.glsl"

const int PREDICTION_POINTS = 5;
const int OPEN_FINER = 3;      // levels

uniform usampler2D last_pyramid;
uniform int prediction_level;  // of the pyramid; -1: there is no last picture

uint last_farthest(ivec2 pixel, int level) { return texelFetch(last_pyramid, pixel >> (level + 1), level).x; }

bool predicted_visible(Capsule c) {
    if (prediction_level < 0) return false;
    vec4 a = to_homogeneous(c.a), b = to_homogeneous(c.b);
    bool any = false;
#if FEATURE_TUBES
    // From a tube's axis to where it shows.
    vec3 v = tube_ray * (tube_radius / max(length(tube_ray), 1e-30));
    vec4 front = window_from_local[0] * v.x + window_from_local[1] * v.y + window_from_local[2] * v.z;
#endif
    for (int k = 0; k < PREDICTION_POINTS; ++k) {
        vec4 c = mix(a, b, (float(k) + 0.5) / float(PREDICTION_POINTS)), s = to_window(c);
#if FEATURE_TUBES
        s.z = to_window(c - front).z;
#endif
        ivec2 at = ivec2(clamp(s.xy, vec2(0.0), viewport - 1.0));
        uint key = last_farthest(at, prediction_level), finer = last_farthest(at, max(prediction_level - OPEN_FINER, 0));
        any = any || s.z <= float(key == 0xFFFFFFFFu ? finer : key) / 4294967296.0;
    }
    return any;
}
