// A pixel's ray: where it enters and leaves what is there.

struct Ray {
    vec3 o;          // voxels
    vec3 d;          // voxels per mm
    vec3 inverse;    // mm per voxel, along each axis
    float first;     // mm
    float last;
};

#if FEATURE_VOLUME_CLOSED
float box_enter, box_leave;      // mm along the pixel's ray
#endif

vec3 at(Ray ray, float t) { return ray.o + t * ray.d; }

void narrow(float start, float rise, inout float first, inout float last) {
    if (abs(rise) < 1e-30) {
        if (start < 0.0) last = -3e38;
    } else if (rise > 0.0) first = max(first, -start / rise);
    else last = min(last, -start / rise);
}

// U / W along the ray is far at the mm that comes back.
float where_far(Ray ray, float far) {
    float u = dot(u_from_voxels, vec4(ray.o, 1.0)), w = dot(w_from_voxels, vec4(ray.o, 1.0));
    float du = dot(u_from_voxels.xyz, ray.d), dw = dot(w_from_voxels.xyz, ray.d);
    float rise = du - far * dw;
    return rise < 0.0 ? (far * w - u) / rise : 3e38;
}

float reversed_depth(Ray ray, float t) {
    vec4 p = vec4(at(ray, t), 1.0);
    return dot(u_from_voxels, p) / max(dot(w_from_voxels, p), 1e-30);
}

Ray ray_of(vec2 fragment) {
    vec2 pixel = fragment - half_picture;
    vec3 way = ray_direction[0] + pixel.x * ray_direction[1] + pixel.y * ray_direction[2];
    vec3 mm = mm_from_voxels * way;
    Ray ray;
    ray.o = ray_origin[0] + pixel.x * ray_origin[1] + pixel.y * ray_origin[2];
    ray.d = way / max(length(mm), 1e-30);
    vec3 least = max(abs(ray.d), 1e-20);
    ray.inverse = vec3(ray.d.x < 0.0 ? -1.0 : 1.0, ray.d.y < 0.0 ? -1.0 : 1.0, ray.d.z < 0.0 ? -1.0 : 1.0) / least;
    vec3 to_low = (box_low - ray.o) * ray.inverse, to_high = (box_high - ray.o) * ray.inverse;
    vec3 enter = min(to_low, to_high), leave = max(to_low, to_high);
    ray.first = max(enter.x, max(enter.y, enter.z));
    ray.last = min(leave.x, min(leave.y, leave.z));
#if FEATURE_VOLUME_CLOSED
    box_enter = ray.first;
    box_leave = ray.last;
#endif
    for (int plane = 0; plane < ray_plane_count; ++plane) {
        narrow(dot(ray_planes[plane], vec4(ray.o, 1.0)), dot(ray_planes[plane].xyz, ray.d), ray.first, ray.last);
    }
    return ray;
}
