"""Fixtures and rules that every room's tests share.

Rules that live here:

* Real data is found, never copied: the ``shared_data`` fixture.
* A test that leaves an OpenGL error behind, or starts with one, fails: the ``gl`` fixture.
* On continuous integration (``PVFIBLETS_CI`` is set) a check cannot vanish unseen: every test function
  must run with some of its parameters, unless the real data is not on that machine, or Firefox or another
  program is not to be had there.
* ``make test`` takes minutes: tests that open a browser or are marked ``more``, and most parameters of those marked
  ``few``, run by ``make test-more``; tests marked ``exhaustive``, and what a product of parameters marked ``every`` has
  besides every value or pair, by ``make test-all`` only.
* A test that fails says how to run it alone, and where the pictures are that it had drawn.
"""

from __future__ import annotations

import ctypes
import gc
import os
import re
import sys
from collections import defaultdict
from itertools import combinations
from pathlib import Path

import hypothesis
import numpy as np
import pytest
from PIL import Image

from pvfiblets.codec import parameters as limits
from tests.debug_log import DebugLog

FAILED = Path(".failed")
"""The folder for pictures of tests that failed."""

USUAL_LIMITS = {name: getattr(limits, name) for name in ("EXACT_BELOW", "EXACT_UP_TO")}

# Sets of tests are small, and coded all the same: they are to show what coding does. What small sets are by default is
# asked by tests that take the fixture `usual_limits`.
limits.EXACT_BELOW = limits.EXACT_UP_TO = 0

# Pictures of tests are exact, and drawn once: of one sample a pixel, in processes that they start, too.
os.environ["PVFIBLETS_ANTIALIAS"] = "off"

NO_DATA = "real data is not on this machine"
NO_FIREFOX = "Firefox is not to be had on this machine"
NO_PROGRAM = "is not on this machine: scripts/programs.sh installs it"

SIZES = {"value": 1, "pair": 2}
"""What ``pytest.mark.every`` may say, and of how many parameters it speaks."""

LONGEST = (
    "query/test_passing.py", "query/test_measures.py", "engine/test_ray_intervals.py",
    "docs/test_snippets.py", "tests/test_examples.py", "web/test_browser_layout.py", "web/test_browser_slices.py",
    "web/test_browser.py", "web/test_browser_connection.py", "left_out/test_left_out.py",
    "plotting/test_everything_at_once.py", "web/test_browser_tools.py", "engine/test_two_phase.py",
    "page/test_page_browser.py", "stability/test_cases.py", "web/test_browser_drawing.py", "web/test_firefox.py",
    "web/test_browser_layers.py", "stability/test_load.py", "engine/test_volume_steep.py",
    "soak/test_soak.py", "engine/test_coverage.py",
    "web/test_browser_attacks.py", "engine/test_region_query.py",
    "web/test_browser_exports.py", "engine/test_clip_regions.py", "web/test_browser_touch.py",
    "engine/test_filter_textures.py", "engine/test_line_tubes.py",
    "report/test_features_study.py", "report/test_tubes_study.py", "formats/test_fuzz.py", "engine/test_volume.py",
)  # fmt: skip
"""Files that take longest. They begin first, so that in the end no process works on while the others have nothing."""

hypothesis.settings.register_profile(
    "default",
    max_examples=15,
    deadline=None,
    derandomize=True,
    suppress_health_check=[hypothesis.HealthCheck.too_slow],
)
hypothesis.settings.register_profile(
    "exhaustive",
    max_examples=100,
    deadline=None,
    derandomize=True,
    suppress_health_check=[hypothesis.HealthCheck.too_slow],
)
hypothesis.settings.register_profile(
    "fuzz",
    max_examples=3000,
    deadline=None,
    suppress_health_check=[hypothesis.HealthCheck.too_slow],
)
hypothesis.settings.load_profile("default")


def data_folder() -> Path:
    """Return where the real files are: ``PVFIBLETS_DATA``, or ``../shared/data``."""
    given = os.environ.get("PVFIBLETS_DATA")
    return Path(given) if given else Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Return the folder of real files, or skip the test where it is missing."""
    folder = data_folder()
    if not folder.is_dir():
        pytest.skip(f"{NO_DATA}: no folder {folder} (set PVFIBLETS_DATA)")
    return folder


@pytest.fixture
def usual_limits(monkeypatch):
    """Keep small sets exactly, as users have it."""
    for name, value in USUAL_LIMITS.items():
        monkeypatch.setattr(limits, name, value)


def current_context() -> int | None:
    """Return the handle of EGL's current context."""
    look_up = ctypes.CDLL("libEGL.so.1").eglGetCurrentContext
    look_up.restype = ctypes.c_void_p
    return look_up()


