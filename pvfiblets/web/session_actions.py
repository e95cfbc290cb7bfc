"""Sessions of the page: saved, kept in the served folder, and opened with progress."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pvfiblets.web.beside import Beside
from pvfiblets.web.loading import Cancelled

__all__ = ["SESSION", "SessionActions"]

SESSION = ".json"
"""The suffix of sessions."""


class SessionActions(Beside):
    """The sessions of an application."""

    def save_session(self) -> str:
        """Return the session as JSON."""
        from pvfiblets.web import session

        return json.dumps(session.to_dict(self._app.scene), indent=1)

    def store_session(self, name: str) -> None:
        """Write the session to a file of the served folder."""
        from pvfiblets.web import session

        app = self._app
        name = str(name).strip().removesuffix(SESSION) + SESSION
        app.confined.writable(name, (SESSION,))
        session.save(app.scene, name)
        app.page.dialog = ""
        app.say(f"The session is saved in the served folder as {name}.", "success")

    def _text(self, path: str) -> str:
        """Return the text of a session file in the served folder."""
        from pvfiblets.web.session import LARGEST

        place = self._app.confined.existing(path)
        if place.stat().st_size > LARGEST:
            raise ValueError(f"{path} has {place.stat().st_size:,} bytes; sessions have {LARGEST:,} at most")
        return str(place.read_text(encoding="utf-8"))

    def load_session(self, text: str, folder: Path | None = None) -> None:
        """Become what a session file says; where it is malformed, all stays as it is.

        Parameters
        ----------
        text : str
            What the file holds.
        folder : Path, optional
            Where it lies in the served folder: its paths are looked for there first.
        """
        try:
            data = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"this is no session file: {error}") from error
        self._app.later(self._become(data, folder))

    async def _become(self, data: Any, folder: Path | None) -> None:
        from pvfiblets.web import session

        app = self._app
        scene = app.scene
        try:
            prepared = await self.beside(
                "session", lambda progress, cancel: session.prepare(scene, data, folder, progress, cancel), "reading"
            )
        except Cancelled:
            app.say("The session was not loaded: cancelled.")
            return
        session.apply(scene, prepared)
        app.refresh()
