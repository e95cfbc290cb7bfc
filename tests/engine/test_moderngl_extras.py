"""The functions that moderngl lacks, each seen by a shader or by moderngl itself."""

import subprocess
import sys

import moderngl
import numpy as np
import pytest

from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.gl import moderngl_extras
from pvfiblets.engine.gl.moderngl_extras import INTEGERS, TEXEL_FORMATS, GLExtras

DTYPES = {"ui": {"8": "u1", "16": "u2", "32": "u4"}, "f": {"32": "f4"}}
CHANNELS = {"r": 1, "rg": 2, "rgba": 4}


def described(internal_format):
    """Return the NumPy type and number of channels that a format's name promises."""
    channels, rest = internal_format.rstrip("uif0123456789"), internal_format.lstrip("rgba")
    return DTYPES[rest.lstrip("0123456789")][rest.rstrip("uif")], CHANNELS[channels]


@pytest.fixture
def gl(gl):
    """Bind a framebuffer: a headless context has none, and without one not even transform feedback runs."""
    with gl.scope(gl.simple_framebuffer((4, 4))):
        yield gl


def read_back(gl, texture, internal_format, count):
    """Read texels by a vertex shader and transform feedback: OpenGL 3.3 and nothing newer."""
    kind = "" if internal_format.endswith("f") else "u"
    program = gl.program(
        vertex_shader=f"""#version 330
            uniform {kind}samplerBuffer data;
            out {kind}vec4 texel;
            void main() {{ texel = texelFetch(data, gl_VertexID); }}""",
        varyings=["texel"],
    )
    array, out = gl.vertex_array(program, []), gl.buffer(reserve=count * 16)
    try:
        texture.bind(5)
        GLExtras(gl).set_sampler(program, "data", 5)
        GLExtras(gl).set_sampler(program, "nothing of that name", 5)
        array.transform(out, moderngl.POINTS, count)
        return np.frombuffer(out.read(), "f4" if not kind else "u4").reshape(count, 4)
    finally:
        for thing in (array, out, program):
            thing.release()


@pytest.mark.parametrize("internal_format", TEXEL_FORMATS)
def test_a_shader_reads_a_buffer_through_a_texture(gl, internal_format):
    dtype, channels = described(internal_format)
    rng = np.random.default_rng(1)
    values = rng.integers(0, 200, (37, channels)).astype(dtype)
    buffer = gl.buffer(values.tobytes())
    texture = GLExtras(gl).texture_buffer(buffer, internal_format)
    try:
        assert (texture.texels, texture.nbytes) == (37, values.nbytes)
        np.testing.assert_array_equal(read_back(gl, texture, internal_format, 37)[:, :channels], values)
        buffer.write(values[::-1].tobytes())
        np.testing.assert_array_equal(read_back(gl, texture, internal_format, 37)[:, :channels], values[::-1])
    finally:
        texture.release()
        texture.release()
        buffer.release()
    assert texture.glo == 0
    with pytest.raises(EngineError, match="has been released"):
        texture.bind(0)


def test_bad_buffer_textures_are_refused_and_parts_of_a_texel_left_out(gl, monkeypatch):
    buffer = gl.buffer(bytes(23))
    texture = GLExtras(gl).texture_buffer(buffer, "rg32ui")
    assert (texture.texels, texture.nbytes) == (2, 16)
    texture.release()
    buffer.release()
    functions = GLExtras(gl)
    buffer = gl.buffer(bytes(64))
    with pytest.raises(EngineError, match=r"'rgb8' is no format of .* \['r8ui'"):
        functions.texture_buffer(buffer, "rgb8")
    monkeypatch.setattr(functions, "get_integer", lambda name: 15)
    with pytest.raises(EngineError, match=r"64 bytes holds 16 texels of r32ui; this OpenGL reads 1 to 15"):
        functions.texture_buffer(buffer, "r32ui")
    functions.texture_buffer(buffer, "rgba32ui").release()
    buffer.release()


def test_moderngl_draws_right_after_a_buffer_texture_was_bound(gl):
    """Textures that moderngl binds to the same unit are those that it samples."""
    buffer, picture = gl.buffer(bytes(4)), gl.texture((1, 1), 1, np.uint32(77).tobytes(), dtype="u4")
    codes = GLExtras(gl).texture_buffer(buffer, "r32ui")
    program = gl.program(
        vertex_shader="""#version 330
            uniform usampler2D data; out uint texel;
            void main() { texel = texelFetch(data, ivec2(0), 0).x; }""",
        varyings=["texel"],
    )
    array, out = gl.vertex_array(program, []), gl.buffer(reserve=4)
    picture.filter = moderngl.NEAREST, moderngl.NEAREST
    picture.use(3)
    codes.bind(3)
    program["data"].value = 3
    array.transform(out, moderngl.POINTS, 1)
    assert np.frombuffer(out.read(), "u4")[0] == 77
    codes.release()
    for thing in (array, out, program, picture, buffer):
        thing.release()


