"""GLSL assembly: includes, feature switches and constants, strictly, and programs cached by their parts.

Sources live in the repository's ``shaders`` folder, which the wheel carries as ``pvfiblets/shaders``. In them:

``#include "fiblets/decode/record.glsl"``
    Pastes that file, once per program. :func:`pvfiblets.codec.layout.glsl_source` writes ``"codec/layout.glsl"``,
    :func:`pvfiblets.colour_modes.glsl_source` ``"colour/line_colour.glsl"``, and
    :class:`.uniform_struct.UniformStruct` writes ``"uniforms/NAME.glsl"`` of the uniform block `NAME`. Below
    ``#if FEATURE_NAME`` a file is pasted only where that is on, so that no unused block is looked up.
``FEATURE_NAME``
    1 or 0, for every name in :data:`FEATURES`; ``#if FEATURE_NAME`` keeps unused code out of the program.
``{{ name }}``
    A constant given by the caller.

A name that is not known is an error, as is a file that is not there, and an error of the GLSL compiler shows the
composed source with its line numbers.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import moderngl

from ...codec import layout
from ...colour_modes import SHADERS, glsl_source
from ...support.cache_folder import is_first_time
from ...support.version import __version__
from ..errors import EngineError
from .bindings import BLOCKS, CONSTANTS
from .gl_version import version_of
from .uniform_struct import find_struct

logger = logging.getLogger("pvfiblets.engine")

FEATURES: dict[str, str] = {
    "ANCHORS_LOW": "anchors of 32 bits per axis",
    "DIRECTION": "fiblets of direction codes",
    "LATTICE": "fiblets of lattice codes",
    "WIDE_LATTICE": "lattice fiblets with their box in the code stream",
    "SPLINE": "fiblets of cubic splines",
    "RANK_TO_ID": "streamlines without points among the others",
    "TEXTURE_DATA": "data from buffer textures, where OpenGL has no storage buffers",
    "WIDE_LINES": "lines wider than one pixel",
    "LINE_ENDS": "discs at the ends of streamlines, not lines",
    "LEVEL_OF_DETAIL": "far fiblets as one segment, among others",
    "ONE_SEGMENT": "far fiblets as one segment, none but these",
    "ONE_CLASS": "few fiblets, all drawn by one program",
    "CLUSTERS": "fiblets found through clusters of neighbours",
    "OPEN_FIBLETS": "marks of the fiblets of clusters that may show",
    "CULL_PYRAMID": "fiblets hidden behind a depth pyramid",
    "CULL_COVERAGE": "fiblets hidden behind a coverage buffer",
    "INT64_ATOMICS": "depth and fiblet in one word of 64 bits",
    "PER_FIBLET": "fiblets tested by an invocation each, not 32 by one",
    "COVER_APART": "pixels of thin lines shared by the invocations of a work group",
    "STORED_ROTATIONS": "rotations of direction codes in a storage buffer, not in a uniform block",
    "SUBGROUPS": "counting across invocations by the driver's own operations",
    "PER_PRIMITIVE": "segments handed to the fragments by a mesh stage",
    "MESH_EXT": "mesh shaders of GL_EXT_mesh_shader, not of GL_NV_mesh_shader",
    "SCENE_DEPTH": "other things in the scene hide fiblets too",
    "SECOND_ROUND": "fiblets drawn over others that were drawn first, out of turn",
    "CLIPPING": "fiblets that cross the edges of the picture",
    "CLIPPING_DEPTH": "fiblets that cross the near or the far plane",
    "CLIP_PLANES": "fiblets that cross planes of the caller's",
    "CLIP_REGION": "fiblets cut at the edge of a region",
    "REGION_FIELDS": "closed surfaces and labels in that region, by their distance fields",
    "STREAMLINE_MASK": "some streamlines only",
    "POINT_MASK": "some points only",
    "PEEL": "surfaces behind an earlier layer",
    "TUBES": "lines of a width in millimetres, with a surface",
    "CROSS_LINE": "where across a wide line a pixel lies",
    "SUBSAMPLES": "sixteen samples of a pixel, side by side",
    "EDGES": "where the edges run of what a pixel shows",
    "GATHER": "all lines of a pixel, not the nearest",
    "GATHER_SLICES": "those behind the nearest, by how far behind it they are",
    "GATHER_OUTSIDE": "lines that nothing else in the scene occludes",
    "GATHER_WORDS": "sums in words, not in floats",
    "PAINTED": "their colours too",
    **{mode.feature: mode.doc for mode in SHADERS.values()},
    "TABLE_LOGARITHM": "a table spread over logarithms",
    "PAINT_VALUE": "per-point values that colours or opacities read",
    "PAINT_LIGHT": "the light on lines",
    "PAINT_ALPHA": "opacities of their own",
    "PAINT_OPACITIES": "an opacity per streamline",
    "PAINT_VALUE_OPACITY": "per-point values as opacities",
    "VALUES_STORED": "a stored per-point array",
    "VALUES_COLOUR": "which holds colours",
    "VALUES_ARC_LENGTH": "arc length along the streamline",
    "VALUES_VOLUME": "a volume sampled along the streamline",
    "TUBE_ILLINOIS": "roots by regula falsi with halved weights",
    "TUBE_ITP": "roots by interpolating, truncating and projecting",
    "TUBE_NEWTON": "roots by guarded Newton steps",
    "TUBE_CHAIN": "spline tubes by the chain of derivatives: the paper's way, and what cuts and insides need",
    "TUBE_HOLLOW": "spline tubes whose inside the eye may see",
    "TUBE_LISTED": "spline tubes that are not hidden",
    "TUBE_VALUES": "numbers along spline tubes",
    "TUBE_COLOURS": "colours along spline tubes",
    "HALO_POINTS": "points with halos, not lines",
    "HALO_LISTED": "halos that are not hidden",
    "HALO_TAPER": "lines with halos whose ends narrow",
    "HALO_CUE": "lines with halos that are narrower far away",
    "HALO_CUT": "lines with halos that planes or the edges of the picture cut",
    "HALO_BENT": "halos that do not fall back evenly",
    "HALO_SOME": "some of the points with halos only",
    "HALO_FILTER": "lines and points with halos whose numbers lie between thresholds",
    "HALO_VALUES": "numbers along lines with halos",
    "HALO_COLOURS": "colours along lines with halos",
    "VOLUME_SURFACE": "surfaces in a volume",
    "VOLUME_COMPOSITE": "light through a volume",
    "VOLUME_LOCAL": "the first peak in a volume, not the greatest",
    "VOLUME_MINIMUM": "the least value in a volume",
    "VOLUME_AVERAGE": "the mean value in a volume",
    "VOLUME_NEAREST": "the field of the nearest voxel",
    "VOLUME_TRICUBIC": "the field of cubics between voxels",
    "VOLUME_BRICKS": "a volume in bricks, larger than 3-D textures",
    "VOLUME_PAGES": "bricks in several textures",
    "VOLUME_FETCHED": "a volume whose voxels the hardware weighs too coarsely",
    "VOLUME_LAYERS": "translucent surfaces in a volume, one behind the other",
    "VOLUME_COLOURS": "light in the voxels' own colours",
    "VOLUME_CLOSED": "surfaces in a volume that end at its border, closed there",
    "VOLUME_CELLS": "surfaces by the cubics that cells hold along rays",
    "VOLUME_UNREFINED": "surfaces at the sample behind them",
    "VOLUME_NEWTON": "surfaces by Newton's steps",
    "VOLUME_PREINTEGRATED": "light of steps integrated beforehand",
    "VOLUME_RIEMANN": "light by Riemann's sum",
    "VOLUME_SIMPSON": "light by Simpson's rule",
    "VOLUME_ROMBERG": "light by Romberg's rule of three levels",
    "VOLUME_RK4": "light by Runge and Kutta's method of order four",
    "VOLUME_WHOLE": "rays that skip nothing",
    "VOLUME_FINER": "light of shorter steps where values bend",
    "VOLUME_EXACT": "light of stretches halved until they agree, where steps are not to be looked up",
    "VOLUME_SHADED": "light through a volume that lamps shine on",
    "VOLUME_HOMOGENEOUS": "light through nodes of hardly any change at once",
    "VOLUME_JITTER": "rays that start at places of their own",
    "SURFACE_NORMALS": "occlusion in screen space of surfaces, whose normals are known",
    "TUBE_DISCARD": "the silhouettes of spline tubes alone, for measuring them",
    "PICTURE_ALIKE": "a pixel's samples are all the same",
    "PICTURE_SHARES": "a picture that shows a part of each pixel",
    "PICTURE_SAMPLES": "a picture of several samples a pixel",
    "PICTURE_DEPTH": "the depths of a picture, beside its colours",
    "SEEN_LIGHT": "the depth of light through a volume, where it is more than faint",
    "SEEN_PEAK": "the depth of peaks in a volume, where their values show",
    "PICTURE_TONE": "other tones for a picture, beside depth of field",
    "TONE_REINHARD": "tones by Reinhard's operator",
    "TONE_EXPONENTIAL": "tones by the exponential function",
    "TONE_ACES": "tones by the ACES film curve",
    "TONE_HABLE": "tones by Hable's film curve",
}
"""Features of programs, by the names of their switches."""

NEWEST = 430  # GLSL that sources are written for, unless they say otherwise

EXTENDED = 450
"""GLSL that sources are raised to for an extension: mesh shaders, with all stages beside them, and 64-bit atomics."""

_VERSION = re.compile(r"^#version \d+$", re.MULTILINE)
_BINDING = re.compile(r",\s*binding\s*=\s*\d+")
_INCLUDE = re.compile(r'^[ \t]*#include[ \t]+"([^"]+)"[ \t]*$', re.MULTILINE)
_UNIFORMS = re.compile(r"uniforms/(\w+)\.glsl")
_CONDITION = re.compile(r"^[ \t]*#[ \t]*(if|ifdef|ifndef|elif|else|endif)\b[ \t]*(.*?)[ \t]*$", re.MULTILINE)
_CONSTANT = re.compile(r"\{\{\s*(\w*)\s*\}\}")
_FEATURE = re.compile(r"\bFEATURE_(\w+)")
_SWITCHED_ON = re.compile(r"^#define FEATURE_(\w+) 1$", re.MULTILINE)


@cache
def read_shader(name: str) -> str:
    """Read one source file."""
    if name == "codec/layout.glsl":
        return layout.glsl_source()
    if name == "colour/line_colour.glsl":
        return glsl_source()
    if block := _UNIFORMS.fullmatch(name):
        return find_struct(block[1]).glsl
    packaged = resources.files("pvfiblets") / "shaders"
    folder = packaged if packaged.is_dir() else Path(__file__).resolve().parents[3] / "shaders"
    source = folder.joinpath(*name.split("/"))
    if not source.is_file():
        raise EngineError(f"no shader {name!r} in {folder}; is the package installed whole?")
    return source.read_text(encoding="utf-8")


def assemble(
    name: str,
    features: Iterable[str] = (),
    constants: Mapping[str, object] | None = None,
    *,
    source: str | None = None,
    version: int = NEWEST,
    replaced: Mapping[str, str] | None = None,
) -> str:
    """Compose a program's source."""
    active, constants = set(features), {**CONSTANTS, **(constants or {})}
    if unknown := active - set(FEATURES):
        raise EngineError(f"unknown features {sorted(unknown)}; there are {sorted(FEATURES)}")
    included: set[str] = {name}

    def include(match: re.Match[str]) -> str:
        file = (replaced or {}).get(match[1], match[1])
        if file in included or _left_out(match.string, match.start(), active):
            return ""
        included.add(file)
        return _INCLUDE.sub(include, read_shader(file))

    text = _INCLUDE.sub(include, read_shader(name) if source is None else source)

    def constant(match: re.Match[str]) -> str:
        if match[1] not in constants:
            raise EngineError(
                f"{name} uses the constant {match[0]}, which is not given; given are {sorted(constants)}\n"
                + _numbered(text)
            )
        return str(constants[match[1]])

    text = _CONSTANT.sub(constant, text)
    used = set(_FEATURE.findall(text))
    if unknown := used - set(FEATURES):
        raise EngineError(
            f"{name} asks for features {sorted(unknown)}; there are {sorted(FEATURES)}\n{_numbered(text)}"
        )
    if not (line := _VERSION.search(text)):
        raise EngineError(f"{name} has no line '#version 430'\n{_numbered(text)}")
    head, body = text[: line.start()], text[line.end() :]
    switches = "".join(f"#define FEATURE_{feature} {int(feature in active)}\n" for feature in sorted(used))
    if version < NEWEST:
        if version < 420:
            body = _BINDING.sub("", body).replace("\\\n", " ")
        if version < 400:
            switches += read_shader("fiblets/data/glsl330.glsl")
        return f"#version {version}\n{switches}{head}{body}"
    return f"#version {max(version, int(line[0].split()[1]))}\n{switches}{head}{body}"


