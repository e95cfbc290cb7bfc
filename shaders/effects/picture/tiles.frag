// Summary of every square of TILE x TILE pixels: the widest disc in front of the plane in focus, and the light if all
// pixels have the same, as a background's, -1 if not.

#version 430

uniform sampler2D colours;
uniform sampler2D blurs;
layout(location = 0) out float radius;
layout(location = 1) out vec4 light;

const int TILE = {{ tile }};

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE, end = min(corner + TILE, textureSize(blurs, 0));
    vec4 least = vec4(3.0e38), most = vec4(-3.0e38);
    radius = 0.0;
    for (int y = corner.y; y < end.y; ++y)
    {
        for (int x = corner.x; x < end.x; ++x)
        {
            vec4 blur = texelFetch(blurs, ivec2(x, y), 0), found = texelFetch(colours, ivec2(x, y), 0);
            found.rgb *= blur.a;
            radius = max(radius, -blur.g);
            least = min(least, found);
            most = max(most, found);
        }
    }
    light = least == most ? least : vec4(-1.0);
}
