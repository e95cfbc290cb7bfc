// Whether a fragment lies in the region that cuts its lines. The shapes lie along the pixel's ray as the engine has them
// (regions/rays.glsl); the engine keeps where the region begins and ends along it (regions/boundaries.glsl), the page asks
// each shape about the fragment, which takes no texture. What joins the shapes stands in the place of REGION, which
// client/src/cuts.ts writes for a region's form.

#if FEATURE_CLIP_REGION
#include "regions/rays.glsl"

bool along(vec2 span, float z) { return span.x <= z && z < span.y; }
bool planes_hold(int leaf, int planes, float z) { return along(rays_planes(leaf, planes, gl_FragCoord.xy), z); }
bool sphere_holds(int leaf, float z) { return along(rays_sphere(leaf, gl_FragCoord.xy), z); }

#define REGION planes_hold(0, 6, z) || sphere_holds(1, z)

bool region_keeps(float z) { return REGION; }
#endif
