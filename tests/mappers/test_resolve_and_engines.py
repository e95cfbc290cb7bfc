"""The resolve's shader pieces, the polydata that VTK believes it draws, and when the engine is asked anew."""

from __future__ import annotations

import numpy as np
import pytest
from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.colour_modes import SHADERS
from pvfiblets.mappers import EngineOptions, FibletMapper
from pvfiblets.mappers.effects import resolve
from pvfiblets.mappers.vtk_pipeline.proxy import proxy_polydata


def text(*features):
    return "\n".join(edit.text for edit in resolve.assemble(frozenset(features)))


def test_a_feature_that_is_not_asked_for_leaves_nothing():
    plain = text("gbuffer", "normal", "colour_orientation")
    for word in ("colour_table", "colour_list", "PositionMap", "log(", "pvfiblets::", "FEATURE", "#include"):
        assert word not in plain
    assert "log(" in text("gbuffer", "normal", "colour_point_scalar", "table_logarithm")
    assert "log(" not in text("gbuffer", "normal", "colour_point_scalar")


@pytest.mark.parametrize("mode", SHADERS)
def test_only_one_colour_is_assembled(mode):
    composed = text("gbuffer", "normal", f"colour_{mode}")
    assert composed.count("diffuseColor = diffuseIntensity") == composed.count("vec4 line_colour(") == 1


def test_vtks_tags_stay_where_pieces_only_add():
    edits = {edit.original: edit.text for edit in resolve.assemble(frozenset(["gbuffer", "normal"]))}
    assert "//VTK::Depth::Impl" in edits["//VTK::Depth::Impl"]
    assert "//VTK::Normal::Impl" not in edits["//VTK::Normal::Impl"]


def test_a_piece_without_its_place_is_refused():
    with pytest.raises(ValueError, match="Number::Impl"):
        resolve.assemble(frozenset(["gbuffer", "density_value"]))


def test_a_bad_section_names_file_and_line(monkeypatch):
    monkeypatch.setattr(resolve, "read_shader", lambda name: "prose\n//@ pixel after //VTK::X\n")
    resolve._sections.cache_clear()
    try:
        with pytest.raises(ValueError, match=r"resolve/normal.glsl:2: found '//@ pixel"):
            resolve._sections("normal")
    finally:
        resolve._sections.cache_clear()


def test_uninstalling_leaves_the_replacements_of_others():
    from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLActor

    shaders = vtkOpenGLActor().GetShaderProperty()
    shaders.AddFragmentShaderReplacement("//VTK::TCoord::Impl", True, "// mine", True)
    edits = resolve.assemble(frozenset(["gbuffer", "normal", "colour_solid"]))
    resolve.install(shaders, edits)
    assert shaders.GetNumberOfShaderReplacements() == len(edits) + 1
    resolve.uninstall(shaders, edits)
    assert shaders.GetNumberOfShaderReplacements() == 1


BOUNDS = {
    "plain": (-1, 2, -3, 4, -5, 6),
    "far away": (1e6, 1e6 + 10, 1e6, 1e6 + 20, -1e6, -1e6 + 5),
    "tiny": (0, 1e-6, 0, 2e-6, 0, 3e-6),
    "flat": (0, 10, 0, 10, 3, 3),
    "one point": (7, 7, 8, 8, 9, 9),
    "at the origin": (0, 0, 0, 0, 0, 0),
}


@pytest.mark.parametrize("name", BOUNDS)
def test_vertices_differ_and_keep_the_bounds(name: str) -> None:
    """VTK before 9.7 drops triangles of coinciding vertices, and with them the whole picture."""
    bounds = np.array(BOUNDS[name], dtype=float)
    proxy = proxy_polydata(bounds)
    points = np.array([proxy.GetPoint(i) for i in range(6)])
    for triangle in (points[:3], points[3:]):
        assert len(np.unique(triangle, axis=0)) == 3
    size = max(np.ptp(bounds.reshape(3, 2), axis=1).max(), 1e-9 * np.abs(bounds).max())
    np.testing.assert_allclose(proxy.GetBounds(), bounds, rtol=0, atol=1e-5 * size + 1e-11)
    assert proxy.GetNumberOfCells() == 2


def test_layers_repeat_its_triangles_and_nothing_to_draw_is_empty() -> None:
    assert proxy_polydata(None).GetNumberOfCells() == 0
    one, many = proxy_polydata(BOUNDS["plain"]), proxy_polydata(BOUNDS["plain"], 5)
    np.testing.assert_allclose(many.GetBounds(), one.GetBounds())
    assert many.GetNumberOfCells() == 10
    assert [many.GetPoint(i) for i in range(30)] == [one.GetPoint(i % 6) for i in range(30)]


def recording(lines):
    """Return a mapper on GL lines, its actor, and the list of keywords that its renderers were made with."""
    asked = []
    factory = lines.mapper()._factory

    def make(ctx, fiblets, **options):
        asked.append(options)
        return factory(ctx, fiblets)

    def build(**arguments):
        mapper, actor = FibletMapper(lines.fiblets, renderer_factory=make, **arguments), vtkActor()
        mapper.attach(actor)
        return mapper, actor

    return build, asked


def test_other_options_make_another_renderer_at_the_next_frame(make_plotter, lines, renderers, tools):
    assert EngineOptions().changed() == {}
    assert EngineOptions(culling="none") == EngineOptions(culling=None)
    build, asked = recording(lines)
    mapper, actor = build(options=EngineOptions(pipeline="geometry"))
    plotter = make_plotter()
    plotter.add_actor(actor)
    first = tools.picture(plotter, mapper)
    assert asked == [{"pipeline": "geometry"}]
    mapper.options = EngineOptions(pipeline="geometry")
    tools.picture(plotter, mapper)
    assert len(asked) == 1
    before = actor.GetMTime()
    mapper.options = EngineOptions(culling=None)
    assert actor.GetMTime() > before, "who renders on demand must see the change"
    assert len(asked) == 1, "nothing is made outside a frame"
    assert (tools.picture(plotter, mapper) == first).all()
    assert asked == [{"pipeline": "geometry"}, {"culling": None}]
    assert [renderer.released for renderer in renderers] == [True, False]


def test_the_pipeline_in_use_is_known_after_the_first_frame(make_plotter, lines, renderers, tools):
    build, _ = recording(lines)
    mapper, actor = build()
    assert mapper.pipeline_in_use is None
    plotter = make_plotter()
    plotter.add_actor(actor)
    tools.picture(plotter, mapper)
    assert mapper.pipeline_in_use == renderers[0].pipeline
    assert mapper.pipeline_in_use is not None
    mapper.release()
    assert mapper.pipeline_in_use is None
