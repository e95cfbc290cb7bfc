"""Progressive refinement: while nothing changes, a renderer's picture becomes the mean of many samples a pixel.

Each sample is a picture of its own, whose camera's window is shifted by a part of a pixel
(`pvfiblets.engine.effects.sample_positions`); so all that is drawn is sampled, VTK's own actors too, after all effects
on the picture and before what lies over it. A frame is one of three:

- *plain*: of the camera as it is. The first after each change, and all while the camera moves.
- *sample*: of the shifted camera, added to those before. The first is asked for (`Refinement.due`); after it any frame
  is one, until there are enough.
- *mean*: of the camera as it is, in whose place the mean of the samples is shown.

The last frame is of the camera as it is: the last sample, or a frame of the mean after it, such as where lines are
thinner in samples. So G-buffers and depths are
in the end those of the picture without refinement. Until then `pvfiblets.mappers.frames.shifted_cameras` knows better.

Samples of lines are drawn at once where that can be, as layers of the lines that they show
(`pvfiblets.engine.fiblets.sample_layers`). Samples of all else, such as meshes, are drawn before, one after the other,
in *held* frames, of the camera as it is.

A picture that ``vtkWindowToImageFilter`` puts together of tiles gets all samples of a tile in the tile's one frame.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Hashable, Iterable, Iterator
from enum import Enum, auto
from typing import TYPE_CHECKING, Any

from pvfiblets.engine.effects.antialias_accumulation import Accumulation
from pvfiblets.engine.effects.picture_passes import Attachment
from pvfiblets.engine.effects.sample_positions import sample_positions
from pvfiblets.mappers.frames.shifted_cameras import exact_wanted, note_depths, note_sample, shift, shifted_copy
from pvfiblets.mappers.frames.windows import Slot

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

__all__ = ["SAMPLES", "SHOWN_FROM", "Refinement"]

MIDDLE = (0.0, 0.0)

SAMPLES = 16
"""Samples that can be drawn in one frame."""

SHOWN_FROM = 8
"""Samples whose mean is better than one picture with smooth edges, which is shown until then to who sees each frame."""

_WHOLE, _TILE = "refinement", "refinement of a tile"


class _Frame(Enum):
    PLAIN = auto()
    SAMPLE = auto()
    MEAN = auto()
    HELD = auto()  # shows the plain frame before it; samples of others are drawn meanwhile
    ADDED = auto()  # a sample of a tile, or a layer of all samples: not shown


class Refinement:
    """The samples of one renderer's picture."""

    def __init__(self, samples: int, seconds: float | None = None) -> None:
        self.samples = samples  # of a pixel
        self.seconds = seconds  # how long they may be drawn for; there are fewer if that is over
        self.due = False  # whether the next frame is to be the first sample, if nothing has changed
        self.seen: Callable[[], bool] = lambda: False  # whether somebody looks at each frame, not at the last only
        self._frame = _Frame.PLAIN
        self._name = _WHOLE
        self.state: Hashable = None  # of the picture drawn last; None if it changes from frame to frame
        self._left: list[tuple[float, float]] = []
        self._taken = 0
        self._spent = self._begun = 0.0
        self._changed = self._unknown = True
        self._exact = True
        self._painted = False
        self._shares: Any = None
        self._others: Any = None
        self._back: Callable[[], None] | None = None

    @property
    def positions(self) -> tuple[tuple[float, float], ...]:
        """Where in a pixel the samples lie."""
        return sample_positions(self.samples)

    def same_as(self, other: Refinement) -> bool:
        """Say whether another one makes the same pictures."""
        return (self.samples, self.seconds) == (other.samples, other.seconds)

    @property
    def taken(self) -> int:
        """Samples in the picture that was drawn last; 0 for a plain one."""
        return 0 if self.plain else self._taken

    @property
    def remaining(self) -> int:
        """Samples that are not drawn yet."""
        return len(self._left)

    @property
    def few(self) -> bool:
        """Whether the picture that was drawn last would be better without its samples."""
        return bool(self._left) and (self._frame is _Frame.HELD or 0 < self.taken < SHOWN_FROM)

    def unfinished(self, state: Hashable) -> bool:
        """Say whether more frames are wanted of a state, of which one has been drawn."""
        return state is not None and state == self.state and (bool(self._left) or not self._exact)

    def forget(self) -> None:
        """Begin anew with the next frame."""
        self.state = None

    def sample_camera(self, renderer: vtkRenderer) -> Any:
        """Return a copy of a renderer's camera, shifted as for the next sample of an unfinished picture; None if none.

        Who draws with it beforehand says by `spend` how long that took.
        """
        if not self._left or self._over or exact_wanted(renderer):
            return None
        return shifted_copy(renderer.GetActiveCamera(), _tile(renderer), self._left[0])

    def spend(self, seconds: float) -> None:
        """Count time that samples took outside of frames."""
        self._spent += seconds

    @property
    def _over(self) -> bool:
        """Whether samples have been drawn for as long as they may."""
        return self.seconds is not None and self._spent >= self.seconds and self._taken > 0

    # Steps of a frame

    def start(self, renderer: vtkRenderer, state: Hashable, *, layered: bool = False, held: bool = False) -> None:
        """Decide what the frame is that a renderer is about to draw, and shift its camera for a sample.

        `layered`, `held`: the next one is, if it is not plain.
        """
        due, self.due = self.due, False
        self._name, self._painted, self._begun = _WHOLE, False, time.perf_counter()
        self._unknown = state is None
        self._changed = state is None or state != self.state
        self._frame = _Frame.PLAIN
        if self._changed:
            self._taken, self._spent = 0, 0.0
            # What changes whenever a sample is to be drawn never comes to rest.
            self._left = [] if due or state is None else list(self.positions)
            return
        if self._over:
            self._left = []
        if self._left and (due or self._taken) and not exact_wanted(renderer):
            self._frame = _Frame.ADDED if layered else _Frame.HELD if held else _Frame.SAMPLE
            if layered:
                self._left = []
            elif not held:
                self._shift(renderer, self._left[0])
        elif self._taken >= (SHOWN_FROM if self._left else 1):
            self._frame = _Frame.MEAN
        note_sample(renderer, begun=not self.plain)

    @property
    def untaken(self) -> bool:
        """Whether the picture lacks all of its samples, and they are as many as are drawn at once."""
        return bool(self._left) and not self._taken and self.samples == SAMPLES and self.seconds is None

    @property
    def layered(self) -> bool:
        """Whether the frame is to show all samples at once."""
        return self._frame is _Frame.ADDED

    @property
    def held(self) -> bool:
        """Whether samples of others are to be drawn within the frame."""
        return self._frame is _Frame.HELD

    def other_frames(self, renderer: vtkRenderer, positions: Iterable[tuple[float, float]]) -> Iterator[None]:
        """Yield for each of some samples of others, with the camera shifted."""
        self._frame = _Frame.ADDED
        note_sample(renderer, begun=True)
        try:
            for position in positions:
                self._shift(renderer, position)
                try:
                    yield
                finally:
                    self.put_back()
        finally:
            self._frame = _Frame.HELD
            note_sample(renderer, begun=False)

    def layer_frames(self, layers: Iterable[Any]) -> Generator[Any, None, None]:
        """Yield the layers of all samples (`pvfiblets.engine.fiblets.sample_layers`), each to be drawn as it is."""
        try:
            for layer in layers:
                self._shares, self._others = layer.shares, layer.others
                yield layer
            self._frame, self._taken = _Frame.MEAN, self.samples
        finally:
            self._shares = self._others = None
            if self._frame is _Frame.ADDED:
                self._frame = _Frame.PLAIN
        self._spent += time.perf_counter() - self._begun

    def draw_singly(self) -> None:
        """Begin anew, with one sample after the other."""
        self._left, self._taken = list(self.positions), 0

    def other_tile_frames(self, renderer: vtkRenderer) -> Iterator[None]:
        """Yield for each sample of a tile but that which the renderer is about to draw, with the camera shifted."""
        self._name, self._painted = _TILE, False
        if min(_tile(renderer)) < 1:  # the renderer has no part in this tile
            self._frame = _Frame.PLAIN
            return
        last = int(self.positions[-1] == MIDDLE)
        for position in self.positions[: len(self.positions) - last]:
            self._frame = _Frame.ADDED
            self._shift(renderer, position)
            try:
                yield
            finally:
                self.put_back()
        self._frame = _Frame.SAMPLE if last else _Frame.MEAN

    def _shift(self, renderer: vtkRenderer, position: tuple[float, float]) -> None:
        self._back = shift(renderer.GetActiveCamera(), _tile(renderer), position)

    def put_back(self) -> None:
        """Put the camera back: what lies over the picture is drawn where it belongs."""
        back, self._back = self._back, None
        if back is not None:
            back()

    @property
    def plain(self) -> bool:
        """Whether the frame is the picture, not one of many or behind their mean."""
        return self._frame in (_Frame.PLAIN, _Frame.HELD)

    @property
    def is_sample(self) -> bool:
        """Whether the frame is one sample, or a layer of all samples."""
        return self._frame in (_Frame.SAMPLE, _Frame.ADDED)

    @property
    def idle(self) -> bool:
        """Whether the frame stays as it is drawn, and nothing of it is taken."""
        return self._frame is _Frame.PLAIN and not (self._changed and self._left and self.seen())

    def paint(
        self, ctx: Any, slot: Slot, colour: Attachment, viewport: tuple[int, int, int, int], *, alike: bool
    ) -> None:
        """Take the picture that has been drawn, and draw what is to be seen instead."""
        if self._name == _WHOLE and _TILE in slot.effects:
            slot.drop_effect(_TILE)
        if self._name not in slot.effects:
            slot.effects[self._name] = Accumulation, Accumulation(ctx)
        sums: Accumulation = slot.effects[self._name][1]
        if self._frame is _Frame.PLAIN:
            sums.keep(colour, viewport, alike=alike)
            return
        if self._frame is _Frame.HELD:
            if sums.kept:
                sums.show_kept(colour, viewport)
            return
        if self._frame is not _Frame.MEAN:
            if not (self._painted if self._name == _TILE or self._shares is not None else self._taken):
                sums.restart()
            if self._others is not None:
                sums.begin(self._others)
            sums.add(colour, viewport, self._shares, alike=alike)
            self._painted = True
        if self._frame is _Frame.SAMPLE and sums.kept and sums.samples < min(SHOWN_FROM, self.samples):
            sums.show_kept(colour, viewport)
        elif self._frame is not _Frame.ADDED and sums.samples:  # none are left in a window that has been made anew
            sums.show(colour, viewport)
            sums.forget_kept()

    def end(self, renderer: vtkRenderer, state: Hashable, *, widened: bool, complete: bool = False) -> None:
        """Note what has been drawn; `complete`: a frame that had no state at its start may have one now."""
        self.put_back()
        note_sample(renderer, begun=False)
        self._exact = True
        if self._frame is _Frame.SAMPLE and self._name == _WHOLE:
            self._exact = self._left[0] == MIDDLE and not widened
            # A sample that nothing came of will not come another time.
            self._left = self._left[1:] if self._painted else []
            self._taken += self._painted
            self._spent += time.perf_counter() - self._begun
        if complete and self._unknown and state is not None:
            self._left = list(self.positions)
        note_depths(renderer, exact=self._exact)
        self.state = state


def _tile(renderer: vtkRenderer) -> tuple[int, int]:
    """Return width and height, in pixels, of what the window shows of a renderer."""
    width, height, x, y = [0], [0], [0], [0]
    renderer.GetTiledSizeAndOrigin(width, height, x, y)
    return width[0], height[0]
