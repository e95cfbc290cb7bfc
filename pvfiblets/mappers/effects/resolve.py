"""The resolve: GLSL pieces that make VTK's polydata shader draw a G-buffer.

The pieces live in ``shaders/resolve``, one file per feature. A file is prose followed by sections

    //@ stage where TAG

with ``stage`` ``vertex`` or ``fragment``, ``where`` ``before``, ``after`` or ``instead`` and ``TAG`` one
of VTK's own tags (``//VTK::Color::Impl``) or a tag of another piece (``//pvfiblets::Value::Impl``). With
``replace`` for ``where``, the rest of the line is GLSL that VTK itself has written for its tags, and the
section takes its place wherever it stands. All ``colour_MODE`` are ``colour.glsl`` with that mode's file of
``shaders/colour``; includes are pasted, and what ``table_logarithm`` switches is decided.
`assemble` turns a set of features into replacements for a ``vtkShaderProperty``; a feature that is not
asked for leaves no text behind.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from vtkmodules.vtkCommonCore import reference

from pvfiblets.colour_modes import SHADERS
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.gl.shaders import preprocess, read_shader

FEATURES = (
    "gbuffer",
    "sums",
    "layers_geometry",
    "layers",
    "slices",
    "normal",
    "tube_shading",
    "tube_normal",
    "layers_across",
    "layers_normal",
    *(f"colour_{shader}" for shader in SHADERS),
    "table_logarithm",
    "point_value",
    "layers_value",
    "density_value",
    "opacity_streamline",
    "opacity_value",
    "density",
    "slices_colour",
    "highlight",
    "illuminated",
    "line_light",
    "legend_colours",
    "own_light",
    "ambient_occlusion",
    "ray_occlusion",
    "ink",
    "depth_cue",
    "halo",
    "strip",
    "silhouette",
    "layers_covered",
)
"""Every feature, in the order in which pieces for the same tag follow each other."""

_OWN_TAG = "//pvfiblets::"
_SECTION = re.compile(r"//@ (?P<stage>\w+) (?P<where>\w+) (?P<tag>//\S+|(?<= replace )\S.*)$")
_UNUSED_TAG = re.compile(r"^//pvfiblets::\S+\n?", re.MULTILINE)
_STAGES = ("vertex", "fragment")
_PLACES = ("before", "instead", "after")
_REPLACE = "replace"

# VTK writes gl_FragCoord.z where it wants a fragment's depth (coincident topology, peeling); the
# covering triangle's depth is not the fiblet's.
_DEPTH_OF_TRIANGLE = "gl_FragCoord.z"
_DEPTH_OF_FIBLET = "fibletDepth"

# And this where its shadow maps want the distance from a lamp.
_DISTANCE_OF_TRIANGLE = "1.0/gl_FragCoord.w"
_DISTANCE_OF_FIBLET = "-vertexVC.z"


@dataclass(frozen=True)
class Replacement:
    """One replacement for a ``vtkShaderProperty``."""

    stage: str  # `'vertex'` or `'fragment'`
    original: str  # text to be replaced
    first: bool  # before VTK makes its own replacements, or after
    text: str  # what takes its place


# VTK computes the highlight of every light, a power each, also where specular is 0.
NO_HIGHLIGHTS = (Replacement("fragment", "sf = sign(df)*pow(", False, "sf = 0.0*pow("),)


@dataclass
class _Edits:
    """Changes by pieces at one tag of one stage."""

    parts: dict[str, list[str]] = field(default_factory=lambda: {place: [] for place in _PLACES})
    replaced: bool = False

    def text(self, tag: str) -> str:
        """Return the composed text, VTK's tag included unless a piece takes its place."""
        middle = self.parts["instead"] if self.replaced else [tag]
        lines = [*self.parts["before"], *middle, *self.parts["after"]]
        return "\n".join(line for line in lines if line)


