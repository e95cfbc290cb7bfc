"""`Actions`: what a part of the page does, apart from the page's layout."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.web.scene.files.loading import Cancelled, Watch
from pvfiblets.web.session.document import LINES

if TYPE_CHECKING:
    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.web.app import Explorer
    from pvfiblets.web.session.document import Layer


class Actions:
    """Some of an application's actions."""

    def __init__(self, app: Explorer) -> None:
        self._app = app  # whose scene and page these act on

    def refresh(self) -> None:
        """Bring the page's data in step with the scene."""

    def _show(self) -> None:
        with self._app.state:
            self.refresh()


class LineActions(Actions):
    """Actions on the chosen layer of lines."""

    @property
    def _layer(self) -> Layer:
        """The chosen layer, which must be of lines."""
        page = self._app.page
        if not page.chosen or page.chosen_kind not in LINES:
            raise ValueError("choose a tractogram first")
        return self._app.scene.layer(page.chosen)

    async def _beside(
        self, layer: Layer, fiblets: FibletSet, work: Callable[[Watch], Any], what: str, *, cancelled: str, again: str
    ) -> Any:
        """Do work on a layer's streamlines beside everything else; None if it was cancelled."""
        app = self._app
        try:
            found = await app.files.run_in_background(
                layer.name, lambda progress, cancel: work(Watch(progress, cancel)), what
            )
        except Cancelled:
            app.say(f"{layer.name}: cancelled{cancelled}.")
            return None
        if app.scene.actor(layer.id).fiblets is not fiblets:
            raise ValueError(f"{layer.name} has other streamlines now; {again} again")
        return found
