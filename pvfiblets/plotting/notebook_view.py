"""Pages in notebooks: the frame of a cell, and the state that it shares with a kernel while there is one.

`show` is PyVista's backend ``"fiblets"`` of notebooks (entry point ``pyvista.jupyter_backends``).
"""

from __future__ import annotations

import base64
import html
import importlib.util
import io
import tempfile
import uuid
import weakref
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.observers import observe, weakly
from pvfiblets.plotting.page.page_scene import camera_place, page_and_actors
from pvfiblets.plotting.viewpoints import point_camera

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.plotting.notebook_state import NotebookState

_HEIGHTS = 50, 10_000


@dataclass(frozen=True)
class Picked:
    """The streamline that was picked in a page.

    Attributes
    ----------
    name : str
        Name of its actor in the plotter.
    streamline : int
        Its number.
    place : tuple of 3 floats, optional
        Where, world mm.
    """

    name: str
    streamline: int
    place: tuple[float, float, float] | None = None


class PageView:
    """A page that a notebook shows, and keeps when it is saved.

    While there is a kernel, and anywidget is installed, the camera of the plotter and that of the page are one, and
    `picked` is the streamline that was clicked on.

    Parameters
    ----------
    text : str
        The page.
    height : int
        Pixels.
    plotter : pyvista.BasePlotter
        Whose camera goes with that of the page.
    names : list of str
        Those of the actors that the page has as layers.
    picture : bytes, optional
        A PNG for readers of notebooks that let no page run.

    Attributes
    ----------
    state : NotebookState or None
        The model of anywidget, with ``camera`` and ``picked``; ``state.observe(function, "picked")`` tells of a click.
        None without anywidget.
    """

    def __init__(
        self, text: str, height: int, plotter: pv.BasePlotter, names: list[str], picture: bytes | None = None
    ) -> None:
        self.text, self.height, self.picture = text, height, picture
        self._names, self._camera = names, plotter.renderer.camera
        self._name = f"pvfiblets-{uuid.uuid4().hex}"
        self._told = False
        self.state: NotebookState | None = None
        if importlib.util.find_spec("anywidget"):
            from pvfiblets.plotting.notebook_state import NotebookState

            self.state = NotebookState(name=self._name, camera=self._place())
            self.state.observe(self._from_page, "camera")
            self._follow()

    @property
    def picked(self) -> Picked | None:
        """The streamline that is marked in the page; set, it marks another one, or with None nothing.

        Raises
        ------
        ValueError
            If a name is set that the page does not have.
        RuntimeError
            If it is set without anywidget.
        """
        if self.state is None or self.state.picked is None:
            return None
        found = self.state.picked
        place = found.get("place")
        return Picked(self._names[found["layer"]], int(found["streamline"]), None if place is None else (*place,))

    @picked.setter
    def picked(self, picked: Picked | None) -> None:
        if self.state is None:
            raise RuntimeError(
                "picks need anywidget: pip install pvfiblets[notebook]"
            )
        if picked is not None and picked.name not in self._names:
            raise ValueError(f"picked has the name {picked.name!r}; the page shows {sorted(self._names)}")
        self.state.set_trait("picked", None if picked is None else self._plain(picked))

    def _plain(self, picked: Picked) -> dict[str, Any]:
        place = {} if picked.place is None else {"place": list(picked.place)}
        return {"layer": self._names.index(picked.name), "streamline": int(picked.streamline), **place}

    def _place(self) -> dict[str, Any]:
        place = asdict(camera_place(self._camera))
        return {key: list(value) if isinstance(value, tuple) else value for key, value in place.items()}

    def _follow(self) -> None:
        """Follow the plotter's camera with the page, as long as this view exists."""
        weakref.finalize(self, observe(self._camera, ("ModifiedEvent",), weakly(self._from_plotter)))

    def _from_plotter(self) -> None:
        if self.state is not None and not self._told:
            self.state.camera = self._place()

    def _from_page(self, change: dict[str, Any]) -> None:
        camera, said = self._camera, change["new"]
        if self._place() == said:
            return
        self._told = True  # the page itself knows; it does not want to hear of half of it
        try:
            camera.SetPosition(said["position"])
            camera.SetFocalPoint(said["focal_point"])
            camera.SetViewUp(said["up"])
            camera.SetViewAngle(said["view_angle"])
            camera.parallel_projection = bool(said["parallel"])
            camera.SetParallelScale(said["parallel_scale"])
        finally:
            self._told = False

    def _repr_html_(self) -> str:
        over = "" if self.picture is None else ";position:absolute;left:0;top:0"
        # Without `allow-same-origin` the page reaches nothing of the notebook.
        frame = (
            f'<iframe sandbox="allow-scripts allow-downloads" width="100%" height="{self.height}" name="{self._name}" '
            f'style="border:0{over}" title="Streamlines" srcdoc="{html.escape(self.text, quote=True)}"></iframe>'
        )
        if self.picture is None:
            return frame
        picture = base64.b64encode(self.picture).decode()
        # Where frames are taken out, as GitHub does, the picture is there; else the frame lies over it.
        return (
            f'<div style="position:relative;height:{self.height}px;overflow:hidden">'
            f'<img alt="" style="max-width:100%" src="data:image/png;base64,{picture}"/>{frame}</div>'
        )


def page_view(
    plotter: pv.BasePlotter, *, title: str | None = None, height: int = 480, picture: bytes | None = None
) -> PageView:
    """Return what a plotter's active renderer shows as a page in a notebook; see `FibletsComponent.page_view`."""
    from pvfiblets.page.writing import LARGEST_FILE, write_page

    if isinstance(height, bool) or int(height) != height or not _HEIGHTS[0] <= height <= _HEIGHTS[1]:
        raise ValueError(f"height is {height!r}; give a whole number of pixels from {_HEIGHTS[0]} to {_HEIGHTS[1]}")
    if not plotter.renderer.camera_set:
        point_camera(plotter, "oblique")  # page and plotter share one camera
    scene, names = page_and_actors(plotter, title=title)
    size = sum(map(len, scene.blobs))
    if size > LARGEST_FILE:
        raise ValueError(
            f"the page has {size} bytes of data, and a notebook should not keep more than {LARGEST_FILE}; use "
            "export_page, or show fewer streamlines"
        )
    with tempfile.TemporaryDirectory() as folder:
        (path,) = write_page(scene, Path(folder) / "page.html")
        return PageView(path.read_text(encoding="utf-8"), int(height), plotter, names, picture)


def show(
    plotter: pv.BasePlotter, *, screenshot: Any = None, title: str | None = None, height: int | None = None
) -> PageView | Any:
    """Show a plotter in a notebook as a page: PyVista calls this for ``plotter.show(jupyter_backend="fiblets")``."""
    from PIL import Image
    from pyvista.jupyter.notebook import show_static_image

    from pvfiblets.plotting.fiblets.actor import FibletActor

    image = show_static_image(plotter, screenshot)
    if not any(isinstance(actor, FibletActor) for actor in plotter.renderer.actors.values()):
        return image
    file = io.BytesIO()
    assert isinstance(image, Image.Image)
    image.save(file, "PNG")
    least, most = _HEIGHTS
    size = min(max(int(plotter.window_size[1]), least), most) if height is None else height
    return page_view(plotter, title=title, height=size, picture=file.getvalue())
