"""What a renderer's last redraw was made of, for :meth:`FibletRenderer.explain`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from .fiblets.census import Census
from .fiblets.pipelines import ComputePipeline, Pipeline

if TYPE_CHECKING:
    from .culling import Occlusion
    from .fiblets.chunks import Chunk
    from .fiblets.depth_peeling import Layers
    from .fiblets.point_values import ValueSources
    from .fiblets.region_query import RegionQuery
    from .fiblets.visibility import Visibility
    from .gbuffer import GBuffer

__all__ = ["buffer_sizes", "count_fiblets", "no_counts"]


def buffer_sizes(
    shared: Mapping[str, Any],
    chunks: Iterable[Chunk],
    pipeline: Pipeline | None,
    occlusion: Occlusion | None,
    target: GBuffer | None,
    kept: Visibility | None,
    values: ValueSources | None,
    layers: Layers | None,
    query: RegionQuery | None,
) -> list[dict[str, object]]:
    """Return name and bytes of everything on the GPU."""
    sizes: dict[str, int] = {name: buffer.size for name, buffer in shared.items()}
    for chunk in chunks:
        for name, buffer in chunk.buffers.items():
            sizes[name] = sizes.get(name, 0) + buffer.size
    if pipeline is not None:
        sizes |= {name: buffer.size for name, buffer in pipeline.buffers.items()}
    if occlusion is not None:
        sizes["occlusion"] = occlusion.nbytes
    if target is not None:
        sizes["gbuffer"] = target.nbytes
    if kept is not None:
        sizes |= kept.buffers
    if values is not None:
        sizes |= values.buffers
    if layers is not None:
        sizes["layers"] = layers.nbytes
    if query is not None:
        sizes["query"] = query.nbytes
    return [{"name": name, "bytes": size} for name, size in sizes.items()]


def no_counts(
    total: int, in_frustum: int | None = None, drawn: int | None = None, visible: int | None = None
) -> dict[str, int | None]:
    """Return how many fiblets there are, and what is known besides."""
    return {"total": total, "in_frustum": in_frustum, "drawn": drawn, "visible": visible}


def count_fiblets(
    census: Census,
    total: int,
    chunks: Sequence[Chunk],
    features: Sequence[str],
    pipeline: Pipeline,
    target: GBuffer,
    kept: Visibility,
    culled: bool,
) -> dict[str, int | None]:
    """Count fiblets of the last picture; uniform blocks and camera are those of it.

    Parameters
    ----------
    census : Census
    total : int
        Fiblets on the GPU.
    chunks : sequence of Chunk
    features : sequence of str
        What the fiblets need to be decoded, and ``CLIP_PLANES``.
    pipeline : Pipeline
    target : GBuffer
    kept : Visibility
    culled : bool
        Whether fiblets behind others were left out.
    """
    marks = pipeline.buffers["visibility_bits"] if isinstance(pipeline, ComputePipeline) and pipeline.planned else None
    in_frustum, drawn = census.count(chunks, [*features, *kept.culling], marks, kept)
    return no_counts(total, in_frustum, drawn if culled else in_frustum, census.visible(target))
