"""The calls and arguments that browsers may send: the only doors of a worker.

trame lets a browser set any key of its state and call any method that was registered. Here it may set a few keys of
known types, call the triggers that the page uses, and move the pointer; whatever else comes is refused and logged by
name, never with its content.
"""

from __future__ import annotations

import inspect
import logging
import math
from collections.abc import Callable, Mapping
from typing import Any

from pvfiblets.errors import FibletsError
from pvfiblets.support.memory import TooLargeError, limited_to, shown
from pvfiblets.web.server.access import REFUSED
from pvfiblets.web.server.log_limiter import printable

logger = logging.getLogger("pvfiblets.web")

LONGEST_TEXT = 20_000  # files come by HTTP
LONGEST_STATE = 1000  # characters of a text that is kept
LARGEST_SIDE = 8192  # pixels of a picture
MOST_PIXELS = 4096 * 2304
PENDING = 8  # messages that come in several pieces at the same time; each takes memory for the whole of it
LISTENED = 64  # keys of one state change, arguments of one call

EVENTS = frozenset(
    {
        "MouseMove", "LeftButtonPress", "LeftButtonRelease", "MiddleButtonPress", "MiddleButtonRelease",
        "RightButtonPress", "RightButtonRelease", "LeftButtonDoubleClick", "StartMouseWheel", "MouseWheel",
        "EndMouseWheel", "StartInteractionEvent", "EndInteractionEvent", "InteractionEvent", "MouseEnter", "MouseLeave",
        "StartPinch", "Pinch", "EndPinch", "StartPan", "Pan", "EndPan", "StartRotate", "Rotate", "EndRotate",
    }
)  # fmt: skip
# Keys have their meaning in client/pvfiblets.js; VTK's own would close or spoil the view.
KEYS = frozenset({"keyPress", "keyDown", "keyUp", "KeyPress", "KeyDown", "KeyUp"})
# Lifecycle events that trame's client reports.
LIFECYCLE = frozenset({"client_connected", "client_exited", "client_unmounted", "client_unmounting"})


Check = Callable[..., list[Any] | None]  # turns a message's arguments into a method's; `None`: nothing to call


# What wrong input raises; anything else is a mistake in this program, and its traceback is for the log.
EXPECTED = (FibletsError, OSError, ValueError, KeyError, MemoryError)


# What unpacking a message raises that is none.
UNREADABLE = (ValueError, TypeError, LookupError, RecursionError, MemoryError)


class MalformedError(ValueError):
    """A message that no page of this application sends."""


def number(value: object, low: float = -1e9, high: float = 1e9) -> float:
    """Return a finite number within limits."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise MalformedError(f"expected a number, found {type(value).__name__}")
    if not low <= value <= high:
        raise MalformedError(f"expected a number from {low:g} to {high:g}, found {value:g}")
    return float(value)


def plain(value: object, depth: int = 0) -> object:
    """Return a value of JSON: not too deep, too long, or with numbers that are none."""
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, (int, float)):
        return value if isinstance(value, int) and abs(value) < 2**53 else number(value, -1e300, 1e300)
    if isinstance(value, str):
        if len(value) > LONGEST_TEXT:
            raise MalformedError(f"a text of {len(value)} characters")
        return value
    if depth > 6:
        raise MalformedError("a value nested too deeply")
    if isinstance(value, list):
        if len(value) > 100_000:
            raise MalformedError(f"a list of {len(value)}")
        return [plain(item, depth + 1) for item in value]
    if isinstance(value, dict):
        if len(value) > 1000:
            raise MalformedError(f"a mapping of {len(value)}")
        return {str(key)[:200]: plain(item, depth + 1) for key, item in value.items()}
    raise MalformedError(f"a value of type {type(value).__name__}")


def pointer_event(event: object) -> dict[str, Any]:
    """Return an event of the pointer for VTK, checked."""
    if not isinstance(event, dict) or event.get("type") not in EVENTS:
        raise MalformedError("not an event of the pointer")
    found = plain(event)
    assert isinstance(found, dict)
    for name in ("x", "y", "w", "h", "spinY", "factor", "rotation"):
        if name in found:
            number(found[name], -1e6, 1e6)
    if "translation" in found:
        _pair(found["translation"])
    positions = found.get("positions", {})
    if not isinstance(positions, dict) or len(positions) > 20:
        raise MalformedError("positions of fingers that are none")
    for place in positions.values():
        if not isinstance(place, dict):
            raise MalformedError("a position that is none")
        for name in ("x", "y"):
            number(place.get(name, 0.0), -1e6, 1e6)
    return found


def _pair(value: object) -> None:
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise MalformedError("expected two numbers")
    for item in value:
        number(item, -1e6, 1e6)


def view_size(size: object) -> tuple[int, int, float]:
    """Return width and height in CSS pixels and the ratio of the device's pixels to them, checked."""
    if not isinstance(size, dict):
        raise MalformedError("not a size")
    width = round(number(size.get("w"), 0, LARGEST_SIDE))
    height = round(number(size.get("h"), 0, LARGEST_SIDE))
    return max(width, 16), max(height, 16), number(size.get("p", 1.0), 0.1, 8.0)


