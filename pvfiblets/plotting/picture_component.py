"""``plotter.picture``: effects on everything that a renderer shows.

PyVista finds this module by an entry point and imports it when a plotter is first asked for that name.
"""

from __future__ import annotations

import weakref
from collections.abc import Mapping
from dataclasses import asdict, fields, replace
from typing import Any

import pyvista as pv

from pvfiblets.engine.effects.tone import Tone
from pvfiblets.mappers.picture import DepthOfField, Picture
from pvfiblets.plotting.setting_places import Place
from pvfiblets.plotting.settings import Setting

TONE = ("operator", "exposure", "white")
"""Settings of :attr:`PictureComponent.tone`; the other changes of colours are attributes of their own."""

OPERATOR = "aces"
"""Of a tone that says nothing else."""

TICK = 15  # ms between pictures while the focus is on its way


class _ToneMapping(Place):
    """A field of the tone of the active renderer's picture, which checks it."""

    def read(self, actor: Any, setting: Setting[Any]) -> Any:
        return getattr(actor._picture().tone, setting.field)  # noqa: SLF001 - of the class that it is part of

    def write(self, actor: Any, setting: Setting[Any], value: Any) -> None:
        actor._set_tone(**{setting.field: value})  # noqa: SLF001


@pv.register_plotter_component("picture")
class PictureComponent:
    """Depth of field, tone mapping, brightness, contrast and gamma of all that the active renderer shows.

    They work on the finished picture of any actors, fiblets, tubes, halos, volumes and meshes alike, and leave scalar
    bars, texts and other things that lie over it as they are. Each is off, and costs nothing, until it is set; it may
    be set at any time, and takes effect at the next render. Subplots have settings of their own: choose one with
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

    __slots__ = ("__weakref__", "_pictures", "_plotter", "_tags")

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = weakref.proxy(plotter)
        self._pictures: dict[str, Picture] = {}
        self._tags: list[int] = []

    # Settings

    @property
    def depth_of_field(self) -> dict[str, Any] | bool:
        """Blur of what is out of focus, as a lens has it.

        Set it to ``True`` for the defaults, to a dict of what shall differ from them, or to ``False`` or ``None`` for
        off; read, it is the dict of all settings, or ``False``.

        ``focal_distance``: mm from the camera to what is in focus; ``None``, the default, is the camera's focal point.
        ``"cursor"`` is what is nearest under the mouse, live; ``"center"`` what is nearest in the middle.
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
        """Distance (mm) from the camera to what was in focus in the last picture; ``None`` before the first."""
        return self._picture().focal_distance

    @property
    def tone(self) -> dict[str, Any] | bool:
        """Tone mapping: how bright colours are kept from being cut off.

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
        0.0, "What is added to colours in 0 to 1, after tone mapping: -1 to 1, 0 for nothing.", where=_ToneMapping()
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
        """Show the active renderer as it is drawn: all effects off."""
        picture = self._picture()
        picture.depth_of_field, picture.tone = None, Tone()
        self._keep()

    def explain(self) -> dict[str, Any]:
        """Return what the effects on the active renderer keep on the GPU: ``buffers``, name and bytes of each."""
        return self._picture().explain()

    def _set_tone(self, **changes: Any) -> None:
        picture = self._picture()
        picture.tone = replace(picture.tone, **changes)
        self._keep()

    # Life cycle

    def _picture(self) -> Picture:
        """Return the active renderer's."""
        renderer = self._plotter.renderer
        address = renderer.GetAddressAsString("")
        picture = self._pictures.get(address)
        if picture is None or picture.renderer is None:
            picture = self._pictures[address] = Picture(renderer)
        return picture

    def _keep(self) -> None:
        """Have errors raised by what renders, and the mouse watched as long as a focus follows it."""
        if any(picture.on for picture in self._pictures.values()):
            # Registered current here, since `clear_on_render_callbacks` drops what others registered.
            self._plotter.add_on_render_callback(self._rendered)
        interactor = self._interactor()
        if interactor is None:
            return
        following = bool(self._following())
        if following and not self._tags:
            reference = weakref.WeakMethod(self._heard)

            def call(_interactor: Any, event: str) -> None:
                alive = reference()
                if alive is not None:
                    alive(event)

            self._tags = [interactor.AddObserver(event, call) for event in ("MouseMoveEvent", "TimerEvent")]
        elif not following:
            self._ignore()

    def _interactor(self) -> Any:
        return getattr(self._plotter.iren, "interactor", None)

    def _ignore(self) -> None:
        tags, self._tags = self._tags, []
        interactor = self._interactor()
        for tag in tags if interactor is not None else []:
            interactor.RemoveObserver(tag)

    def _following(self) -> list[Picture]:
        """Pictures whose focus moves without anybody setting it."""
        kept = [(picture, picture.depth_of_field) for picture in self._pictures.values()]
        return [picture for picture, wanted in kept if wanted is not None and isinstance(wanted.focal_distance, str)]

    def _heard(self, event: str) -> None:
        """Render where the focus moves and nobody else renders: not while the mouse turns the camera."""
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
        interactor = self._interactor() if self._tags else None
        if (
            interactor is not None
            and interactor.GetInitialized()
            and any(not p.focusing.settled for p in self._following())
        ):
            interactor.CreateOneShotTimer(TICK)

    def __plotter_close__(self) -> None:
        """Release everything; PyVista calls this before the render window goes."""
        self._ignore()
        for picture in self._pictures.values():
            picture.release()
        self._pictures.clear()


def _wanted(picture: Picture) -> Any:
    """Return what a picture's depth of field is to focus on."""
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
