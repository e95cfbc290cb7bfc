"""Assembly of the resolve's shader pieces."""

from __future__ import annotations

import pytest

from pvfiblets.mappers import resolve

COLOURS = ("colour_orientation", "colour_solid", "colour_streamline", "colour_point_rgba", "colour_point_scalar")


def text(*features):
    return "\n".join(edit.text for edit in resolve.assemble(frozenset(features)))


def test_a_feature_that_is_not_asked_for_leaves_nothing():
    plain = text("gbuffer", "normal", "colour_orientation")
    for word in ("Table", "StreamlineColours", "PositionMap", "log(", "pvfiblets::"):
        assert word not in plain
    assert "log(" in text("gbuffer", "normal", "colour_point_scalar", "scale_logarithm")


@pytest.mark.parametrize("colour", COLOURS)
def test_only_one_colour_is_assembled(colour):
    composed = text("gbuffer", "normal", colour)
    assert composed.count("diffuseColor = diffuseIntensity") == 1


def test_vtks_tags_stay_where_pieces_only_add():
    edits = {edit.original: edit.text for edit in resolve.assemble(frozenset(["gbuffer", "normal"]))}
    assert "//VTK::Depth::Impl" in edits["//VTK::Depth::Impl"]
    assert "//VTK::Normal::Impl" not in edits["//VTK::Normal::Impl"]


def test_a_piece_without_its_place_is_refused():
    with pytest.raises(ValueError, match="Scale::Impl"):
        resolve.assemble(frozenset(["gbuffer", "scale_logarithm"]))


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