@cache
def _sections(feature: str, logarithm: bool = False) -> tuple[tuple[str, str, str, str], ...]:
    """Return (stage, where, tag, text) of every section of a feature's file."""
    if feature == "table_logarithm":
        return ()
    mode = feature.removeprefix("colour_")
    path = f"resolve/{'colour' if mode in SHADERS else feature}.glsl"
    switches = ("TABLE_LOGARITHM",) if logarithm else ()
    sections: list[tuple[str, str, str, list[str]]] = []
    for number, line in enumerate(read_shader(path).replace("MODE", mode).splitlines(), start=1):
        if line.startswith("//@"):
            match = _SECTION.match(line.rstrip())
            if not match or match["stage"] not in _STAGES or match["where"] not in (*_PLACES, _REPLACE):
                raise ValueError(
                    f"{path}:{number}: found {line!r}, expected '//@ stage where //TAG' with stage "
                    f"one of {_STAGES} and where one of {_PLACES}, or '//@ stage {_REPLACE} GLSL'"
                )
            sections.append((match["stage"], match["where"], match["tag"], []))
        elif sections:
            sections[-1][3].append(line)
    return tuple(
        (stage, where, tag, preprocess("\n".join(lines), switches).strip("\n")) for stage, where, tag, lines in sections
    )


def _has_piece(feature: str) -> bool:
    try:
        return bool(read_shader(f"resolve/{feature}.glsl"))
    except EngineError:
        return False


@cache
def assemble(features: frozenset[str]) -> tuple[Replacement, ...]:
    """Return the shader replacements of a set of features."""
    more = sorted(features - set(FEATURES))
    unknown = [feature for feature in more if not _has_piece(feature)]
    if unknown:
        raise ValueError(f"unknown resolve features {unknown}; known are {FEATURES}")
    edits: dict[tuple[str, str], _Edits] = {}
    result = []
    for feature in (*FEATURES, *more):
        if feature not in features:
            continue
        for stage, where, tag, text in _sections(feature, "table_logarithm" in features):
            if where == _REPLACE:
                result.append(Replacement(stage, tag, False, text))
                continue
            edit = edits.setdefault((stage, tag), _Edits())
            edit.parts[where].append(text)
            edit.replaced = edit.replaced or where == "instead"
    own = {key: edit for key, edit in edits.items() if key[1].startswith(_OWN_TAG)}
    for (stage, tag), edit in edits.items():
        if (stage, tag) in own:
            continue
        text = edit.text(tag)
        for (own_stage, own_tag), own_edit in own.items():
            if own_stage == stage:
                text = text.replace(own_tag, own_edit.text(""))
        result.append(Replacement(stage, tag, True, _UNUSED_TAG.sub("", text)))
    joined = "\n".join(replacement.text for replacement in result)
    for (_, own_tag), own_edit in own.items():
        if own_edit.text("") not in joined:
            raise ValueError(f"{own_tag} is in no piece of {sorted(features)}")
    result.append(Replacement("fragment", _DEPTH_OF_TRIANGLE, False, _DEPTH_OF_FIBLET))
    result.append(Replacement("fragment", _DISTANCE_OF_TRIANGLE, False, _DISTANCE_OF_FIBLET))
    return tuple(result)


def install(shader_property: Any, replacements: tuple[Replacement, ...]) -> None:
    """Add replacements to an actor's ``vtkShaderProperty``."""
    for edit in replacements:
        if edit.stage == "vertex":
            shader_property.AddVertexShaderReplacement(edit.original, edit.first, edit.text, True)
        else:
            shader_property.AddFragmentShaderReplacement(edit.original, edit.first, edit.text, True)


def vertex_replacements(shader_property: Any) -> Iterator[tuple[str, bool, str]]:
    """Yield tag, whether it comes first, and text of each replacement of a ``vtkShaderProperty``."""
    for index in range(shader_property.GetNumberOfShaderReplacements()):
        name, first, text, every = reference(""), reference(False), reference(""), reference(False)
        shader_property.GetNthShaderReplacement(index, name, first, text, every)
        if shader_property.GetNthShaderReplacementTypeAsString(index) == "Vertex":
            yield str(name), bool(first), str(text)


def uninstall(shader_property: Any, replacements: tuple[Replacement, ...]) -> None:
    """Remove these replacements; others stay."""
    for edit in replacements:
        if edit.stage == "vertex":
            shader_property.ClearVertexShaderReplacement(edit.original, edit.first)
        else:
            shader_property.ClearFragmentShaderReplacement(edit.original, edit.first)
