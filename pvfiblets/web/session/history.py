"""The history of a scene, for undo and redo.

A step is the document before it and after it; documents share equal parts, so a step costs little.
The camera is no part of them.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Change, Scene
    from pvfiblets.web.session.document import State


@dataclass(frozen=True)
class _Step:
    """One thing that was done."""

    what: str
    before: State
    after: State
    key: tuple[str, ...] | None
    at: float


class History:
    """Undo and redo for a scene."""

    def __init__(
        self, scene: Scene, limit: int = 100, *, together: float = 1.0, clock: Callable[[], float] = time.monotonic
    ) -> None:
        if limit < 1:
            raise ValueError(f"limit is {limit}; give a number of steps from 1 on")
        self._scene = scene  # watched from now on
        self._limit = limit  # steps that are kept; the oldest go first
        # seconds within which changes of one and the same thing, such as a slider makes, are one step
        self._together = together
        self._clock = clock  # returns the time in seconds; for tests
        self.held = False  # A slider is held: its changes are one step, however long that takes
        self._done: list[_Step] = []
        self._undone: list[_Step] = []
        self._present = scene.state
        self._unwatch = scene.watch(self._changed)

    @property
    def undo_label(self) -> str | None:
        """Name of the step that :meth:`undo` would undo; None for nothing."""
        return self._done[-1].what if self._done else None

    @property
    def redo_label(self) -> str | None:
        """Name of the step that :meth:`redo` would redo; None for nothing."""
        return self._undone[-1].what if self._undone else None

    def __len__(self) -> int:
        return len(self._done)

    def undo(self) -> str | None:
        """Undo the last step; return its name, or None."""
        return self._move(self._done, self._undone, back=True)

    def redo(self) -> str | None:
        """Redo the last undone step; return its name, or None."""
        return self._move(self._undone, self._done, back=False)

    def clear(self) -> None:
        """Forget all steps."""
        self._done.clear()
        self._undone.clear()
        self._present = self._scene.state
        self._scene.forget_unused()

    def close(self) -> None:
        """Watch no longer; twice is harmless."""
        self._unwatch()

    def _move(self, steps: list[_Step], others: list[_Step], *, back: bool) -> str | None:
        if not steps:
            return None
        step = steps[-1]
        state = step.before if back else step.after
        self._scene.become(state)  # with no name: it is no step of its own
        self._present = state
        others.append(steps.pop())
        return step.what

    def _changed(self, change: Change) -> None:
        now, after = self._clock(), self._scene.state
        last = self._done[-1] if self._done and not self._undone else None
        before = self._present
        same = last is not None and change.key is not None and last.key == change.key
        if last is not None and same and (self.held or change.whole or now - last.at < self._together):
            before = last.before
            self._done.pop()
        self._undone.clear()
        self._done.append(_Step(change.what, before, after, change.key, now))
        self._present = after
        if len(self._done) > self._limit:
            del self._done[0]
        self._scene.forget_unused([state for step in self._done for state in (step.before, step.after)])
