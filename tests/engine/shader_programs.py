"""Every program that the engine can link, and the features to compile it with: each pair of them at least once.

A `Kind` is a program's files, and the features that they look at are those that it varies. What Python never asks for
together stands once, in `EXCLUSIVE` and `NEEDS`. The rows of a kind are
choices in which every pair of features that can occur does: a covering array, found greedily.
"""

import itertools
import random
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from pvfiblets.colour_modes import SHADERS
from pvfiblets.engine.effects.ambient_occlusion import BIAS, GAIN
from pvfiblets.engine.effects.antialias_coverage import TILE as LINE_TILE
from pvfiblets.engine.effects.halos import TILE as HALO_TILE
from pvfiblets.engine.effects.picture import STEPS
from pvfiblets.engine.effects.picture import TILE as PICTURE_TILE
from pvfiblets.engine.fiblets.pipelines import CONSTANTS as OF_PIPELINES
from pvfiblets.engine.gl import shaders
from pvfiblets.engine.gl.shaders import EXTENDED, NEWEST, assemble
from pvfiblets.engine.halos.uniform_blocks import CONSTANTS as OF_HALOS
from pvfiblets.engine.volumes.ray_occlusion import GOLDEN, LIFT
from pvfiblets.engine.volumes.uniform_blocks import CONSTANTS as OF_VOLUMES
from pvfiblets.report.studies.tubes.tessellated import LEAST_SIDES, MOST_SIDES, TOLERANCE

__all__ = ["EXCLUSIVE", "KINDS", "NEEDS", "Choice", "Kind", "preprocessed", "rows", "varied"]

