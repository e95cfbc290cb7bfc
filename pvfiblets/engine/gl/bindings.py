"""Binding points of the engine, each once: texture units, images, storage buffers and uniform blocks.

A :class:`Scope` names the numbers that programs of one kind use. :func:`together` states which scopes one program may
use at once: two names for one number among them are an error when this module is imported. Programs that never run
with the same bindings may use the same numbers. Sources take the numbers as constants, ``{{ storage_anchors }}``
(:data:`CONSTANTS`).

The mappers' resolve has no fixed units: it asks VTK for free ones. Texture units begin at :data:`FIRST_UNIT`: VTK
hands out its own from 0 upwards. OpenGL 3.3 promises 48 units, 4.3 eight storage buffers and eight images.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

FIRST_UNIT = 9


class BindingError(ValueError):
    """Two names have one number in a program, or a number is out of range."""


class Scope(Mapping[str, int]):
    """Binding numbers by name."""

    def __init__(self, name: str, numbers: Mapping[str, int], *, first: int = FIRST_UNIT, last: int = 47) -> None:
        self.name = name  # of the programs, for messages
        self._numbers = dict(numbers)
        for bound, number in self._numbers.items():
            if not first <= number <= last:
                raise BindingError(f"{name}: {bound!r} is bound to {number}; numbers are {first} to {last}")
        together(self)

    def __getitem__(self, bound: str) -> int:
        return self._numbers[bound]

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)


def together(*scopes: Scope) -> None:
    """State that a program may use all of these scopes at once."""
    taken: dict[int, str] = {}
    for scope in scopes:
        for bound, number in scope.items():
            if number in taken:
                raise BindingError(
                    f"{number} is both {taken[number]} and {bound!r} of {scope.name}; choose a free number"
                )
            taken[number] = f"{bound!r} of {scope.name}"


def _storage(name: str, **numbers: int) -> Scope:
    return Scope(name, numbers, first=0, last=9)  # more than eight only where drivers have them


# Texture units, shared by drawables.
CULLING = Scope("occlusion culling", {"last": 9, "outside": 10, "occlusion": 11})
REGIONS = Scope("regions", {"region_boundaries": 26, "region_fields": 27})
CROSSINGS = Scope(
    "surface crossings",
    {"layers_even": 11, "layers_even_end": 12, "layers_odd": 13, "layers_odd_end": 14, "tallies": 15},
)
ITEMS = Scope("items that pull vertices", {"listed": 20})
ITEMS_SHOWN = Scope("items of the last picture", {"shown": 12})
HIT_KEYS = Scope("depth keys of hits", {"depths": 12})

# Fiblets.
FIBLET_DATA = Scope(
    "fiblets' records",
    {
        name: 16 + index
        for index, name in enumerate(
            ("anchors", "pages", "bounds", "anchors_low", "decoding", "codes", "values", "starts")
        )
    },
)
MASKS = Scope("filters", {"streamline_mask": 24, "point_mask": 25})
SAMPLED = Scope("volumes that colour streamlines", {"sampled_volume": 28})
PEELING = Scope("depth peeling", {"peeled_depth": 29, "peeled_ids": 30, "peeled_position": 31})
GATHERING = Scope(
    "lines added up",
    {
        "nearest_depth": 32, "nearest_owner": 33, "nearest_ids": 34, "nearest_position": 35, "outside_depth": 36,
        "colours": 37, "gathered": 38, "slice_keys": 39, "paint_opacities": 40,
    },
)  # fmt: skip
FIBLET_ROUNDS = Scope("rounds of two-phase culling", {"first_round": 12, "seen": 13, "owner": 14, "segment": 15})
BETWEEN_ROUNDS = Scope("the pass between rounds", {"depth_key": 13, "owner": 14, "depth": 15})
LAYER_COPY = Scope("copies of layers", {"depth": 12, "ids": 13, "position": 14, "across": 15})
SAMPLE_LAYER = Scope(
    "layers of samples",
    {"drawn_owner": 12, "entries": 13, "drawn_depth": 14, "drawn_ids": 15, "drawn_position": 16, "shares": 17,
     "drawn_set": 18, "other_colours": 19, "other_depths": 20},
)
NEARER_PART = Scope(
    "the nearer of two parts",
    {
        f"{of}_{name}": 12 + 6 * number + index
        for number, of in enumerate(("kept", "drawn"))
        for index, name in enumerate(("depth", "owner", "ids", "position", "across", "edges"))
    },
)
together(FIBLET_DATA, MASKS, SAMPLED, PEELING, GATHERING, REGIONS, CULLING, FIBLET_ROUNDS)

# Tubes.
TUBES = Scope(
    "tubes",
    {"hits": 10, "depths": 11, "node_texels": 16, "segment_texels": 17, "value_texels": 18, "colour_texels": 19},
)
TUBE_PROBE = Scope("the probe of tubes' solvers", {"cases": 16})
together(TUBES, ITEMS, ITEMS_SHOWN, REGIONS)
together(Scope("tubes' nodes", {k: v for k, v in TUBES.items() if k.endswith("_texels")}), CULLING, ITEMS)

# Halos.
HALOS = Scope(
    "halos",
    {
        "hits": 10, "depths": 11, "place_texels": 13, "mask_texels": 14, "filter_texels": 15, "value_texels": 16,
        "colour_texels": 17, "offset_texels": 18,
    },
)  # fmt: skip
together(HALOS, ITEMS, ITEMS_SHOWN, REGIONS)
together(Scope("halos' vertices", {k: v for k, v in HALOS.items() if k.endswith("_texels")}), CULLING, ITEMS)

# Volumes.
VOLUMES = Scope(
    "volumes",
    {"media": 9, "voxels": 10, "nodes": 11, "colours": 12, "segments": 13, "outside": 14, "means": 15,
     "allowed_bends": 21, "voxel_colours": 22, **{f"voxels_{page}": 32 + page for page in range(1, 8)}},
)  # fmt: skip
VOLUME_COARSE = Scope(
    "coarse rays",
    {"coarse_depth": 16, "coarse_owner": 17, "coarse_position": 18, "coarse_normal": 19, "coarse_colour": 20},
)
VOLUME_OCCLUSION = Scope(
    "occlusion by rays", {"surface_depth": 17, "surface_position": 18, "surface_normal": 19, "rough": 20}
)
together(VOLUMES, VOLUME_COARSE, REGIONS)
together(VOLUMES, VOLUME_OCCLUSION, REGIONS)

STORAGE = _storage(
    "fiblets' records", anchors=0, decoding=1, codes=2, bounds=3, pages=4, visibility_bits=5, anchors_low=6, values=7,
    nearest=8, rotations=9,
)  # fmt: skip
"""Storage buffers of a chunk and of a picture. Passes that need no bits or no values bind their own buffers there."""

MEASURE_STORAGE = _storage("measures of fiblets", measures=STORAGE["visibility_bits"])
CLUSTER_STORAGE = _storage("clusters of fiblets", clusters=STORAGE["values"])
OPEN_STORAGE = _storage("fiblets of clusters that may show", open_fiblets=STORAGE["visibility_bits"])
COUNT_STORAGE = _storage("counts of fiblets", fiblet_counts=STORAGE["values"])
ANSWER_STORAGE = _storage("answers about fiblets", answers=STORAGE["visibility_bits"], lists=STORAGE["values"])
ITEM_STORAGE = _storage("items", seen=0, listed=1, counts=2, commands=3)

IMAGES = Scope(
    "images of the G-buffer",
    {"depth": 0, "owner": 1, "ids": 2, "position": 3, "across": 4, "edges": 5},
    first=0,
    last=7,
)

SUM_IMAGES = Scope("images of sums", {"gathered": 0, "slice_keys": 1, "nearest_owner": 2}, first=0, last=7)

BLOCKS = Scope(
    "uniform blocks",
    {
        "Frame": 0, "Coding": 1, "Chunk": 2, "ClipPlanes": 3, "Rotations": 4, "Regions": 5, "Sampling": 6, "Tubes": 7,
        "Splines": 8, "Halos": 9, "Raycast": 10, "Rays": 11,
    },
    first=0, last=11,
)  # fmt: skip
"""Largest number of uniform blocks: OpenGL guarantees twelve to a stage."""

CONSTANTS = {
    **{
        f"storage_{name}": number
        for scope in (STORAGE, ANSWER_STORAGE, MEASURE_STORAGE, COUNT_STORAGE, CLUSTER_STORAGE, OPEN_STORAGE)
        for name, number in scope.items()
    },
    **{f"items_{name}": number for name, number in ITEM_STORAGE.items()},
    **{f"image_{name}": number for name, number in {**IMAGES, **SUM_IMAGES}.items()},
    **{f"unit_{name}": number for name, number in {**PEELING, **SAMPLED}.items()},
}
"""Names of these numbers in sources."""
