// The depth so far as the keys that the pyramid is made of (pvfiblets/engine/gbuffer.py); all ones where nothing is.

#version 430

uniform sampler2D depths;

out uint key;

void main() {
    float far = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).x;
    key = 0xFFFFFFFFu - (far > 0.0 ? uint(clamp(far * 4294967296.0, 1.0, 4294967040.0)) : 0u);
}
