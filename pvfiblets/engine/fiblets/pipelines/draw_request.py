"""The request that a pipeline draws, and the methods of every pipeline."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from ...gbuffer import GBuffer
from ...gl.passes import Passes
from ..data.chunks import Chunk

if TYPE_CHECKING:
    from ...culling.occlusion import Occlusion
    from ..gather.gathering import Gather
    from ..gather.layered_buffer import Peel
    from ..visibility import Visibility


@dataclass(frozen=True)
class DrawRequest:
    """One picture.

    The uniform blocks ``Frame``, ``Coding``, ``ClipPlanes`` (if there are planes) and ``Rotations`` are bound to 0, 1,
    3 and 4 already.
    """

    chunks: Sequence[Chunk]
    target: GBuffer
    passes: Passes  # Takes the times
    # Features (keys of :data:`pvfiblets.engine.gl.shaders.FEATURES`) that the fiblets' records ask for
    decoding: tuple[str, ...]
    values: tuple[str, ...]  # Feature of the per-point value
    clipping: bool  # Whether any fiblet may cross the edges of the picture, the near or the far plane
    planes: tuple[str, ...]  # ``CLIP_PLANES``, if planes of the caller's may touch anything
    detail: tuple[str, ...]  # ``LEVEL_OF_DETAIL``, unless every point is to be drawn
    line_width: float  # Pixels of round brushes; 0 for thin lines and for tubes
    segment: Callable[[], float]  # Returns the pixels that the longest segments in the picture take, roughly
    occlusion: Occlusion | None  # Tests what earlier depth hides
    kept: Visibility  # The caller's filter and region
    # ``TUBES``, ``LINE_ENDS``, ``CROSS_LINE``, ``EDGES`` and ``SUBSAMPLES``, if asked for. With tubes the uniform
    # block ``Tubes`` is bound too.
    tubes: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
    across: tuple[str, ...] = ()
    edges: tuple[str, ...] = ()
    samples: tuple[str, ...] = ()
    peel: Peel | None = None  # The picture begins behind these layers
    gather: Gather | None = None  # Where all lines are added up, in place of the nearest's picture
    # Whether nearer pixels in the target stay, but for their owner. Only the pipeline ``compute`` can.
    adds: bool = False

    @property
    def wide(self) -> tuple[str, ...]:
        """``WIDE_LINES``, if they are; what tubes, ends, and places across, ask of drawing programs goes along."""
        return (*self.brush, *self.across)

    @property
    def brush(self) -> tuple[str, ...]:
        """Features that decide which pixels lines take."""
        wide = ("WIDE_LINES",) if self.line_width > 0.0 or self.tubes else ()
        return (*wide, *self.tubes, *self.ends)

    @property
    def extra(self) -> tuple[str, ...]:
        """Additional outputs of drawing programs; none for layers behind others."""
        return () if self.peel is not None else (*self.edges, *self.samples)

    @property
    def peeling(self) -> tuple[str, ...]:
        """``PEEL``, if the picture begins behind others."""
        return () if self.peel is None else ("PEEL",)

    @property
    def gathering(self) -> tuple[str, ...]:
        """``GATHER`` and what goes along, if all lines are added up."""
        return () if self.gather is None else self.gather.features

    @property
    def clustered(self) -> bool:
        """Whether the chunks have clusters, and there are depth pyramids to test them against."""
        halfway = self.occlusion is not None and self.occlusion.halfway
        return halfway and all("clusters" in chunk.buffers for chunk in self.chunks)

    @property
    def culling(self) -> tuple[str, ...]:
        """Features of programs that look for fiblets to leave out, beside occlusion."""
        return (*self.kept.culling, *self.ends)

    @property
    def cluster_features(self) -> tuple[str, ...]:
        """Features of the programs that test clusters (``fiblets/compute/cluster_box.glsl``)."""
        assert self.occlusion is not None
        return (*self.decoding, *self.planes, *self.tubes, *self.culling, self.occlusion.feature)

    @property
    def cutting(self) -> tuple[str, ...]:
        """Features that draw a fiblet in part."""
        return (*self.planes, *self.kept.cutting)

    def classes(self, *, one: bool = False) -> list[tuple[int, tuple[str, ...]]]:
        """Classes of fiblets (``fiblets/compute/cull.comp``) that there can be, with the features of their programs."""
        common = (*self.decoding, *self.values, *self.wide, *self.extra, *self.peeling, *self.gathering)
        whole = (*common, *self.detail, *self.cutting, "CLIPPING", "CLIPPING_DEPTH")
        if one:
            return [(0, whole if self.clipping or self.detail else common)]
        classes = [(0, common)]
        if self.clipping:
            classes.append((1, (*common, *self.detail, "CLIPPING")))
            classes.append((2, whole))
        if self.detail:
            classes.append((3, (*common, "ONE_SEGMENT")))
        return classes


class Sized(Protocol):
    """Something on the GPU."""

    @property
    def size(self) -> int:
        """Bytes."""
        ...


class Pipeline(Protocol):
    """A method of drawing fiblets."""

    name: str

    @property
    def buffers(self) -> Mapping[str, Sized]:
        """Its own GPU memory, by name."""
        ...

    def draw(self, request: DrawRequest) -> None:
        """Fill the target."""
        ...

    def gathers_words(self, request: DrawRequest) -> bool:
        """Return whether sums for such a request are words, not floats (`gathering.Gathered`)."""
        ...

    def gather(self, request: DrawRequest) -> None:
        """Fill the target of ``request.gather``, and nothing else."""
        ...

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        ...
