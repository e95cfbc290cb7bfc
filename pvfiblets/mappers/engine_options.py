"""Options of a mapper's engine, and the choice of the engine."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar

from pvfiblets.codec.files.stored_parts import in_parts
from pvfiblets.engine.gl.capabilities import AUTO, check_choices

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet


@dataclass(frozen=True)
class Options:
    """Options that a renderer is made with, without its style's."""

    NOT_MADE_WITH: ClassVar[frozenset[str]] = frozenset()

    def __post_init__(self) -> None:
        """Check the values; None stands for no culling."""
        if getattr(self, "culling", None) == "none":
            object.__setattr__(self, "culling", None)
        self._check()

    def _check(self) -> None:
        """Raise where a value is unknown."""

    def changed(self) -> dict[str, Any]:
        """Return the options that differ from the defaults, as keyword arguments of a renderer."""
        return {
            field.name: getattr(self, field.name)
            for field in fields(self)
            if getattr(self, field.name) != field.default and field.name not in self.NOT_MADE_WITH
        }


@dataclass(frozen=True)
class EngineOptions(Options):
    """Options of drawing that do not change the picture."""

    # How fiblets become pixels: ``'auto'`` takes the fastest that the window's OpenGL has; see
    # `pvfiblets.engine.gl.capabilities.pipelines`
    pipeline: str = AUTO
    # How fiblets behind others are found out; ``'auto'`` is two-phase where that is measured to be faster
    culling: str | None = AUTO
    # What to do where memory does not suffice: refuse, draw a share of the streamlines, or all of them part by part
    fit: str | None = None
    cluster: Any = None  # Has its workers draw, part by part where memory does not suffice

    def _check(self) -> None:
        check_choices(pipeline=self.pipeline, culling=self.culling, fit=self.fit)


def engine_renderer(ctx: moderngl.Context, fiblets: FibletSet, **options: Any) -> Any:
    """Make the engine's renderer; the default ``renderer_factory``."""
    if options.get("cluster") is not None:
        from pvfiblets.engine.fiblets.parts.cluster_renderer import ClusterRenderer

        return ClusterRenderer(ctx, fiblets, options["cluster"], pipeline=options.get("pipeline", AUTO))
    if options.get("fit") is None and in_parts(fiblets):
        options["fit"] = "stream"  # where all of it does not fit, or is not here yet
    options.setdefault("culling", EngineOptions.culling)  # the engine's own is the same in every picture
    if options.get("fit") == "stream":
        from pvfiblets.engine.fiblets.parts.streamed_renderer import streamed_renderer

        return streamed_renderer(ctx, fiblets, **{name: given for name, given in options.items() if name != "fit"})
    from pvfiblets.engine import FibletRenderer

    return FibletRenderer(ctx, fiblets, **options)
