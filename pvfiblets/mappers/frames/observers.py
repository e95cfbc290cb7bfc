"""Calls that VTK and others make for an object, and that do not keep it alive."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Sequence
from typing import Any

from pvfiblets.mappers.frames.scene import weak


def observe(
    watched: Any, events: Sequence[str], call: Callable[[Any, str], object], priority: float = 0.0
) -> Callable[[], None]:
    """Call a function with VTK's object and each event; return what ends that, and may be called twice."""
    # An event goes no further where the function returns True.
    kept, tags = weak(watched), dict[str, int]()

    def called(caller: Any, event: str) -> None:
        if call(caller, event) is True:
            caller.GetCommand(tags[event]).SetAbortFlag(1)

    for event in events:
        tags[event] = watched.AddObserver(event, called, priority)

    def end() -> None:
        there: Any = kept.Get()
        while tags:
            _, tag = tags.popitem()
            if there is not None:
                there.RemoveObserver(tag)

    return end


def weakly(method: Callable[..., Any], *, passing: bool = False) -> Callable[..., Any]:
    """Return a function that calls a method while its object lives; it passes arguments on only if asked to."""
    reference = weakref.WeakMethod(method)

    def call(*arguments: Any) -> Any:
        alive = reference()
        return None if alive is None else alive(*arguments) if passing else alive()

    return call
