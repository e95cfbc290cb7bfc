"""Addresses of OpenGL functions, from whatever made the context that is current: EGL, GLX, WGL or CGL."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from ctypes.util import find_library
from functools import cache
from typing import Any

from ..errors import EngineError


@cache
def _library(name: str) -> Any:
    """Load a library by its short name, None where there is none."""
    path = find_library(name)
    return None if path is None else ctypes.CDLL(path)


def loader() -> Callable[[str], int]:
    """Return what looks up functions of the current context: EGL's or GLX's, WGL's, or macOS' framework."""
    if sys.platform == "win32":
        library = ctypes.WinDLL("opengl32")
        library.wglGetProcAddress.restype = library.wglGetCurrentContext.restype = ctypes.c_void_p
        if library.wglGetCurrentContext():
            return lambda name: library.wglGetProcAddress(name.encode()) or _exported(library, name)
    elif sys.platform == "darwin":
        framework = ctypes.CDLL("/System/Library/Frameworks/OpenGL.framework/OpenGL")
        framework.CGLGetCurrentContext.restype = ctypes.c_void_p
        if framework.CGLGetCurrentContext():
            return lambda name: _exported(framework, name)
    else:
        for short, current, address in (
            ("EGL", "eglGetCurrentContext", "eglGetProcAddress"),
            ("GL", "glXGetCurrentContext", "glXGetProcAddressARB"),
        ):
            library = _library(short)
            if library is None:
                continue
            is_current, look_up = getattr(library, current), getattr(library, address)
            is_current.restype = look_up.restype = ctypes.c_void_p
            if is_current():
                return lambda name, look_up=look_up: look_up(name.encode()) or 0  # type: ignore[misc]  # mypy infers no defaults of lambdas
    raise EngineError("no OpenGL context is current; make it so (render_window.MakeCurrent(), or `with ctx:`)")


def _exported(library: Any, name: str) -> int:
    """Return the address of a function that a library exports, 0 where it does not."""
    function = getattr(library, name, None)
    return 0 if function is None else ctypes.cast(function, ctypes.c_void_p).value or 0
