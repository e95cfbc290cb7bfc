"""`SparsePicture`: the pixels of a G-buffer that show something, in memory, to be sent and put together elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...gbuffer import EMPTY, RELIEF, GBuffer

if TYPE_CHECKING:
    import moderngl

Array = npt.NDArray[Any]

_KINDS = {"u": "<u4", "f": "<f4"}


@dataclass(frozen=True)
class Cost:
    """The cost of one step towards a picture."""

    step: str
    seconds: float
    bytes: int  # of the picture that came of it


@dataclass(frozen=True)
class SparsePicture:
    """Pixels of a picture."""

    size: tuple[int, int]  # width and height of all of it
    order: int  # of the part that it shows, the lowest where it shows several
    pixels: npt.NDArray[np.uint32]  # `(n,)` uint32: row times width plus column, each once
    # `(n,)` or `(n, 2)`: what the G-buffer's textures hold there, by their names. `owner` is the order of the part that
    # a pixel is of.
    textures: dict[str, Array]
    relief: str | None = None  # what `across` is
    costs: tuple[Cost, ...] = field(default=(), compare=False)  # what has gone into it

    @property
    def nbytes(self) -> int:
        """Bytes that are sent."""
        return self.pixels.nbytes + sum(array.nbytes for array in self.textures.values())

    def __sizeof__(self) -> int:
        return object.__sizeof__(self) + self.nbytes  # dask asks where to merge two


def read_picture(drawn: GBuffer, order: int) -> SparsePicture:
    """Read the pixels of a part's picture that show something."""
    depth = _read(drawn.depth, "<u4", 1)
    pixels = np.flatnonzero(depth != EMPTY).astype(np.uint32)
    textures = {"depth": depth[pixels], "owner": np.full(len(pixels), order, np.uint32)}
    textures["ids"] = _read(drawn.ids, "<u4", 2)[pixels]
    textures["position"] = _read(drawn.position, "<f4", 2)[pixels]
    if drawn.across is not None and drawn.relief is not None:
        textures["across"] = _read(drawn.across, f"<{RELIEF[drawn.relief]}", 1)[pixels]
    if drawn.edges is not None:
        textures["edges"] = _read(drawn.edges, "<u4", 1)[pixels]
    return SparsePicture(drawn.size, order, pixels, textures, drawn.relief)


def nearer(one: SparsePicture, other: SparsePicture) -> SparsePicture:
    """Put two pictures together: of each pixel the nearer, of two at one depth that of the lower order."""
    # Where the first picture has each pixel: sorting and searching would take ten times as long.
    place = np.full(one.size[0] * one.size[1], -1, np.int32)
    place[one.pixels] = np.arange(len(one.pixels), dtype=np.int32)
    there = place[other.pixels]
    fresh, shared = np.flatnonzero(there < 0), np.flatnonzero(there >= 0)
    before, after = _keys(one)[there[shared]], _keys(other)[shared]
    won = shared[after < before]
    textures = {}
    for name, array in one.textures.items():
        theirs = other.textures[name]
        whole = textures[name] = np.concatenate([array, theirs[fresh]])
        whole[there[won]] = theirs[won]
    pixels = np.concatenate([one.pixels, other.pixels[fresh]])
    order = min(one.order, other.order)
    return SparsePicture(one.size, order, pixels, textures, one.relief, one.costs + other.costs)


def _keys(picture: SparsePicture) -> npt.NDArray[np.uint64]:
    """Depth, and below it the part: the least is in front."""
    depth = picture.textures["depth"].astype(np.uint64)
    keys: npt.NDArray[np.uint64] = (depth << np.uint64(32)) | picture.textures["owner"]
    return keys


def write_picture(found: SparsePicture, target: GBuffer, *, adds: bool = False) -> None:
    """Fill a G-buffer of the same size and kind; with `adds`, nearer pixels in it stay, but for their owner.

    The other pixels are empty.
    """
    count = found.size[0] * found.size[1]
    shown: Any = slice(None)
    if adds:
        shown = found.textures["depth"] <= _read(target.depth, "<u4", 1)[found.pixels]
    for name, array in found.textures.items():
        texture = getattr(target, name)
        if adds and name != "owner":
            whole = _read(texture, array.dtype.str, 1 if array.ndim == 1 else array.shape[1]).copy()
        else:
            whole = np.full((count, *array.shape[1:]), EMPTY if name in ("depth", "owner") else 0, array.dtype)
        whole[found.pixels[shown]] = array[shown]
        texture.write(whole.tobytes())


def _read(texture: moderngl.Texture, dtype: str, components: int) -> Array:
    found = np.frombuffer(texture.read(alignment=1), dtype)
    return found if components == 1 else found.reshape(-1, components)
