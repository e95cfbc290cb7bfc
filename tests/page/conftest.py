"""Pages that draw by themselves, in Chromium with WebGL 2 on the processor."""

from __future__ import annotations

import pytest

from tests.page.pages import Page
from tests.web.browsing import FLAGS, chromium

WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")


@pytest.fixture(scope="module")
def browser():
    """Return Chromium with WebGL 2, or skip where there is none."""
    playwright = pytest.importorskip("playwright.sync_api")
    path = chromium()
    if path is None:
        pytest.skip("there is no Chromium on this machine: scripts/browser.sh installs it")
    flags = [flag for flag in FLAGS if flag != "--disable-gpu"]
    with playwright.sync_playwright() as driver:  # for one module: while it runs, asyncio.run() cannot
        found = driver.chromium.launch(executable_path=path, args=[*flags, *WEBGL])
        yield found
        found.close()


@pytest.fixture
def visit(browser):
    """Return a function that opens a page; errors on its console fail the test."""
    pages = []

    def open_page(path, **options):
        pages.append(Page(browser, path, **options))
        return pages[-1]

    yield open_page
    errors = [error for page in pages for error in page.errors]
    for page in pages:
        page.context.close()
    assert not errors