class _Headless:
    """One headless context for all tests, made anew when VTK has taken its display away by closing a window."""

    def __init__(self, moderngl) -> None:
        self._moderngl = moderngl
        self._module = None
        self.version = self._make().info["GL_VERSION"]

    def _make(self):
        self._context = self._moderngl.create_standalone_context(require=430, backend="egl")
        assert self._context.info["GL_VERSION"]  # read once, and kept: while it is current
        self._handle = current_context()
        return self._context

    def context(self, module):
        """Return it alive; `module` is the test's, whose predecessors' windows are gone for good first."""
        if module is not self._module:  # a window that the garbage collector finds later takes the display away then
            gc.collect()
            self._module = module
        with self._context:  # never within another `with` of it: leaving the inner one leaves none current
            if current_context() == self._handle:
                return self._context
        # Its display is gone, and all that it held: nothing became current, or another context stayed so.
        return self._make()


@pytest.fixture(scope="session")
def _headless():
    return _Headless(pytest.importorskip("moderngl"))


@pytest.fixture
def gl(_headless, request):
    """Return a current headless OpenGL 4.3 context that must be free of errors on both sides."""
    context = _headless.context(request.module)
    with context:
        assert context.error == "GL_NO_ERROR", "an earlier test left an OpenGL error"
        said = DebugLog(context)
        said.take()
        yield context
        assert context.error == "GL_NO_ERROR", "this test left an OpenGL error"
        complaints = said.take()
        assert not complaints, "\n".join(complaints)


# What OpenGL 4.1 lacks and Mesa lists as extensions however old it is told to be. Two more it will not take away,
# texture_storage and direct_state_access: calls of those are not caught.
NEWER_THAN_4_1 = (
    "buffer_storage", "clear_texture", "compute_shader", "copy_image", "explicit_uniform_location",
    "gpu_shader_int64", "indirect_parameters", "multi_draw_indirect", "shader_atomic_counters", "shader_ballot",
    "shader_image_load_store", "shader_storage_buffer_object", "shading_language_420pack",
)  # fmt: skip


@pytest.fixture(scope="session")
def older_opengl(_headless):
    """Return a function: the environment in which Mesa's OpenGL is no newer than a version up to 4.1, for a subprocess.

    MESA_GL_VERSION_OVERRIDE alone changes the number that is told and nothing else: compute shaders still compile and
    run, so that a test under it shows nothing. The version of GLSL must be held down and extensions taken away too.
    """
    if "Mesa" not in _headless.version:
        pytest.skip("only Mesa's OpenGL can be told to be older")

    def environment(version: str) -> dict[str, str]:
        return os.environ | {
            "MESA_GL_VERSION_OVERRIDE": version,
            "MESA_GLSL_VERSION_OVERRIDE": {"3.2": "150"}.get(version, version.replace(".", "") + "0"),
            "MESA_EXTENSION_OVERRIDE": " ".join(f"-GL_ARB_{name}" for name in NEWER_THAN_4_1),
        }

    return environment


@pytest.fixture(autouse=True)
def _no_plotter_left_open():
    """Close what a failing test leaves open, so that it cannot spoil the next one."""
    yield
    if (pyvista := sys.modules.get("pyvista")) is not None and hasattr(pyvista, "close_all"):
        pyvista.close_all()


def covering(rows: list[list[str]], size: int) -> set[int]:
    """Return which rows to take so that all sets of `size` values that occur in a row occur in one that is taken."""
    wanted = [set(combinations(enumerate(row), min(size, len(row)))) for row in rows]
    missing, taken = set().union(*wanted), set()
    while missing:
        best = max(range(len(rows)), key=lambda row: len(wanted[row] & missing))  # of equals, the first
        taken.add(best)
        missing -= wanted[best]
    return taken


@pytest.hookimpl(tryfirst=True)  # before pytest deselects by mark
def pytest_collection_modifyitems(items):
    """Put the longest files first, and thin products of parameters."""
    order = {name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: order.get("/".join(item.path.parts[-2:]), len(order)))
    thin(items)


