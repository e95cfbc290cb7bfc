"""Write ``pvfiblets/plotting/plotter.pyi``, for type checkers and editors, from the declarations.

``python scripts/plotter_stub.py`` writes it; a test says when that was forgotten.
"""

from __future__ import annotations

import inspect
import re
import tomllib
from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
STUB = ROOT / "pvfiblets" / "plotting" / "plotter.pyi"

WIDEST = 115

KNOWN = {
    "Any": "from typing import Any",
    "ColorLike": "from pyvista.plotting._typing import ColorLike",
    "ColormapOptions": "from pyvista.plotting._typing import ColormapOptions",
    "Displacement": "from pvfiblets.halos.displacement import Displacement",
    "Iterable": "from collections.abc import Iterable",
    "PerPoint": "from pvfiblets.codec.encoding.compress import PerPoint",
    "Preference": "from pvfiblets.plotting.colours.same_names import Preference",
    "Sequence": "from collections.abc import Sequence",
    "Threshold": "from pvfiblets.plotting.halos.settings import Threshold",
    "TransformLike": "from pyvista.core._typing_core import TransformLike",
    "np": "import numpy as np",
}
"""What annotations of arguments name; another name wants a line here."""


def stub() -> str:
    """Return the text of the stub."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    named = project["entry-points"]["pyvista.plotter_components"]
    found = [one for module in dict.fromkeys(named.values()) for one in _components(import_module(module))]
    made = {one.ADD: one for one in found} | {one.NAME: one for one in found}
    imports, classes, members = {"import pyvista as pv", "from typing import Any, Protocol"}, [], []
    for name, module in named.items():
        component = made.get(name)
        if component is None:
            kind = "".join(part.title() for part in name.split("_")) + "Component"
            imports.add(f"from {module} import {kind}")
        elif name == component.ADD:
            kind = _adder(component)
            classes.append(_class_of_adder(component, imports))
        else:
            kind = f"_{component.__name__}"
            imports.add(f"from {module} import {component.__name__}")
            classes.append(
                f"class {kind}({component.__name__}):\n    @property\n"
                f"    def add(self) -> {_adder(component)}: ...{_narrower(component)}"
            )
        members.append(f"    @property\n    def {name}(self) -> {kind}: ...")
    text = "\n\n".join([*classes, "\n".join(["class Plotter(pv.Plotter):", *members])])
    imports |= {line for name, line in KNOWN.items() if re.search(rf"\b{name}\b", text)} - {KNOWN["Any"]}
    ours = _joined(line for line in imports if "pvfiblets" in line)
    theirs = [line for line in imports if line.split()[1].split(".")[0] in ("numpy", "pyvista")]
    standard = [line for line in imports if "pvfiblets" not in line and line not in theirs]
    theirs, standard = (
        sorted(line for line in lines if line.startswith("import"))
        + _joined(line for line in lines if line.startswith("from"))
        for lines in (theirs, standard)
    )
    blocks = ["\n".join(block) for block in (standard, theirs, ours) if block]
    head = "# Written by scripts/plotter_stub.py from the settings that are declared; do not change it by hand."
    return "\n\n".join([head, *blocks, '__all__ = ["Plotter"]', text]) + "\n"


def _joined(lines: Iterable[str]) -> list[str]:
    """Return ``from`` lines with all names of a module in one, except renamed ones."""
    names: dict[str, list[str]] = {}
    for line in sorted(lines):
        module, _, name = line.removeprefix("from ").partition(" import ")
        names.setdefault(f"{module} as" if " as " in name else module, []).append(name)
    return sorted(f"from {module.removesuffix(' as')} import {', '.join(found)}" for module, found in names.items())


def _components(module: Any) -> list[Any]:
    return [
        one
        for one in vars(module).values()
        if inspect.isclass(one) and hasattr(one, "ADD") and one.__module__ == module.__name__
    ]


def _narrower(component: Any) -> str:
    """Return a remark for type checkers where ``add`` takes less than that of all components does."""
    kinds = {one.kind for one in inspect.signature(component.add).parameters.values()}
    return "" if inspect.Parameter.VAR_KEYWORD in kinds else "  # type: ignore[override]"


def _adder(component: Any) -> str:
    return "_" + "".join(part.title() for part in component.ADD.split("_"))


def _class_of_adder(component: Any, imports: set[str]) -> str:
    signature = inspect.signature(component.add)
    actor = signature.return_annotation
    imports.add(f"from {_home(component, actor)} import {actor}")
    parts = ["self"]
    for name, one in signature.parameters.items():
        if name != "self" and one.kind is one.POSITIONAL_OR_KEYWORD:  # data; the module has its type
            kind = f"{component.__name__.removesuffix('Component')}{name.title()}"
            imports.add(f"from {component.__module__} import {one.annotation} as {kind}")
            parts.append(f"{name}: {kind}")
    parts.append("*")
    for name, one in signature.parameters.items():
        if one.kind is one.KEYWORD_ONLY:
            default = f'"{one.default}"' if isinstance(one.default, str) else repr(one.default)
            parts.append(f"{name}: {one.annotation} = {default}")
        elif one.kind is one.VAR_KEYWORD:
            parts.append(f"**{name}: {one.annotation}")
    lines = [""]
    for part in parts:
        if len(lines[-1]) + len(part) > WIDEST:
            lines.append("")
        lines[-1] += f" {part}," if lines[-1] else f"        {part},"
    body = "\n".join(lines)
    return f"class {_adder(component)}(Protocol):\n    def __call__(\n{body}\n    ) -> {actor}: ..."


def _home(component: Any, actor: str) -> str:
    """Return the module that the component's own module has an actor from."""
    source = Path(inspect.getfile(component)).read_text(encoding="utf-8")
    found = re.search(rf"from (\S+) import .*\b{actor}\b", source)
    assert found is not None, f"{component.__module__} does not import {actor}"
    return found[1]


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
