"""Fixtures and rules that every room's tests share.

Three rules live here:

* Real data is found, never copied: the ``shared_data`` fixture.
* A test that leaves an OpenGL error behind, or starts with one, fails: the ``gl`` fixture.
* On continuous integration (``PVFIBLETS_CI`` is set) a test may be skipped only because the real
  data is not on that machine; any other skip fails, so that a check cannot vanish unseen.
"""

from __future__ import annotations

import os
from pathlib import Path

import hypothesis
import pytest

NO_DATA = "real data is not on this machine"

hypothesis.settings.register_profile(
    "default",
    max_examples=30,
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


@pytest.fixture(scope="session")
def _headless_context():
    moderngl = pytest.importorskip("moderngl")
    context = moderngl.create_standalone_context(require=430, backend="egl")
    yield context
    context.release()


@pytest.fixture
def gl(_headless_context):
    """Return a current headless OpenGL 4.3 context that must be free of errors on both sides."""
    with _headless_context:
        assert _headless_context.error == "GL_NO_ERROR", "an earlier test left an OpenGL error"
        yield _headless_context
        assert _headless_context.error == "GL_NO_ERROR", "this test left an OpenGL error"


@pytest.fixture(autouse=True)
def _no_plotter_left_open():
    """Close what a failing test leaves open, so that it cannot spoil the next one."""
    yield
    import sys

    if (pyvista := sys.modules.get("pyvista")) is not None and hasattr(pyvista, "close_all"):
        pyvista.close_all()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    """Turn skips that continuous integration does not allow into failures."""
    outcome = yield
    report = outcome.get_result()
    if not (os.environ.get("PVFIBLETS_CI") and report.skipped) or hasattr(report, "wasxfail"):
        return
    reason = str(report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr)
    if NO_DATA not in reason:
        report.outcome = "failed"
        report.longrepr = f"{item.nodeid} must run on continuous integration, but: {reason}"
