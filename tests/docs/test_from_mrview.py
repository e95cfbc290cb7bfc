"""Keys, gestures and labels that docs/from-mrview.md names are there: in the page's scripts and help, and in panes."""

import re
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.plotting.slices.pane_events import _STEPS
from pvfiblets.web.panels.dialogs import KEYS

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "from-mrview.md").read_text(encoding="utf-8")
CLIENT = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "pvfiblets" / "web" / "client").glob("*.js"))
HERE = re.findall(r"^\|[^|\n]+\|([^|\n]+)\|$", PAGE, re.MULTILINE)  # the second column of each table


def bound():
    """Return the keys that the page's scripts listen to, in lower case."""
    tables = " ".join(re.findall(r"const (?:KEYS|STEPS) = \{(.*?)\};", CLIENT, re.DOTALL))
    single = re.findall(r'key(?:\.toLowerCase\(\))? === "([^"]+)"', CLIENT)
    return {key.lower() for key in [*re.findall(r'([\w?\[\]]+)"?: ', tables), *single]}


NAMED = sorted(set(re.findall(r"\*\*([A-Z0-9])\*\*", PAGE)))


def test_the_page_names_keys():
    assert set("OXCS") <= set(NAMED)


@pytest.mark.parametrize("key", NAMED)
def test_a_key_of_the_page_is_bound_and_in_its_help(key):
    assert key.lower() in bound()
    assert any(key in keys.split() for keys, _ in KEYS)


def test_keys_of_the_help_are_bound():
    single = {key.lower() for keys, _ in KEYS for key in keys.split() if len(key) == 1}
    assert single <= bound()


@pytest.mark.parametrize(
    ("words", "events", "keys"),
    [
        ("wheel", ["MouseWheelForwardEvent", "MouseWheelBackwardEvent"], []),
        ("Page Up and Page Down", ["KeyPressEvent"], ["Prior", "Next"]),
        ("right button, drag", ["RightButtonPressEvent", "MouseMoveEvent", "RightButtonReleaseEvent"], []),
    ],
)
def test_a_gesture_of_the_page_is_heard_by_panes(words, events, keys):
    assert words in PAGE
    plotter = pv.Plotter(off_screen=True, shape=(2, 2))
    plotter.slices.workspace(np.zeros((4, 4, 4)))
    assert all(plotter.iren.interactor.HasObserver(event) for event in events)
    assert set(keys) <= set(_STEPS)
    assert {"pageup", "pagedown"} <= bound()
    plotter.close()


def labels():
    """Return what the second columns of the page's tables emphasise, menus by their parts; keys are none."""
    marked = [one or other for cell in HERE for one, other in re.findall(r"\*\*(.+?)\*\*|\*(.+?)\*", cell)]
    parts = {part.strip().removeprefix("+ ") for one in marked for part in one.split(">")}
    return sorted(part for part in parts if len(part) > 1)


def test_labels_of_the_page_are_those_of_the_panels():
    rooms = [ROOT / "pvfiblets" / "web", ROOT / "pvfiblets" / "plotting"]
    panels = "\n".join(path.read_text(encoding="utf-8") for room in rooms for path in room.rglob("*.py"))
    assert {"Filter", "Colour by", "Slab"} <= set(labels())
    assert [label for label in labels() if not re.search(rf'"(?:\+ )?{re.escape(label)}"', panels)] == []
