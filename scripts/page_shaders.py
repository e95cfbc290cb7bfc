"""The shaders of pages (client/), and what else their script takes from the package; scripts/page_client.py builds it.

They are the engine's own pieces, assembled as for OpenGL 3.3, turned into GLSL ES 3.00 and shortened. Switches that the
page sets stay switches: it sets the ``#define FEATURE_`` lines itself. Beside them stand the offsets of uniform blocks,
the rotations of direction codes, and their scales.
"""

from __future__ import annotations

import base64
import re
import sys
from pathlib import Path
from typing import Any

from pvfiblets.codec import direction_codebook, layout
from pvfiblets.colour_modes import SHADERS
from pvfiblets.engine.gl.shaders import FEATURES, assemble
from pvfiblets.engine.gl.uniform_struct import find_struct

sys.path.insert(0, str(Path(__file__).resolve().parent))

from shader_shrinking import pieces, renamed, shrunk

CLIENT = Path(__file__).resolve().parents[1] / "client" / "src"
REPLACED = {
    "fiblets/data/culling.glsl": "page/data.glsl",
    "fiblets/data/decoding.glsl": "page/data.glsl",
    "colour/missing.glsl": "page/missing.glsl",
    "fiblets/attributes/packed_colour.glsl": "page/packed_colour.glsl",
    "fiblets/gather/line_opacity.glsl": "page/line_opacity.glsl",
}
ANY_FIBLETS = ("ANCHORS_LOW", "DIRECTION", "LATTICE", "WIDE_LATTICE", "SPLINE")
ANY_LINES = (
    "CLIPPING",
    "CLIPPING_DEPTH",
    "CLIP_PLANES",
    "CLIP_REGION",
    "EDGES",
    "WIDE_LINES",
    "LINE_ENDS",
    "VALUES_STORED",
    "VALUES_COLOUR",
    "POINT_MASK",
    "STREAMLINE_MASK",
)
NEAREST = (*ANY_LINES, "GATHER_SLICES")
COLOURS = ("TABLE_LOGARITHM", *(mode.feature for mode in SHADERS.values() if mode.reads != "colours"))
SUMS = (*NEAREST, *COLOURS, "PAINT_ALPHA", "PAINT_LIGHT")
ALWAYS = ("CLIPPING", "CLIPPING_DEPTH", "DIRECTION", "EDGES", "PAINT_ALPHA", "PAINT_LIGHT")
"""Switches that a page never has off, where a stage knows them."""
STAGES: dict[str, tuple[str, ...]] = {
    "page/decode.vert": ANY_FIBLETS,
    "page/none.frag": (),
    "page/segment.vert": NEAREST,
    "page/segment.frag": NEAREST,
    "page/sum.frag": SUMS,
    "page/screen.vert": (),
    "page/tile_mask.frag": (),
    "page/far_tiles.frag": (),
    "page/tiles.vert": (),
    "page/resolve.frag": COLOURS,
    "page/through.frag": COLOURS,
    "page/mixed.frag": (),
    "page/visible_edges.frag": (),
    "effects/picture/antialias_coverage.frag": (),
    "page/copy.frag": (),
    "page/background.frag": (),
    "page/surface.vert": (),
    "page/surface.frag": ("TABLE_LOGARITHM",),
    "page/image.vert": (),
    "page/image.frag": (),
}
BLOCKS = ("Frame", "Coding", "Rotations", "ClipPlanes", "Rays")
PRECISION = "".join(f"precision highp {kind};\n" for kind in ("float", "int", "sampler2D", "usampler2D"))


def page_shader(name: str, features: tuple[str, ...]) -> str:
    """Return a stage in GLSL ES, without comments."""
    text = assemble(name, features, version=300, replaced=REPLACED)
    text = re.sub(r"/\*.*?\*/", "", re.sub(r"//[^\n]*", "", text), flags=re.DOTALL)
    head, _, body = text.partition("\n")
    assert head == "#version 300", head
    lines = [re.sub(r"[ \t]+", " ", line).strip() for line in body.splitlines()]
    body = "\n".join(_tight(line) for line in lines if line)
    switches = {feature: feature in features for feature in FEATURES if feature in ALWAYS or feature not in features}
    return shrunk(f"#version 300 es\n{PRECISION}{body}\n", switches)


def _tight(line: str) -> str:
    """Leave blanks out beside signs; a line of the preprocessor keeps its own."""
    if line.startswith("#"):
        return line
    line = re.sub(r" ?([*/=<>{}();,?:&|!%^]) ?", r"\1", line)
    return re.sub(r"(?<![+-]) ?([+-]) ?(?![+-])", r"\1", line)  # but not where it would make a `--`


def _client_names() -> set[str]:
    """Return all names in the client's own source, including names of uniforms and of changed text."""
    source = "".join(path.read_text(encoding="utf-8") for path in sorted(CLIENT.glob("*.ts")))
    return {
        *re.findall(r"[A-Za-z_]\w*", source),
        *BLOCKS,
        *(f"o{i}" for i in range(15)),
        *(f"sums{i}" for i in range(4)),
    }


def everything() -> dict[str, Any]:
    """Return all that a page needs of the package."""
    blocks = {}
    for name in BLOCKS:
        struct = find_struct(name)
        blocks[name] = {"bytes": struct.nbytes, "fields": {field: struct.offset(field) for field in struct.fields}}
    texts = {name: page_shader(name, features) for name, features in STAGES.items()}
    lines, shaders = pieces(renamed(texts, _client_names()))
    return {
        "lines": "\n".join(lines),
        "shaders": shaders,
        "blocks": blocks,
        "rotations": base64.b64encode(direction_codebook.packed().astype("<u4").tobytes()).decode(),
        "rotation_scales": direction_codebook.packed_scales().tolist(),
        "fields": {f.name: [f.word, f.shift, f.width] for f in layout.FIELDS.values()},
        "page_bits": layout.PAGE_BITS,
    }
