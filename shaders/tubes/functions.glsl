// One half of a segment in ray space, and the functions whose roots say where a ray meets it.
// Paper: Russig et al. 2020, section 3.2, "Intersection", equations 1 to 3.
//
// Symbols
//   q(t)         (r, p_y, p_z) = q_a + t q_b + t^2 q_c: radius, and distance from the ray in two directions
//   h(t)         p_x, along the ray
//   <u, v>       u_x v_x - u_y v_y - u_z v_z
//   g            <q, q> = r^2 - p_y^2 - p_z^2: positive where the sphere at t meets the ray
//   f            h - sqrt g: where the ray enters that sphere. Its least minimum is the nearest point of the tube
//   g', g'', g'''    2 G1, 2 G2, 2 G3 with G1 = <q, q'>, G2 = <q', q'> + <q, q''>, G3 = 3 <q', q''>
//
// u by its order: functions with the sign of those that are wanted, and no pole where g = 0
//   0            g
//   1            G1
//   2            of f':   F1 = sqrt(g) h' - G1                          = sqrt(g) f'
//   3            of f'':  F2 = g sqrt(g) h''  + G1^2 - g G2             = g sqrt(g) f''
//   4            of f''': F3 = -(g^2 G3 - 3 g G1 G2 + 3 G1^3)           = g^2 sqrt(g) f'''
//
// g is never expanded to its five coefficients: p_y and p_z of a long thin segment are large where its coefficients are
// taken and small where the ray passes, and their squares would lose twice the digits. Where g < 0, F1 goes on as -G1: on a
// concave g that leads back to where g is positive, so that no search needs to know where that begins.

const int MISS = 0, ENTRY = 1, EXIT = 2, CUT = 3;

struct Found {
    float l;
    float t;
    int kind;
};

vec3 q_a, q_b, q_c;
float h_a, h_b, h_c;

// A control point as r, p_y, p_z and p_x.
vec4 in_ray_space(vec4 p, vec3 o, vec3 d, vec3 y_axis, vec3 z_axis) {
    vec3 v = p.xyz - o;
    return vec4(p.w, dot(y_axis, v), dot(z_axis, v), dot(d, v));
}

float product(vec3 u, vec3 v) { return u.x * v.x - u.y * v.y - u.z * v.z; }

// Have the functions below be those of the half with these control points.
void take_half(vec4 k0, vec4 k1, vec4 k2) {
    vec4 b = 2.0 * (k1 - k0), c = (k0 - k1) + (k2 - k1);
    q_a = k0.xyz;
    q_b = b.xyz;
    q_c = c.xyz;
    h_a = k0.w;
    h_b = b.w;
    h_c = c.w;
}

// Whether the ray may meet a half: g has the Bezier coefficients <q_i, q_j>.
bool may_meet(vec4 k0, vec4 k1, vec4 k2) {
    float most = max(product(k0.xyz, k0.xyz), product(k2.xyz, k2.xyz));
    most = max(most, max(product(k0.xyz, k1.xyz), product(k1.xyz, k2.xyz)));
    return max(most, product(k0.xyz, k2.xyz) + 2.0 * product(k1.xyz, k1.xyz)) > 0.0;
}

float u(int order, float t) {
    vec3 q = q_a + t * (q_b + t * q_c), dq = q_b + 2.0 * t * q_c;
    float g = product(q, q);
    if (order == 0) return g;
    float g1 = product(q, dq);
    if (order == 1) return g1;
    float s = sqrt(max(g, 0.0)), dh = h_b + 2.0 * t * h_c;
    if (order == 2) return s * dh - g1;
    float g2 = product(dq, dq) + 2.0 * product(q, q_c);
    g = max(g, 0.0);
    if (order == 3) return 2.0 * g * s * h_c + g1 * g1 - g * g2;
    float g3 = 6.0 * product(dq, q_c);
    return -(g * g * g3 - 3.0 * g * g1 * g2 + 3.0 * g1 * g1 * g1);
}

#if FEATURE_TUBE_NEWTON
// The same, and Newton's step of the function that is meant; 0/0 is NaN, which no bracket holds.
float u_with_step(int order, float t, out float step) {
    vec3 q = q_a + t * (q_b + t * q_c), dq = q_b + 2.0 * t * q_c;
    float g = product(q, q), g1 = product(q, dq);
    if (order == 0) {
        step = 0.5 * g / g1;
        return g;
    }
    float g2 = product(dq, dq) + 2.0 * product(q, q_c);
    if (order == 1) {
        step = g1 / g2;
        return g1;
    }
    if (g <= 0.0 && order == 2) {
        step = g1 / g2;
        return -g1;
    }
    g = max(g, 0.0);
    float s = sqrt(g), dh = h_b + 2.0 * t * h_c, f2 = 2.0 * g * s * h_c + g1 * g1 - g * g2;
    if (order == 2) {
        float f1 = s * dh - g1;
        step = f1 * g / f2;
        return f1;
    }
    float g3 = 6.0 * product(dq, q_c), f3 = -(g * g * g3 - 3.0 * g * g1 * g2 + 3.0 * g1 * g1 * g1);
    if (order == 3) {
        step = f2 * g / f3;
        return f2;
    }
    step = 3e38;                             // the fourth derivative is not worth it: bisection
    return f3;
}
#endif
