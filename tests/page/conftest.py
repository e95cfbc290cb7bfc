"""Pages that draw by themselves, in Chromium with WebGL 2 on the processor."""

import pytest

from tests.page.pages import Page
from tests.web.browsing import FLAGS, launched

WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")


@pytest.fixture(scope="module")
def browser():
    """Return Chromium with WebGL 2, or skip where there is none."""
    with launched([*(flag for flag in FLAGS if flag != "--disable-gpu"), *WEBGL]) as found:
        yield found


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
