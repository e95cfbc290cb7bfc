"""Effects on the whole picture of a renderer: depth of field, tones, refinement, behind scalar bars and texts.

VTK draws opaque, translucent and volumetric props, and at last the overlay: scalar bars, texts. In each of these
turns a prop may draw, in the order of the renderer's props. `Picture` puts a prop of its own before the first during a
frame, a ``vtkContextActor``, which draws in the last of these turns only, and calls Python there: that is when the
picture is complete, its depths are in VTK's framebuffer, and the overlay is not drawn yet. Colours and depths are
read from the textures of whichever framebuffer VTK draws into, and the changed colours are drawn there; depths stay as
they are.

Refinement (`antialias_refinement.py`) takes the picture as smooth edges (`antialias_coverage.py`) and effects leave it.
Whoever reads a window's picture gets the finished one: all do that with ``vtkWindowToImageFilter``, PyVista's
``screenshot`` and ``image`` too. It gives each renderer a copy of its camera before, and VTK tells of that
(``ActiveCameraEvent``). Where an interactor must not render (``EnableRenderOff``), the window is a server's, whose
pictures follow the camera: it has them refined itself.

While nothing is changed, none of this exists.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Hashable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vtkmodules.vtkRenderingCore import vtkRenderer

from pvfiblets.engine.effects.picture import Attachment, PictureEffects
from pvfiblets.engine.effects.sample_positions import sample_squares
from pvfiblets.engine.effects.tone import Tone
from pvfiblets.engine.errors import EngineError
from pvfiblets.mappers.frames.idle_windows import finish, shown_pictures
from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import in_motion, items_of, lenses, partly_shown, streamed, weak
from pvfiblets.mappers.frames.scene_state import scene_state
from pvfiblets.mappers.frames.shifted_cameras import shifted
from pvfiblets.mappers.frames.windows import Slot, WindowContext, context_of, contexts_with, gl_viewport
from pvfiblets.mappers.picture.antialias_refinement import SAMPLES, Refinement
from pvfiblets.mappers.picture.lens_focus import FOLLOWED, DepthOfField, Focusing, lens_of
from pvfiblets.mappers.picture.overlays import Overlay
from pvfiblets.mappers.picture.picture_prop import COLOUR, DEPTH, PictureProp, attachment
from pvfiblets.mappers.picture.tiles import Margin, margin_of

if TYPE_CHECKING:
    from pvfiblets.engine.fiblets.sample_layers import OtherSamples

__all__ = ["DepthOfField", "Picture"]

_EVENTS = ("StartEvent", "EndEvent", "ActiveCameraEvent")

_COVERAGE = "coverage"
_OTHERS = "samples of others"

SIDE = 4  # a pixel has SIDE x SIDE squares, with one sample each

MOST_BYTES = 2**29
"""Limit of kept samples of others; above it, samples of the whole scene are drawn one after the other."""

PATIENCE = 0.2
"""Seconds for samples of others in one frame, so that a window answers."""

ANTIALIAS = ("off", _COVERAGE)  # methods of smoothing edges of lines


@dataclass(slots=True)
class _Job:
    """Samples that are drawn at once, part by part, between the frames of a resting picture."""

    state: Hashable
    lines: list[Any]    # actors, in the order in which they are drawn
    others: list[Any]   # all else that is shown
    sampled: int = 0    # samples of others
    steps: Generator[Any, None, None] | None = None   # shares of the work that is done, then layers
    share: float = 0.0

    @property
    def samples_others(self) -> bool:
        return bool(self.others) and self.sampled < SAMPLES

    @property
    def progress(self) -> float:
        """Share of all the work."""
        return (self.sampled / SAMPLES + self.share) / 2.0 if self.others else self.share


class Picture:
    """Effects on everything that a renderer draws.

    An exception while drawing cannot pass through VTK: it is stored, the picture stays as it was drawn, and
    `raise_pending` raises it.
    """

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = weak(renderer)
        self._address: str = renderer.GetAddressAsString("")
        self._tone = Tone()
        self._depth_of_field: DepthOfField | None = None
        self._prop: PictureProp | None = None
        self._ignore: Callable[[], None] = lambda: None
        self._overlay = Overlay()
        self._smoothing: Any = None
        self._margin: Margin | None = None
        self._shift = 0, 0
        self._inside = False
        self._refinement: Refinement | None = None
        self._error: BaseException | None = None
        self._untextured = weak(None)  # the render pass that does not draw into textures
        self.focusing = Focusing()
        self.drawn: Callable[[], None] | None = None  # called after each frame of a picture that is refined
        # says whether somebody asks for more frames of the picture while it rests
        self.paced: Callable[[], bool] = lambda: False
        self._job: _Job | None = None
        self.hurries = False  # whether the picture is finished before the window answers again
        self._lacks_memory = False
        self._fetched_in: Hashable = None  # a state in whose samples parts were fetched after all
        shown_pictures.add(self)

    @property
    def renderer(self) -> Any:
        """The renderer, or None once it is gone."""
        return self._renderer.Get()

    @property
    def tone(self) -> Tone:
        """Tone mapping and colour correction."""
        return self._tone

    @tone.setter
    def tone(self, tone: Tone) -> None:
        self._tone = tone
        self._hang()

    @property
    def depth_of_field(self) -> DepthOfField | None:
        """The focus; None for everything sharp."""
        return self._depth_of_field

    @depth_of_field.setter
    def depth_of_field(self, wanted: DepthOfField | None) -> None:
        self._depth_of_field = wanted
        if wanted is None or wanted.focal_distance not in FOLLOWED:
            self.focusing.forget()
        self._hang()

    @property
    def refinement(self) -> Refinement | None:
        """Samples of the picture at rest; None for one."""
        return self._refinement

    @refinement.setter
    def refinement(self, wanted: Refinement | None) -> None:
        self._refinement = wanted
        self._hang()

    @property
    def unfinished(self) -> bool:
        """Whether the scene is as it was drawn last, and its picture wants more samples, or parts of a set."""
        renderer = self.renderer
        if self._refinement is None or renderer is None or renderer.GetRenderWindow() is None:
            return False
        return self.fetching or self._refinement.unfinished(self._state(renderer))

    @property
    def progress(self) -> int:
        """Samples that have been drawn of the picture at rest."""
        assert self._refinement is not None
        job = self._job
        return self._refinement.taken if job is None else int(job.progress * self._refinement.samples)

    def draw_part(self) -> bool:
        """Draw a part of all samples at once, if that can be done; return whether there are more parts."""
        # Called between frames of a picture that is unfinished: the next frame shows what all parts together are.
        renderer, refinement = self.renderer, self._refinement
        assert refinement is not None
        state = self._state(renderer)
        lines, others = self._lines_at_once(renderer)
        if self._job is not None and not (lines and self._job.state == state):
            self._drop_job()
        if not lines:
            return False
        if self._job is None:
            self._job = _Job(state, lines, others)
        job = self._job
        if job.samples_others:
            return False
        if job.steps is None:
            mappers = [line.GetMapper() for line in lines]
            job.steps = mappers[0].sample_layers(renderer, mappers, self._other_samples(renderer) if others else None)
        if job.share < 1.0:
            renderer.GetRenderWindow().MakeCurrent()
            try:
                job.share = next(job.steps)
            except EngineError:
                self._lacks_memory = True
                self._drop_job()
                return False
            except Exception:
                self._drop_job()  # its steps are at their end, the picture is not
                raise
        if job.share < 1.0 and self.drawn is not None:
            self.drawn()
        return job.share < 1.0

    @property
    def needs_multisamples(self) -> bool:
        """Whether the next sample needs VTK's own samples of each pixel, or the overlay does."""
        refinement = self._refinement
        assert refinement is not None
        if refinement.samples < SAMPLES or refinement.remaining < 2 or self.draws_at_once():
            return True
        return self._smoothing is None or not self._smoothing.only_surfaces

    def draws_at_once(self) -> bool:
        """Whether the samples that the picture wants next are drawn at once."""
        return bool(self._lines_at_once(self.renderer)[0])

    @property
    def samples_others(self) -> bool:
        """Whether the next frame draws samples of others."""
        return self._job is not None and self._job.samples_others

    def _drop_job(self) -> None:
        job, self._job = self._job, None
        if job is not None and job.steps is not None:
            job.steps.close()
        if job is not None and job.others:
            self._drop(_OTHERS)

    @property
    def fetching(self) -> bool:
        """Whether a set has parts that are not drawn yet."""
        return any(engine.unfinished for engine in self._streamed)

    @property
    def _resident(self) -> bool:
        """Whether samples can be drawn without fetching parts."""
        return all(engine.resident for engine in self._streamed)

    @property
    def _streamed(self) -> list[Any]:
        """Return the engines of the scene that have parts of their sets at a time."""
        return [engine for engine in streamed.get(self._address, ()) if not engine.released]

    @property
    def antialias(self) -> str:
        """How lines are smoothed: ``'off'``, or ``'coverage'`` (`pvfiblets.mappers.picture.antialias_coverage`)."""
        return "off" if self._smoothing is None else "coverage"

    @antialias.setter
    def antialias(self, wanted: str) -> None:
        if wanted not in ANTIALIAS:
            raise ValueError(f"antialias is {wanted!r}; use one of {list(ANTIALIAS)}")
        if wanted == self.antialias or self.renderer is None:
            return
        if wanted == "off":
            self._smoothing.release()
            self._smoothing = None
            self._drop(_COVERAGE)
        else:
            from pvfiblets.mappers.picture.antialias_coverage import EdgeSmoothing

            self._smoothing = EdgeSmoothing(self.renderer)
        self._hang()

    @property
    def focal_distance(self) -> float | None:
        """Distance (mm) that was in focus in the last picture; None before the first, and without depth of field."""
        return self.focusing.distance if self._depth_of_field is not None else None

    @property
    def has_effects(self) -> bool:
        """Whether colours or focus are changed."""
        return self._tone.changes or self._depth_of_field is not None

    @property
    def settings(self) -> Hashable:
        """State of all effects; None if it changes from frame to frame."""
        focus = self._depth_of_field
        if focus is not None and (focus.focal_distance in FOLLOWED or not self.focusing.settled):
            return None
        return self._tone, focus, self.antialias, id(self._refinement)

    @property
    def on(self) -> bool:
        """Whether anything is changed."""
        return self.has_effects or self._refinement is not None or self._smoothing is not None

    def _drop(self, name: str) -> None:
        """Give back what an effect keeps on the GPU."""
        for context in contexts_with(self._prop) if self._prop is not None else []:
            slot = context.slot(self._prop)
            if name in slot.effects and context.alive:
                context.window.MakeCurrent()
                with context.foreign():
                    slot.drop_effect(name)

    # In the renderer

    def _hang(self) -> None:
        """Put the prop into the renderer, or take it out, as need be."""
        renderer = self.renderer
        if renderer is None:
            return
        if self.on and self._prop is None:
            self._prop = PictureProp()
            self._prop.hang(self)
            self._ignore = observe(renderer, _EVENTS, weakly(self._follow_frame, passing=True))
            self._prop.AddConsumer(renderer)
        elif not self.on:
            self.release()
        if self._refinement is not None:
            self._refinement.forget()
        renderer.Modified()

    def _follow_frame(self, _renderer: Any, event: str) -> None:
        steps = self.start, self.end, self.captured
        self.stored(steps[_EVENTS.index(event)])

    def _insert(self) -> None:
        """Put the prop before all others of the renderer, while it draws: users' lists of actors lack it."""
        if self._prop is None:  # a callback switched the picture off in a frame within this one
            return
        props = self.renderer.GetViewProps()
        if props.GetNumberOfItems() == 0:
            props.AddItem(self._prop)  # there is none to insert it before
        elif props.GetItemAsObject(0) is not self._prop:
            props.InsertItem(-1, self._prop)

    def release(self) -> None:
        """Leave the renderer and give everything on the GPU back; twice is harmless."""
        self._drop_job()
        if self._smoothing is not None:
            self._smoothing.release()
        lenses.pop(self._address, None)
        prop, self._prop = self._prop, None
        if prop is None:
            return
        renderer = self.renderer
        if renderer is not None:
            self._ignore()
            prop.RemoveConsumer(renderer)
            renderer.GetViewProps().RemoveItem(prop)
        for context in contexts_with(prop):
            context.release(prop)

    def raise_pending(self) -> None:
        """Raise the exception of the last draw, if there was one, once."""
        error, self._error = self._error, None
        try:
            if error is not None:
                raise error
        finally:
            del error  # held here it would keep itself, and VTK's objects in its frames, for Python's collector

    def explain(self) -> dict[str, Any]:
        """Return the cost of the effects: ``buffers``, name and bytes of each GPU buffer."""
        slots = [] if self._prop is None else [c.slot(self._prop) for c in contexts_with(self._prop)]
        kept = [("picture", slot.renderer) for slot in slots if slot.renderer is not None]
        kept += [(name, sums) for slot in slots for name, (_, sums) in slot.effects.items()]
        return {"buffers": [{"name": name, "bytes": effects.nbytes} for name, effects in kept]}

    # Drawing

    def start(self) -> None:
        """Get ready; called when the renderer is about to draw."""
        renderer = self.renderer
        if renderer is None or self._prop is None:
            return
        if renderer.GetSelector() is not None:
            return
        self._overlay.hold(renderer)
        if self._inside:
            self._begin()
            return
        refinement = self._refinement
        if refinement is not None and tuple(renderer.GetRenderWindow().GetTileScale()) == (1, 1):
            state, job = self._state(renderer), self._job
            ready = job is not None and job.state == state and job.share == 1.0
            if job is not None and job.state != state:
                self._drop_job()
            refinement.start(renderer, state, layered=ready, held=self.samples_others)
            if refinement.layered:
                self._draw_layers(renderer)
            elif refinement.held:
                self._draw_others(renderer)
        elif refinement is not None and _refinable(renderer) and _starts_empty(renderer):
            self._insert()
            for _ in refinement.other_tile_frames(renderer):
                self._draw_around(renderer)
                self._draw_inside(renderer)
            self._overlay.hold(renderer)
        if self._smoothing is not None or self.has_effects or (refinement is not None and not refinement.idle):
            self._insert()
        self._draw_around(renderer)
        self._begin()

    def _begin(self) -> None:
        """Make mappers record the inputs of effects in this frame: edges, and things without depth."""
        if self._depth_of_field is not None:
            lenses[self._address] = {}
        if self._smoothing is not None:
            refinement = self._refinement
            sample = refinement is not None and refinement.is_sample
            self._smoothing.begin(sample=sample, smooths=refinement is None or refinement.plain)

    def _lines_at_once(self, renderer: vtkRenderer) -> tuple[list[Any], list[Any]]:
        """Return actors whose samples are drawn at once next, and all else that is shown.

        None where samples are drawn one after the other.
        """
        refinement = self._refinement
        if refinement is None or not refinement.untaken or self._lacks_memory or not _starts_empty(renderer):
            return [], []
        if self._smoothing is None or self._depth_of_field is not None or renderer.GetPass() is not None:
            return [], []
        found: tuple[list[Any], list[Any]] = self._smoothing.at_once()
        return found

    def _draw_others(self, renderer: vtkRenderer) -> None:
        """Draw samples of others, each in a frame within the next one."""
        refinement, job = self._refinement, self._job
        assert refinement is not None
        assert job is not None
        self._insert()
        begun = time.perf_counter()
        with _only(renderer, [self._prop, *job.others]):
            for _ in refinement.other_frames(renderer, refinement.positions[job.sampled :]):
                self._draw_inside(renderer)
                job.sampled += 1
                waited = job.sampled % SIDE == 0 and time.perf_counter() - begun > PATIENCE
                if self._lacks_memory or (waited and not self.hurries):
                    break
        self._overlay.hold(renderer)
        if self._lacks_memory:
            self._drop_job()

    def _take_other(self, context: WindowContext, slot: Slot, viewport: tuple[int, int, int, int]) -> None:
        """Keep the picture of others as the next of their samples."""
        assert self._job is not None
        colour, depth = attachment(context, COLOUR), attachment(context, DEPTH)
        size = viewport[2:]
        if SAMPLES * size[0] * size[1] * (20 if colour.floats else 8) > MOST_BYTES:
            self._lacks_memory = True
            return
        if _OTHERS not in slot.effects:
            slot.effects[_OTHERS] = PictureEffects, PictureEffects(context.ctx)
        others: PictureEffects = slot.effects[_OTHERS][1]
        column, row = sample_squares(SIDE)[self._job.sampled]
        corner = column * size[0], row * size[1]
        try:
            others.copy(colour, depth, viewport, size=(SIDE * size[0], SIDE * size[1]), corner=corner)
        except EngineError:
            self._lacks_memory = True

    def _other_samples(self, renderer: vtkRenderer) -> OtherSamples:
        """Return the samples of others."""
        from pvfiblets.engine.fiblets.sample_layers import OtherSamples

        kept = context_of(renderer.GetRenderWindow()).slot(self._prop).effects[_OTHERS][1]
        return OtherSamples(*kept.copied)

    def _draw_layers(self, renderer: vtkRenderer) -> None:
        """Add up the layers of all samples, each in a frame inside of the one that the renderer is about to draw."""
        assert self._refinement is not None
        assert self._job is not None
        assert self._job.steps is not None
        self._insert()
        frames = self._refinement.layer_frames(self._job.steps)
        lines = self._job.lines
        numbers = {line.GetMapper().GetAddressAsString(""): number for number, line in enumerate(lines)}
        alone = _only(renderer, [self._prop, *lines]) if self._job.others else nullcontext()
        try:
            with alone:
                for layer in frames:
                    self._smoothing.layer = lambda mapper, of=layer.of: of(numbers[mapper.GetAddressAsString("")])
                    self._draw_inside(renderer)
        except EngineError:
            self._lacks_memory = True
            self._refinement.draw_singly()
        finally:
            self._smoothing.layer = None
            frames.close()
            self._drop_job()
        self._overlay.hold(renderer)

    def _draw_around(self, renderer: vtkRenderer) -> None:
        """Copy the surroundings of a tile for effects that read them, before the tile is drawn."""
        self._margin = None
        if self._depth_of_field is None:
            return
        reach = int(self._depth_of_field.max_blur * renderer.GetRenderWindow().GetTileScale()[1]) + 1
        self._margin = margin_of(renderer, reach)
        if self._margin is None:
            return
        try:
            for shift in self._margin.shifts():
                self._shift = shift
                with shifted(renderer.GetActiveCamera(), self._margin.size, shift):
                    self._draw_inside(renderer)
        finally:
            self._shift = 0, 0

    def _draw_inside(self, renderer: vtkRenderer) -> None:
        """Draw another frame of the renderer inside of the one that it is about to draw."""
        self._inside = True
        try:
            renderer.Render()
        finally:
            self._inside = False

    def end(self) -> None:
        """Draw the postponed overlays; called after the renderer."""
        renderer = self.renderer
        if renderer is None:
            return
        if renderer.GetSelector() is not None:
            return
        self._overlay.let_go(renderer)
        lenses.pop(self._address, None)
        if self._inside:
            return
        renderer.GetViewProps().RemoveItem(self._prop)
        refinement = self._refinement
        if refinement is None:
            return
        if tuple(renderer.GetRenderWindow().GetTileScale()) == (1, 1):
            widened = self._smoothing is not None and self._smoothing.widened
            if self._streamed and not refinement.plain and not self._resident:
                self._fetched_in = refinement.state
            refinement.end(renderer, self._state(renderer), widened=widened, complete=bool(self._streamed))
            if self.drawn is not None:
                self.drawn()

    def _state(self, renderer: vtkRenderer) -> Hashable:
        """Return what the picture is made of; None while it changes from frame to frame, or cannot be refined."""
        if renderer.GetPass() is not None and renderer.GetPass() is self._untextured.Get():
            return None
        if not _refinable(renderer) or in_motion(renderer) or not self.focusing.settled:
            return None
        if not self._resident:  # each sample would fetch parts anew
            return None
        interactor = renderer.GetRenderWindow().GetInteractor()
        follows = self._depth_of_field is not None and self._depth_of_field.focal_distance == "cursor"
        mouse = tuple(interactor.GetEventPosition()) if follows and interactor is not None else None
        state = scene_state(renderer), mouse
        return None if state == self._fetched_in else state

    def captured(self) -> None:
        """Finish the picture; called when the renderer has another camera: a copy, if somebody reads pictures."""
        renderer = self.renderer
        window = None if renderer is None else renderer.GetRenderWindow()
        if self._refinement is None or window is None or window.CheckInRenderStatus():
            return
        interactor = window.GetInteractor()
        if interactor is None or interactor.GetEnableRender():
            finish(window)

    def stored(self, step: Callable[[], None]) -> None:
        """Take a step of a frame, and keep its error, which VTK would swallow: see `raise_pending`."""
        try:
            step()
        except Exception as error:  # noqa: BLE001
            self._error = error

    def paint(self) -> None:
        """Apply the effects; called when everything but the overlays is drawn."""
        renderer, prop = self.renderer, self._prop
        if renderer is None or prop is None or renderer.GetSelector() is not None:
            return
        context = context_of(renderer.GetRenderWindow())
        viewport = gl_viewport(context.window)
        if min(viewport[2:]) < 1:  # a tile of an enlarged picture in which the renderer has no part
            return
        slot, refinement, smoothing = context.slot(prop), self._refinement, self._smoothing
        samples_others = self._inside and self.samples_others
        smooth = smoothing is not None and smoothing.pending
        taken = refinement is not None and self._shift == (0, 0) and not refinement.idle
        if smooth or taken or self.has_effects:
            with context.foreign():
                self._paint_into(context, slot, viewport, smooth, taken and not samples_others)
                if samples_others:
                    self._take_other(context, slot, viewport)
        if refinement is not None and self._shift == (0, 0):
            refinement.put_back()

    def _paint_into(
        self, context: WindowContext, slot: Slot, viewport: tuple[int, int, int, int], smooth: bool, taken: bool
    ) -> None:
        """Smooth edges, paint effects and add up samples, as far as VTK draws into textures."""
        try:
            colour = attachment(context, COLOUR)
            depth = attachment(context, DEPTH) if smooth else None
        except RuntimeError:
            if self.has_effects or self.renderer.GetPass() is None:  # asked for, or no render pass is the reason
                raise
            self._untextured = weak(self.renderer.GetPass())
            return
        if smooth:
            self._smoothing.smooth(_smoother(context, slot), colour, depth, viewport)
        if self.has_effects:
            self._paint_effects(context, slot, colour, viewport)
        if taken and self._refinement is not None:
            alike = self._smoothing is not None and not self._smoothing.others
            self._refinement.paint(context.ctx, slot, colour, viewport, alike=alike)

    def _paint_effects(
        self, context: WindowContext, slot: Slot, colour: Attachment, viewport: tuple[int, int, int, int]
    ) -> None:
        """Apply tones and depth of field; copy the surroundings of a tile."""
        renderer, wanted = self.renderer, self._depth_of_field
        if slot.renderer is None:
            slot.renderer = PictureEffects(context.ctx)
        effects = slot.renderer
        if wanted is None:
            effects.copy(colour, None, viewport)
            effects.draw(colour, viewport, tone=self._tone)
            return
        depth, margin = attachment(context, DEPTH), self._margin
        if margin is None or margin.size != viewport[2:]:
            effects.copy(colour, depth, viewport)
        else:
            effects.copy(colour, depth, viewport, size=margin.padded, corner=margin.corner(self._shift))
        effects.take_in(lenses.get(self._address, {}).values())
        if self._shift != (0, 0):
            return
        lens = lens_of(renderer, viewport[2:])
        held = self._refinement is not None and not self._refinement.plain
        focus = self.focusing.focus(wanted, renderer, effects, lens, held=held)
        effects.draw(colour, viewport, tone=self._tone, focus=focus, lens=lens)