def sentence(error: BaseException) -> str:
    """Return an error as users read it."""
    if isinstance(error, MemoryError):
        most = limited_to()
        said = str(error) if isinstance(error, TooLargeError) else str(TooLargeError())
        of = "" if most is None else f" of the {shown(most)} that a session may have"
        remedy = "" if most is None else ", or have the server started with a larger --max-memory"
        return f"{said}{of}; remove layers, open less{remedy}"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror  # without the server's path
    return str(error.args[0] if isinstance(error, KeyError) and error.args else error) or type(error).__name__


def check_call(call: object) -> None:
    """Refuse a message that is no call as the page makes them."""
    if not isinstance(call, dict):
        raise MalformedError(f"a call that is a {type(call).__name__}")
    for name in ("id", "method"):
        if not isinstance(call.get(name), str):
            raise MalformedError(f"a call without a text as its {name}")
    if not isinstance(call.get("args", []), list) or call.get("kwargs"):
        raise MalformedError("a call with arguments that are no list")


def guard_messages(handler: Any, complain: Callable[[str], None]) -> None:
    """Close connections that send malformed messages, and log it; wslink would write a traceback."""
    receive, complete = handler.onMessage, handler.onCompleteMessage

    async def on_complete(call: object, client: str) -> None:
        check_call(call)
        await complete(call, client)

    async def on_message(is_binary: bool, message: Any, client: str) -> None:
        try:
            if not is_binary:
                raise MalformedError("a text")
            await receive(is_binary, message, client)
            if len(handler.unchunkers[client].pending_messages) > PENDING:
                raise MalformedError("too many messages that are not complete")
        except ConnectionError:  # it has gone: its own loop ends
            return
        except UNREADABLE as error:  # called methods catch their own errors
            reason = str(error) if isinstance(error, MalformedError) else type(error).__name__
            logger.warning("refused a message: %s", reason)
            complain(f"{REFUSED}: {reason}.")
            handler.unchunkers[client].release_pending_messages()
            await handler.connections[client].close(code=1007, message=b"malformed message")

    handler.onMessage, handler.onCompleteMessage = on_message, on_complete


