"""A log that a flood cannot fill: so many lines of a kind in a while, then how many more there were."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

LINES = 20  # of one kind in one period
PERIOD = 60.0  # seconds
LONGEST = 1000  # characters of a line that somebody else wrote

_Kind = tuple[str, int, str, str]


class LogLimiter(logging.Filter):
    """Lets through a few records of a kind, and says how many it left out.

    A kind is the logger, the level and the text before its arguments are put in; a record with the attribute ``about``
    (given by ``extra``) shares its kind only with records about the same, and ten times the limit are let through: they
    are a session's, and tracebacks are long.
    """

    def __init__(
        self, lines: int = LINES, seconds: float = PERIOD, clock: Callable[[], float] = time.monotonic
    ) -> None:
        super().__init__()
        # returns the time in seconds
        # how long a period is
        self.lines, self.seconds, self._clock = lines, seconds, clock  # the most records of a kind in one period
        self._lock = threading.Lock()
        self._began = clock()
        self._counts: dict[_Kind, int] = {}
        self._left_out: dict[_Kind, str] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        """Return whether a record is to be written."""
        if getattr(record, "counted", False):
            return True
        if self._clock() - self._began > self.seconds:
            self.report()
        kind = (record.name, record.levelno, str(record.msg) if record.args else "", getattr(record, "about", ""))
        with self._lock:
            count = self._counts[kind] = self._counts.get(kind, 0) + 1
            if count == self._most(kind) + 1:
                self._left_out[kind] = record.getMessage()[:200]
        return count <= self._most(kind)

    def _most(self, kind: _Kind) -> int:
        return self.lines * (10 if kind[3] else 1)

    def report(self) -> None:
        """Log how many records were dropped since the last report, and begin another period."""
        with self._lock:
            counts, left_out = self._counts, self._left_out
            self._counts, self._left_out = {}, {}
            self._began = self._clock()
        for kind, example in left_out.items():
            logging.getLogger(kind[0]).log(
                kind[1],
                "%d more lines were left out, of the kind: %s",
                counts[kind] - self._most(kind),
                example,
                extra={"counted": True},
            )


def printable(text: str) -> str:
    """Return a text for one line of a log: what moves a terminal's cursor or colours it is written out."""
    cut = text if len(text) <= LONGEST else f"{text[:LONGEST]}… ({len(text)} characters)"
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in cut)