def _refinable(renderer: vtkRenderer) -> bool:
    """Return whether a picture has a camera that can be shifted, and one of them."""
    camera = renderer.GetActiveCamera()
    fixed = camera.GetUseExplicitProjectionTransformMatrix() or camera.GetUseOffAxisProjection()
    return not fixed and not renderer.GetRenderWindow().GetStereoRender()


@contextmanager
def _only(renderer: vtkRenderer, props: list[Any]) -> Iterator[None]:
    """Show only some props of a renderer, without events and without a change of state."""
    shown, address = renderer.GetViewProps(), renderer.GetAddressAsString("")
    before = items_of(shown)
    alone = [prop for prop in before if prop in props]
    for prop in before:
        if prop not in alone:
            shown.RemoveItem(prop)
    partly_shown.add(address)
    try:
        yield
    finally:
        partly_shown.discard(address)
        left = items_of(shown)  # others may have added and removed some
        shown.RemoveAllItems()
        for prop in [prop for prop in before if prop in left or prop not in alone] + left:
            if not shown.IsItemPresent(prop):
                shown.AddItem(prop)


def _starts_empty(renderer: vtkRenderer) -> bool:
    """Return whether a renderer that draws once more begins with its background."""
    return renderer.GetLayer() == 0 and bool(renderer.GetErase()) and not renderer.GetPreserveColorBuffer()


def _smoother(context: WindowContext, slot: Slot) -> Any:
    """Return what smooths edges in a window, made when it is first needed."""
    if _COVERAGE not in slot.effects:
        from pvfiblets.engine.effects.antialias_coverage import Coverage

        slot.effects[_COVERAGE] = Coverage, Coverage(context.ctx)
    return slot.effects[_COVERAGE][1]
