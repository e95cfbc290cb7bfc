"""The stages of the pipelines that OpenGL's rasteriser draws for: they link, and keep to OpenGL's promises."""

import re
from types import SimpleNamespace

import pytest

from pvfiblets.engine.fiblets import pipelines
from pvfiblets.engine.gl.shaders import Programs, read_shader

from .shader_programs import preprocessed

STAGES = {
    "geometry": (
        "fiblets/hardware_raster/survivors.vert", None, None, "fiblets/geometry/lines.geom",
        "fiblets/hardware_raster/line.frag",
    ),
    "geometry, wide": (
        "fiblets/hardware_raster/survivors.vert", None, None, "fiblets/geometry/capsules.geom",
        "fiblets/hardware_raster/capsule.frag",
    ),
    "tessellation": (
        "fiblets/hardware_raster/survivors.vert", "fiblets/tessellation/decode.tesc",
        "fiblets/tessellation/lines.tese", None, "fiblets/hardware_raster/line.frag",
    ),
    "tessellation, wide": (
        "fiblets/hardware_raster/survivors.vert", "fiblets/tessellation/decode.tesc",
        "fiblets/tessellation/capsules.tese", "fiblets/tessellation/capsules.geom",
        "fiblets/hardware_raster/capsule.frag",
    ),
    "visibility_bits": (
        "fiblets/hardware_raster/visible.vert", None, None, None, "fiblets/hardware_raster/visible.frag",
    ),
    "resolve": (
        "fiblets/hardware_raster/resolve.vert", None, None, None, "fiblets/hardware_raster/resolve.frag",
    ),
    "resolve, wide": (
        "fiblets/hardware_raster/resolve.vert", None, None, None, "fiblets/hardware_raster/resolve.frag",
    ),
    "between": ("screen/triangle.vert", None, None, None, "fiblets/hardware_raster/between.frag"),
}  # fmt: skip


@pytest.mark.few(6)
@pytest.mark.every("pair")
@pytest.mark.parametrize("name", STAGES)
@pytest.mark.parametrize("clipping", [(), ("CLIPPING", "CLIPPING_DEPTH", "CLIP_PLANES")])
@pytest.mark.parametrize("culling", [("CULL_PYRAMID", "SECOND_ROUND"), ("CULL_COVERAGE",)])
@pytest.mark.parametrize("values", ["STORED", "ARC_LENGTH"])
def test_stages_link_in_the_oldest_glsl(gl, name, values, culling, clipping):
    """With every kind of record, in the version of GLSL that the pipeline's OpenGL has."""
    version = 410 if "tessellation" in name else 330
    older = SimpleNamespace(version_code=version, program=gl.program, info=gl.info)
    every = ["ANCHORS_LOW", "DIRECTION", "LATTICE", "WIDE_LATTICE", "SPLINE", "RANK_TO_ID", "LEVEL_OF_DETAIL"]
    every.append("TEXTURE_DATA")
    wide = ["WIDE_LINES"] if "wide" in name else []
    stages = ("vertex", "tess_control", "tess_evaluation", "geometry", "fragment")
    chosen = {stage: file for stage, file in zip(stages, STAGES[name], strict=True) if file}
    programs = Programs(older, pipelines.CONSTANTS)
    assert programs.render(chosen, [*every, *wide, *culling, *clipping, f"VALUES_{values}"]).glo
    programs.release()


@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("clipping", [(), ("CLIPPING",), ("CLIPPING", "CLIP_PLANES")])
@pytest.mark.parametrize("values", [(), ("VALUES_STORED",), ("VALUES_ARC_LENGTH",), ("VALUES_VOLUME",)])
@pytest.mark.parametrize("summed", [(), ("PEEL",), ("GATHER", "GATHER_SLICES"), ("GATHER", "GATHER_SLICES", "PAINTED")])
@pytest.mark.parametrize("tubes", [(), ("TUBES",), ("TUBES", "CLIP_REGION")])
def test_a_geometry_stage_emits_no_more_than_opengl_promises(tubes, summed, values, clipping, wide):
    features = {*summed, *values, *clipping, *(("WIDE_LINES", *tubes) if wide else ())}
    sizes = {"float": 1, "uint": 1, "vec2": 2, "uvec2": 2, "vec3": 3, "vec4": 4, "uvec4": 4}
    declared = [
        re.match(r"VARYING (\w+) varying", line)
        for line in preprocessed(read_shader("fiblets/hardware_raster/varyings.glsl"), features)
    ]
    components = 4 + sum(sizes[match[1]] for match in declared if match)
    geometry = "\n".join(
        preprocessed(read_shader(f"fiblets/geometry/{'capsules' if wide else 'lines'}.geom"), features)
    )
    vertices = pipelines.CONSTANTS[re.search(r"max_vertices = \{\{ (\w+) \}\}", geometry)[1]]
    share = pipelines.CONSTANTS[re.search(r"SHARE = \{\{ (\w+) \}\}", geometry)[1]]
    assert components >= 8
    if not summed and not wide:
        assert components == 10, "a visibility buffer: fiblet and segment, and where the line runs"
    assert vertices <= 256
    assert vertices * components <= 1024
    assert vertices >= (4 * share if wide else 2 * share if clipping else share + 1)
