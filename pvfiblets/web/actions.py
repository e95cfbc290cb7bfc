"""`Actions`: what a part of the page does, apart from the page's layout."""

from __future__ import annotations

from typing import Any

__all__ = ["Actions"]


class Actions:
    """Some of an application's actions.

    Parameters
    ----------
    app : Explorer
        Whose scene and page these act on.
    """

    def __init__(self, app: Any) -> None:
        self._app = app
