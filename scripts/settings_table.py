"""Write ``docs/reference/settings.md``, a table of all settings of actors, from the declarations.

``python scripts/settings_table.py`` writes it; a test fails if it is out of date.
"""

from __future__ import annotations

import re
from pathlib import Path

from pvfiblets.plotting.fiblets.settings import FibletSettings
from pvfiblets.plotting.halos.settings import HaloLineSettings, HaloPointSettings
from pvfiblets.plotting.settings.settings import Argument, Setting, Settings, arguments
from pvfiblets.plotting.slices.settings import SliceSettings
from pvfiblets.plotting.tubes.settings import TubeSettings
from pvfiblets.plotting.volumes.settings import VolumeSettings

PAGE = Path(__file__).resolve().parents[1] / "docs" / "reference" / "settings.md"

DRAWABLES: dict[str, type[Settings]] = {
    "lines": FibletSettings,
    "tubes": TubeSettings,
    "halo lines": HaloLineSettings,
    "halo points": HaloPointSettings,
    "volumes": VolumeSettings,
    "slices": SliceSettings,
}

HEAD = """# Settings

All settings of actors: **A**, an argument of `add_...`; **P**, a property of the actor that can be changed at any time.
A name with two meanings or defaults has two rows. The columns stand for [`add_fiblets`](plotting/fiblets.rst),
[`add_spline_tubes`](plotting/tubes.rst), [`add_halo_lines` and `add_halo_points`](plotting/halos.rst),
[`add_raycast_volume`](plotting/volumes.rst) and [`add_slices`](plotting/slices.rst), whose pages describe each setting
in full. All of them also take `name`, `pickable`, `show_scalar_bar`, `scalar_bar_args`, `user_matrix`, `reset_camera`
and `render`, as `add_mesh` does.

"""


def table() -> str:
    """Return the text of the page."""
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    for drawable, settings in DRAWABLES.items():
        for name, one in settings.DECLARED.items():
            rows.setdefault(_row(name, one), {})[drawable] = _access(name, one, settings)
    heads = ["setting", "default", "meaning", "unit or choices", *DRAWABLES]
    lines = [f"| {' | '.join(heads)} |", "|" + "---|" * len(heads)]
    names = list(dict.fromkeys(row[0] for row in rows))
    for (name, default, values, meaning), access in sorted(rows.items(), key=lambda item: names.index(item[0][0])):
        cells = [name, default, meaning, values, *(access.get(drawable, "") for drawable in DRAWABLES)]
        lines.append(f"| {' | '.join(cells)} |")
    return HEAD + "\n".join(lines) + "\n"


def _row(name: str, one: Argument) -> tuple[str, ...]:
    doc = " ".join(((one.__doc__ if isinstance(one, Setting) else None) or one.argument_doc).split("\n\n")[0].split())
    found = re.search(r"\((mm)\)|, (mm|pixels|voxels)\b|\bin (pixels|voxels|mean voxel spacings)\b", doc)
    unit = next(filter(None, found.groups())) if found and not one.choices else ""
    values = ", ".join(f"`{choice!r}`" for choice in one.choices) or unit
    sentence = re.match(r".*?(?:\.(?= |$)|$)", re.sub(r":\w+:`~?([^`]*)`", r"`\1`", doc).replace("``", "`"))
    assert sentence is not None
    return f"`{name}`", f"`{one.default!r}`", values, sentence[0].replace("|", "\\|")


def _access(name: str, one: Argument, settings: type[Settings]) -> str:
    return " ".join(filter(None, ("A" * (name in arguments(settings)), "P" * isinstance(one, Setting))))


if __name__ == "__main__":
    PAGE.write_text(table(), encoding="utf-8")
