"""Uniform blocks: the driver's own offsets, what GLSL reads of what Python packs, and errors of declarations."""

import ctypes
import re
from pathlib import Path

import moderngl
import numpy as np
import pytest

from pvfiblets.engine import EngineError
from pvfiblets.engine.gl.bindings import BLOCKS
from pvfiblets.engine.gl.gl_loader import loader
from pvfiblets.engine.gl.shaders import assemble, read_shader
from pvfiblets.engine.gl.uniform_struct import MODULES, Field, UniformStruct, UniformStructError, find_struct

ROOT = Path(__file__).resolve().parents[2]
ASKED = {"type": 0x8A37, "size": 0x8A38, "block": 0x8A3A, "offset": 0x8A3B, "array": 0x8A3C, "matrix": 0x8A3D}
TYPES = {
    0x1406: "float", 0x8B50: "vec2", 0x8B51: "vec3", 0x8B52: "vec4", 0x8B5B: "mat3", 0x8B5C: "mat4",
    0x1404: "int", 0x8B53: "ivec2", 0x8B54: "ivec3", 0x8B55: "ivec4",
    0x1405: "uint", 0x8DC6: "uvec2", 0x8DC7: "uvec3", 0x8DC8: "uvec4",
}  # fmt: skip
EVERY = UniformStruct(
    "Frame",
    Field("a_float", "float", "4 bytes"),
    Field("a_vec3", "vec3", "from 16 on"),
    Field("a_uint", "uint", "in the vec3's last word"),
    Field("a_vec2", "vec2", "on 8 bytes"),
    Field("a_mat3", "mat3", "three columns of 16 bytes"),
    Field("an_int", "int", "after the last column's empty word"),
    Field("a_mat4", "mat4", "four columns"),
    Field("floats", "float[3]", "16 bytes each"),
    Field("an_ivec2", "ivec2", "after the last element's empty words"),
    Field("pairs", "vec2[2]", "16 bytes each"),
    Field("triples", "ivec3[2]", "16 bytes each"),
    Field("matrices", "mat3[2]", "48 bytes each"),
    Field("a_uvec4", "uvec4", "16 bytes"),
    Field("the_end", "uint", "of the last 16 bytes, the first four"),
)
VALUES = {
    "a_float": 1.5,
    "a_vec3": (2.5, 3.5, 4.5),
    "a_uint": 4_000_000_000,
    "a_vec2": (5.5, 6.5),
    "a_mat3": np.arange(9).reshape(3, 3) + 0.25,
    "an_int": -7,
    "a_mat4": np.arange(16).reshape(4, 4) - 0.25,
    "floats": (8.5, 9.5),
    "an_ivec2": (-10, 11),
    "pairs": [(12.5, 13.5), (14.5, 15.5)],
    "triples": [(-16, 17, -18), (19, -20, 21)],
    "matrices": np.arange(18).reshape(2, 3, 3) + 0.125,
    "a_uvec4": (22, 23, 24, 25),
    "the_end": 26,
}


@pytest.fixture
def program_of(gl):
    """Return a maker of programs of a block: it reads one field, and names all others."""
    made = []

    def make(struct):
        field = next(iter(struct.fields.values()))
        number = field.name + "[0]" * field.type.count("[")
        if field.type.startswith("mat"):
            number += "[0][0]"
        elif "vec" in field.type:
            number += ".x"
        text = f"#version 430\n{struct.glsl}out vec4 found;\nvoid main() {{ found = vec4(float({number})); }}\n"
        stage = "#version 430\nvoid main() { gl_Position = vec4(0.0); }\n"
        made.append(gl.program(vertex_shader=stage, fragment_shader=text))
        return made[-1]

    yield make
    for program in made:
        program.release()


def driver_says(program, struct):
    """Type, count, offset and strides of each field, by what the driver answers; -1 for a field that it has not."""
    look_up = loader()
    indices_of = ctypes.CFUNCTYPE(
        None, ctypes.c_uint, ctypes.c_int, ctypes.POINTER(ctypes.c_char_p), ctypes.POINTER(ctypes.c_uint)
    )(look_up("glGetUniformIndices"))
    answers_of = ctypes.CFUNCTYPE(
        None, ctypes.c_uint, ctypes.c_int, ctypes.POINTER(ctypes.c_uint), ctypes.c_uint, ctypes.POINTER(ctypes.c_int)
    )(look_up("glGetActiveUniformsiv"))
    count = len(struct.fields)
    names = [f"{field.name}[0]" if "[" in field.type else field.name for field in struct.fields.values()]
    indices = (ctypes.c_uint * count)()
    indices_of(program.glo, count, (ctypes.c_char_p * count)(*(name.encode() for name in names)), indices)
    assert 0xFFFFFFFF not in indices, f"the driver does not know {names[list(indices).index(0xFFFFFFFF)]}"
    found = {}
    for what, code in ASKED.items():
        answers = (ctypes.c_int * count)()
        answers_of(program.glo, count, indices, code, answers)
        found[what] = dict(zip(struct.fields, answers, strict=True))
    return found


