"""What OpenGL says of how it is used (KHR_debug): errors, undefined behaviour, and what it will not do for long."""

from __future__ import annotations

import ctypes

from pvfiblets.engine.gl.gl_loader import loader

API = 0x8246  # shader compilers say much of what tests ask of them
KINDS = {0x824C: "error", 0x824D: "deprecated", 0x824E: "undefined behaviour", 0x824F: "not portable"}
_OUTPUT, _AT_ONCE = 0x92E0, 0x8242
_LONGEST = 1 << 14


class DebugLog:
    """The messages of a context, which must be current; none where OpenGL is older than 4.3."""

    def __init__(self, ctx):
        address = loader()("glGetDebugMessageLog")
        numbers = ctypes.POINTER(ctypes.c_uint)
        kind = ctypes.CFUNCTYPE(
            ctypes.c_uint, ctypes.c_uint, ctypes.c_int, numbers, numbers, numbers, numbers,
            ctypes.POINTER(ctypes.c_int), ctypes.c_char_p,
        )  # fmt: skip
        self._next = kind(address) if address else None
        if self._next is not None:
            ctx.enable_direct(_OUTPUT)
            ctx.enable_direct(_AT_ONCE)

    def take(self):
        """Return the complaints since the last time, and forget them."""
        found = []
        text = ctypes.create_string_buffer(_LONGEST)
        source, kind, number, severity = (ctypes.c_uint() for _ in range(4))
        length = ctypes.c_int()
        fields = [ctypes.byref(field) for field in (source, kind, number, severity, length)]
        while self._next is not None and self._next(1, _LONGEST, *fields, text):
            if source.value == API and kind.value in KINDS:
                found.append(f"{KINDS[kind.value]}: {text.value.decode(errors='replace')}")
        return found
