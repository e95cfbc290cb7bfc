"""A scene pays only for what it uses: no program, switch, pass, buffer or module that nobody asked for.

Each feature alone is drawn in a process of its own by ``scenes.py``, and what is seen there between the program and
OpenGL, and among the imported modules, must be what ``plain.py`` and ``changed.py`` name: no more and no less.
"""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from pvfiblets.engine.gl.shaders import FEATURES
from tests.reference_compiler import complaints

from .changed import CHANGED
from .expected import COMPANIONS, expected
from .plain import PLAIN
from .scenes import SCENES, prepare
from .what import KINDS

SCRIPT = Path(__file__).with_name("scenes.py")
ALIKE = {
    "colours: logarithm", "wide lines, shaded", "tubes, shaded", "illuminated", "ink", "clip: planes of VTK",
    "clip: outside a box", "clip: plane and ball", "selection outlined", "pipeline: tessellation",
    "picture: refined, moving", "spline tubes: colours", "spline tubes: solver", "spline tubes: planes",
    "halo lines: tapered", "halo lines: bent", "halo lines: colours", "volume: local mip", "volume: gentle light",
    "volume: nearest", "volume: jitter", "volume: no octree", "volume: sparse", "volume: cut",
}  # fmt: skip
"""Scenes whose like is among the others, by the same code: one setting of several."""
EXACT_AT_ONCE = {
    "density": ["glReadPixels"],  # the most lines of a pixel, for the range of colours
    "density, by a map": ["glReadPixels"],
    "clip: mesh": ["glReadPixels"],  # layers of the mesh along a pixel's ray
}
EACH = [pytest.param(name, marks=[pytest.mark.exhaustive] if name in ALIKE else []) for name in SCENES]

pytestmark = [
    pytest.mark.more,
    pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are forked, which this system cannot"),
    pytest.mark.timeout(1200),  # the first test waits for all scenes
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Data of all scenes, and what VTK compiled for them."""
    place = tmp_path_factory.mktemp("left-out")
    prepare(place)
    return place


@pytest.fixture(scope="module")
def seen(folder, _headless, request):
    """What every scene that a test asks for is made of, by name."""
    renderer = _headless._context.info["GL_RENDERER"]
    if "llvmpipe" not in renderer:
        pytest.skip(f"what a picture is made of depends on the OpenGL; plain.py has llvmpipe's, this is {renderer}")
    items = (item for item in request.session.items if item.path == request.path and hasattr(item, "callspec"))
    asked = {item.callspec.params["name"] for item in items}
    names = [name for name in SCENES if name in asked]

    def run(chosen: list[str]) -> list[str]:
        done = subprocess.run(
            [sys.executable, str(SCRIPT), str(folder), *chosen], capture_output=True, text=True, check=True
        )
        return done.stdout.splitlines()

    with ThreadPoolExecutor(2) as threads:
        lines = [line for part in threads.map(run, (names[::2], names[1::2])) for line in part]
    return {found["name"]: found for found in map(json.loads, lines)}


def of_kind(found: dict, kind: str) -> set[str]:
    """Return what was seen of one kind."""
    if kind == "resolve":
        return set(found["told"]) - set(FEATURES)
    names = set(found[kind])
    if kind == "packages":
        return {name for name in names - COMPANIONS if not name.startswith("_cython")}
    if kind == "modules":
        return {name.removeprefix("pvfiblets.") for name in names}
    return names


def test_every_scene_is_expected():
    assert set(SCENES) == set(PLAIN) | set(CHANGED)


@pytest.mark.parametrize("name", EACH)
def test_a_scene_has_what_it_asks_for_tells_all_of_it_and_waits_for_nothing(seen, name):
    found = seen[name]
    assert "error" not in found, found["error"]
    for kind in KINDS:
        there, wanted = of_kind(found, kind), expected(name, kind)
        assert there == wanted, f"{kind}: unasked {sorted(there - wanted)}, missing {sorted(wanted - there)}"
    # The bytes of ``explain()`` are those of OpenGL; a frame makes nothing anew; a closed plotter leaves nothing.
    assert sum(found["buffers"].values()) + found["selection"] == found["nbytes"] > 0
    assert found["made"] == 0
    assert found["left"] == 0
    # ``explain()`` of an actor names them; effects on whole pictures are no actor's.
    told = set(seen[name]["told"] + seen[name]["told apart"]) & set(FEATURES)
    of_pictures = {switch for switch in FEATURES if switch.startswith(("PICTURE_", "TONE_"))}
    samples = {"WIDE_LINES"} if name == "picture: refined" else set()  # the last frame is of the camera as it is
    assert told | samples == set(seen[name]["features"]) - of_pictures
    # None of a camera in motion; at rest, what is to be exact at once and no card can tell without being asked.
    waits = seen[name]["waits"]
    if not waits:
        pytest.skip("calls of OpenGL are recorded on x86-64 and Linux only")
    assert waits == {"at rest": EXACT_AT_ONCE.get(name, []), "in motion": []}


ROOMS = ("tubes", "halos", "volumes", "slices", "query.bundles", "query.painting", "cluster", "web", "report", "cli")


@pytest.mark.parametrize(
    ("name", "own"),
    [("plain", ()), ("spline tubes", ("tubes",)), ("halo lines", ("halos",)), ("volume: mip", ("volumes",))],
)
def test_a_scene_loads_no_module_of_other_rooms(seen, name, own):
    others = set(ROOMS) - set(own)
    parts = {module: module.removeprefix("pvfiblets.") for module in seen[name]["modules"]}
    kinds = ("", "engine.", "plotting.")
    found = [
        module
        for module, part in parts.items()
        if any(part == kind + other or part.startswith(f"{kind}{other}.") for kind in kinds for other in others)
    ]
    assert found == []


def test_what_vtk_compiles_is_valid_for_the_reference_compiler(seen, folder):
    """VTK's own shaders with the pieces of the resolve in them; drivers do not agree on what is."""
    paths = sorted(folder.glob("vtk-*"))
    assert len(paths) > len(seen) / 4
    assert complaints(paths) == []
