"""Streamlines in a window of their own, in one call."""

from __future__ import annotations

from typing import Any

import pyvista as pv

_PLOTTER = ("off_screen", "notebook", "window_size", "theme", "border", "border_color", "border_width", "image_scale")
_SHOW = (
    "full_screen", "screenshot", "interactive", "return_img", "return_cpos", "jupyter_backend", "jupyter_kwargs",
    "return_viewer", "before_close_callback", "auto_close", "title",
)  # fmt: skip


def plot(source: Any, **options: Any) -> Any:
    """Show streamlines in a plotter of their own, as :func:`pyvista.plot` shows meshes.

    Parameters
    ----------
    source : path, FibletSet, Streamlines, pyvista.PolyData or list of (n, 3) arrays
        As for ``plotter.add_fiblets``.
    **options
        Those of :func:`pyvista.plot` that are of plotters (``off_screen``, ``notebook``, ``window_size``, ``theme``,
        ``border`` and its like), of :meth:`pyvista.Plotter.show` (``screenshot``, ``cpos``, ``return_img``,
        ``jupyter_backend`` and its like), and ``background``, ``text``, ``zoom``, ``show_axes``, ``show_bounds``. All
        other arguments are passed to ``plotter.add_fiblets``.

    Returns
    -------
    object
        What :meth:`pyvista.Plotter.show` returns.

    Raises
    ------
    TypeError
        If an argument is unknown to all of these.

    Examples
    --------
    >>> import pvfiblets
    >>> from pvfiblets.synthetic import brain_streamlines
    >>> fiblets = pvfiblets.compress(pvfiblets.Streamlines.from_list(brain_streamlines(100)))
    >>> picture = pvfiblets.plot(fiblets, color="red", off_screen=True, screenshot=True)
    """
    import pvfiblets.plotting.fiblets.component  # noqa: F401 - registers plotter.add_fiblets

    def taken(*names: str) -> dict[str, Any]:
        return {name: options.pop(name) for name in names if name in options}

    scene, shown = taken("background", "text", "zoom", "show_axes", "show_bounds", "cpos"), taken(*_SHOW)
    plotter: Any = pv.Plotter(**taken(*_PLOTTER))
    try:
        if scene.get("background") is not None:
            plotter.set_background(scene["background"])  # before the lines: some looks ask for it
        plotter.add_fiblets(source, **options)
        if scene.get("text"):
            plotter.add_text(scene["text"])
        if scene.get("show_axes", plotter.theme.axes.show):
            plotter.add_axes()
        if scene.get("show_bounds"):
            plotter.show_bounds()
        if scene.get("cpos") is not None:
            plotter.camera_position = scene["cpos"]
        if scene.get("zoom") is not None:
            plotter.reset_camera()
            plotter.camera.zoom(scene["zoom"])
            plotter.camera_set = True
    except Exception:
        plotter.close()
        raise
    return plotter.show(**shown)
