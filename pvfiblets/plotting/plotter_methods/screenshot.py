"""Pictures for print: larger than the window, black and white with one bit a pixel, or averaged from many samples."""

from __future__ import annotations

import os
import sys
from contextlib import AbstractContextManager, nullcontext
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pyvista as pv

from pvfiblets.mappers.frames.observers import observe
from pvfiblets.plotting.actors.registry import A, ActorRegistry
from pvfiblets.support.real_numbers import is_number

ONE_BIT_FORMATS = (".png", ".tif", ".tiff", ".bmp")  # kinds of files that hold one bit for a pixel

_HALF = 128


class PrintableComponent(ActorRegistry[A]):
    """Component whose pictures can be taken for print."""

    def screenshot(
        self,
        filename: str | os.PathLike[str] | BytesIO | None = None,
        *,
        scale: int = 1,
        one_bit: bool = False,
        supersampling: int = 1,
        window_size: tuple[int, int] | None = None,
        dpi: float | None = None,
        return_img: bool = True,
    ) -> npt.NDArray[Any] | None:
        """Take a picture of the whole plotter for print.

        Lines, points and their halos are as wide, relative to the picture, as in the window, however
        much larger the picture is: ``min_width`` counts pixels of the window.

        Parameters
        ----------
        filename : str, path or file object, optional
            Where to write it; ``.png`` without a suffix.
        scale : int, default: 1
            Pixels of the image per pixel of the window, along each side.
        one_bit : bool, default: False
            Pure black and white, one bit a pixel, as in the paper: white where a pixel is at least
            half as bright as white, without dithering. The file is a ``.png``, ``.tif`` or ``.bmp``.
        supersampling : int, default: 1
            Render this many times larger along each side, and average, for smooth edges; ``one_bit``
            compares the average. By default edges are smoothed by ``plotter.picture.antialias``.
        window_size : (int, int), optional
            Width and height of the window for this image.
        dpi : float, optional
            Pixels per inch, which set the printed size.
        return_img : bool, default: True
            Return the image.

        Returns
        -------
        numpy.ndarray or None
            ``(height, width)`` bool, True for white, with ``one_bit``; else ``(height, width)``
            uint8 where the picture is grey all over, or ``(height, width, 3)`` uint8.

        Raises
        ------
        TypeError, ValueError
            If a number is out of its range, or such files have no pictures of one bit.

        Notes
        -----
        While it is averaged the picture takes three bytes for each sample, and twelve for each pixel.

        Source: Everts et al. 2009, section 3.4: figures are high-resolution 1-bit pictures.

        Examples
        --------
        >>> import pyvista as pv
        >>> pl = pv.Plotter(off_screen=True, window_size=(400, 300))
        >>> actor = pl.add_halo_lines([[(0, 0, 0), (10, 0, 5), (20, 0, 0)], [(10, -9, 9), (10, 9, 9)]])
        >>> pl.halo_lines.screenshot(scale=4, one_bit=True).shape
        (1200, 1600)
        """
        scale, supersampling = _whole("scale", scale), _whole("supersampling", supersampling)
        if dpi is not None and not (is_number(dpi) and dpi > 0.0):
            raise ValueError(f"dpi is {dpi!r}; give pixels per inch, a number above 0")
        target = _target(filename, one_bit)
        with _sampled_once(self._plotter) if supersampling > 1 else nullcontext():
            taken = _taken(self._plotter, scale * supersampling, window_size)
        image: npt.NDArray[Any] = _flat(_averaged(taken, supersampling))
        if one_bit:
            image = _brightness(image) >= _HALF
        if target is not None:
            from PIL import Image

            written: dict[str, Any] = {} if dpi is None else {"dpi": (float(dpi), float(dpi))}
            Image.fromarray(image).save(target, format="PNG" if isinstance(target, BytesIO) else None, **written)
        return image if return_img else None


def _sampled_once(plotter: pv.BasePlotter) -> AbstractContextManager[None]:
    """Return what keeps a plotter's pictures from being refined meanwhile."""
    if "pvfiblets.plotting.picture_component" not in sys.modules:
        return nullcontext()
    kept: AbstractContextManager[None] = plotter.picture.sampled_once()
    return kept


def _taken(plotter: pv.BasePlotter, scale: int, window_size: tuple[int, int] | None) -> npt.NDArray[np.uint8]:
    """Return ``(height, width, 3)`` of a plotter as it is now."""
    # Tiles of an enlarged picture are drawn past the plotter's callbacks: errors in them are raised here.
    errors: list[Exception] = []

    def collect(*_: Any) -> None:
        for renderer in plotter.renderers:
            for actor in renderer.actors.values():
                try:
                    if hasattr(actor, "raise_pending"):
                        actor.raise_pending()
                except Exception as error:  # noqa: BLE001 - VTK would print it and go on
                    errors.append(error)

    with plotter.window_size_context(window_size):
        if not plotter._first_time:  # noqa: SLF001 - else screenshot renders
            plotter.render()
        window = plotter.render_window
        end = None if window is None else observe(window, ("EndEvent",), collect)
        try:
            picture = plotter.screenshot(None, transparent_background=False, scale=scale)
        finally:
            if end is not None:
                end()
    if errors:
        raise errors[0]
    return np.asarray(picture)[..., :3]


def _whole(name: str, value: Any) -> int:
    if not is_number(value) or value < 1 or value % 1 != 0:
        raise ValueError(f"{name} is {value!r}; give a whole number, 1 or more")
    return int(value)



def _target(filename: Any, one_bit: bool) -> Path | BytesIO | None:
    if filename is None or isinstance(filename, BytesIO):
        return filename
    if not isinstance(filename, (str, os.PathLike)):
        raise TypeError(f"filename is a {type(filename).__name__}; give a path, a BytesIO, or None to write no file")
    path = Path(filename)
    if not path.suffix:
        path = path.with_suffix(".png")
    if one_bit and path.suffix.lower() not in ONE_BIT_FORMATS:
        raise ValueError(
            f"{path.suffix} files have no pictures of one bit; give a name that ends in one of {ONE_BIT_FORMATS}"
        )
    if isinstance(pv.FIGURE_PATH, str) and not path.is_absolute():
        path = Path(pv.FIGURE_PATH) / path
    return path.expanduser().resolve()


def _averaged(picture: npt.NDArray[np.uint8], samples: int) -> npt.NDArray[np.uint8]:
    """Return the mean of every square of so many pixels along each side, rounded."""
    if samples == 1:
        return picture
    total = np.zeros((picture.shape[0] // samples, picture.shape[1] // samples, 3), np.uint32)
    for row in range(samples):
        for column in range(samples):
            total += picture[row::samples, column::samples]
    count = samples * samples
    averaged: npt.NDArray[np.uint8] = ((total + count // 2) // count).astype(np.uint8)
    return averaged


def _flat(picture: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
    """Return one channel where all three are the same everywhere."""
    grey = (picture == picture[..., :1]).all()
    return np.ascontiguousarray(picture[..., 0] if grey else picture)


def _brightness(image: npt.NDArray[np.uint8]) -> npt.NDArray[Any]:
    """Return 0 to 255, of colours weighted as ITU-R BT.601 has it."""
    return image if image.ndim == 2 else image @ np.array([0.299, 0.587, 0.114])
