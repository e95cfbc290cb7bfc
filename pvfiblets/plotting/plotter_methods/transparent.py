"""Pictures whose background is transparent: ``plotter.screenshot(transparent_background=True)``.

VTK blends smooth edges and translucent actors with the background's colour, and its picture keeps that. So the
scene is drawn on two backgrounds: the difference of a pixel is its transparency, and the rest is the scene's colour.
Halos, fog and other things of the background's colour become transparent, too.
"""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.plotting.settings.call_signature import replace_method

# Red and blue differ. Both of a pair are dark, or light: what contrasts with the background stays as it is.
_DARK = (0.0, 0.0, 0.0), (1.0, 0.0, 1.0)
_LIGHT = (1.0, 1.0, 1.0), (0.0, 1.0, 0.0)

_METHOD: Any = next(vars(kind)["screenshot"] for kind in pv.Plotter.__mro__ if "screenshot" in vars(kind))


def screenshot(plotter: pv.BasePlotter, filename: Any = None, *, return_img: bool = True, **options: Any) -> Any:
    """Take a picture without the background, as PNG has it: colours are not multiplied by the opacity."""
    pictures = []
    for ground in range(2):
        with _on_ground(plotter, ground):
            if not plotter._first_time:  # noqa: SLF001 - else the method renders
                plotter.render()
            taken = _METHOD(plotter, None, transparent_background=True, **options)
            pictures.append(np.asarray(taken, np.float64))
    whole = _unmixed(*pictures).view(pv.pyvista_ndarray)
    return plotter._save_image(whole, filename, return_img)  # noqa: SLF001 - as the method does


def _unmixed(on_first: npt.NDArray[np.float64], on_second: npt.NDArray[np.float64]) -> npt.NDArray[np.uint8]:
    """Return colours and opacities of two pictures, on the first and the second ground of a pair."""
    gap = (on_second - on_first)[..., :3:2].mean(axis=-1)
    empty = on_first[..., 3] == 0.0
    most = max(float(np.abs(gap)[empty].mean()), 1.0) if empty.any() else 255.0  # less where tones are mapped
    opacity = np.clip(np.rint(255.0 * (1.0 - np.abs(gap) / most)), 0.0, 255.0)
    through = np.where(gap < 0.0, most * (1.0 - opacity / 255.0), 0.0)  # of the first ground: white, or black
    colour = (on_first[..., :3] - through[..., None]) * 255.0 / np.maximum(opacity, 1.0)[..., None]
    colour[opacity == 0.0] = 0.0
    return np.concatenate([np.clip(np.rint(colour), 0.0, 255.0), opacity[..., None]], axis=-1).astype(np.uint8)


@contextmanager
def _on_ground(plotter: pv.BasePlotter, number: int) -> Iterator[None]:
    """Draw all renderers of a plotter on the first or the second background in this scope."""
    from pvfiblets.mappers.effects.shading import is_light

    renderers = list(plotter.renderers)
    before = [(one.GetBackground(), one.GetGradientBackground(), one.GetTexturedBackground()) for one in renderers]
    for renderer in renderers:
        renderer.SetBackground((_LIGHT if is_light(renderer) else _DARK)[number])
        renderer.SetGradientBackground(False)
        renderer.SetTexturedBackground(False)
    try:
        yield
    finally:
        for renderer, (colour, gradient, textured) in zip(renderers, before, strict=True):
            renderer.SetBackground(colour)
            renderer.SetGradientBackground(gradient)
            renderer.SetTexturedBackground(textured)


def _screenshot(plotter: pv.BasePlotter, original: Any, arguments: tuple[Any, ...], named: dict[str, Any]) -> Any:
    from pvfiblets.mappers.engine_mapper import shows_engine

    given = inspect.signature(original).bind(plotter, *arguments, **named).arguments
    transparent = given.get("transparent_background")
    if transparent is None:
        transparent = plotter._theme.transparent_background  # noqa: SLF001 - as the method does
    if not transparent or plotter.render_window is None or not any(map(shows_engine, plotter.renderers)):
        return original(plotter, *arguments, **named)
    options = {name: value for name, value in given.items() if name not in ("self", "transparent_background")}
    return screenshot(plotter, **options)


replace_method("screenshot", _screenshot, __name__)
