"""`Actions`: what a part of the page does, apart from the page's layout."""

from __future__ import annotations

from typing import Any

from pvfiblets.web.document import LINES

__all__ = ["Actions", "LineActions"]


class Actions:
    """Some of an application's actions.

    Parameters
    ----------
    app : Explorer
        Whose scene and page these act on.
    """

    def __init__(self, app: Any) -> None:
        self._app = app


class LineActions(Actions):
    """Those on the chosen layer of lines."""

    @property
    def _layer(self) -> Any:
        """The chosen layer, which must be of lines."""
        page = self._app.page
        if not page.chosen or page.chosen_kind not in LINES:
            raise ValueError("choose a tractogram first")
        return self._app.scene.layer(page.chosen)
