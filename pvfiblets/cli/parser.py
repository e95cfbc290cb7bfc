"""A parser of the command line that guesses which word was meant."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import Any, TypeAlias


class Parser(argparse.ArgumentParser):
    """argparse's, whose errors name the option or command that is spelt most alike, and the command they are of."""

    def parse_known_args(  # type: ignore[override]  # argparse gives it overloads for other namespaces
        self, args: Sequence[str] | None = None, namespace: argparse.Namespace | None = None
    ) -> tuple[argparse.Namespace, list[str]]:
        """Parse as argparse does, but for words that are not known, which a command tells itself."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown and not self._commands():
            self.error(f"unrecognized arguments: {' '.join(unknown)}{self._meant(unknown)}")
        return found, unknown

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            raise argparse.ArgumentError(
                action, f"{error.message}{_like(str(value), map(str, action.choices or ()))}"
            ) from None

    def _commands(self) -> bool:
        return any(isinstance(action, argparse._SubParsersAction) for action in self._actions)  # noqa: SLF001

    def _meant(self, unknown: Sequence[str]) -> str:
        options = [option for action in self._actions for option in action.option_strings]
        return next(filter(None, (_like(word.partition("=")[0], options) for word in unknown if word[:1] == "-")), "")


def _like(word: str, known: Iterable[str]) -> str:
    alike = get_close_matches(word, list(known), 1)
    return f"; did you mean {alike[0]}?" if alike else ""


Commands: TypeAlias = "argparse._SubParsersAction[Parser]"  # noqa: SLF001 - argparse has no public name
"""What ``add_subparsers`` returns."""