VALUES = ("VALUES_STORED", "VALUES_ARC_LENGTH", "VALUES_VOLUME")
COLOURS = tuple(mode.feature for mode in SHADERS.values() if mode.reads != "colours")
INTEGRATORS = (
    "VOLUME_PREINTEGRATED", "VOLUME_RIEMANN", "VOLUME_SIMPSON", "VOLUME_ROMBERG", "VOLUME_RK4",
)  # fmt: skip
# One of each line, or none.
EXCLUSIVE = (
    VALUES,
    COLOURS,
    INTEGRATORS,
    ("CULL_PYRAMID", "CULL_COVERAGE", "CLUSTERS"),
    ("TEXTURE_DATA", "STORED_ROTATIONS"),
    ("TEXTURE_DATA", "OPEN_FIBLETS"),
    ("ONE_SEGMENT", "CLIPPING"),
    ("ONE_SEGMENT", "LEVEL_OF_DETAIL"),
    ("GATHER", "PEEL", "EDGES"),
    ("GATHER", "CROSS_LINE"),
    ("LINE_ENDS", "TUBES"),
    ("LINE_ENDS", "CROSS_LINE"),
    *(("SUBSAMPLES", other) for other in ("TUBES", "CROSS_LINE", "GATHER", "PEEL", "EDGES", "CLIP_REGION")),
    ("TUBE_ILLINOIS", "TUBE_ITP", "TUBE_NEWTON"),
    ("TUBE_VALUES", "TUBE_COLOURS"),
    ("HALO_VALUES", "HALO_COLOURS"),
    ("VOLUME_SURFACE", "VOLUME_COMPOSITE", "VOLUME_LOCAL", "VOLUME_MINIMUM", "VOLUME_AVERAGE"),
    ("VOLUME_NEAREST", "VOLUME_TRICUBIC"),
    ("VOLUME_CELLS", "VOLUME_UNREFINED", "VOLUME_NEWTON"),
    *(
        ("VOLUME_CELLS", other)
        for other in ("VOLUME_NEAREST", "VOLUME_TRICUBIC", "VOLUME_COMPOSITE", "VOLUME_AVERAGE", "VOLUME_JITTER")
    ),
    ("VOLUME_WHOLE", "VOLUME_HOMOGENEOUS"),
    ("TONE_REINHARD", "TONE_EXPONENTIAL", "TONE_ACES", "TONE_HABLE"),
)
# What the first asks for: all of one of the lines after it.
NEEDS: dict[str, tuple[tuple[str, ...], ...]] = {
    **dict.fromkeys(("CLIP_PLANES", "POINT_MASK", "CLIP_REGION"), (("CLIPPING", "CLIPPING_DEPTH"),)),
    "CLIPPING_DEPTH": (("CLIPPING",),),
    "WIDE_LATTICE": (("LATTICE",),),
    "TUBES": (("WIDE_LINES",),),
    "CROSS_LINE": (("WIDE_LINES",),),
    "SUBSAMPLES": (("WIDE_LINES",),),
    "LINE_ENDS": (("WIDE_LINES",),),
    **dict.fromkeys(("SECOND_ROUND", "OPEN_FIBLETS"), (("CULL_PYRAMID",),)),
    **dict.fromkeys(("GATHER_SLICES", "GATHER_OUTSIDE", "PAINTED"), (("GATHER",),)),
    "PAINTED": tuple((source, "GATHER") for source in COLOURS),
    **dict.fromkeys((*COLOURS, "PAINT_LIGHT", "PAINT_ALPHA"), (("PAINTED",),)),
    "COLOUR_POINT_SCALAR": (("PAINT_VALUE", "PAINTED"),),
    "PAINT_VALUE": tuple((value, "PAINTED") for value in VALUES),
    "VALUES_COLOUR": (("VALUES_STORED",),),
    "COLOUR_POINT_PACKED": (("VALUES_COLOUR", "PAINT_VALUE", "PAINTED"),),
    "TABLE_LOGARITHM": (("COLOUR_POINT_SCALAR",),),
    "PAINT_OPACITIES": (("PAINT_ALPHA",),),
    "PAINT_VALUE_OPACITY": (("PAINT_VALUE", "PAINT_ALPHA"),),
    **dict.fromkeys(("VOLUME_UNREFINED", "VOLUME_NEWTON"), (("VOLUME_SURFACE",),)),
    **dict.fromkeys((*INTEGRATORS, "VOLUME_FINER", "VOLUME_HOMOGENEOUS"), (("VOLUME_COMPOSITE",),)),
    "VOLUME_SHADED": (("VOLUME_COMPOSITE",), ("VOLUME_LAYERS",)),
    "VOLUME_LAYERS": (("VOLUME_SURFACE",),),
    "VOLUME_CLOSED": (("VOLUME_SURFACE",),),
    "VOLUME_COLOURS": (("VOLUME_COMPOSITE",),),
    "VOLUME_EXACT": (("VOLUME_PREINTEGRATED", "VOLUME_FINER"),),
    "VOLUME_PAGES": (("VOLUME_BRICKS",),),
    "TUBE_HOLLOW": (("TUBE_CHAIN",),),
    "HALO_TAPER": (("!HALO_POINTS",),),
    "HALO_CUT": (("!HALO_POINTS",),),
    "HALO_SOME": (("HALO_POINTS",),),
}


@dataclass(frozen=True)
class Kind:
    """The files of a program.

    Attributes
    ----------
    stages : mapping of str to str
        Files by glslang's names of stages.
    versions : tuple of int
        Of GLSL: what drivers of different ages get.
    always, never : tuple of str
        Features that are on in all such programs, or in none.
    needs : mapping
        More of `NEEDS`, for these programs; an empty entry takes one away.
    constants : mapping
    """

    stages: Mapping[str, str]
    versions: tuple[int, ...] = (NEWEST,)
    always: tuple[str, ...] = ()
    never: tuple[str, ...] = ()
    needs: Mapping[str, tuple[tuple[str, ...], ...]] = field(default_factory=dict)
    constants: Mapping[str, object] = field(default_factory=dict)

    def sources(self, features, version):
        """GLSL by glslang's names of stages."""
        return {
            stage: assemble(name, features, {**OF_PIPELINES, **self.constants}, version=version)
            for stage, name in self.stages.items()
        }


def _features_in(name, seen):
    if name in seen:
        return set()
    seen.add(name)
    text = shaders.read_shader(name)
    found = set(shaders._FEATURE.findall(text))
    return found.union(*(_features_in(included, seen) for included in shaders._INCLUDE.findall(text)))


