// The depth as the keys of the G-buffer (pvfiblets/engine/gbuffer.py), of which pyramids are made too; all ones where nothing is.

#version 430

uniform sampler2D depths;

out uint key;

void main() {
    float z = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).x;
    key = z >= 1.0 ? 0xFFFFFFFFu : uint(int(clamp(z, 0.0, 0.99999988) * 2147483648.0)) << 1u;
}
