"""Files that swell, in a real browser and a session with little memory; files that wait for their turn."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import pvfiblets
from pvfiblets import memory
from tests.web import bombs


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


def test_a_file_that_is_opened_while_another_one_is_waits_and_is_named(visit):
    from pvfiblets.synthetic import brain_streamlines

    here = visit("lines.fiblets")
    pvfiblets.write(here.served.root / "large.tck", brain_streamlines(12_000))
    for name in ("large.tck", "ball.ply"):
        here.press("o")
        here.page.click(f"[data-entry='{name}']")
        here.page.wait_for_selector("#dialog-open", state="hidden")  # the key would toggle it
    here.wait(lambda: "then ball.ply" in here.page.locator("#busy").inner_text(), "what waits")
    here.page.click("[data-action=cancel]")
    here.wait(lambda: here.layers() == 2, "its turn")
    names = here.page.locator("[data-layer]").all_inner_texts()
    assert any("ball.ply" in name for name in names)
    (here.served.root / "large.tck").unlink()
