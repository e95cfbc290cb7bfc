"""Colours by value as textures: those of a place, and those of a step between two values."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ...volumes.raycast_options import LARGEST
from ...volumes.steepness import DEEP, KINKS, PARTS, allowed_bends, largest_bend
from ..gl.bindings import VOLUMES

if TYPE_CHECKING:
    from ...volumes.raycast_options import RaycastOptions
    from ...volumes.transfer import Transfer
    from ...volumes.volume import RaycastVolume

SIZE = 1024  # entries of colours by value: opacities are linear between those of the user, extinctions are not


class TransferTextures:
    """The tables of one volume (``shaders/volumes/light.glsl``)."""

    def __init__(self, ctx: moderngl.Context, volume: RaycastVolume) -> None:
        self._ctx, self._volume = ctx, volume
        self._made_for: object = None
        self._textures: dict[str, moderngl.Texture] = {}
        self._numbers: dict[str, float | tuple[float, float]] = {}
        # whether there are values between which not even parts of a step may be looked up: stretches are halved there
        self.finer = self.exact = False  # whether steps are taken in parts where values bend

    def make(self, casting: RaycastOptions, step: float) -> None:
        """Bring them up to date for steps of some mm."""
        transfer = casting.transfer if casting.mode == "composite" else None
        adaptive = casting.integrator == "adaptive"
        beforehand = step if casting.integrator == "preintegrated" or adaptive else None
        key = transfer, beforehand, adaptive, casting.low, casting.high
        if self._made_for == key:
            return
        self.release()
        if transfer is not None:
            values = np.linspace(*transfer.clim, max(SIZE, len(transfer.table)))
            medium = np.concatenate([transfer.colour(values), transfer.extinction(values)[:, None]], axis=1)
            self._textures["colours"] = self._texture(medium[None])
            if adaptive:
                self._allow(transfer, step, casting.low, casting.high)
            if beforehand is not None:
                lengths = [beforehand, *([beforehand / PARTS] if self.finer else [])]
                rows = [transfer.preintegrated(length).transpose(1, 0, 2) for length in lengths]
                self._textures["segments"] = self._texture(np.concatenate(rows))
            if self.exact:
                media, places = transfer.media()
                self._numbers["places_per_entry"] = float(places)
                self._textures["media"] = self._texture(media)
        self._made_for = key

    def _allow(self, transfer: Transfer, step: float, low: float, high: float) -> None:
        """Find what rays must do where values bend, or where a look-up is off; do no more than this volume needs."""
        allowed, bend = allowed_bends(transfer, step, low, high), self._bends_in(step)
        there = self._met(transfer, len(allowed))
        least = float(allowed[there, there].min())
        deep = step * transfer.largest_extinction > DEEP
        self.finer = deep or bend > KINKS * least
        if not self.finer:
            return
        in_parts = allowed_bends(transfer, step / PARTS, low, high)
        self.exact = deep or least < 0.0 or bend / PARTS > KINKS * float(in_parts[there, there].min())
        self._textures["allowed_bends"] = self._numbers_texture(np.concatenate([allowed.T, in_parts.T]))
        ends = np.clip(transfer.opaque_range, -LARGEST, LARGEST).tolist()
        self._numbers |= {"all_bends": transfer.clim[1] - transfer.clim[0], "opaque_values": (ends[0], ends[1])}

    def _met(self, transfer: Transfer, count: int) -> slice:
        """Return which of so many intervals of colours have values of the volume."""
        ends = (np.array(self._volume.value_range) - transfer.clim[0]) / (transfer.clim[1] - transfer.clim[0]) * count
        first, last = np.clip(np.floor(ends), 0, count - 1).astype(int)
        return slice(int(first), int(last) + 1)

    def _bends_in(self, step: float) -> float:
        """Return by how much, at the most, the change of values changes from one step to the next, across an edge."""
        return step / float(self._volume.spacing.min()) * self._largest_bend

    @cached_property
    def _largest_bend(self) -> float:
        return largest_bend(self._volume)

    def _texture(self, rows: npt.NDArray[Any]) -> moderngl.Texture:
        height, width = rows.shape[:2]
        texture = self._ctx.texture((width, height), 4, np.ascontiguousarray(rows, "<f4"), dtype="f4")
        texture.filter = moderngl.LINEAR, moderngl.LINEAR
        texture.repeat_x = texture.repeat_y = False
        return texture

    def _numbers_texture(self, rows: npt.NDArray[Any]) -> moderngl.Texture:
        texture = self._ctx.texture(rows.shape[::-1], 1, np.ascontiguousarray(rows, "<f4"), dtype="f4")
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        texture.repeat_x = texture.repeat_y = False
        return texture

    def bind(self, program: moderngl.Program) -> None:
        """Bind all, and tell a program where they are."""
        for name, texture in self._textures.items():
            if name in program:
                texture.use(VOLUMES[name])
                program[name] = VOLUMES[name]
        for name, number in self._numbers.items():
            if name in program:
                program[name] = number

    @property
    def sizes(self) -> dict[str, int]:
        """Bytes by name."""
        return {
            name: 4 * texture.components * texture.width * texture.height for name, texture in self._textures.items()
        }

    def release(self) -> None:
        """Give everything back; twice is harmless."""
        for texture in self._textures.values():
            texture.release()
        self._textures.clear()
        self._numbers.clear()
        self.finer = self.exact = False
        self._made_for = None
