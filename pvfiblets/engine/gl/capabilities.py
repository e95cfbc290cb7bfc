"""What an OpenGL context can do, and which pipelines can therefore draw on it.

>>> choose(ctx, "auto")                                           # doctest: +SKIP
'compute'

What counts is the version that a context can be used as (:mod:`.gl_version`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import moderngl

from ..errors import EngineError
from .gl_version import version_of
from .moderngl_extras import INTEGERS, GLExtras
from .passes import is_software

AUTO = "auto"

# Fastest first. On an NVIDIA H100 compute draws 60 million segments in 7 ms, tessellation in 640, the geometry stage in
# 2,900 (docs/benchmarks): rasterisers are not made for primitives of a pixel. Mesh stages have not been measured on a
# card. mesh-serial is there to be compared with.
ORDER = ("compute", "mesh", "tessellation", "geometry", "mesh-serial")
# On a CPU there is no rasteriser to feed: the pipeline that draws its own segments is the fastest. The geometry stage
# takes up to a third less time than tessellation (docs/benchmarks/pipelines-llvmpipe.md).
SOFTWARE_ORDER = ("compute", "geometry", "tessellation", "mesh", "mesh-serial")

MESH, MESH_EXT = "GL_NV_mesh_shader", "GL_EXT_mesh_shader"

_NEEDS: dict[str, tuple[int, str | None]] = {
    "mesh": (450, MESH),
    "mesh-serial": (450, MESH),
    "compute": (430, None),
    "tessellation": (410, None),
    "geometry": (330, None),
}

PIPELINES = (AUTO, *_NEEDS)  # values of `pipeline`
CULLINGS = ("auto", "none", "coverage", "two-phase")
"""Values of ``culling``; None means ``'none'``, and ``'auto'`` two-phase where that is measured to be faster."""
FITS = (None, "sample", "stream")  # values of `fit`

# Any of these sets lets a shader take the least of 64-bit words atomically.
_ATOMICS_64 = (
    ("GL_EXT_shader_image_int64", "GL_ARB_gpu_shader_int64"),
    ("GL_NV_shader_atomic_int64", "GL_ARB_gpu_shader_int64"),
)


@dataclass(frozen=True)
class PipelineInfo:
    """One pipeline on one context."""

    name: str  # for `pipeline=`
    available: bool
    why_not: str | None  # the missing requirements; None where it is available
    needs: str  # the OpenGL version and extension


class PipelineTable(list[PipelineInfo]):
    """All pipelines in the order in which ``'auto'`` tries them; printed as a table."""

    @property
    def auto(self) -> str | None:
        """Name of the one that ``'auto'`` takes, None where none is available."""
        return next((info.name for info in self if info.available), None)

    def __repr__(self) -> str:
        rows = [("pipeline", "", "needs")]
        for info in self:
            state = "available" if info.available else f"no: {info.why_not}"
            rows.append((info.name, state + (" (auto)" if info.name == self.auto else ""), info.needs))
        widths = [max(len(row[column]) for row in rows) for column in range(3)]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
        return "\n".join(line.rstrip() for line in lines)


@dataclass(frozen=True)
class Capabilities:
    """An OpenGL context described; made by :meth:`of`."""

    version: str  # such as `'4.5'`
    vendor: str  # as OpenGL names them: `GL_VENDOR`, `GL_RENDERER`, `GL_VERSION`
    renderer: str
    driver: str
    software: bool  # whether OpenGL runs on the CPU
    atomics64: str | None  # the extension for depth and id in one atomic word, if any
    extensions: tuple[str, ...]  # sorted
    limits: dict[str, int]  # integers by OpenGL's names, without missing extensions

    @classmethod
    def from_context(cls, ctx: moderngl.Context) -> Capabilities:
        """Describe a context, which must be current."""
        functions, info = GLExtras(ctx), ctx.info
        limits = {name: functions.get_integer(name) for name in _limits_of(ctx)}
        return cls(
            version=_number(version_of(ctx)),
            vendor=str(info["GL_VENDOR"]),
            renderer=str(info["GL_RENDERER"]),
            driver=str(info["GL_VERSION"]),
            software=is_software(ctx),
            atomics64=atomics64(ctx.extensions),
            extensions=tuple(sorted(ctx.extensions)),
            limits=limits,
        )

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain values, for JSON."""
        return {**asdict(self), "extensions": list(self.extensions)}


def _limits_of(ctx: moderngl.Context) -> list[str]:
    """Names of the limits that a context knows."""
    return sorted(
        name
        for name, (_, needs) in INTEGERS.items()
        if (name.startswith("GL_MAX") or needs == "GL_KHR_shader_subgroup")
        and (needs in ctx.extensions if isinstance(needs, str) else version_of(ctx) >= needs)
    )


def atomics64(extensions: Iterable[str]) -> str | None:
    """Return the extension that gives 64-bit atomic minima, None where there is none."""
    present = set(extensions)
    return next((names[0] for names in _ATOMICS_64 if present.issuperset(names)), None)


def pipelines(ctx: moderngl.Context) -> PipelineTable:
    """Return every pipeline, available or not, in the order in which ``'auto'`` tries them."""
    order = SOFTWARE_ORDER if is_software(ctx) else ORDER
    return PipelineTable(_inspect(ctx, name) for name in order)


def _inspect(ctx: moderngl.Context, name: str) -> PipelineInfo:
    version, extension = _NEEDS[name]
    either = f"{MESH} or {MESH_EXT}" if extension == MESH else extension
    needs = f"OpenGL {_number(version)}" + (f" and {either}" if either else "")
    missing = []
    if version_of(ctx) < version:
        missing.append(f"OpenGL is {_number(version_of(ctx))}, needed is {_number(version)}")
    if extension and extension not in ctx.extensions and not (extension == MESH and MESH_EXT in ctx.extensions):
        missing.append(f"{either} is missing")
    return PipelineInfo(name, not missing, "; ".join(missing) or None, needs)


def choose(ctx: moderngl.Context, name: str) -> str:
    """Return the pipeline to draw with."""
    check_choices(pipeline=name)
    table = pipelines(ctx)
    place = f"OpenGL {_number(version_of(ctx))} ({ctx.info['GL_RENDERER']})"
    if table.auto is None:
        last = next(info for info in table if info.name == "geometry")
        raise EngineError(
            f"no pipeline can draw fiblets on {place}: the least is {last.needs}; "
            "a newer driver, or Mesa's software OpenGL, has it"
        )
    if name == AUTO:
        return table.auto
    wanted = next(info for info in table if info.name == name)
    if not wanted.available:
        there = ", ".join(repr(info.name) for info in table if info.available)
        raise EngineError(
            f"pipeline {name!r} cannot draw on {place}: {wanted.why_not}. Available are {there}; "
            f"pipeline='auto' takes {table.auto!r}"
        )
    return name


def check_choices(*, pipeline: str = AUTO, culling: str | None = None, fit: str | None = None) -> None:
    """Refuse values that no context could serve, before there is one."""
    known: Mapping[str, tuple[object, ...]] = {"pipeline": PIPELINES, "culling": (None, *CULLINGS), "fit": FITS}
    for name, value in (("pipeline", pipeline), ("culling", culling), ("fit", fit)):
        if not (value is None or isinstance(value, str)) or value not in known[name]:
            raise ValueError(f"{name} is {value!r}; expected one of {', '.join(map(repr, known[name]))}")


def _number(code: int) -> str:
    """Return 4.3 for 430."""
    return f"{code // 100}.{code % 100 // 10}"
