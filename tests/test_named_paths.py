"""Paths and files that comments, docstrings, shaders and pages name are there."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
KINDS = ("glsl", "comp", "frag", "vert", "geom", "tesc", "tese", "task", "mesh", "py")
NAMED = re.compile(
    rf"(?<![\w/.*{{}}<>-])((?:[\w-]+/)*[a-z][\w-]*\.(?:{'|'.join(KINDS)})|shaders(?:/[\w-]+)+)(?![\w*/(-]|\.\w)"
)
FOLDERS = ("pvfiblets", "shaders", "tests", "benchmarks", "docs", "examples", "scripts")
FILES = {
    path.relative_to(ROOT).as_posix()
    for folder in FOLDERS
    for path in (ROOT / folder).rglob("*")
    if "__pycache__" not in path.parts and "_build" not in path.parts
} | set(FOLDERS)
NAMES = {name.rpartition("/")[2] for name in FILES}
WRITTEN = re.compile(r"codec/layout\.glsl|uniforms/\w+\.glsl")  # by the package itself
ELSEWHERE = ("shaders/resolve/emission.glsl", "wslink/chunking.py")  # an example, and another library's


def prose(source: str, python: bool) -> Iterator[tuple[int, str]]:
    """Yield lines with their numbers; of Python, comments and docstrings."""
    if not python:
        yield from enumerate(source.splitlines(), 1)
        return
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(source)):
        value = node.value if isinstance(node, ast.Expr) else None
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            yield from enumerate(value.value.splitlines(), value.lineno)


def exists(name: str, source: str) -> bool:
    """Say whether a path is there: from the root, from a room, or from a folder that its source lies in."""
    if "/" not in name:
        return name in NAMES
    inside = source.split("/")[:-1]
    bases = ["", "shaders/", "pvfiblets/", *("/".join(inside[:end]) + "/" for end in range(1, len(inside) + 1))]
    return any(base + name in FILES for base in bases)


def unknown(path: str, text: str) -> list[str]:
    """Return what a file names that is not there."""
    if not NAMED.search(text):
        return []
    named = [(line, name) for line, words in prose(text, path.endswith(".py")) for name in NAMED.findall(words)]
    return [
        f"{path}:{line}: {name}"
        for line, name in named
        if name not in ELSEWHERE and name == name.lower() and not WRITTEN.fullmatch(name) and not exists(name, path)
    ]


def test_a_dead_pointer_is_seen():
    text = '"""See ``shaders/nowhere``\n``culling/frustum.glsl``, now.comp."""\nx = "no/code.py"  # codec/nothing.py\n'
    assert [line.split(": ") for line in unknown("pvfiblets/a.py", text)] == [
        ["pvfiblets/a.py:3", "codec/nothing.py"],
        ["pvfiblets/a.py:1", "shaders/nowhere"],
        ["pvfiblets/a.py:2", "now.comp"],
    ]


@pytest.mark.more
def test_every_named_path_is_there():
    kinds = (*(f".{kind}" for kind in KINDS), ".md", ".rst")
    sources = [name for name in FILES if name.endswith(kinds) and not name.startswith("docs/benchmarks/")]
    sources += [name for name in ("README.md", "CONTRIBUTING.md") if (ROOT / name).is_file()]
    assert len(sources) > 500
    missing = [line for name in sources for line in unknown(name, (ROOT / name).read_text(encoding="utf-8"))]
    assert not missing, "\n".join(sorted(missing))