def varied(kind):
    """Features that programs of a kind look at, and that are not the same in all of them."""
    found = set().union(*(_features_in(name, set()) for name in kind.stages.values()))
    return tuple(sorted(found - set(kind.always) - set(kind.never)))


@dataclass(frozen=True)
class Choice:
    """Features that are on, those that must be off, and nothing that contradicts `NEEDS` or `EXCLUSIVE`."""

    needs: Mapping[str, tuple[tuple[str, ...], ...]]
    draw: random.Random
    on: frozenset[str]
    off: frozenset[str]

    def having(self, names):
        """Return the choice with more features, and all that these need; None if that cannot be."""
        on, off, todo = set(self.on), set(self.off), list(names)
        while todo:
            name = todo.pop()
            if name.startswith("!"):
                off.add(name[1:])
                continue
            if name in on:
                continue
            on.add(name)
            off |= _BESIDE.get(name, frozenset())
            options = self.needs.get(name, ())
            if options and not any(all(other in on or other[0] == "!" for other in option) for option in options):
                free = [option for option in options if not off.intersection(option)]
                todo += self.draw.choice(free or options)
            elif options:
                todo += [other for other in options[0] if other[0] == "!"]
        return None if on & off else Choice(self.needs, self.draw, frozenset(on), frozenset(off))


_BESIDE = {
    name: frozenset(other for line in EXCLUSIVE if name in line for other in line if other != name)
    for name in itertools.chain(*EXCLUSIVE)
}


@cache
def rows(kind_name, size=2):
    """Return choices of a kind's features, the plain program first.

    Parameters
    ----------
    kind_name : str
        Of `KINDS`.
    size : {2, 1}
        Whether each pair of features that can occur (both, either, none) does in some choice, or each feature.
    """
    kind = KINDS[kind_name]
    draw, names = random.Random(kind_name), varied(kind)
    bits = {name: 1 << k for k, name in enumerate(names)}
    empty = Choice({**NEEDS, **kind.needs}, draw, frozenset(), frozenset(kind.never)).having(kind.always)
    assert empty is not None

    def word(choice):
        return sum(bits.get(name, 0) for name in choice.on)

    # A pair is the bits that it speaks of, and what they are to be.
    levels = [(bits[name], bits[name] * on) for name in names for on in (1, 0)]
    pairs = [(m | n, v | w) for (m, v), (n, w) in itertools.combinations(levels, 2) if m != n]
    missing = np.array((pairs if size == 2 else []) or levels, np.int64).reshape(-1, 2)
    taken = []
    choice = _decoding(empty, names)
    while choice is not None or len(missing):
        if choice is not None:
            taken.append(choice.on)
            missing = missing[(missing[:, 0] & word(choice)) != missing[:, 1]]
        if not len(missing):
            break
        mask, value = missing[0].tolist()
        fixed = [name if value & bit else f"!{name}" for name, bit in bits.items() if mask & bit]
        begun = [_begun(empty, fixed, names) for _ in range(8)]
        filled = [_filled(begin, names) for begin in begun if begin is not None]
        choice = max(filled, key=lambda one: ((missing[:, 0] & word(one)) == missing[:, 1]).sum(), default=None)
        if choice is None:  # it cannot occur
            missing = missing[1:]
    return taken


def _begun(empty, fixed, names):
    """Return a choice with some features fixed, and what these need."""
    begun = empty.having([name for name in fixed if name[0] == "!"])
    begun = begun and begun.having([name for name in fixed if name[0] != "!"])
    return begun and _decoding(begun, names)


def _decoding(choice, names):
    """Add a kind of record, if fiblets are decoded: there is no set without."""
    kinds = [name for name in ("DIRECTION", "LATTICE", "SPLINE") if name not in choice.off]
    if "DIRECTION" not in names or choice.on.intersection(kinds):
        return choice
    return choice.having([choice.draw.choice(kinds)]) if kinds else None