def thin(items):
    """Mark as `exhaustive` or `more` the parameters that ``make test`` leaves out of tests marked `every` or `few`."""
    products, lists = defaultdict(list), defaultdict(list)
    for item in items:
        function = item.nodeid.partition("[")[0]
        if "browser" in getattr(item, "fixturenames", ()):
            item.add_marker(pytest.mark.more)
        if (mark := item.get_closest_marker("every")) is not None and hasattr(item, "callspec"):
            products[function, SIZES[mark.args[0]]].append(item)
        if (mark := item.get_closest_marker("few")) is not None:
            lists[function, mark.args[0]].append(item)
    for (_, size), product in products.items():
        taken = covering([item.callspec._idlist for item in product], size)
        for row, item in enumerate(product):
            if row not in taken:
                item.add_marker(pytest.mark.exhaustive)
    for (_, count), rows in lists.items():
        rest = [item for item in rows if item.get_closest_marker("exhaustive") is None]
        taken = {place * len(rest) // count for place in range(count)}
        for row, item in enumerate(rest):
            if row not in taken:
                item.add_marker(pytest.mark.more)


def drawn_pictures(traceback) -> dict[str, np.ndarray]:
    """Return the pictures that a failed test had in its hands, by variable: of 0 to 255, or floats of 0 to 1."""
    found = {}
    for entry in traceback:
        if not str(entry.path).startswith(str(Path(__file__).parent)):
            continue
        for name, value in entry.frame.f_locals.items():
            if not (isinstance(value, np.ndarray) and value.ndim == 3 and value.shape[2] in (3, 4)):
                continue
            if min(value.shape[:2]) >= 8 and value.dtype.kind in "uf":
                levels = np.nan_to_num(value)
                scale = 255 if value.dtype.kind == "f" and levels.max() <= 1 else 1
                found[name] = np.clip(levels * scale, 0, 255).astype(np.uint8)
    if len(found) == 2:
        one, other = found.values()
        if one.shape == other.shape:
            found["difference"] = np.abs(one[..., :3].astype(int) - other[..., :3]).astype(np.uint8)
    return found


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Say how to run a failed test alone, and where its pictures are."""
    report = yield
    if report.failed:
        compiled = f"GALLIVM_PERF={level} " if (level := os.environ.get("GALLIVM_PERF")) else ""
        said = [f"{compiled}{sys.executable} -m pytest -m '' '{item.nodeid}'"]
        folder = FAILED / re.sub(r"[^\w.-]+", "_", item.nodeid)[-150:]
        for name, picture in drawn_pictures(call.excinfo.traceback).items():
            folder.mkdir(parents=True, exist_ok=True)
            Image.fromarray(picture).save(folder / f"{name}.png")
            said.append(f"picture {name!r}: {folder.absolute() / name}.png")
        report.sections.append(("to run it alone, and what it had drawn", "\n".join(said)))
    return report


class _SkipRule:
    """Remembers which test functions ran at least once, and which were only ever skipped."""

    def __init__(self) -> None:
        self.ran: set[str] = set()
        self.skipped: dict[str, str] = {}

    def pytest_runtest_logreport(self, report):
        function = report.nodeid.partition("[")[0]
        if report.skipped and not hasattr(report, "wasxfail"):
            reason = str(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr)
            if not any(allowed in reason for allowed in (NO_DATA, NO_FIREFOX, NO_PROGRAM)):
                self.skipped[function] = reason
        elif getattr(report, "when", "") == "call":
            self.ran.add(function)

    def pytest_collectreport(self, report):
        if report.skipped:  # a whole module
            self.pytest_runtest_logreport(report)

    def vanished(self) -> dict[str, str]:
        return {name: reason for name, reason in self.skipped.items() if name not in self.ran}

    def pytest_sessionfinish(self, session, exitstatus):
        if self.vanished() and exitstatus == 0:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def pytest_terminal_summary(self, terminalreporter):
        for name, reason in self.vanished().items():
            terminalreporter.write_line(f"FAILED {name}: must run on continuous integration, but: {reason}")


def pytest_configure(config):
    """Hold the rule about skips where it must hold, and where all tests are known: not in one of several processes."""
    if os.environ.get("PVFIBLETS_CI") and not hasattr(config, "workerinput"):
        config.pluginmanager.register(_SkipRule(), "pvfiblets-skips")