class AllowedCalls:
    """Stands between wslink's messages and the called methods."""

    def __init__(
        self, writable: Mapping[str, type], triggers: Callable[[str], bool], complain: Callable[[str], None]
    ) -> None:
        self._writable = writable  # the keys of the state that a browser may set, and the type of each
        self._triggers = triggers  # says whether a name is a trigger that the page uses
        self._complain = complain  # told of every refusal and every error, as one sentence for the user

    def guard(self, functions: dict[str, tuple[Any, Callable[..., Any]]]) -> None:
        """Replace a handler's table of methods by one of checked ones; others are gone."""
        checks: dict[str, Check] = {
            "trame.state.get": self._nothing,
            "trame.state.update": self._state,
            "trame.trigger": self._trigger,
            "trame.lifecycle.update": self._lifecycle,
            "trame.error.client": self._client_error,
            "trame.rca.size": self._size,
            "trame.rca.event": self._event,
            "trame.rca.reset": self._area,
        }
        kept = {
            name: (found[0], self._checked(name, check, found[1]))
            for name, check in checks.items()
            if (found := functions.get(name)) is not None
        }
        # Said by the client when it leaves; the front server decides when a session ends.
        functions.clear()
        functions.update(kept)
        functions["application.exit.later"] = (None, lambda *_: None)

    def _checked(self, name: str, check: Check, function: Callable[..., Any]) -> Callable[..., Any]:
        async def call(target: Any, *arguments: Any, **named: Any) -> Any:
            try:
                if named:
                    raise MalformedError("named arguments")
                checked = check(*arguments)
            except (MalformedError, TypeError) as error:
                reason = error if isinstance(error, MalformedError) else "wrong arguments"
                logger.warning("refused a call of %s: %s", name, reason)
                self._complain(f"{REFUSED}: {reason}.")
                return None
            if checked is None:
                return None
            try:
                result = function(target, *checked)
                if inspect.isawaitable(result):
                    result = await result
            except EXPECTED as error:
                logger.info("%s: %s", name, sentence(error))
                self._complain(sentence(error))
                return None
            except Exception as error:
                logger.exception("%s failed", name)
                self._complain(sentence(error))
                return None
            return result

        return call

    def _nothing(self) -> list[Any]:
        return []

    def _state(self, changes: object) -> list[Any]:
        if not isinstance(changes, list) or len(changes) > LISTENED:
            raise MalformedError("state changes that are no short list")
        allowed = []
        for change in changes:
            if not isinstance(change, dict) or not isinstance(change.get("key"), str):
                raise MalformedError("a state change without a key")
            key, value = change["key"], plain(change.get("value"))
            if key.startswith("trame__"):  # what trame's own client reports; nothing here listens
                continue
            kind = self._writable.get(key)
            if kind is None:
                raise MalformedError(f"the state {key[:40]!r} is not a browser's to set")
            if kind is float and isinstance(value, int) and not isinstance(value, bool):
                value = float(value)
            if isinstance(value, str) and len(value) > LONGEST_STATE:
                raise MalformedError(f"the state {key!r} is a text of {len(value)} characters")
            if not isinstance(value, kind):
                raise MalformedError(f"the state {key!r} is a {kind.__name__}, found {type(value).__name__}")
            allowed.append({"key": key, "value": value})
        return [allowed]

    def _trigger(self, name: object, arguments: object = None, named: object = None) -> list[Any]:
        if not isinstance(name, str) or not self._triggers(name):
            raise MalformedError(f"no trigger {str(name)[:40]!r}")
        arguments, named = arguments or [], named or {}
        if not isinstance(arguments, list) or len(arguments) > LISTENED or named:
            raise MalformedError("arguments of a trigger that are no short list")
        return [name, plain(arguments), {}]

    def _lifecycle(self, name: object) -> list[Any]:
        if name not in LIFECYCLE:
            raise MalformedError("not an event of a page's life")
        return [name]

    def _client_error(self, message: object) -> list[Any]:
        return [printable(str(message)[:500])]

    def _area(self, area: object, *_: object) -> list[Any]:
        if not isinstance(area, str):
            raise MalformedError("an area without a name")
        return [area]

    def _size(self, area: object, origin: object, size: object) -> list[Any]:
        width, height, ratio = view_size(size)
        return [*self._area(area), str(origin)[:100], {"w": width, "h": height, "p": ratio}]

    def _event(self, area: object, origin: object, event: object) -> list[Any] | None:
        if isinstance(event, dict) and event.get("type") in KEYS:
            return None
        return [*self._area(area), str(origin)[:100], pointer_event(event)]
