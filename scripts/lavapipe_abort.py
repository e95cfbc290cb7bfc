"""The smallest program found of which LLVM 22.1.8 dies in Mesa 26.2.6's lavapipe, where machine code is not optimised.

A geometry stage that reads a texture where some of the invocations of a vector do not. Each stage is tried in a process
of its own. ``docs/limits.md`` says whom it concerns::

    GALLIVM_PERF=nopt scripts/newer_mesa.sh --zink -- \
        env MESA_SHADER_CACHE_DISABLE=true python scripts/lavapipe_abort.py
"""

from __future__ import annotations

import subprocess
import sys

VERTEX = """
#version 330
uniform usamplerBuffer texels;
void main() {
    uint x = uint(gl_VertexID);
    VERTEX
    gl_Position = vec4(0.1 * float(x), 0.0, 0.0, 1.0);
}
"""
GEOMETRY = """
#version 330
layout(points) in;
layout(points, max_vertices = 1) out;
uniform usamplerBuffer texels;
void main() {
    uint x = uint(9.0 * gl_in[0].gl_Position.x);
    GEOMETRY
    gl_Position = vec4(float(x));
    EmitVertex();
}
"""
FRAGMENT = """
#version 330
uniform usamplerBuffer texels;
out vec4 colour;
void main() {
    uint x = uint(gl_FragCoord.x);
    FRAGMENT
    colour = vec4(float(x));
}
"""
READ = "x = texelFetch(texels, int(x)).x;"
CASES = {"always": READ, "where x > 1": f"if (x > 1u) {READ}"}


def draw(stage: str, case: str) -> None:
    """Draw four points by a program of which one stage reads."""
    import moderngl

    sources = [text.replace(stage, CASES[case]) for text in (VERTEX, GEOMETRY, FRAGMENT)]
    for name in ("VERTEX", "GEOMETRY", "FRAGMENT"):
        sources = [text.replace(name, "") for text in sources]
    ctx = moderngl.create_standalone_context(backend="egl")
    vertex, geometry, fragment = sources
    program = ctx.program(vertex_shader=vertex, geometry_shader=geometry, fragment_shader=fragment)
    ctx.framebuffer([ctx.texture((64, 64), 4)]).use()
    ctx.vertex_array(program, []).render(moderngl.POINTS, vertices=4)
    ctx.finish()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        draw(*sys.argv[1:])
        sys.exit()
    for stage in ("VERTEX", "GEOMETRY", "FRAGMENT"):
        for case in CASES:
            done = subprocess.run([sys.executable, __file__, stage, case], capture_output=True, text=True, check=False)
            said = next((line for line in done.stderr.splitlines() if "LLVM" in line), "")
            print(f"{stage.lower()} stage reads {case}: {said or done.returncode or 'drawn'}")