def _filled(choice, names):
    """Add half of the other features, as far as they go with those that are there."""
    for name in choice.draw.sample(names, len(names)):
        if name not in choice.on and name not in choice.off and choice.draw.random() < 0.5:
            choice = choice.having([name]) or choice
    return choice


SCREEN = (330, 410, NEWEST)
FREE = {"CLIP_PLANES": (), "POINT_MASK": (), "CLIP_REGION": (), "LINE_ENDS": ()}  # what culls is drawn by nobody
# Whole programs of the rasteriser: both edges of the picture or none.
RASTER = {"CLIPPING": (("CLIPPING_DEPTH",),), "REGION_FIELDS": (("CLIP_REGION",),)}
GATHERED = ("GATHER_SLICES", "GATHER_OUTSIDE", "PAINTED")
PICTURE = ("blur", "copy", "gather", "mean", "reach", "seen_through", "tiles", "tone")


def _raster(vertex, fragment, versions, always, never=()):
    wide = fragment == "capsule"
    fragments = {"frag": f"fiblets/hardware_raster/{fragment}.frag"}
    never = (*never, "ONE_SEGMENT", *(() if wide else ("WIDE_LINES", "TUBES", "CROSS_LINE", "LINE_ENDS")))
    return Kind({**vertex, **fragments}, versions, (*always, *(("WIDE_LINES",) if wide else ())), never, RASTER)


def _fiblets():
    kinds = {}
    survivors, textured = {"vert": "fiblets/hardware_raster/survivors.vert"}, ("TEXTURE_DATA",)
    not_mesh = ("PER_PRIMITIVE", "MESH_EXT", "SUBGROUPS")
    decode = {**survivors, "tesc": "fiblets/tessellation/decode.tesc"}
    for fragment, shape in (("line", "lines"), ("capsule", "capsules")):
        kinds[f"geometry {fragment}"] = _raster(
            {**survivors, "geom": f"fiblets/geometry/{shape}.geom"}, fragment, (330, 410, NEWEST), textured, not_mesh
        )
        stages = {**decode, "tese": f"fiblets/tessellation/{shape}.tese"}
        if fragment == "capsule":
            stages["geom"] = "fiblets/tessellation/capsules.geom"
        kinds[f"tessellation {fragment}"] = _raster(stages, fragment, (410, NEWEST), textured, not_mesh)
        for how, form in itertools.product(("together", "serial"), ("nv", "ext")):
            stages = {"task": "fiblets/mesh/fiblets.task", "mesh": f"fiblets/mesh/{how}.mesh"}
            always = ("PER_PRIMITIVE", *(("MESH_EXT",) if form == "ext" else ()))
            never = ("TEXTURE_DATA", *(() if form == "ext" else ("MESH_EXT",)))
            kinds[f"{form} mesh {how} {fragment}"] = _raster(stages, fragment, (EXTENDED,), always, never)
    classes = {**RASTER, "CLIPPING": ()}
    for stage in ("depth", "gather", "resolve_owner", "resolve_ties"):
        gathers = ("GATHER",) if stage == "gather" else ()
        kinds[f"compute {stage}"] = Kind(
            {"comp": f"fiblets/compute/{stage}.comp"},
            always=gathers,
            never=("TEXTURE_DATA", "PER_PRIMITIVE", "INT64_ATOMICS", *(() if gathers else GATHERED)),
            needs=classes,
        )
    choosing = "choose_predicted", "choose_rest", "clusters"
    for stage in (*choosing, "clear", "count", "cull", "measure", "occlude", "plan", "query", "refine"):
        needs = FREE if stage == "query" else {**FREE, "REGION_FIELDS": (("CLIP_REGION",),), "TUBES": ()}
        kinds[f"compute {stage}"] = Kind(
            {"comp": f"fiblets/compute/{stage}.comp"}, never=("TEXTURE_DATA", "INT64_ATOMICS"), needs=needs
        )
    for name, always, versions in (("textures", textured, (330, 410, NEWEST)), ("buffers", (), (NEWEST,))):
        kinds[f"raster resolve, {name}"] = Kind(
            {stage: f"fiblets/hardware_raster/resolve.{stage}" for stage in ("vert", "frag")},
            versions,
            always,
            (*not_mesh, "ONE_SEGMENT", "SUBSAMPLES", *(() if always else ("TEXTURE_DATA",))),
            RASTER,
        )
    needs = {**FREE, "REGION_FIELDS": (("CLIP_REGION",),), "TUBES": ()}
    kinds["mesh open"] = Kind({"comp": "fiblets/mesh/open.comp"}, never=("TEXTURE_DATA",), needs=needs)
    kinds["pyramid"] = Kind({"comp": "culling/pyramid_reduce.comp"})
    for stage in ("clear", "depth", "split"):
        kinds[f"compute {stage}, 64 bits"] = Kind(
            {"comp": f"fiblets/compute/{stage}.comp"},
            (EXTENDED,),
            always=("INT64_ATOMICS",),
            never=("TEXTURE_DATA", *GATHERED),
            needs=classes,
        )
    for name, fragment in (("count", "count"), ("measure", None), ("visible", "visible")):
        stages = {"vert": f"fiblets/hardware_raster/{name}.vert"}
        if fragment:
            stages["frag"] = f"fiblets/hardware_raster/{fragment}.frag"
        always = () if name == "visible" else textured
        needs = {**FREE, "REGION_FIELDS": (("CLIP_REGION",),)}
        kinds[f"raster {name}"] = Kind(stages, SCREEN, always=always, needs=needs)
    return kinds


