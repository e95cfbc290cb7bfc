"""``plotter.picture``: effects on the finished image of a renderer.

PyVista finds this module by an entry point and imports it when a plotter is first asked for that name.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, fields, replace
from typing import TYPE_CHECKING, Any

import pyvista as pv

from pvfiblets.antialias import check_antialias, default_antialias, samples_of
from pvfiblets.engine.effects.tone import Tone
from pvfiblets.mappers.engine_mapper import shows_engine
from pvfiblets.mappers.frames.idle_windows import refine
from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.mappers.frames.scene import partly_shown
from pvfiblets.mappers.picture.antialias_refinement import Refinement
from pvfiblets.mappers.picture.picture import DepthOfField, Picture
from pvfiblets.plotting.antialias_pacing import Pacer
from pvfiblets.plotting.components import register
from pvfiblets.plotting.settings.places import OWN, Place, Stored
from pvfiblets.plotting.settings.settings import Setting, number

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

TONE = ("operator", "exposure", "white")
"""Settings of :attr:`PictureComponent.tone`; the other changes of colours are attributes of their own."""

OPERATOR = "aces"  # default operator

TICK = 15  # ms between pictures while the focus is on its way


class _ToneMapping(Place):
    """A field of the active renderer's tone, which checks it."""

    def read(self, actor: Any, setting: Stored) -> Any:
        return getattr(actor._picture().tone, setting.field)  # noqa: SLF001 - of the class that it is part of

    def write(self, actor: Any, setting: Stored, value: Any) -> None:
        actor._set_tone(**{setting.field: value})  # noqa: SLF001


def _seconds(name: str, value: Any) -> float | None:
    """Return a time limit, or None."""
    return None if value is None else number(name, value, 0.0, None, "seconds")


