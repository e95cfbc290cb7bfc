"""The engine with other values of its constants, for as long as something is measured beside its usual self."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from importlib import import_module
from typing import Any
from unittest.mock import patch

ENGINE = "pvfiblets.engine"


@contextmanager
def replaced(constants: Mapping[str, Any]) -> Iterator[None]:
    """Give constants other values, ``{"gl.passes:GROUP_SIZE": 128}``, in all modules of the engine that hold them.

    Of a named tuple some fields are given, as a mapping.
    """
    with ExitStack() as stack:
        for place, given in constants.items():
            module, _, name = place.partition(":")
            usual = getattr(import_module(f"{ENGINE}.{module}"), name)
            value = usual._replace(**given) if isinstance(given, Mapping) else given
            for other in [one for key, one in sys.modules.items() if key.startswith(ENGINE)]:
                if vars(other).get(name) == usual:
                    stack.enter_context(patch.object(other, name, value))
                if name.lower() in vars(other).get("CONSTANTS", {}):  # what shaders are told
                    stack.enter_context(patch.dict(vars(other)["CONSTANTS"], {name.lower(): value}))
        yield
