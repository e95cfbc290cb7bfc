"""Writes the page of what programs do, where ``PVFIBLETS_PAGE`` says so."""

import os

from .rows import PAGE, written


def pytest_sessionfinish(session, exitstatus):
    if os.environ.get("PVFIBLETS_PAGE") and exitstatus == 0 and not hasattr(session.config, "workerinput"):
        PAGE.write_text(written())
