"""A display without a screen, for tests that open windows."""

from __future__ import annotations

import contextlib
import os
import shutil
import socket
import subprocess

import pytest


@contextlib.contextmanager
def display(size="800x600"):
    """Give what DISPLAY is to be for a display of its own, or skip where there is none."""
    if shutil.which("Xvfb") is None:
        pytest.skip("there is no Xvfb on this machine: scripts/display.sh installs it")
    for _ in range(5):  # two servers that start at once may choose the same number, and one of them ends
        server, number = _started(size)
        if _answers(number):
            break
        server.kill()
        server.wait(10)
    else:
        pytest.fail("Xvfb was started five times, and none of them took a connection")
    try:
        yield f":{number}"
    finally:
        server.terminate()
        server.wait(10)


def _started(size):
    """Start a server; return it and the number of its display, which is empty if it has ended."""
    ours, theirs = os.pipe()
    command = ["Xvfb", "-displayfd", str(theirs), "-screen", "0", f"{size}x24", "-nolisten", "tcp"]
    command.append("-noreset")  # else it resets when its last client leaves, and drops one that comes meanwhile
    server = subprocess.Popen(command, pass_fds=[theirs], stderr=subprocess.DEVNULL)
    os.close(theirs)
    with os.fdopen(ours) as told:
        return server, told.readline().strip()


def _answers(number):
    """Return True if a client of a display can connect and is accepted."""
    if not number:
        return False
    with socket.socket(socket.AF_UNIX) as client:
        client.settimeout(60)
        try:
            client.connect(f"/tmp/.X11-unix/X{number}")
            client.sendall(b"l\0\x0b\0\0\0\0\0\0\0\0\0")  # little-endian, version 11.0, no authorization
            return client.recv(1) == b"\1"
        except OSError:
            return False