@pytest.mark.parametrize(("dtype", "components"), [("u4", 1), ("u4", 2), ("f4", 1)])
def test_every_level_of_a_texture_can_be_drawn_and_read(gl, dtype, components):
    """A chain of levels: each is drawn from the one before; a fragment adds one to its texel."""
    functions, size, levels = GLExtras(gl), (13, 6), 4
    texture = gl.texture(size, components, bytes(size[0] * size[1] * 4 * components), dtype=dtype, alignment=1)
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    functions.add_levels(texture, levels)
    kind, vector = ("u", "uvec4") if dtype == "u4" else ("", "vec4")
    program = gl.program(
        vertex_shader="""#version 330
            void main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }""",
        fragment_shader=f"""#version 330
            uniform {kind}sampler2D before; out {vector} texel;
            void main() {{ texel = texelFetch(before, ivec2(gl_FragCoord.xy) * 2, 0) + {vector}(1); }}""",
    )
    array = gl.vertex_array(program, [])
    framebuffers = [gl.framebuffer([texture]) for _ in range(levels)]
    other = gl.simple_framebuffer((4, 4))
    other.use()
    for level, framebuffer in enumerate(framebuffers):
        functions.attach_level(framebuffer, texture, level)
        assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == other.glo
        assert framebuffer.viewport == (0, 0, max(1, size[0] >> level), max(1, size[1] >> level))
    for level in range(1, levels):
        functions.limit_levels(texture, level - 1, level - 1)
        framebuffers[level].use()
        texture.use(0)
        program["before"].value = 0
        array.render(moderngl.TRIANGLES, 3)
    functions.limit_levels(texture, 0, levels - 1)
    for level, framebuffer in enumerate(framebuffers):
        region = framebuffer.viewport
        data = framebuffer.read(viewport=region, components=components, dtype=dtype, alignment=1)
        assert np.frombuffer(data, dtype).tolist() == [level] * (region[2] * region[3] * components)
    for thing in (*framebuffers, other, array, program, texture):
        thing.release()


def test_an_integer_attachment_is_cleared_and_no_other(gl):
    textures = [gl.texture((3, 2), 2, dtype="u4") for _ in range(2)]
    framebuffer, other = gl.framebuffer(textures), gl.simple_framebuffer((2, 2))
    other.use()
    functions = GLExtras(gl)
    functions.clear_integers(framebuffer, (7, 0xFFFFFFFF))
    functions.clear_integers(framebuffer, (5,), attachment=1)
    assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == other.glo
    assert np.frombuffer(textures[0].read(alignment=1), "u4").reshape(-1, 2).tolist() == [[7, 0xFFFFFFFF]] * 6
    assert np.frombuffer(textures[1].read(alignment=1), "u4").reshape(-1, 2).tolist() == [[5, 0]] * 6
    for thing in (framebuffer, other, *textures):
        thing.release()


def test_framebuffers_are_bound_again_and_moderngl_knows(gl):
    functions = GLExtras(gl)
    bound = functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING")
    mine = gl.simple_framebuffer((2, 2))
    with functions.framebuffers_kept():
        mine.use()
        assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == mine.glo
    assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == bound
    assert functions.get_integer("GL_READ_FRAMEBUFFER_BINDING") == bound
    mine.release()
    another = gl.simple_framebuffer((2, 2))  # binds what moderngl remembers: an error, were it the released one
    assert gl.error == "GL_NO_ERROR"
    assert functions.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") == bound
    another.release()


@pytest.mark.parametrize("name", INTEGERS)
def test_integers_are_those_of_moderngl_or_refused(gl, name):
    functions = GLExtras(gl)
    needs = INTEGERS[name][1]
    if isinstance(needs, str) and needs not in gl.extensions:
        with pytest.raises(EngineError, match=f"{name} needs {needs}, which this OpenGL .* lacks"):
            functions.get_integer(name)
        return
    value = functions.get_integer(name)
    assert value == gl.info.get(name, value)
    if name.startswith("GL_MAX"):
        assert value > 0


def test_what_this_opengl_lacks_is_named(gl, monkeypatch):
    with pytest.raises(EngineError, match="GL_NONSENSE is not a known integer of OpenGL; known are GL_"):
        GLExtras(gl).get_integer("GL_NONSENSE")

    class Old:
        version_code = 330
        extensions = frozenset()
        info = {"GL_RENDERER": "an old card", "GL_VENDOR": "somebody"}  # noqa: RUF012

    with pytest.raises(EngineError, match=r"GL_MAX_TESS_GEN_LEVEL needs OpenGL 4\.0, found 3\.3"):
        GLExtras(Old()).get_integer("GL_MAX_TESS_GEN_LEVEL")
    with pytest.raises(EngineError, match=r"glDrawMeshTasksEXT needs GL_EXT_mesh_shader, which .*an old card"):
        GLExtras(Old()).function("glDrawMeshTasksEXT")
    monkeypatch.setattr(moderngl_extras, "loader", lambda: lambda name: 0)
    with pytest.raises(EngineError, match=r"this OpenGL \(.+\) has no function glTexBuffer"):
        GLExtras(gl).function("glTexBuffer")
    texture = gl.texture((4, 4), 3)
    with pytest.raises(EngineError, match=r"\('f1', 3\)"):
        GLExtras(gl).add_levels(texture, 2)
    texture.release()


def test_without_a_context_nothing_is_looked_up():
    code = "from pvfiblets.engine.gl.gl_loader import loader; loader()"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert "EngineError: no OpenGL context is current; make it so" in result.stderr


def test_parts_of_buffers_are_cleared(gl):
    extras, buffer = GLExtras(gl), gl.buffer(np.arange(1, 9, dtype="<u4").tobytes())
    extras.clear_words(buffer, 8, 12)
    assert np.frombuffer(buffer.read(), "<u4").tolist() == [1, 2, 0, 0, 0, 6, 7, 8]
    extras.clear_words(buffer, 24)
    assert np.frombuffer(buffer.read(), "<u4").tolist() == [1, 2, 0, 0, 0, 6, 0, 0]
    extras.clear_words(buffer)
    assert not any(buffer.read())
    buffer.release()
