"""What OpenGL itself draws of polylines, with or without clip distances."""

import moderngl
import numpy as np

GL_CLIP_DISTANCE0 = 0x3000


def pairs(lines):
    """Vertices of GL_LINES for polylines."""
    return np.concatenate([np.repeat(line, 2, axis=0)[1:-1] for line in lines])


def gl_lines(gl, lines, matrix, size, planes=()):
    """Mask and depth (h, w) of GL_LINES, row 0 at the bottom; vertices reach OpenGL relative to their middle."""
    vertices = pairs(lines)
    centre = vertices.mean(0)
    to_data = np.eye(4)
    to_data[:3, 3] = centre
    planes = np.asarray(planes, float).reshape(-1, 4) @ to_data
    clipping = "".join(f"gl_ClipDistance[{i}] = dot(planes[{i}], vec4(p, 1.0));" for i in range(len(planes)))
    count = max(len(planes), 1)
    program = gl.program(
        f"#version 430\nuniform mat4 m; uniform vec4 planes[{count}]; in vec3 p;"
        f"out gl_PerVertex {{ vec4 gl_Position; float gl_ClipDistance[{count}]; }};"
        f"void main() {{ gl_Position = m * vec4(p, 1.0); {clipping} }}",
        "#version 430\nout vec4 c; void main() { c = vec4(1.0); }",
    )
    program["m"].write((matrix @ to_data).T.astype("<f4").tobytes())
    if len(planes):
        program["planes"].write(planes.astype("<f4").tobytes())
    buffer = gl.buffer((vertices - centre).astype("<f4").tobytes())
    array = gl.vertex_array(program, [(buffer, "3f", "p")])
    colour, depth = gl.renderbuffer(size), gl.depth_texture(size)
    target = gl.framebuffer([colour], depth)
    before = gl.detect_framebuffer()
    target.use()
    gl.enable_only(moderngl.DEPTH_TEST)
    target.clear(depth=1.0)
    for i in range(len(planes)):
        gl.enable_direct(GL_CLIP_DISTANCE0 + i)
    array.render(moderngl.LINES)
    for i in range(len(planes)):
        gl.disable_direct(GL_CLIP_DISTANCE0 + i)
    mask = np.frombuffer(target.read(components=1), np.uint8).reshape(size[1], size[0]) > 0
    z = np.frombuffer(depth.read(), "<f4").reshape(size[1], size[0])
    before.use()  # a released framebuffer must not stay bound
    for thing in (array, buffer, program, target, colour, depth):
        thing.release()
    return mask, z