def preprocess(text: str, features: Iterable[str]) -> str:
    """Return GLSL with includes resolved and inactive features removed, for programs made elsewhere."""
    active, included = set(features), set[str]()

    def include(match: re.Match[str]) -> str:
        if match[1] in included or _left_out(match.string, match.start(), active):
            return ""
        included.add(match[1])
        return _INCLUDE.sub(include, read_shader(match[1]))

    text, lines, at = _INCLUDE.sub(include, text), [], 0
    for line in text.splitlines():
        if not _CONDITION.match(line) and not _left_out(text, at, active):
            lines.append(line)
        at += len(line) + 1
    return "\n".join(lines)


def _left_out(text: str, place: int, active: set[str]) -> bool:
    """Return whether a place in a file lies below ``#if FEATURE_NAME`` of a feature that is off."""
    off: list[bool] = []
    for condition in _CONDITION.finditer(text, 0, place):
        if condition[1] == "endif":
            off.pop()
        elif condition[1] in ("elif", "else"):
            off[-1] = False
        else:
            feature = _FEATURE.fullmatch(condition[2])
            off.append(condition[1] == "if" and feature is not None and feature[1] not in active)
    return any(off)


def switched_on(*sources: str) -> frozenset[str]:
    """Return the features that are on in what :func:`assemble` made."""
    return frozenset(feature for source in sources for feature in _SWITCHED_ON.findall(source))


