"""Which modules of the package a module brings with it: the closure of imports that run when it is imported."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def file_of(module: str) -> Path | None:
    """Return the file of a module of the package, by its name below ``pvfiblets``; None if there is none."""
    base = ROOT / "pvfiblets"
    path = base.joinpath(*module.split(".")) if module != "pvfiblets" else base
    return next((file for file in (path / "__init__.py", path.with_suffix(".py")) if file.is_file()), None)


def _running(body: Iterable[ast.stmt]) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield imports that run with the module: none of functions, and none that are for type checkers alone."""
    for statement in body:
        if isinstance(statement, (ast.Import, ast.ImportFrom)):
            yield statement
        elif isinstance(statement, ast.If) and "TYPE_CHECKING" not in ast.unparse(statement.test):
            yield from _running([*statement.body, *statement.orelse])
        elif isinstance(statement, (ast.Try, ast.With, ast.ClassDef)):
            yield from _running(statement.body)


@cache
def imports(module: str) -> frozenset[str]:
    """Return the modules of the package that one imports as it is imported, and the packages that it lies in."""
    file = file_of(module)
    assert file is not None, f"no module pvfiblets.{module}"
    inside = ["pvfiblets"] if module == "pvfiblets" else ["pvfiblets", *module.split(".")]
    package = inside if file.name == "__init__.py" else inside[:-1]
    found = {".".join(inside[1:end]) for end in range(2, len(inside))} | {"pvfiblets"}
    for statement in _running(ast.parse(file.read_text(encoding="utf-8")).body):
        if isinstance(statement, ast.Import):
            names = [alias.name for alias in statement.names]
        else:
            base = package[: len(package) - statement.level + 1] if statement.level else []
            source = ".".join([*base, *([statement.module] if statement.module else [])])
            names = [source, *(f"{source}.{alias.name}" for alias in statement.names)]
        for name in names:
            if name == "pvfiblets" or name.startswith("pvfiblets."):
                below = name.removeprefix("pvfiblets").removeprefix(".") or "pvfiblets"
                if file_of(below):
                    found |= {below, *(".".join(below.split(".")[:end]) for end in range(1, below.count(".") + 1))}
    return frozenset(found - {module})


def closure(entries: Iterable[str]) -> set[str]:
    """Return all modules that are there once some are imported, these included."""
    there: set[str] = set()
    waiting = list(entries)
    while waiting:
        if (module := waiting.pop()) not in there:
            there.add(module)
            waiting.extend(imports(module))
    return there
