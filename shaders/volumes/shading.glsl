// Light of the scene's lamps on a volume that emits and absorbs: Phong's model, whose normal is the gradient of the values (Levoy 1988).
//
//   colour' = ambient c + sum over lamps of (diffuse |N L| c + specular max(R V, 0)^power) * lamp
//
// as in VTK's volume mappers, on both sides of a normal. Where the field hardly changes there is no normal: from a gradient of
// `weakest` on downwards the colour goes over into that without any lamps, so that noise casts no shadows and even parts are not black.
//
// Places are mm from the eye in the scene's own coordinates, which lamps and actors' matrices are given in.

// Of a voxel that has one; the table of colours is white then.
#if FEATURE_VOLUME_COLOURS
uniform sampler3D voxel_colours;
vec3 own_colour(vec3 voxel) { return textureLod(voxel_colours, (voxel + 0.5) / volume_shape, 0.0).rgb; }
#else
vec3 own_colour(vec3 voxel) { return vec3(1.0); }
#endif

#if FEATURE_VOLUME_SHADED
const int LAMPS = {{ lamps }};
uniform mat3 seen_from_voxels;        // of directions
uniform mat3 normal_from_voxels;      // its inverse, transposed
uniform vec3 seen_start;              // voxel 0
uniform vec4 towards_eye;             // of a parallel view, with 1; else 0
uniform int lamp_count;
uniform vec4 lamp_places[LAMPS];      // with 1, or with 0 the direction towards it
uniform vec4 lamp_cones[LAMPS];       // the way it shines, and the cosine of its cone; -2 for none
uniform vec4 lamp_fading[LAMPS];      // by distance: 1 / (x + d y + d d z); w: power of the cosine within the cone
uniform vec3 lamp_colours[LAMPS];
uniform vec3 lamp_highlights[LAMPS];
uniform vec4 reflection;              // ambient, diffuse, specular, power
uniform float weakest;                // change by mm of the scene

// What all lamps add, at a place in voxels, on a normal of length 1; from both of its sides, or from that which it points to.
void shine(vec3 voxel, vec3 n, bool both, out vec3 diffuse, out vec3 specular) {
    vec3 place = seen_from_voxels * voxel + seen_start;
    vec3 v = mix(normalize(-place), towards_eye.xyz, towards_eye.w);
    diffuse = specular = vec3(0.0);
    for (int k = 0; k < lamp_count; ++k) {
        vec3 way = lamp_places[k].xyz - lamp_places[k].w * place;
        float far = length(way);
        vec3 l = way / max(far, 1e-30);
        vec4 fading = lamp_fading[k];
        float strength = lamp_places[k].w > 0.0 ? 1.0 / max(fading.x + far * (fading.y + far * fading.z), 1e-30) : 1.0;
        float inside = -dot(l, lamp_cones[k].xyz);
        if (lamp_cones[k].w > -1.5) strength *= inside >= lamp_cones[k].w ? pow(max(inside, 1e-6), fading.w) : 0.0;
        float nl = dot(n, l);
        vec3 r = 2.0 * nl * n - l;
        diffuse += strength * (both ? abs(nl) : max(nl, 0.0)) * lamp_colours[k];
        specular += (both || nl > 0.0 ? strength : 0.0) * pow(max(dot(r, v), 1e-6), reflection.w) * lamp_highlights[k];
    }
}

// The colour of a surface, whose normal by voxels points to the viewer.
vec3 lit_surface(vec3 colour, vec3 voxel, vec3 gradient) {
    vec3 n = normal_from_voxels * gradient, diffuse, specular;
    shine(voxel, n / max(length(n), 1e-30), false, diffuse, specular);
    return clamp(colour * (reflection.x + reflection.y * diffuse) + reflection.z * specular, 0.0, 1.0);
}

vec4 shaded(Ray ray, float t, vec4 part) {
    vec3 voxel = at(ray, t);
    part.rgb *= own_colour(voxel);
    vec3 low = max(voxel - 1.0, 0.0), high = min(voxel + 1.0, volume_shape - 1.0);
    vec3 g = normal_from_voxels * (vec3(value_at(vec3(high.x, voxel.yz)) - value_at(vec3(low.x, voxel.yz)),
                                        value_at(vec3(voxel.x, high.y, voxel.z)) - value_at(vec3(voxel.x, low.y, voxel.z)),
                                        value_at(vec3(voxel.xy, high.z)) - value_at(vec3(voxel.xy, low.z))) / (high - low));
    float size = length(g);
    vec3 diffuse, specular;
    shine(voxel, g / max(size, 1e-30), true, diffuse, specular);
    vec3 lit = part.rgb * (reflection.x + reflection.y * diffuse) + part.a * reflection.z * specular;
    return vec4(mix(part.rgb, min(lit, vec3(part.a)), smoothstep(0.0, 1.0, size / max(weakest, 1e-30))), part.a);
}
#else
vec3 lit_surface(vec3 colour, vec3 voxel, vec3 gradient) { return colour; }
vec4 shaded(Ray ray, float t, vec4 part) { return vec4(part.rgb * own_colour(at(ray, t)), part.a); }
#endif