def compare(program, struct):
    """Assert that Python and the driver lay a block out alike."""
    says = driver_says(program, struct)
    for name, field in struct.fields.items():
        base, _, count = field.type.rstrip("]").partition("[")
        assert says["block"][name] >= 0
        assert TYPES[says["type"][name]] == base
        assert says["size"][name] == int(count or 1)
        assert says["offset"][name] == struct.offset(name) == struct.dtype.fields[name][1]
        inside = struct.dtype[name]
        if count:
            assert says["array"][name] == inside.itemsize // int(count)
        if base.startswith("mat"):
            assert says["matrix"][name] == inside.base.itemsize * inside.shape[-1]
    block = program[struct.name]
    assert block.size == struct.nbytes
    assert block.binding == BLOCKS[struct.name]


@pytest.mark.parametrize("name", MODULES)
def test_the_driver_lays_a_block_out_as_numpy_has_it_and_shaders_read_it(program_of, name):
    struct = find_struct(name)
    compare(program_of(struct), struct)
    # What none reads would only be packed.
    text = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "shaders").rglob("*.*"))
    unread = [field for field in find_struct(name).fields if not re.search(rf"\b{field}\b", text)]
    assert not unread


def test_all_kinds_of_fields_lie_where_the_driver_has_them(program_of):
    compare(program_of(EVERY), EVERY)


def test_all_blocks_with_a_binding_point_are_declared_and_none_by_hand():
    assert set(MODULES) == set(BLOCKS)
    by_hand = [path for path in (ROOT / "shaders").rglob("*.*") if "std140" in path.read_text(encoding="utf-8")]
    assert not by_hand


def test_shaders_read_what_python_packs(gl):
    """Every number of every kind of field, as the shader has it."""
    reads = {
        "a_float": "a_float", "a_vec3": "a_vec3[{0}]", "a_uint": "a_uint / 2u", "a_vec2": "a_vec2[{0}]",
        "a_mat3": "a_mat3[{1}][{0}]", "an_int": "an_int", "a_mat4": "a_mat4[{1}][{0}]", "floats": "floats[{0}]",
        "an_ivec2": "an_ivec2[{0}]", "pairs": "pairs[{0}][{1}]", "triples": "triples[{0}][{1}]",
        "matrices": "matrices[{0}][{2}][{1}]", "a_uvec4": "a_uvec4[{0}]", "the_end": "the_end",
    }  # fmt: skip
    values = {name: np.array(value, np.float64) for name, value in VALUES.items()}
    values["a_uint"] = values["a_uint"] / 2
    values["floats"] = np.append(values["floats"], 0.0)  # what is not given is zero
    asked = [
        (reads[name].format(*place), value[place])
        for name, value in values.items()
        for place in np.ndindex(value.shape)
    ]
    body = "".join(f"found[{k}] = float({read});\n" for k, (read, _) in enumerate(asked))
    source = f"#version 430\nlayout(local_size_x = 1) in;\n{EVERY.glsl}"
    program = gl.compute_shader(
        source + f"layout(std430, binding = 0) buffer Found {{ float found[]; }};\nvoid main() {{\n{body}}}\n"
    )
    block, out = gl.buffer(EVERY.pack(**VALUES)), gl.buffer(reserve=4 * len(asked))
    block.bind_to_uniform_block(BLOCKS["Frame"])
    out.bind_to_storage_buffer(0)
    program.run()
    gl.memory_barrier(moderngl.ALL_BARRIER_BITS)
    found = np.frombuffer(out.read(), "<f4")
    for thing in (program, block, out):
        thing.release()
    assert found.tolist() == [np.float32(value) for _, value in asked]


def test_some_fields_are_written_the_others_stay_and_none_is_forgotten(gl):
    buffer = gl.buffer(EVERY.pack(**VALUES))
    EVERY.write(buffer, the_end=31, a_vec3=(32.0, 33.0, 34.0), floats=[35.0])
    expected = EVERY.pack(**{**VALUES, "the_end": 31, "a_vec3": (32.0, 33.0, 34.0), "floats": [35.0]})
    assert buffer.read() == expected
    buffer.release()
    with pytest.raises(UniformStructError, match=r"Frame: no value for a_mat4, the_end$"):
        EVERY.pack(**{name: value for name, value in VALUES.items() if name not in ("a_mat4", "the_end")})


def test_the_text_has_each_field_with_its_type_and_what_it_is():
    lamp = UniformStruct("Halos", Field("lamp_place", "vec3", "mm"), Field("powers", "float[2]", "W, of both"))
    assert lamp.glsl == (
        "layout(std140, binding = 9) uniform Halos {\n"
        "    vec3 lamp_place;  // mm\n"
        "    float powers[2];  // W, of both\n"
        "};\n"
    )


