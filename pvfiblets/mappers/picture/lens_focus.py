"""Focus of a camera's lens: a fixed distance, or one that follows the nearest surface at a pixel."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from pvfiblets.engine.effects.depth_of_field import WIDEST, Focus, distance_of
from pvfiblets.engine.effects.picture import PictureEffects
from pvfiblets.engine.effects.projection import Projection
from pvfiblets.mappers.frames.scene import in_motion, pixel_scale, samples_per_pixel, to_array
from pvfiblets.support.real_numbers import is_number

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

FOLLOWED = ("cursor", "center")  # places in the picture whose depth may be the one in focus

APERTURE = 0.06  # default diameter of the lens, as a share of the visible height at the distance in focus

NEAR_CURSOR = 2  # search radius around the mouse, pixels: lines are thin

SETTLED = 1e-3  # relative error at which a moving focus counts as arrived

LONGEST = 0.1  # seconds that count as passed at most: a focus that has rested starts slowly, too


@dataclass(frozen=True)
class DepthOfField:
    """The focus of a lens, and the blur around it."""

    # mm from the viewer's plane; None for the camera's focal point; `'cursor'` for the nearest surface under the mouse,
    # or `'center'` for the nearest in the middle, or the last one found
    focal_distance: float | str | None = None
    # mm: diameter of the lens. `APERTURE` of the height that is seen at the distance in focus by default.
    aperture: float | None = None
    darkening: float = 0.0  # 0 to 1: share of the light that things with the greatest blur lose
    max_blur: float = 16.0  # pixels of the window, 1 to `WIDEST`: the greatest radius of a blurred point
    smooth: float = 0.0  # seconds in which a focus that follows comes 63 % of the way; 0 for at once

    def __post_init__(self) -> None:
        focal = self.focal_distance
        if not (focal is None or focal in FOLLOWED or (is_number(focal) and float(focal) > 0.0)):
            raise ValueError(
                f"focal_distance is {focal!r}; give a number of mm above 0, None for the camera's focal point, "
                f"or one of {FOLLOWED}"
            )
        if self.aperture is not None and not (is_number(self.aperture) and self.aperture >= 0.0):
            raise ValueError(f"aperture is {self.aperture!r}; give a number of mm, 0 or more, or None")
        if not (is_number(self.darkening) and 0.0 <= self.darkening <= 1.0):
            raise ValueError(f"darkening is {self.darkening!r}; give a number from 0 to 1")
        if not (is_number(self.max_blur) and 1.0 <= self.max_blur <= WIDEST):
            raise ValueError(f"max_blur is {self.max_blur!r}; give a number of pixels from 1 to {WIDEST:g}")
        if not (is_number(self.smooth) and self.smooth >= 0.0):
            raise ValueError(f"smooth is {self.smooth!r}; give a number of seconds, 0 or more")


class Focusing:
    """The lens of one renderer: where its focus is, and on its way to."""

    def __init__(self) -> None:
        self.distance: float | None = None  # mm, in focus in the last picture
        self.clock: Callable[[], float] = time.monotonic  # tells seconds
        self._aim: float | None = None
        self._moved = 0.0

    def forget(self) -> None:
        """Start anew, as if nothing had been seen."""
        self.distance = self._aim = None

    @property
    def settled(self) -> bool:
        """Whether a focus that follows has arrived: if not, another picture would show it nearer to where it goes."""
        if self.distance is None or self._aim is None:
            return True
        return abs(self.distance - self._aim) <= SETTLED * self._aim

    def focus(
        self,
        wanted: DepthOfField,
        renderer: vtkRenderer,
        effects: PictureEffects,
        lens: Projection,
        *,
        held: bool = False,
    ) -> Focus:
        """Return what the lens is set to for a picture that has just been copied."""
        viewport = (0, 0, *lens.size)
        samples = samples_per_pixel(renderer, viewport)
        place = wanted.focal_distance
        if isinstance(place, str) and not held:
            wait = self._aim is None or not in_motion(renderer)
            self._follow(_seen_at(place, renderer, effects, lens, samples, wait=wait), wanted.smooth)
        elif place is not None and not isinstance(place, str):
            self.distance = float(place)
        if place is None or self.distance is None:  # nothing has been seen there so far
            self.distance = float(renderer.GetActiveCamera().GetDistance())
        aperture = wanted.aperture
        if aperture is None:
            height = renderer.GetSize()[1] * samples
            aperture = APERTURE * height / lens.pixels_per_mm(self.distance)
        blur = float(wanted.max_blur) * pixel_scale(renderer, viewport)
        return Focus(self.distance, float(aperture), blur, float(wanted.darkening))

    def _follow(self, seen: float | None, smooth: float) -> None:
        """Move the focus towards the current surface; None continues to the last one."""
        now = self.clock()
        passed, self._moved = now - self._moved, now
        if seen is not None:
            self._aim = seen
        if self._aim is None:
            return
        if self.distance is None or smooth == 0.0:
            self.distance = self._aim
            return
        # In the logarithm, so that the way from near to far is as long as the way back.
        left = math.log(self.distance / self._aim) * math.exp(-min(passed, LONGEST) / smooth)
        self.distance = self._aim * math.exp(left)
        if self.settled:
            self.distance = self._aim


def lens_of(renderer: vtkRenderer, size: tuple[int, int]) -> Projection:
    """Return the camera's lens for a picture of some pixels, stereo eye and tile included."""
    aspect = renderer.GetTiledAspectRatio()
    return Projection(size, to_array(renderer.GetActiveCamera().GetProjectionTransformMatrix(aspect, -1.0, 1.0)))


def _seen_at(
    place: str, renderer: vtkRenderer, effects: PictureEffects, lens: Projection, samples: float, *, wait: bool
) -> float | None:
    """Return the distance (mm) of the nearest surface at a pixel; None over the background, and in tiles."""
    # Without waiting for the GPU, it is that of a picture before; None if nothing new is known of any.
    window = renderer.GetRenderWindow()
    if tuple(window.GetTileScale()) != (1, 1):
        return None
    if place == "center":
        x, y = (side // 2 for side in lens.size)
    else:
        interactor = window.GetInteractor()
        if interactor is None:
            return None
        mouse, origin = interactor.GetEventPosition(), renderer.GetOrigin()
        x, y = (int((at - start + 0.5) * samples) for at, start in zip(mouse, origin, strict=True))
        if not (0 <= x < lens.size[0] and 0 <= y < lens.size[1]):
            return None
    around = int(NEAR_CURSOR * samples)
    rectangle = x - around, y - around, 2 * around + 1, 2 * around + 1
    if wait:
        depths = effects.depths(rectangle)
    elif (came := effects.depths_later(rectangle, lens)) is None:
        return None
    else:
        lens, depths = came
    nearest = float(depths.min(initial=1.0))
    return distance_of(lens, nearest) if nearest < 1.0 else None
