"""Which pipelines a context can draw with: made-up drivers, this machine's, and this machine's made to look older."""

import json
import subprocess
import sys

import pytest

from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.gl.capabilities import Capabilities, PipelineInfo, atomics64, check_choices, choose, pipelines

MESH = "GL_NV_mesh_shader"


class Driver:
    """The three things that are asked of a context."""

    def __init__(self, version_code, *extensions, renderer="A card"):
        self.version_code = version_code
        self.extensions = set(extensions)
        self.info = {"GL_RENDERER": renderer, "GL_VENDOR": "V", "GL_VERSION": "D"}


def by_name(ctx):
    return {info.name: info for info in pipelines(ctx)}


@pytest.mark.parametrize(
    ("driver", "available"),
    [
        (Driver(460, MESH), ["compute", "mesh", "tessellation", "geometry", "mesh-serial"]),
        (Driver(460, "GL_EXT_mesh_shader"), ["compute", "mesh", "tessellation", "geometry", "mesh-serial"]),
        (Driver(460), ["compute", "tessellation", "geometry"]),
        (Driver(440, MESH), ["compute", "tessellation", "geometry"]),
        (Driver(430), ["compute", "tessellation", "geometry"]),
        (Driver(420), ["tessellation", "geometry"]),
        (Driver(410, "GL_ARB_compute_shader"), ["tessellation", "geometry"]),
        (Driver(400), ["geometry"]),
        (Driver(330), ["geometry"]),
        (Driver(320), []),
        (Driver(460, MESH, renderer="llvmpipe (LLVM 19)"),
         ["compute", "geometry", "tessellation", "mesh", "mesh-serial"]),
        (Driver(410, renderer="llvmpipe (LLVM 19)"), ["geometry", "tessellation"]),
    ],
)  # fmt: skip
def test_a_driver_has_what_its_version_and_extensions_give_in_order_of_speed(driver, available):
    table = pipelines(driver)
    assert [info.name for info in table if info.available] == available
    assert len(table) == 5
    assert all(info.available == (info.why_not is None) for info in table)
    assert table.auto == (available[0] if available else None)
    if available:
        assert choose(driver, "auto") == available[0]
        assert [choose(driver, name) for name in available] == available


EITHER = "GL_NV_mesh_shader or GL_EXT_mesh_shader"


def test_what_is_missing_is_said():
    assert by_name(Driver(460))["mesh"] == PipelineInfo(
        "mesh", False, f"{EITHER} is missing", f"OpenGL 4.5 and {EITHER}"
    )
    assert by_name(Driver(410))["compute"].why_not == "OpenGL is 4.1, needed is 4.3"
    assert by_name(Driver(430))["mesh-serial"].why_not == f"OpenGL is 4.3, needed is 4.5; {EITHER} is missing"
    lines = repr(pipelines(Driver(410))).splitlines()
    assert lines[0].split() == ["pipeline", "needs"]
    assert [line.split()[0] for line in lines[1:]] == ["compute", "mesh", "tessellation", "geometry", "mesh-serial"]
    assert [line.split()[0] for line in lines if "(auto)" in line] == ["tessellation"]
    assert "no: OpenGL is 4.1, needed is 4.3" in lines[1]


def test_what_cannot_draw_is_an_error_that_says_what_there_is():
    with pytest.raises(EngineError) as caught:
        choose(Driver(430), "mesh")
    assert str(caught.value) == (
        f"pipeline 'mesh' cannot draw on OpenGL 4.3 (A card): OpenGL is 4.3, needed is 4.5; {EITHER} is "
        "missing. Available are 'compute', 'tessellation', 'geometry'; pipeline='auto' takes 'compute'"
    )
    with pytest.raises(ValueError, match="pipeline is 'vulkan'; expected one of 'auto', 'mesh', 'mesh-serial', 'comp"):
        choose(Driver(460), "vulkan")


@pytest.mark.parametrize("name", ["auto", "geometry"])
def test_where_there_is_none_the_least_version_is_named(name):
    with pytest.raises(EngineError, match=r"no pipeline can draw .* OpenGL 3\.2 \(A card\): the least is OpenGL 3\.3"):
        choose(Driver(320), name)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"pipeline": None}, "pipeline is None; expected one of 'auto', 'mesh'"),
        ({"culling": "occlusion"}, "culling is 'occlusion'; expected one of None, 'auto', 'none', 'coverage', 'two-"),
        ({"culling": True}, "culling is True"),
        ({"fit": "half"}, "fit is 'half'; expected one of None, 'sample'"),
        ({"fit": ["sample"]}, "fit is "),
    ],
)
def test_bad_choices_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        check_choices(**given)


def test_good_choices_pass():
    for culling in (None, "none", "coverage", "two-phase"):
        check_choices(pipeline="geometry", culling=culling, fit="sample")


@pytest.mark.parametrize(
    ("extensions", "found"),
    [
        ((), None),
        (("GL_NV_shader_atomic_int64",), None),
        (("GL_ARB_gpu_shader_int64",), None),
        (("GL_NV_shader_atomic_int64", "GL_ARB_gpu_shader_int64"), "GL_NV_shader_atomic_int64"),
        (("GL_EXT_shader_image_int64", "GL_ARB_gpu_shader_int64"), "GL_EXT_shader_image_int64"),
    ],
)
def test_atomics_of_64_bits_need_the_integers_too(extensions, found):
    assert atomics64(extensions) == found


def test_this_context_is_described_and_can_compute(gl):
    found = Capabilities.from_context(gl)
    assert int(found.version.replace(".", "")) * 10 == gl.version_code
    assert (found.vendor, found.renderer, found.driver) == tuple(
        gl.info[f"GL_{name}"] for name in ("VENDOR", "RENDERER", "VERSION")
    )
    assert set(found.extensions) == set(gl.extensions)
    assert {name: found.limits[name] for name in gl.info if name in found.limits} == {
        name: gl.info[name] for name in gl.info if name in found.limits
    }
    assert found.limits["GL_MAX_TESS_GEN_LEVEL"] >= 64  # what OpenGL 4.0 promises
    assert found.limits["GL_MAX_GEOMETRY_TOTAL_OUTPUT_COMPONENTS"] >= 1024
    assert json.loads(json.dumps(found.as_dict()))["limits"] == found.limits
    # The fixture asks for OpenGL 4.3.
    assert {"compute", "tessellation", "geometry"} <= {info.name for info in pipelines(gl) if info.available}


@pytest.mark.parametrize(
    ("version", "auto"),
    [("4.1", "geometry"), ("4.0", "geometry"), ("3.3", "geometry"), ("3.2", None)],
)
def test_an_older_opengl_is_seen_for_what_it_is(older_opengl, version, auto):
    command = [sys.executable, "-m", "pvfiblets", "gl", "--json"]
    result = subprocess.run(command, capture_output=True, text=True, check=False, env=older_opengl(version))
    assert result.returncode == 0, result.stderr
    report = json.loads(result.stdout)
    assert (report["version"], report["auto"]) == (version, auto)
    assert not any(name.startswith("GL_MAX_COMPUTE") for name in report["limits"])
    assert {entry["name"]: entry["available"] for entry in report["pipelines"]}["compute"] is False
