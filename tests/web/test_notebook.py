"""``plotter.show()`` in a notebook: the kernel draws, and the page that it shows is a picture of fiblets."""

import re
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from tests.web.browsing import FLAGS, chromium

pytestmark = pytest.mark.more

CELLS = (
    """
import pyvista as pv
pv.set_jupyter_backend("server")
plotter = pv.Plotter(notebook=True, window_size=(400, 300))
plotter.set_background("black")
actor = plotter.add_fiblets("lines.fiblets", color="red", line_width=3, lighting=False)
plotter.view_xy()
""",
    'viewer = plotter.show(return_viewer=True)\nprint("at", getattr(viewer, "src", None) or viewer.value)',
)

# A page in a browser, in a process of its own: Playwright and the notebook's client each want their own event loop.
LOOK = """
import io, sys, time
import numpy as np
from PIL import Image
from playwright.sync_api import sync_playwright
address, path, chromium, flags = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
with sync_playwright() as driver:
    browser = driver.chromium.launch(executable_path=chromium, args=flags)
    page = browser.new_page(viewport={"width": 500, "height": 400})
    page.goto(address)
    page.wait_for_selector("img[src^=blob], canvas", timeout=60000)
    end = time.monotonic() + 120.0
    while True:
        pixels = np.asarray(Image.open(io.BytesIO(page.screenshot(path=path))).convert("RGB")).astype(int)
        if ((pixels[..., 0] > 150) & (pixels[..., 1:].max(axis=2) < 90)).sum() > 500 or time.monotonic() > end:
            break
        page.wait_for_timeout(50)
    browser.close()
"""


def test_a_notebook_shows_fiblets(folder, tmp_path):
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    path = chromium()
    if path is None:
        pytest.skip("there is no Chromium on this machine: scripts/browser.sh installs it")
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    client = nbclient.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(folder)}})
    with client.setup_kernel():
        for index, cell in enumerate(book.cells):
            client.execute_cell(cell, index)
        said = "".join(output.get("text", "") for cell in book.cells for output in cell.outputs)
        # What the kernel's own log says may name addresses, too.
        address = re.search(r"^at .*?(https?://[^\s'\"]+)", said, re.MULTILINE)
        assert address, said
        picture = tmp_path / "notebook.png"
        command = [sys.executable, "-c", LOOK, address[1], str(picture), path, *FLAGS]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    pixels = np.asarray(Image.open(picture).convert("RGB")).astype(int)
    red = (pixels[..., 0] > 150) & (pixels[..., 1:].max(axis=2) < 90)
    assert red.sum() > 500