def _others():
    kinds = {}

    def screen(*names, vertex="screen/triangle.vert", versions=SCREEN, **rest):
        for name in names:
            kinds[name] = Kind({"vert": vertex, "frag": f"{name}.frag"}, versions, **rest)

    screen("fiblets/gather/greatest", "fiblets/gather/slice_keys", "fiblets/hardware_raster/between", "screen/keys")
    screen("fiblets/layers/copy", needs={"TUBES": (("CROSS_LINE",),), "CROSS_LINE": ()})
    screen("fiblets/samples/entries", "fiblets/samples/layer", "fiblets/samples/claim", "fiblets/samples/of_set")
    screen("fiblets/samples/begin", "fiblets/samples/others")
    screen("fiblets/parts/nearer", needs={"TUBES": (("CROSS_LINE",),), "CROSS_LINE": (), "EDGES": ()})
    screen("culling/coverage_dilate", "culling/pyramid_reduce")
    screen("regions/inspect", "regions/tally", always=("PEEL",))
    screen("culling/coverage_grid", vertex="culling/coverage_grid.vert")
    screen("effects/halo", "effects/tile_min_distance", constants={"tile": HALO_TILE})
    screen("effects/linear_depth", "effects/outline", "effects/selection_mask")
    screen("effects/ssao", "effects/ssao_blur", constants={"gain": GAIN, "bias": BIAS})
    picture = {"steps": float(STEPS), "tile": PICTURE_TILE}
    screen(*(f"effects/picture/{name}" for name in PICTURE), constants=picture)
    screen("effects/picture/line_tiles", constants={"tile": LINE_TILE})
    tiled = [f"effects/picture/{name}" for name in ("antialias_coverage", "visible_edges")]
    screen(*tiled, vertex="effects/picture/line_tiles.vert", constants={"tile": LINE_TILE})
    screen("regions/peel", "regions/overflow", vertex="regions/surface.vert")
    for outputs, kind, leaves in ((1, "SPHERE", 1), (2, "PLANES", 1), (4, "SPHERE", 2), (8, "PLANES", 2)):
        constants = {
            "leaves": leaves,
            "kinds": ", ".join([f"RAYS_{kind}"] * leaves),
            "planes": ", ".join(["0", "6"][:leaves]),
            "expression": " && ".join(f"!LEAF({k})" for k in range(leaves)),
            "outputs": outputs,
        }
        name = "regions/combine"
        kinds[f"{name} {outputs}"] = Kind(
            {"vert": "screen/triangle.vert", "frag": f"{name}.frag"}, SCREEN, constants=constants
        )
    screen("tubes/probe", needs={"CLIP_PLANES": (("TUBE_CHAIN",),), "CLIP_REGION": (("TUBE_CHAIN",),)})
    plain = {"CLIP_PLANES": (), "CLIP_REGION": (("TUBE_CHAIN",),)}
    for shape, vertex in (("rectangles", "rectangles"), ("pulled boxes", "boxes"), ("boxes", "pass")):
        stages = {"vert": f"tubes/{vertex}.vert", "frag": "tubes/tube.frag"}
        if vertex == "pass":
            stages["geom"] = "tubes/boxes.geom"
        kinds[f"tubes {shape}"] = Kind(stages, SCREEN, always=("TUBES",), needs=plain)
    whole = {"CLIP_PLANES": (), "CLIP_REGION": ()}
    screen("tubes/attributes", vertex="screen/near.vert", always=("TUBES",), needs=whole)
    for shape, points in (("strips", False), ("discs", True)):
        point = {"always": ("HALO_POINTS",)} if points else {"never": ("HALO_POINTS",)}
        stages = {"vert": f"halos/{shape}.vert", "frag": "halos/halo.frag"}
        cut = {"CLIP_PLANES": () if points else (("HALO_CUT",),), "TUBES": (), "CLIP_REGION": ()}
        never = (*point.get("never", ()), "TUBES")
        kinds[f"halos {shape}"] = Kind(stages, SCREEN, point.get("always", ()), never, cut, OF_HALOS)
    screen("halos/attributes", vertex="screen/near.vert", never=("TUBES",), constants=OF_HALOS)
    volume = {"CLIP_REGION": ()}
    screen("volumes/cast", "volumes/fill", "volumes/ray_occlusion_mean", needs=volume, constants=OF_VOLUMES)
    occlusion = {**OF_VOLUMES, "lift": LIFT, "golden_u": GOLDEN[0], "golden_v": GOLDEN[1]}
    screen("volumes/ray_occlusion", needs=volume, never=("VOLUME_HOMOGENEOUS",), constants=occlusion)
    for name in ("culling/item_commands", "culling/visible_items", "halos/cull", "tubes/cull"):
        always = ("TUBES",) if name == "tubes/cull" else ()
        never = ("TUBES",) if name == "halos/cull" else ()
        kinds[name] = Kind({"comp": f"{name}.comp"}, always=always, never=never, constants=OF_HALOS)
    kinds["scene depth"] = Kind({"frag": "frame/scene_depth.frag"}, (330,))
    stages = {stage: f"baselines/tessellated.{stage}" for stage in ("vert", "tesc", "tese", "frag")}
    sides = {"least_sides": float(LEAST_SIDES), "most_sides": float(MOST_SIDES), "most_steps": 6.0}
    sides["tolerance"] = TOLERANCE
    kinds["tessellated tubes"] = Kind(stages, constants=sides)
    return kinds


KINDS: dict[str, Kind] = {**_fiblets(), **_others()}
"""Every program, by a name for messages."""


def preprocessed(source, features):
    """Lines that are left of a source, composed or not, when its features are decided; without comments and defines."""
    kept, branches = [], []  # of each #if: whether this branch is on, whether one was

    def holds(condition):
        condition = re.sub(r"FEATURE_(\w+)", lambda m: str(m[1] in features), condition).replace("__VERSION__", "430")
        return bool(eval(condition.replace("&&", " and ").replace("||", " or ").replace("!", " not "), {}))

    for line in source.splitlines():
        words = line.split("//")[0].strip()
        if words.startswith(("#if ", "#ifndef")):
            on = words.startswith("#ifndef") or holds(words[4:])
            branches.append((on, on))
        elif words.startswith(("#elif ", "#else")):
            before = branches.pop()[1]
            on = not before and (words.startswith("#else") or holds(words[6:]))
            branches.append((on, before or on))
        elif words.startswith("#endif"):
            branches.pop()
        elif words and not words.startswith("#define") and all(on for on, _ in branches):
            kept.append(words)
    return kept
