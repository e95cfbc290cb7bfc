"""Shader assembly is strict, and every source says what it is."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from pvfiblets.engine import EngineError
from pvfiblets.engine.fiblets.pipelines import CONSTANTS as OF_PIPELINES
from pvfiblets.engine.gl.shaders import FEATURES, Programs, assemble, tell_of_compiling
from pvfiblets.engine.halos.uniform_blocks import CONSTANTS as OF_HALOS
from tests.engine.shader_programs import COLOURS

ROOT = Path(__file__).resolve().parents[2]
SOURCES = sorted(p for p in (ROOT / "shaders").rglob("*") if p.is_file() and "resolve" not in p.parts)


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: p.name)
def test_every_source_starts_with_a_header(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("// ")
    assert len(lines[0]) > 20


INT64 = "INT64_ATOMICS"  # compiled by test_int64_atomics.py: Mesa's software OpenGL has none
EVERYTHING = set(FEATURES) - {INT64} - set(COLOURS) | {"COLOUR_POINT_SCALAR"}  # a program has one mode of colours


COMPUTE = [p for p in SOURCES if p.suffix == ".comp" and p.stem != "split"]


NAMES = [p.relative_to(ROOT / "shaders").as_posix() for p in COMPUTE]
CONSTANTS = {**OF_HALOS, **OF_PIPELINES}
ALWAYS = {"tubes/cull.comp": ("TUBES",)}  # rays are what it is about


@pytest.mark.few(14)
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("features", [(), tuple(EVERYTHING)], ids=["plain", "all"])
def test_every_program_compiles(gl, name, features):
    programs = Programs(gl, CONSTANTS)
    features = tuple(dict.fromkeys([*features, *ALWAYS.get(name, ())]))
    assert programs.compute(name, features) is programs.compute(name, list(reversed(features)))
    programs.release()
    programs.release()


def test_unused_features_leave_no_code_and_a_file_is_pasted_once():
    source = assemble("fiblets/compute/cull.comp", (), CONSTANTS)
    assert "WIDE_LINES" not in source
    assert "#define FEATURE_ANCHORS_LOW 0" in source
    source = assemble("fiblets/compute/resolve_owner.comp", (), CONSTANTS)
    assert source.count("buffer Anchors {") == 1
    assert source.startswith("#version 430\n")


@pytest.mark.parametrize(
    ("source", "features", "message"),
    [
        ('#version 430\n#include "decode/nowhere.glsl"\n', (), "no shader 'decode/nowhere.glsl'"),
        ("#version 430\nlayout(local_size_x = {{ group_siz }}) in;\n", (), "group_siz"),
        ("#version 430\n#if FEATURE_WIDE_LINE\n#endif\n", (), "WIDE_LINE"),
        ("#version 430\n", ("COLOUR",), "COLOUR"),
        ("void main() {}\n", (), "#version 430"),
    ],
)
def test_unknown_names_are_errors(source, features, message):
    with pytest.raises(EngineError, match=message):
        assemble("test", features, CONSTANTS, source=source)


def test_a_compiler_error_shows_the_composed_source(gl, monkeypatch):
    wrong = "#version 430\nvoid main() { wrong(); }\n"
    monkeypatch.setattr("pvfiblets.engine.gl.shaders.read_shader", lambda name: wrong)
    with pytest.raises(EngineError, match=r"(?s)wrong.*   3 void main\(\) \{ wrong\(\); \}"):
        Programs(gl, CONSTANTS).compute("compute/broken.comp")


def test_a_pipeline_that_opengl_is_too_old_for_is_refused_plainly():
    code = (
        "import moderngl\n"
        "from types import SimpleNamespace\n"
        "from pvfiblets.engine import FibletRenderer, EngineError\n"
        "ctx = moderngl.create_context(standalone=True, backend='egl')\n"
        "try: FibletRenderer(ctx, SimpleNamespace(), pipeline='compute')\n"
        "except EngineError as error: print(error)\n"
    )
    path = os.pathsep.join([str(ROOT), *sys.path])
    environment = {**os.environ, "MESA_GL_VERSION_OVERRIDE": "4.1", "PYTHONPATH": path}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    if "4.1" not in done.stdout and not done.stdout:
        pytest.skip("this OpenGL is not Mesa: its version cannot be lowered")
    assert done.stdout.startswith("pipeline 'compute' cannot draw on OpenGL 4.1")


@pytest.mark.every("value")
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("value", ["VALUES_STORED", "VALUES_ARC_LENGTH", "VALUES_VOLUME"])
def test_storage_buffers_are_no_more_than_opengl_promises(gl, name, value):
    """Eight bindings, 0 to 7: asked of the driver for a program with everything on."""
    more = {8: "INT64_ATOMICS", 9: "STORED_ROTATIONS"}  # used where drivers have them
    features = (EVERYTHING - {f for f in FEATURES if f.startswith("VALUES_")} - set(more.values())) | {value}
    source = assemble(name, features, CONSTANTS)
    bindings = [int(n) for n in re.findall(r"std430, binding = (\d+)", source)]
    assert all(n < 8 or f"#if FEATURE_{more[n]}" in source for n in bindings)
    program = gl.compute_shader(source)
    blocks = [m for m in (program[name] for name in program) if type(m).__name__ == "StorageBlock"]
    program.release()
    assert len(blocks) <= 8


def test_the_first_shaders_of_a_machine_are_told_of_once(tmp_path, monkeypatch, caplog):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    for _ in range(2):
        tell_of_compiling.cache_clear()  # as a new process
        tell_of_compiling("llvmpipe", "4.5")
    assert [record.message for record in caplog.records] == [
        "compiling shaders for llvmpipe: once per machine, some seconds"
    ]
