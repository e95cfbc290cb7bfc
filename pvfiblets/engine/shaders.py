"""GLSL assembly: includes, feature switches and constants, strictly, and programs cached by what they are made of.

Sources live in the repository's ``shaders`` folder, which the wheel carries as ``pvfiblets/shaders``. In them:

``#include "decode/record.glsl"``
    Pastes that file, once per program; :func:`pvfiblets.codec.layout.glsl_source` writes ``"codec/layout.glsl"``.
``FEATURE_NAME``
    1 or 0, for every name in :data:`FEATURES`; ``#if FEATURE_NAME`` keeps unused code out of the program.
``{{ name }}``
    A constant given by the caller.

A name that is not known is an error, as is a file that is not there, and an error of the GLSL compiler shows the
composed source with its line numbers.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import resources
from pathlib import Path

import moderngl

from ..codec import layout
from .errors import EngineError

__all__ = ["FEATURES", "Programs", "assemble", "read_shader"]

FEATURES: dict[str, str] = {
    "ANCHORS_LOW": "anchors of 32 bits per axis",
    "DIRECTION": "fiblets of direction codes",
    "LATTICE": "fiblets of lattice codes",
    "WIDE_LATTICE": "lattice fiblets with their box in the code stream",
    "RANK_TO_ID": "streamlines without points among the others",
    "WIDE_LINES": "lines wider than one pixel",
    "CLIPPING": "fiblets that cross the edges of the picture",
    "CLIPPING_DEPTH": "fiblets that cross the near or the far plane",
    "CLIP_PLANES": "fiblets that cross planes of the caller's",
    "VALUES_STORED": "a stored per-point array",
    "VALUES_ARC_LENGTH": "arc length along the streamline",
    "VALUES_CURVATURE": "curvature of the streamline",
}
"""What a program can be made to do, by the name of its switch."""

_INCLUDE = re.compile(r'^[ \t]*#include[ \t]+"([^"]+)"[ \t]*$', re.MULTILINE)
_CONSTANT = re.compile(r"\{\{\s*(\w*)\s*\}\}")
_FEATURE = re.compile(r"\bFEATURE_(\w+)")


@cache
def read_shader(name: str) -> str:
    """Read one source file.

    Parameters
    ----------
    name : str
        Path below the shader folder, with forward slashes.

    Raises
    ------
    EngineError
        If there is no such file.
    """
    if name == "codec/layout.glsl":
        return layout.glsl_source()
    packaged = resources.files("pvfiblets") / "shaders"
    folder = packaged if packaged.is_dir() else Path(__file__).resolve().parents[2] / "shaders"
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
) -> str:
    """Compose a program's source.

    Parameters
    ----------
    name : str
        The stage's file, see :func:`read_shader`.
    features : iterable of str
        Keys of :data:`FEATURES` that are on.
    constants : mapping, optional
        Values of ``{{ name }}``.
    source : str, optional
        The stage's text, instead of a file; ``name`` then only serves messages.

    Returns
    -------
    str
        GLSL that starts with ``#version``.

    Raises
    ------
    EngineError
        If a file, a feature or a constant is not known.
    """
    active, constants = set(features), constants or {}
    if unknown := active - set(FEATURES):
        raise EngineError(f"unknown features {sorted(unknown)}; there are {sorted(FEATURES)}")
    included: set[str] = {name}

    def include(match: re.Match[str]) -> str:
        if match[1] in included:
            return ""
        included.add(match[1])
        return _INCLUDE.sub(include, read_shader(match[1]))

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
    head, version, body = text.partition("#version 430")
    if not version:
        raise EngineError(f"{name} has no line '#version 430'\n{_numbered(text)}")
    switches = "".join(f"#define FEATURE_{feature} {int(feature in active)}\n" for feature in sorted(used))
    return f"{version}\n{switches}{head}{body}"


class Programs:
    """Compute programs of one context, built when first asked for and kept.

    Parameters
    ----------
    ctx : moderngl.Context
    constants : mapping
        Values of ``{{ name }}`` in every source.
    """

    def __init__(self, ctx: moderngl.Context, constants: Mapping[str, object]) -> None:
        self._ctx = ctx
        self._constants = dict(constants)
        self._programs: dict[str, moderngl.ComputeShader] = {}
        self._requests: dict[tuple[str, frozenset[str]], moderngl.ComputeShader] = {}

    def compute(self, name: str, features: Iterable[str] = ()) -> moderngl.ComputeShader:
        """Return the program of a stage with some features on.

        Programs are kept by composed source: a feature that a stage does not look at makes no second program.

        Raises
        ------
        EngineError
            If the source does not compile; the message holds all of it.
        """
        request = name, frozenset(features)
        if request in self._requests:
            return self._requests[request]
        source = assemble(name, request[1], self._constants)
        if source not in self._programs:
            try:
                self._programs[source] = self._ctx.compute_shader(source)
            except moderngl.Error as error:
                raise EngineError(f"{name} does not compile: {error}\n{_numbered(source)}") from error
        self._requests[request] = self._programs[source]
        return self._programs[source]

    def release(self) -> None:
        """Give all programs back; twice is harmless."""
        for program in self._programs.values():
            program.release()
        self._programs.clear()
        self._requests.clear()


def _numbered(source: str) -> str:
    return "\n".join(f"{i:4d} {line}" for i, line in enumerate(source.splitlines(), 1))