@register("picture")
class PictureComponent:
    """Smooth edges, depth of field, tone mapping, brightness, contrast and gamma of the active renderer.

    They apply to the finished image of all actors (fiblets, tubes, halos, volumes, meshes), but not to scalar bars,
    texts and other overlays. Each effect is off, and costs nothing, until it is set;
    it may be set at any time, and takes effect at the next render. Subplots have settings of their own: choose one with
    :meth:`pyvista.Plotter.subplot`.

    Parameters
    ----------
    plotter : pyvista.BasePlotter
        The plotter it belongs to.

    Examples
    --------
    >>> import pyvista as pv
    >>> pl = pv.Plotter(off_screen=True)
    >>> _ = pl.add_mesh(pv.Sphere())
    >>> pl.picture.depth_of_field = {"focal_distance": 3.0, "darkening": 0.3}
    >>> pl.picture.gamma = 1.2
    """

    __slots__ = ("__weakref__", "_antialias", "_end", "_pacer", "_pictures", "_plotter", "_seconds")

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = weakref.proxy(plotter)
        self._pictures: dict[str, Picture] = {}
        self._end: Callable[[], None] | None = None
        self._antialias: dict[str, str | int] = {}
        self._seconds: dict[str, float | None] = {}
        self._pacer = Pacer(plotter, self.refine, self._unfinished)

    # Settings

    antialias: Setting[str | int] = Setting(
        "refined",
        """Smoothing of edges.

        ``"off"``: none. ``"coverage"``: by the share of each pixel that lines and tubes cover, in one frame.
        ``"refined"``, the default where the renderer shows an object of this package: when nothing changes, 16 samples
        are drawn, shifted by parts of a pixel, and their mean is shown; then nothing is drawn. Screenshots and frames
        of movies are finished images. Until then, and while something moves, ``"coverage"``. A number from 2 to 256:
        that number of samples.

        Everything in the scene is refined, meshes too, and every effect; picks, depths and ids come from the
        unsmoothed frame. A still image takes longer by the number of its samples; `antialias_seconds` limits
        that. The environment variable ``PVFIBLETS_ANTIALIAS`` sets another default.
        """,
        kind="str | int",
        where=OWN,
        check=check_antialias,
    )
    antialias_seconds: Setting[float | None] = Setting(
        None,
        """Time limit of a still image's samples, seconds, or ``None``, the default, for no limit.

        The image is then the mean of the samples so far, at least one. With a limit, images of slow scenes differ
        between machines.
        """,
        kind="float | None",
        where=OWN,
        check=_seconds,
    )

    @property
    def samples(self) -> int:
        """Number of samples of the last frame: 1 unless ``antialias`` refined it."""
        refinement = self._picture().refinement
        return 1 if refinement is None else max(refinement.taken, 1)

    def refine(self) -> bool:
        """Draw one more accumulation sample of the plotter's idle frames, or more parts of sets larger than GPU memory.

        All samples of opaque fiblets are drawn at once, part by part, also beside opaque meshes and tubes.

        Windows on a screen, notebooks and pages do it by themselves, screenshots draw all that are left. It is for
        event loops of other kinds, which call it while nothing happens.

        Returns
        -------
        bool
            Whether another call is wanted. If none was, nothing has been drawn.
        """
        window = self._plotter.render_window
        return window is not None and refine(window)

    @property
    def fetching(self) -> bool:
        """Whether the frame lacks parts of a set larger than GPU memory; :meth:`refine` draws more of it."""
        return any(picture.fetching for picture in self._pictures.values())

    def pace_by_hand(self) -> None:
        """Stop drawing samples automatically; the caller then calls :meth:`refine`."""
        self._pacer.by_hand = True
        self._pacer.release()

    @property
    def depth_of_field(self) -> dict[str, Any] | bool:
        """Blur outside the focus of a lens.

        Set it to ``True`` for the defaults, to a dict of what shall differ from them, or to ``False`` or ``None`` for
        off; read, it is the dict of all settings, or ``False``.

        ``focal_distance``: mm from the camera to the plane in focus; ``None`` is the camera's focal point (default).
        ``"cursor"`` is the nearest surface under the mouse, live; ``"center"`` the nearest in the middle.
        ``aperture`` (mm): diameter of the lens: the wider, the more is blurred. ``None``, the default, is 6 % of the
        height that is seen at the distance in focus. ``darkening`` (0): 0 to 1, the share of light that things lose
        where they are blurred most. ``max_blur`` (16): pixels, 1 to 64; no point is blurred to a greater radius.
        ``smooth`` (0): seconds in which a focus that follows comes most of its way.
        """
        settings = self._picture().depth_of_field
        return False if settings is None else asdict(settings)

    @depth_of_field.setter
    def depth_of_field(self, wanted: Mapping[str, Any] | bool | None) -> None:
        given = _settings("depth_of_field", wanted, [field.name for field in fields(DepthOfField)])
        self._picture().depth_of_field = None if given is None else DepthOfField(**given)
        self._keep()

    @property
    def focal_distance(self) -> float | None:
        """Distance (mm) in focus in the last frame, from the camera; ``None`` before the first."""
        return self._picture().focal_distance

    @property
    def tone(self) -> dict[str, Any] | bool:
        """Tone mapping, which keeps bright colours from being clipped.

        Set it to ``True`` for the defaults, to a dict of what shall differ from them, or to ``False`` or ``None`` for
        off; read, it is the dict of all settings, or ``False``.

        ``operator``: ``"aces"``, the default, ``"reinhard"``, ``"exponential"``, ``"hable"`` or ``"none"``.
        ``exposure`` (1): factor of the colours before the operator. ``white``: the exposed value that ``"reinhard"``
        and ``"hable"`` make white; ``None``, the default, is the exposure for the former, 11.2 for the latter.
        """
        settings = self._picture().tone
        if (settings.operator, settings.exposure) == ("none", 1.0):
            return False
        return {name: getattr(settings, name) for name in TONE}

    @tone.setter
    def tone(self, wanted: Mapping[str, Any] | bool | None) -> None:
        given = _settings("tone", wanted, TONE)
        plain = Tone()
        new = {name: getattr(plain, name) for name in TONE}
        self._set_tone(**(new if given is None else new | {"operator": OPERATOR} | given))

    brightness: Setting[float] = Setting(
        0.0, "Constant added to colours in 0 to 1, after tone mapping: -1 to 1, 0 for none.", where=_ToneMapping()
    )
    contrast: Setting[float] = Setting(
        1.0,
        "Factor of the distance of colours from middle grey, after tone mapping: 0 or more, 1 for no change.",
        where=_ToneMapping(),
    )
    gamma: Setting[float] = Setting(
        1.0, "Colours, at last, are raised to ``1 / gamma``: above 1 is brighter, 1 no change.", where=_ToneMapping()
    )

    def reset(self) -> None:
        """Switch all effects of the active renderer off, except the smoothing of edges."""
        picture = self._picture()
        picture.depth_of_field, picture.tone = None, Tone()
        self._keep()

    def explain(self) -> dict[str, Any]:
        """Return the GPU buffers of the active renderer's effects: ``buffers``, name and bytes of each."""
        return self._picture().explain()

    # Smooth edges

    def follow(self, renderer: vtkRenderer) -> None:
        """Update whether a renderer shows an object of this package."""
        if renderer.GetAddressAsString("") not in partly_shown:
            self._smooth_as_set(renderer)

    def _read_antialias(self) -> str | int:
        return self._antialias.get(self._plotter.renderer.GetAddressAsString(""), default_antialias())

    def _write_antialias(self, value: str | int) -> None:
        renderer = self._plotter.renderer
        self._antialias[renderer.GetAddressAsString("")] = value
        self._smooth_as_set(renderer)

    def _read_antialias_seconds(self) -> float | None:
        return self._seconds.get(self._plotter.renderer.GetAddressAsString(""))

    def _write_antialias_seconds(self, value: float | None) -> None:
        renderer = self._plotter.renderer
        self._seconds[renderer.GetAddressAsString("")] = value
        self._smooth_as_set(renderer)

    def _smooth_as_set(self, renderer: vtkRenderer) -> None:
        """Apply the antialiasing of a renderer; by default, if it shows an object of this package."""
        address = renderer.GetAddressAsString("")
        value = self._antialias.get(address)
        if value is None:
            value = default_antialias() if shows_engine(renderer) else "off"
        if value == "off" and address not in self._pictures:
            return
        picture, samples = self._picture(renderer), samples_of(value)
        picture.antialias = "off" if value == "off" else "coverage"
        wanted = Refinement(samples, self._seconds.get(address)) if samples > 1 else None
        now = picture.refinement
        if wanted is None or now is None or not wanted.same_as(now):
            if wanted is not None:
                wanted.seen = self._seen
            if wanted is not now:
                picture.refinement = wanted
        picture.drawn, picture.paced = self._drawn, self._paced
        self._keep()

    @contextmanager
    def sampled_once(self) -> Iterator[None]:
        """Draw frames with one sample a pixel meanwhile."""
        refined = [(picture, picture.refinement) for picture in self._pictures.values() if picture.refinement]
        for picture, _ in refined:
            picture.refinement = None
        try:
            yield
        finally:
            for picture, refinement in refined:
                picture.refinement = refinement

    def _unfinished(self) -> tuple[bool, int]:
        """Return whether samples or parts are missing, and the largest number of samples of a renderer."""
        pictures = [picture for picture in self._pictures.values() if picture.unfinished]
        taken = [picture.refinement.taken + picture.fetching for picture in pictures if picture.refinement]
        return bool(pictures), max(taken, default=0)

    def _drawn(self) -> None:
        """Note that a renderer has drawn a frame."""
        self._pacer.frame_drawn()

    def _seen(self) -> bool:
        return self._pacer.seen

    def _paced(self) -> bool:
        return self._pacer.paces

    def _set_tone(self, **changes: Any) -> None:
        picture = self._picture()
        picture.tone = replace(picture.tone, **changes)
        self._keep()

    # Life cycle

    def _picture(self, renderer: vtkRenderer | None = None) -> Picture:
        """Return a renderer's, by default the active one's."""
        renderer = self._plotter.renderer if renderer is None else renderer
        address = renderer.GetAddressAsString("")
        picture = self._pictures.get(address)
        if picture is None or picture.renderer is None:
            picture = self._pictures[address] = Picture(renderer)
        return picture

    def _keep(self) -> None:
        """Raise errors from rendering, and observe the mouse while a focus follows it."""
        if any(picture.on for picture in self._pictures.values()):
            # Registered current here, since `clear_on_render_callbacks` drops what others registered.
            self._plotter.add_on_render_callback(self._rendered)
        interactor = self._interactor()
        if interactor is None:
            return
        following = bool(self._following())
        if following and self._end is None:
            events = ("MouseMoveEvent", "TimerEvent")
            self._end = observe(interactor, events, weakly(self._heard, passing=True))
        elif not following:
            self._ignore()

    def _interactor(self) -> Any:
        return getattr(self._plotter.iren, "interactor", None)

    def _ignore(self) -> None:
        if self._end is not None:
            self._end()
        self._end = None

    def _following(self) -> list[Picture]:
        """Renderers whose focus moves by itself."""
        kept = [(picture, picture.depth_of_field) for picture in self._pictures.values()]
        return [picture for picture, wanted in kept if wanted is not None and isinstance(wanted.focal_distance, str)]

    def _heard(self, _interactor: Any, event: str) -> None:
        """Render if the focus moves and nothing else renders, as while the mouse turns the camera."""
        interactor = self._interactor()
        style = interactor.GetInteractorStyle()
        if style is not None and hasattr(style, "GetState") and style.GetState() != 0:
            return
        following = self._following()
        if event == "MouseMoveEvent":
            under = interactor.FindPokedRenderer(*interactor.GetEventPosition())
            moves = any(p.renderer is under and _wanted(p) == "cursor" for p in following)
        else:
            moves = any(not p.focusing.settled for p in following)
        if moves:
            self._plotter.render()

    def _rendered(self, _plotter: Any = None) -> None:
        for picture in self._pictures.values():
            picture.raise_pending()
        interactor = None if self._end is None else self._interactor()
        if (
            interactor is not None
            and interactor.GetInitialized()
            and any(not p.focusing.settled for p in self._following())
        ):
            interactor.CreateOneShotTimer(TICK)

    def __plotter_close__(self) -> None:
        """Release everything; PyVista calls this before the render window goes."""
        self._ignore()
        self._pacer.release()
        for picture in self._pictures.values():
            picture.release()
        self._pictures.clear()


def _wanted(picture: Picture) -> Any:
    """Return the focus of a renderer's depth of field."""
    settings = picture.depth_of_field
    return None if settings is None else settings.focal_distance


def _settings(name: str, wanted: Any, known: Any) -> dict[str, Any] | None:
    """Return settings as a dict; None for off."""
    if wanted is None or wanted is False:
        return None
    if wanted is not True and not isinstance(wanted, Mapping):
        raise ValueError(f"{name} is {wanted!r}; give True, False or a dict of settings")
    given = {} if wanted is True else dict(wanted)
    if unknown := sorted(set(given) - set(known), key=str):
        raise ValueError(f"{name} has no settings {unknown}; it has {list(known)}")
    return given
