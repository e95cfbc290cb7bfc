"""Firefox for tests, beside Chromium of browsing.py: in a window under Xvfb, where it has WebGL 2 by Mesa.

Without a window (`--headless`) it finds no OpenGL.
"""

import contextlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import NO_FIREFOX
from tests.display import display

RELAY = Path(__file__).with_name("firefox_relay.py")
# Files may not read other files, as users have it: what drives browsers would allow it. Nothing opens over the page.
PREFERENCES = {
    "webgl.force-enabled": True, "browser.download.alwaysOpenPanel": False, "remote.prefs.recommended": False,
    "security.fileuri.strict_origin_policy": True,
}  # fmt: skip


def firefox() -> str | None:
    """Return where Firefox is, if it is."""
    given = os.environ.get("FIREFOX")
    return given or next((found for name in ("firefox-esr", "firefox") if (found := shutil.which(name))), None)


def _offered() -> bool:
    """Return whether apt has what scripts/firefox.sh installs."""
    if shutil.which("apt-cache") is None:
        return False
    said = subprocess.run(["apt-cache", "policy", "firefox-esr"], capture_output=True, text=True, check=False).stdout
    return "Candidate:" in said and "Candidate: (none)" not in said


@contextlib.contextmanager
def launched_firefox(folder: Path):
    """Give Firefox, or skip where there is none; `folder` keeps what starts it. It is for one module, like Chromium."""
    playwright = pytest.importorskip("playwright.sync_api")
    path = firefox()
    if path is None:
        pytest.skip("there is no Firefox on this machine: scripts/firefox.sh installs it" if _offered() else NO_FIREFOX)
    start = folder / "firefox"
    start.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{RELAY}" "{path}" "$@"\n')
    start.chmod(0o755)
    with display() as number, playwright.sync_playwright() as driver:
        found = driver.firefox.launch(
            channel="moz-firefox", executable_path=start, headless=False, firefox_user_prefs=PREFERENCES,
            env={**os.environ, "DISPLAY": number, "LIBGL_ALWAYS_SOFTWARE": "1"},
        )  # fmt: skip
        yield found
        found.close()
