"""Connections that are lost, conversions that are cancelled, and places that are taken, in a real browser."""

from __future__ import annotations

import numpy as np


def test_a_lost_connection_is_taken_up_again(visit):
    here = visit("lines.fiblets", opened=False)
    sockets = []

    def pass_on(socket):
        socket.connect_to_server()
        sockets.append(socket)

    here.page.route_web_socket(lambda url: url.endswith("/ws"), pass_on)
    here.page.goto(here.served.url)
    here.ready()
    before = here.rests()
    here.choose("scalars", "length")
    coloured = here.changed(before)
    here.drag()
    turned = here.changed(coloured)
    assert len(sockets) == 1
    sockets[0].close()
    here.wait(lambda: len(sockets) > 1, "another connection")
    here.ready()
    assert np.abs(here.rests() - turned).mean() < 0.5
    assert "scalars" in here.state("undo_label")
    here.press("2")  # and what is done next is done there
    here.changed(turned)


def test_a_page_stays_when_what_loads_before_it_comes_late(visit):
    here = visit("lines.fiblets")
    held = []

    def hold(route):  # what trame's own document fetches, and puts over the page
        held.append(route)

    here.page.route("**/loading.tpl", hold)
    here.page.reload()
    here.ready()
    for late in held:
        late.continue_()
    assert not held


def test_a_long_conversion_shows_how_far_it_is_and_can_be_cancelled(visit, tmp_path):
    import pvfiblets
    from pvfiblets.synthetic import brain_streamlines

    here = visit("lines.fiblets")
    pvfiblets.write(here.served.root / "large.tck", brain_streamlines(12_000))
    here.press("o")
    here.page.click("[data-entry='large.tck']")
    busy = here.page.locator("#busy")
    busy.wait_for()
    assert "large.tck" in busy.inner_text()
    # The page goes on meanwhile.
    here.tab("filter")
    here.page.click("[data-action=cancel]")
    here.wait(lambda: "cancelled" in here.toast(), "that it was cancelled")
    here.wait(lambda: not busy.is_visible(), "the progress to go")
    assert here.layers() == 1
    (here.served.root / "large.tck").unlink()


def test_beyond_the_limit_a_page_says_so_until_a_place_is_free(visit):
    one = visit("lines.fiblets", "--limit", "1")
    other = visit("lines.fiblets", "--limit", "1", opened=False)
    answer = other.page.goto(other.served.url)
    assert answer.status == 503
    assert "All sessions are taken" in other.page.inner_text("h1")
    one.page.click("[data-action=end]")
    one.page.click("[data-action=end-session]")
    one.page.wait_for_selector("h1:has-text('Session ended')")
    other.page.click("a.button")
    other.ready()
    assert all("503" in error or "/ws" in error for error in one.errors + other.errors), one.errors + other.errors
    one.errors.clear()  # Chromium logs what was refused, and so it should be
    other.errors.clear()


def test_files_that_cannot_be_read_leave_the_page_as_it_was(visit):
    here = visit("lines.fiblets")
    for name in ("bad.trk", "bad.ply", "bad.nii.gz"):
        (here.served.root / name).write_bytes(b"neither lines nor surface nor volume" * 40)
        here.press("o")
        here.page.click(f"[data-entry='{name}']")
        here.wait(lambda name=name: here.state("toast_open") and name in here.toast(), "why it was not opened")
        assert str(here.served.root) not in here.toast()
        assert here.layers() == 1
        assert here.picture().std() > 1.0
        (here.served.root / name).unlink()
