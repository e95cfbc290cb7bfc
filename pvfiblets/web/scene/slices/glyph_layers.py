"""Glyphs of an image of slices: peaks, tensors, spherical harmonics and fixels, as settings of its layer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pvfiblets.slices.glyphs import TENSORS
from pvfiblets.slices.spherical_harmonics import BASES
from pvfiblets.web.scene.properties import Choices, Property

GLYPHS, UNDER, VECTORS = "glyphs", "image_under", "vectors"
_SIZE, _BASIS, _TENSOR = "glyph_size", "glyph_basis", "glyph_tensor"
_BY_NUMBERS, _LONG = "glyph_colour", "glyph_length"


def _kinds(image: Any) -> Choices:
    """Return the kinds of glyphs that fit an image's numbers per voxel."""
    n = image.n_volumes
    found: list[tuple[Any, str]] = [(None, "none")]
    if image.fixels is not None:
        return [*found, ("fixels", "fixels, as lines")]
    found += [("peaks", "peaks, as lines")] if n % 3 == 0 else []
    found += [("tensor", "tensors, as ellipsoids")] if n == 6 else []
    even = {(degree + 1) * (degree + 2) // 2 for degree in range(2, 33, 2)}
    return [*found, ("sh", "spherical harmonics, as lobes")] if n in even else found


def _numbers_of_fixels(image: Any) -> Choices:
    """Return by what fixels can be coloured, or be as long as."""
    named = None if image.fixels is None else image.fixels.shown
    return [(None, "none")] if named is None else [(None, "none"), (named, named)]


def _when(*kinds: str) -> Any:
    return lambda settings: settings[GLYPHS] in kinds


ROWS = (
    Property.own(GLYPHS, "choice", "Glyphs", "Show each voxel's directions by shapes.", "Glyphs", choices=_kinds),
    Property.own(_SIZE, "number", "Size", "Of the greatest, in voxels.", "Glyphs", 1.0, limits=(0.1, 10.0),
                 matters=lambda settings: settings[GLYPHS] is not None),
    Property.own(_BASIS, "choice", "Basis", "Of the harmonics; all but the first as dipy names them.", "Glyphs",
                 "mrtrix", choices=[(one, one.replace("_", ", ")) for one in BASES], matters=_when("sh")),
    Property.own(_TENSOR, "choice", "Order", "Of the six parts of a tensor, by program.", "Glyphs", "mrtrix",
                 choices=[(one, one) for one in TENSORS], matters=_when("tensor")),
    Property.own(_BY_NUMBERS, "choice", "Coloured by", "Numbers of fixels; none: their direction.", "Glyphs",
                 choices=_numbers_of_fixels, matters=_when("fixels")),
    Property.own(_LONG, "choice", "As long as", "Numbers of fixels; none: all alike.", "Glyphs",
                 choices=_numbers_of_fixels, matters=_when("fixels")),
    Property.own(UNDER, "bool", "Image too", "Show the numbers of the image under them.", "Glyphs", False,
                 matters=lambda settings: settings[GLYPHS] is not None),
)  # fmt: skip
"""Rows of the page."""


def covers(settings: Mapping[str, Any]) -> bool:
    """Whether glyphs are shown in the place of the image's numbers."""
    return settings[GLYPHS] is not None and not settings[UNDER]


def arguments(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return arguments of ``slices.add_glyphs``."""
    found = {"kind": settings[GLYPHS], "size": settings[_SIZE]}
    own = {"sh": {"basis": settings[_BASIS]}, "tensor": {"tensor": settings[_TENSOR]}}
    if settings[VECTORS] != "scanner":
        own["peaks"] = {"vectors": settings[VECTORS]}
    if settings[GLYPHS] == "fixels":
        by, long = settings[_BY_NUMBERS], settings[_LONG]
        own["fixels"] = {name: value for name, value in (("scalars", by), ("length", long)) if value is not None}
        if by is not None:
            own["fixels"] |= {"cmap": settings["cmap"], "clim": settings["clim"]}
    return found | own.get(settings[GLYPHS], {})


class GlyphLayers:
    """The glyphs of a stack of slices, kept in step with the layers that they are of."""

    def __init__(self) -> None:
        self._made: dict[int, tuple[dict[str, Any], Any]] = {}  # by the layer of the stack

    def become(self, stack: Any, image: Any, data: Any, settings: Mapping[str, Any], visible: bool) -> None:
        """Show an image's glyphs as settings say."""
        wanted = arguments(settings) if settings[GLYPHS] is not None else None
        before, glyphs = self._made.get(id(image), (None, None))
        if glyphs is not None and (wanted is None or {**wanted, "size": 0} != {**(before or {}), "size": 0}):
            self.remove(stack, image)
            glyphs = None
        if wanted is None:
            return
        if glyphs is None:
            glyphs = stack.add_glyphs(data, **wanted)
        elif wanted != before:
            glyphs.size = wanted["size"]
        glyphs.visible = visible
        self._made[id(image)] = wanted, glyphs

    def remove(self, stack: Any, image: Any) -> None:
        """Take an image's glyphs away; there may be none."""
        _, glyphs = self._made.pop(id(image), (None, None))
        if glyphs is not None:
            stack.remove_glyphs(glyphs)

    def forget(self) -> None:
        """Know of none any more: their stack is gone."""
        self._made.clear()
