"""Khronos' own GLSL compiler and the checker of what it makes: they let nothing pass that the languages forbid.

Drivers do, each something else: a shader that runs on one may be refused by the next.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

__all__ = ["check", "complaints", "glslang", "link"]


def _tool(name: str, package: str) -> str:
    path = shutil.which(name)
    if path is None:
        pytest.skip(f"no {name} on this machine (Debian: {package})")
    return path


def glslang() -> str:
    """Path of the compiler; the test is skipped where there is none."""
    return _tool("glslangValidator", "glslang-tools")


def complaints(paths: Sequence[Path]) -> list[str]:
    """Compile files of single stages, each by itself and all in one process; return what is said of bad ones."""
    done = subprocess.run([glslang(), *map(str, paths)], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        return []
    # A line with a file's name comes before what is said of it.
    names, said, name = {str(path) for path in paths}, [], ""
    for line in done.stdout.splitlines():
        if line in names:
            name = line
        elif line.startswith(("ERROR", "WARNING")):
            said.append(f"{name}: {line}")
    return said or [done.stdout]


def link(folder: Path, sources: Mapping[str, str], *options: str) -> subprocess.CompletedProcess[str]:
    """Compile all stages of a program and link them, without taking a look at what comes out."""
    command = [glslang(), "-l", *options, *_written(folder, sources)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def check(folder: Path, sources: Mapping[str, str]) -> str:
    """Compile, link, make SPIR-V for OpenGL of a program's stages, and have that checked; return what is wrong."""
    text = "\n".join(sources.values())
    version = "1.4" if "FEATURE_MESH_EXT 1" in text else "1.3" if "FEATURE_SUBGROUPS 1" in text else "1.0"
    made = folder / "program.spv"
    options = ["-G", "--auto-map-locations", "--auto-map-bindings", "--target-env", f"spirv{version}", "-o", str(made)]
    done = subprocess.run(
        [glslang(), *options, *_written(folder, sources)], capture_output=True, text=True, check=False
    )
    if done.returncode != 0 or "ERROR" in done.stdout:
        return done.stdout
    # OpenGL 4.5 names SPIR-V 1.0 only; extensions that came after it ask for more.
    target = "opengl4.5" if version == "1.0" else f"spv{version}"
    checker = _tool("spirv-val", "spirv-tools")
    done = subprocess.run([checker, "--target-env", target, str(made)], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr if done.returncode else ""


def _written(folder: Path, sources: Mapping[str, str]) -> list[str]:
    for stage, source in sources.items():
        (folder / f"stage.{stage}").write_text(source)
    return [str(folder / f"stage.{stage}") for stage in sources]
