"""Numbers that the pipelines' sources and modules share, in a module that imports no pipeline."""

from __future__ import annotations

from ...gl.passes import GROUP_SIZE
from ...view import MAX_CLIP_PLANES
from ..data.chunks import CLUSTER, CLUSTER_BIAS, CLUSTER_STEP
from ..data.filter_textures import MASK_BITS

CLASSES = 4
ROUNDS = 8
GROUP_CLUSTERS = 4
GROUP_WORDS = 8
VISIBILITY_WORDS = 7
LIST_SHARE = 8
"""A list has room for a chunk's fiblets divided by this."""

SHARES = {"line": 60, "cut_line": 30, "capsule": 15, "painted_capsule": 12, "cut_capsule": 9}
VERTICES = {"line": 61, "cut_line": 61, "capsule": 60, "painted_capsule": 48, "cut_capsule": 36}

THREADS = 32
"""Invocations of a mesh stage's work group: a warp, as in the paper."""

TASK_ROUNDS = 8
"""Fiblets that each invocation of a task work group tests."""

GREATEST_SIDE = 16
"""Pixels of the side of the squares that the greatest sum is searched in."""

TASK_FIBLETS = THREADS * TASK_ROUNDS

CONSTANTS = {
    "group_size": GROUP_SIZE,
    "group_words": GROUP_WORDS,
    "classes": CLASSES,
    "rounds": ROUNDS,
    "group_clusters": GROUP_CLUSTERS,
    "cluster_size": CLUSTER,
    "cluster_bias": CLUSTER_BIAS,
    "cluster_step": CLUSTER_STEP,
    "list_share": LIST_SHARE,
    "visibility_words": VISIBILITY_WORDS,
    "mask_bits": MASK_BITS,
    "max_clip_planes": MAX_CLIP_PLANES,
    "greatest_side": GREATEST_SIDE,
    "mesh_threads": THREADS,
    "task_fiblets": TASK_FIBLETS,
    "task_rounds": TASK_ROUNDS,
    **{f"{drawn}_share": share for drawn, share in SHARES.items()},
    **{f"{drawn}_vertices": count for drawn, count in VERTICES.items()},
}
"""Constants of all pipelines' sources."""