def test_a_source_has_a_block_by_its_name_once_and_only_if_it_is_looked_at():
    source = '#version 430\n#include "uniforms/Raycast.glsl"\n#include "uniforms/Raycast.glsl"\n'
    made = assemble("test", source=source)
    assert made.count(find_struct("Raycast").glsl) == made.count("Raycast") == 1
    assert "binding" not in assemble("test", source=source, version=330)
    with pytest.raises(EngineError, match=r"no uniform block 'Raycasts' is known; MODULES .* has \['Chunk"):
        read_shader("uniforms/Raycasts.glsl")
    # Nor is any other file: who packs the block is not imported.
    source = """#version 430
#if FEATURE_TUBES
#include "uniforms/Nowhere.glsl"
#else
#include "uniforms/Raycast.glsl"
#endif
#if FEATURE_CLIPPING || FEATURE_TUBES
#include "uniforms/Raycast.glsl"
#endif
"""
    assert assemble("test", ["CLIPPING"], source=source).count("uniform Raycast") == 1
    with pytest.raises(EngineError, match="no uniform block 'Nowhere'"):
        assemble("test", ["TUBES"], source=source)


@pytest.mark.parametrize(
    ("field", "message"),
    [
        (("place", "vec5", "mm"), r"place: 'vec5' is no type of a field; give float, int, uint, vec2 to vec4"),
        (("place", "mat2", "mm"), r"place: 'mat2' is no type"),
        (("place", "ufloat", "mm"), r"place: 'ufloat' is no type"),
        (("place", "vec3[0]", "mm"), r"place: 'vec3\[0\]' is no type"),
        (("place", "vec3[n]", "mm"), r"place: 'vec3\[n\]' is no type"),
        (("the place", "vec3", "mm"), r"'the place' is no name of a field; give letters, digits and underscores"),
        (("place", "vec3", ""), r"place: describe it in one line; its doc is ''"),
        (("place", "vec3", "mm\nor so"), r"place: describe it in one line"),
    ],
)
def test_a_bad_field_is_one_clear_error(field, message):
    with pytest.raises(UniformStructError, match=message):
        Field(*field)


def test_a_bad_block_is_one_clear_error():
    place = Field("place", "vec3", "mm")
    with pytest.raises(UniformStructError, match=r"'Lamp' has no binding point; give it a number in BLOCKS .*'Chunk'"):
        UniformStruct("Lamp", place)
    with pytest.raises(UniformStructError, match=r"Frame: give fields of different names, not \['place', 'place'\]"):
        UniformStruct("Frame", place, place)
    with pytest.raises(UniformStructError, match=r"Frame: give fields"):
        UniformStruct("Frame")
    with pytest.raises(UniformStructError, match=r"Frame: 16400 bytes; OpenGL promises 16384 to a uniform block"):
        UniformStruct("Frame", Field("places", "vec4[1025]", "mm"))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"a_vec4": (1, 2, 3, 4)}, r"Frame has no field 'a_vec4'; it has a_float, a_vec3"),
        ({"a_vec3": (1, 2)}, r"Frame: a_vec3 is of type vec3; it cannot hold an array of shape \(2,\)"),
        ({"a_float": (1, 2)}, r"a_float is of type float; it cannot hold an array of shape \(2,\)"),
        ({"a_mat3": np.eye(4)}, r"a_mat3 is of type mat3; it cannot hold an array of shape \(4, 4\)"),
        ({"floats": np.zeros(4)}, r"floats is of type float\[3\]; it cannot hold an array of shape \(4,\)"),
        ({"pairs": np.zeros((2, 3))}, r"pairs is of type vec2\[2\]; it cannot hold an array of shape \(2, 3\)"),
        ({"pairs": 1.0}, r"pairs is of type vec2\[2\]; it cannot hold an array of shape \(\)"),
        ({"an_int": 1.5}, r"an_int is of type int; it cannot hold numbers of type float64"),
        ({"a_uint": -1}, r"a_uint is of type uint; it cannot hold -1"),
        ({"an_ivec2": (1, 2**31)}, r"an_ivec2 is of type ivec2; it cannot hold \[1, 2147483648\]"),
        ({"a_float": "1"}, r"a_float is of type float; it cannot hold numbers of type <U1"),
    ],
)
def test_a_value_that_does_not_fit_is_one_clear_error(gl, changed, message):
    with pytest.raises(UniformStructError, match=message):
        EVERY.pack(**{**VALUES, **changed})
    buffer = gl.buffer(EVERY.pack(**VALUES))
    with pytest.raises(UniformStructError, match=message):
        EVERY.write(buffer, **changed)
    buffer.release()
