"""A display without a screen, for tests that open windows."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess

import pytest


@contextlib.contextmanager
def display(size="800x600"):
    """Give what DISPLAY is to be for a display of its own, or skip where there is none."""
    if shutil.which("Xvfb") is None:
        pytest.skip("there is no Xvfb on this machine: scripts/display.sh installs it")
    ours, theirs = os.pipe()
    command = ["Xvfb", "-displayfd", str(theirs), "-screen", "0", f"{size}x24", "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[theirs], stderr=subprocess.DEVNULL)
    os.close(theirs)
    with os.fdopen(ours) as told:
        number = told.readline().strip()
    try:
        yield f":{number}"
    finally:
        server.terminate()
        server.wait(10)