@cache
def tell_of_compiling(renderer: str, version: str) -> None:
    """Report why a first frame takes some seconds: drivers cache compiled programs."""
    if is_first_time(f"shaders of {__version__} {renderer} {version}"):
        logger.warning("compiling shaders for %s: once per machine, some seconds", renderer)


class Programs:
    """Programs of one context, built when first asked for and kept.

    Whoever draws asks for a program each time it runs, so that :meth:`noting` knows what a picture was made of.
    """

    def __init__(self, ctx: moderngl.Context, constants: Mapping[str, object]) -> None:
        tell_of_compiling(ctx.info["GL_RENDERER"], ctx.info["GL_VERSION"])
        self._ctx = ctx
        self._constants = dict(constants)  # values of `{{ name }}` in every source
        self._programs: dict[str, moderngl.ComputeShader] = {}
        self._requests: dict[tuple[str, frozenset[str]], moderngl.ComputeShader] = {}
        self._linked: dict[tuple[tuple[tuple[str, str], ...], frozenset[str]], moderngl.Program] = {}
        self._screens: dict[tuple[str, frozenset[str]], tuple[moderngl.Program, moderngl.VertexArray]] = {}
        self._switches: dict[object, frozenset[str]] = {}
        self._noted: list[set[str]] = []

    @contextmanager
    def noting(self) -> Iterator[set[str]]:
        """Yield a set that collects the features of all programs requested meanwhile."""
        # They are read from the programs' text: what a caller switches on and no stage looks at is not among them.
        noted: set[str] = set()
        self._noted.append(noted)
        try:
            yield noted
        finally:
            self._noted.pop()

    def note(self, features: Iterable[str]) -> None:
        """Add features of a program that somebody else made and is about to run."""
        for noted in self._noted:
            noted.update(features)

    def compute(self, name: str, features: Iterable[str] = ()) -> moderngl.ComputeShader:
        """Return the program of a stage with some features on."""
        # Programs are kept by composed source: a feature that a stage does not look at makes no second program.
        request = name, frozenset(features)
        if request in self._requests:
            self.note(self._switches[request])
            return self._requests[request]
        version = EXTENDED if "INT64_ATOMICS" in request[1] else NEWEST
        source = assemble(name, request[1], self._constants, version=version)
        if source not in self._programs:
            try:
                self._programs[source] = self._ctx.compute_shader(source)
            except moderngl.Error as error:
                raise EngineError(f"{name} does not compile: {error}\n{_numbered(source)}") from error
        self._requests[request] = self._programs[source]
        self._switches[request] = switched_on(source)
        self.note(self._switches[request])
        return self._programs[source]

    def has_compute(self, name: str, features: Iterable[str] = ()) -> bool:
        """Return True if a stage with these features was requested before."""
        return (name, frozenset(features)) in self._requests

    def screen(self, name: str, features: Iterable[str] = ()) -> tuple[moderngl.Program, moderngl.VertexArray]:
        """Return the program of a fragment stage that runs on every pixel, and what to render three vertices of."""
        key = name, frozenset(features)
        program = self.render({"vertex": "screen/triangle.vert", "fragment": name}, key[1])
        if key not in self._screens:
            self._screens[key] = program, self._ctx.vertex_array(program, [])
        return self._screens[key]

    def render(
        self, stages: Mapping[str, str], features: Iterable[str] = (), varyings: Sequence[str] = ()
    ) -> moderngl.Program:
        """Return the program of several stages with some features on."""
        request = tuple(sorted(stages.items())), frozenset(features)
        if request not in self._linked:
            version = EXTENDED if "mesh" in stages else min(version_of(self._ctx), NEWEST)
            sources: dict[str, Any] = {
                f"{stage}_shader": assemble(name, request[1], self._constants, version=version)
                for stage, name in stages.items()
            }
            try:
                program: Any
                if "mesh" in stages:
                    from .mesh_program import MeshProgram

                    program = MeshProgram(self._ctx, sources, BLOCKS, nvidia="MESH_EXT" not in request[1])
                else:
                    program = self._ctx.program(**sources, varyings=tuple(varyings))
            except moderngl.Error as error:
                shown = "\n\n".join(f"{stage}:\n{_numbered(source)}" for stage, source in sources.items())
                raise EngineError(f"{', '.join(stages.values())} do not link: {error}\n{shown}") from error
            for block, binding in BLOCKS.items():
                if isinstance(member := program.get(block, None), moderngl.UniformBlock):
                    member.binding = binding
            self._linked[request] = program
            self._switches[request] = switched_on(*sources.values())
        self.note(self._switches[request])
        return self._linked[request]

    def release(self) -> None:
        """Give all programs back; twice is harmless."""
        for _, array in self._screens.values():
            array.release()
        self._screens.clear()
        for computing in self._programs.values():
            computing.release()
        for drawing in self._linked.values():
            drawing.release()
        self._programs.clear()
        self._requests.clear()
        self._linked.clear()
        self._switches.clear()


def _numbered(source: str) -> str:
    return "\n".join(f"{i:4d} {line}" for i, line in enumerate(source.splitlines(), 1))
