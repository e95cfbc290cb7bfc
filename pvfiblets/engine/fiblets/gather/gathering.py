"""All lines of each pixel, added up: how many there are, and their colours, whole or in slices by distance.

The picture of a renderer holds the nearest line of each pixel. Here every line in view adds to the pixels that it takes
(``shaders/fiblets/gather``). What it adds are whole numbers: the sums are the same in whatever order lines are drawn,
and by whichever pipeline. There are two ways to look at them:

density
    One sum a pixel, of all lines: their number, and with colours their mean colour.
slices
    The nearest line of a pixel is in no sum; the others are in :data:`SLICES` sums by how far behind it they are. The
    slices grow with that distance, since lines near the nearest one show most. Lines of one slice are blended in
    no order; the slices are, one behind the other. This is layered weighted blending (after Friederichs, Eisemann and
    Eisemann, "Layered Weighted Blended Order-Independent Transparency", Graphics Interface 2021) with an exact first
    layer and, where all lines have the same opacity, an exact opacity of the whole: ``n`` lines of opacity ``a`` let
    ``(1 - a)^n`` through, whatever their order.

The compute pipeline adds in words of an image array, with atomics; the raster pipelines add by blending, in an
array of float32, which holds whole numbers up to 2^24 exactly. One pass over all fiblets in view makes all of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...errors import GPUMemoryError
from ...gl.bindings import GATHERING, SUM_IMAGES
from .paint import Paint, set_uniforms

if TYPE_CHECKING:
    from ...gbuffer import GBuffer
    from ...gl.moderngl_extras import GLExtras
    from ...gl.shaders import Programs
    from ...view import View

SLICES = 4  # sums of a pixel behind its nearest line; the shaders' three edges between them must agree

GROWTH = 2.5  # ratio of each slice's depth to the depth of the one before

Array = npt.NDArray[np.float64]


def slice_edges() -> tuple[float, ...]:
    """Return where slices end, from the nearest line, 0, to the far end of the data, 1; the last end is left out."""
    whole = GROWTH**SLICES - 1.0
    return tuple((GROWTH**k - 1.0) / whole for k in range(1, SLICES))


@dataclass(frozen=True)
class SliceDistances:
    """The distance along the view as a function of depth: ``(p + q c) / (r + s c)``, with c = 1 - window depth."""

    terms: tuple[float, float, float, float]  # p, q, r, s
    far: float  # distance of the far end of the data

    @classmethod
    def from_box(cls, view: View, low: npt.ArrayLike, high: npt.ArrayLike) -> SliceDistances:
        """Return them for a view of data between two corners in mm: farther points count as at the far end."""
        matrix = np.asarray(view.model_view_projection, np.float64)
        box = np.stack([np.asarray(low, np.float64), np.asarray(high, np.float64)], 1)
        corners = np.array([[box[0, i], box[1, j], box[2, k], 1.0] for i, j, k in np.ndindex(2, 2, 2)])
        z, w = matrix[2], matrix[3]
        square = float(w[:3] @ w[:3])
        if square > 0.0:  # z = a w + b, and the normalised depth is z / w = 1 - 2 c
            a = float(z[:3] @ w[:3]) / square
            b = float(z[3] - a * w[3])
            size = abs(b) or 1.0
            return cls((b / size, 0.0, (1.0 - a) / size, -2.0 / size), float((corners @ w).max()))
        size = float(np.linalg.norm(z[:3])) or 1.0
        return cls((w[3] / size, -2.0 * w[3] / size, 1.0, 0.0), float((corners @ z).max()) / size)


class Gathered:
    """The sums of a picture.

    Their texture has a layer for each slice. ``words`` are of 32 bits: of each pixel red, green, blue and weight, or
    the weight alone; else it is of float32 with these in its channels. Of words with colours it is four times as wide
    as the picture, or twice as wide and high, where that is too much.
    """

    def __init__(
        self, ctx: moderngl.Context, gl: GLExtras, size: tuple[int, int], slices: int, painted: bool, words: bool
    ) -> None:
        # slices: sums of a pixel; painted: colours beside numbers
        self.size, self.slices, self.painted, self.words = size, slices, painted, words
        self.shape = (1, 1)  # columns and rows of a pixel's words
        if words and painted:
            self.shape = (4, 1) if 4 * size[0] <= int(ctx.info["GL_MAX_TEXTURE_SIZE"]) else (2, 2)
        channels = 1 if words else 4
        self.nbytes = 4 * math.prod(size) * slices * math.prod(self.shape) * channels
        # rgba32ui, if there are several slices: depth keys of the nearest line, and of where each slice but the first
        # begins
        self.keys: moderngl.Texture | None = None
        self._key_target: moderngl.Framebuffer | None = None
        held: list[Any] = []
        try:
            if slices > 1:
                self.keys = ctx.texture(size, 4, dtype="u4")
                self.keys.filter = moderngl.NEAREST, moderngl.NEAREST
                held.append(self.keys)
                self._key_target = ctx.framebuffer([self.keys])
                held.append(self._key_target)
                self.nbytes += 16 * size[0] * size[1]
            shape, dtype = (self.shape[0] * size[0], self.shape[1] * size[1]), "u4" if words else "f4"
            self.texture = ctx.texture_array((*shape, slices), channels, dtype=dtype)
            self.texture.filter = moderngl.NEAREST, moderngl.NEAREST
            held.append(self.texture)
            # moderngl attaches whole textures: these hold the places.
            places = [ctx.renderbuffer(shape, channels, dtype=dtype) for _ in range(slices)]
            held += places
            self.framebuffer = ctx.framebuffer(places)
            for layer in range(slices):
                gl.attach_layer(self.framebuffer, self.texture, layer, layer)
            for place in places:
                place.release()
        except moderngl.Error as error:
            for thing in held:
                thing.release()
            width, height = size
            raise GPUMemoryError(f"no memory for {self.nbytes} bytes of sums of {width} x {height} pixels") from error


    def find_keys(self, ctx: moderngl.Context, programs: Programs, nearest: GBuffer, distances: SliceDistances) -> None:
        """Find where the slices of each pixel begin, if there are several."""
        if self._key_target is None:
            return
        program, array = programs.screen("fiblets/gather/slice_keys.frag")
        nearest.depth.use(GATHERING["nearest_depth"])
        set_uniforms(
            program,
            nearest_depth=GATHERING["nearest_depth"],
            slice_distances=distances.terms,
            slice_far=distances.far,
            slice_edges=slice_edges(),
        )
        ctx.enable_only(moderngl.NOTHING)
        self._key_target.use()
        array.render(moderngl.TRIANGLES, vertices=3)

    def clear(self, gl: GLExtras) -> None:
        """Empty the sums."""
        with gl.framebuffers_kept():
            for layer in range(self.slices):
                if self.words:
                    gl.clear_integers(self.framebuffer, (0,), layer)
                else:
                    gl.fill(self.framebuffer, layer, (0.0, 0.0, 0.0, 0.0))

    def read(self) -> npt.NDArray[np.float64]:
        """Return ``(slices, height, width, 4)`` red, green, blue and weight, the lowest row first."""
        width, height = self.size
        if not self.words:
            raw = np.frombuffer(self.texture.read(), "<f4").reshape(self.slices, height, width, 4)
            return raw.astype(np.float64)
        raw = np.frombuffer(self.texture.read(), "<u4").reshape(self.slices, *self.texture.size[1::-1])
        found = np.zeros((self.slices, height, width, 4))
        if not self.painted:
            found[..., 3] = raw
        else:
            for channel in range(4):
                columns, rows = self.shape
                found[..., channel] = raw[:, channel // columns :: rows, channel % columns :: columns]
        return found

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for thing in (self.framebuffer, self._key_target, self.keys, self.texture):
            if thing is not None:
                thing.release()
        self._key_target = self.keys = None


@dataclass(frozen=True)
class Gather:
    """Parameters of a pipeline's sums."""

    target: Gathered
    paint: Paint
    nearest: GBuffer  # the picture, which slices begin behind
    outside: moderngl.Texture | None = None  # depth keys of what hides lines, r32ui of the picture's size
    # picture of the part that adds its lines to sums of all: whose fiblets its `owner` numbers. The sums do not begin
    # at 0 then.
    own: GBuffer | None = None

    @property
    def owners(self) -> moderngl.Texture:
        """Texture with the nearest of the added fiblets."""
        return (self.nearest if self.own is None else self.own).owner

    @property
    def features(self) -> tuple[str, ...]:
        """Keys of :data:`pvfiblets.engine.gl.shaders.FEATURES`."""
        sliced = ("GATHER_SLICES",) if self.target.slices > 1 else ()
        outside = ("GATHER_OUTSIDE",) if self.outside is not None else ()
        return ("GATHER", *sliced, *outside, *self.paint.features)

    def bind(self, program: Any) -> None:
        """Bind what programs look at, and tell them where."""
        self.paint.bind(program)
        set_uniforms(program, word_shape=self.target.shape)
        sources = {f"nearest_{name}": getattr(self.nearest, name) for name in ("depth", "ids", "position")}
        sources |= {"nearest_owner": self.owners, "slice_keys": self.target.keys, "outside_depth": self.outside}
        for name, texture in sources.items():
            if texture is not None and name in program:
                texture.use(GATHERING[name])
                program[name] = GATHERING[name]

    def bind_images(self) -> None:
        """Bind what compute stages read and write."""
        self.target.texture.bind_to_image(SUM_IMAGES["gathered"], read=True, write=True)
        if self.target.keys is not None:
            self.target.keys.bind_to_image(SUM_IMAGES["slice_keys"], read=True, write=False)
            self.owners.bind_to_image(SUM_IMAGES["nearest_owner"], read=True, write=False)
