"""Uniforms of programs, set where they change: a program keeps their values, and each call takes time."""

from __future__ import annotations

from typing import Any

import moderngl

from .moderngl_extras import Uniform


def set_uniforms(program: Any, **uniforms: object) -> None:
    """Set those uniforms that the compiler left in, as far as they are not what this function set last."""
    told = program.extra
    if told is None:
        told = program.extra = {}
    for name, value in uniforms.items():
        if name in told and told[name] == value:
            continue
        if isinstance(program.get(name, None), (moderngl.Uniform, Uniform)):
            program[name] = value
        told[name] = value
