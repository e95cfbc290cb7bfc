"""Files that swell, in a real browser and a session with little memory."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from pvfiblets import memory
from tests.web import bombs

pytestmark = pytest.mark.more


@pytest.mark.skipif(not memory.CAN_LIMIT, reason="only Linux limits the data of a process")
def test_bombs_are_refused_on_the_page_and_the_session_goes_on(visit):
    here = visit("lines.fiblets", "--max-memory", "768M")
    root = here.served.root
    process = re.findall(r"started as process (\d+)", here.served.log.read_text())[-1]
    limits = Path(f"/proc/{process}/limits").read_text()
    assert re.search(rf"^Max data size +{768 << 20} ", limits, re.MULTILINE)
    bombs.trk_of_one(root / "lines.trk.gz", 2000)
    bombs.nii(root / "scaled.nii.gz", 150, 2.0)
    for name, says in (("lines.trk.gz", "it says that it takes 2.0 GB"), ("scaled.nii.gz", "it needs more memory")):
        here.press("o")
        here.page.click(f"[data-entry='{name}']")
        here.wait(lambda name=name, says=says: f"{name} was not opened: {says}" in here.toast(), "a sentence")
        assert "of the 768 MB that a session may have" in here.toast()
        here.tab("filter")
        here.tab("clip")
        assert here.layers() == 1
        (root / name).unlink()
    before = here.rests()
    here.drag()
    here.changed(before)
    here.press("o")
    here.page.click("[data-entry='lines.trk']")
    here.wait(lambda: here.layers() == 2, "a file like any other")
