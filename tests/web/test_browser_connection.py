"""Connections that are lost, conversions that wait or are cancelled, and places that are taken, in a real browser."""

import contextlib
import json
import os
import re
import signal
import sys
import time
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest

import pvfiblets
from pvfiblets.synthetic import brain_streamlines
from tests.web.browsing import PATIENCE, Visit
from tests.web.cable import Cable

pytestmark = pytest.mark.more


@pytest.fixture(scope="module")
def cable(served):
    cable = Cable(urlsplit(served("lines.fiblets").base).port)
    yield cable
    cable.close()


@pytest.fixture(scope="module")
def _wired(browser, served, cable):
    """A page that reaches its server by the cable."""
    here = Visit(browser, served("lines.fiblets"))
    here.sockets = []
    here.page.on("websocket", lambda socket: here.sockets.append(socket.url) if socket.url.endswith("/ws") else None)
    here.page.goto(here.served.url.replace(str(urlsplit(here.served.base).port), str(cable.port), 1))
    here.ready().rests()
    yield here.remember()
    here.close()


@pytest.fixture
def wired(_wired, cable):
    """Return that page, at rest with a change that can be undone, and its picture."""
    here = _wired.begin_again()
    here.sockets.clear()
    first = here.picture()
    here.choose("scalars", "length")
    yield here, here.changed(first)
    cable.mend()
    errors, here.errors[:] = list(here.errors), []
    assert not errors


def test_a_cut_cable_leaves_the_dimmed_picture_and_a_countdown_until_it_is_mended(wired, cable):
    here, before = wired
    refused = cable.refused
    cable.cut()
    lost = here.page.locator("#pv-lost")
    lost.wait_for()
    # trame's own client gives up after ten attempts in five seconds, and shows a button alone.
    here.wait(lambda: cable.refused > refused + 3 and "Trying again in" in lost.inner_text(), "a countdown")
    said = re.search(r"kept for (\d+):(\d\d) more", lost.inner_text())
    assert 200 < 60 * int(said[1]) + int(said[2]) <= 300
    assert lost.locator("img[src^=blob]").evaluate("image => image.naturalWidth") == before.shape[1]
    cable.mend()
    lost.locator("button:has-text('Try now')").click()
    comes_back(here, before)


def comes_back(here, before):
    """Wait until a page is as it was, with nobody's help, and see that it can be used."""
    here.wait(lambda: here.sockets, "another connection")
    here.wait(lambda: here.page.locator("#pv-lost").count() == 0, "the page again")
    here.ready()
    assert np.abs(here.rests() - before).mean() < 0.5
    assert "scalars" in here.state("undo_label")
    here.press("2")
    here.changed(before)
    assert all("ERR_" in error or "Bad Gateway" in error for error in here.errors), here.errors
    here.errors.clear()  # Chromium logs what could not be reached


@pytest.mark.exhaustive
def test_a_session_goes_on_by_itself_after_seven_attempts_in_vain(wired, cable):
    here, before = wired
    known = len(here.requests)
    cable.cut()
    here.page.locator("#pv-lost").wait_for()
    here.wait(lambda: sum(url.endswith("/status") for url in here.requests[known:]) >= 7, "attempts")  # 13 s
    cable.mend()
    comes_back(here, before)


def test_a_network_that_drops_all_without_a_word_is_noticed_and_comes_back(wired, cable):
    here, before = wired
    cable.drop()
    lost = here.page.locator("#pv-lost")
    lost.wait_for()
    assert "kept for" in lost.inner_text() or "Trying to connect" in lost.inner_text()
    cable.mend()
    comes_back(here, before)


@pytest.mark.exhaustive
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="signals, /proc")
def test_a_session_goes_on_after_sleep(wired, cable):
    """The browser's processes stop, and with them all its clocks, as when a laptop is closed."""
    here, before = wired
    here.page.evaluate("window.stopped = Date.now()")
    processes = chromium_processes()
    assert processes
    connected = here.served.log.read_text()
    cookies = "; ".join(f"{cookie['name']}={cookie['value']}" for cookie in here.context.cookies())
    status = urllib.request.Request(f"{here.served.base}/status", headers={"Cookie": cookies})
    end = time.monotonic() + PATIENCE / 1000.0
    try:
        for process in processes:
            os.kill(process, signal.SIGSTOP)
        while json.load(urllib.request.urlopen(status)) != {"state": "running", "connected": 0}:
            assert time.monotonic() < end, "the server does not notice that nobody answers its pings"
            time.sleep(0.2)
    finally:
        for process in reversed(processes):
            os.kill(process, signal.SIGCONT)
    assert here.served.log.read_text().count("ended") == connected.count("ended")
    comes_back(here, before)


def test_a_frozen_page_goes_on(wired, cable):
    """Browsers freeze pages that nobody looks at: their scripts stop, while the connection is answered for them."""
    here, before = wired
    devtools, stopped = here.context.new_cdp_session(here.page), []
    devtools.on("Debugger.paused", lambda _: stopped.append(1))  # Chromium truly freezes no page that it shows
    devtools.send("Debugger.enable")
    here.page.evaluate("window.ticks = setInterval(() => 0, 20)")  # something to stop at
    devtools.send("Debugger.pause")
    here.wait(lambda: stopped, "its scripts to stop")
    cable.cut()
    cable.mend()
    devtools.send("Debugger.disable")
    here.page.evaluate("clearInterval(window.ticks)")
    comes_back(here, before)


def chromium_processes():
    """Return the numbers of the processes of Chromium that this one has started, the first before its own."""
    parents = {}
    for place in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            number, rest = place.read_text().split(" (", 1)
            name, rest = rest.rsplit(") ", 1)
            parents[int(number)] = int(rest.split()[1]), name
    mine = []
    for number, (_, name) in parents.items():
        above = number
        while above in parents and above != os.getpid():
            above = parents[above][0]
        if above == os.getpid() and "chrom" in name:
            mine.append(number)
    return sorted(mine)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_a_dead_session_is_reported_at_once_and_restored(visit):
    here = visit("lines.fiblets", opened=False)
    (own,) = (Path(file).parent for file in map(os.readlink, Path(f"/proc/{here.served.process.pid}/fd").iterdir())
              if "pvfiblets-serve-" in file and file.endswith("/lock"))  # fmt: skip
    others = set(own.glob("*/session.json"))
    here.open()
    here.choose("scalars", "length")
    here.wait(lambda: "scalars" in here.state("undo_label"), "another colour")
    places = """(within) => ['.v-toolbar', '.pv-tools', '.pv-row', '.pv-edge', '[data-tab=clip]'].map((what) => {
        const {x, y, width, height} = document.querySelector(`${within} ${what}`).getBoundingClientRect();
        return [x, y, width, height].map(Math.round);
    })"""
    before = here.page.evaluate(places, "#app")
    here.wait(
        lambda: any('"scalars": "length"' in one.read_text() for one in set(own.glob("*/session.json")) - others),
        "the session to be kept",
    )
    process = int(re.findall(r"started as process (\d+)", here.served.log.read_text())[-1])
    os.kill(process, signal.SIGKILL)
    lost = here.page.locator("#pv-lost")
    here.wait(lambda: lost.count() and "The session has ended" in lost.inner_text(), "that it has ended")
    assert "It failed" in lost.inner_text()
    assert lost.locator("img[src^=blob]").count() == 1
    assert here.page.evaluate(places, "#pv-lost") == before  # nothing of the page has moved
    lost.locator("button:has-text('Restore')").click()
    here.page.wait_for_selector("#pv-lost", state="detached")
    here.ready()
    here.wait(lambda: here.state("undo_label") == "open a session", "the session as it was")
    assert "length" in here.page.locator("[data-property=scalars]").inner_text()
    here.errors.clear()


def test_a_lost_connection_is_taken_up_again(visit):
    here = visit("lines.fiblets", opened=False)
    sockets = []

    def pass_on(socket):
        def pass_back(data):
            here.take(data)
            socket.send(data)

        socket.connect_to_server().on_message(pass_back)
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


def test_a_page_stays_when_what_loads_before_it_comes_late(revisit):
    here = revisit("lines.fiblets")
    held = []

    def hold(route):  # what trame's own document fetches, and puts over the page
        held.append(route)

    here.page.route("**/loading.tpl", hold)
    here.page.reload()
    here.ready()
    here.page.unroute("**/loading.tpl", hold)
    for late in held:
        late.continue_()
    assert not held


def test_a_long_conversion_shows_how_far_it_is_and_can_be_cancelled(revisit):
    here = revisit("lines.fiblets")
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


def test_a_file_that_is_opened_while_another_one_is_waits_and_is_named(revisit):
    here = revisit("lines.fiblets")
    pvfiblets.write(here.served.root / "large.tck", brain_streamlines(12_000))
    for name in ("large.tck", "ball.ply"):
        here.press("o")
        here.page.click(f"[data-entry='{name}']")
        here.page.wait_for_selector("#dialog-open", state="hidden")  # the key would toggle it
    here.wait(lambda: "then ball.ply" in here.page.locator("#busy").inner_text(), "what waits")
    here.page.click("[data-action=cancel]")
    layers = here.page.locator("[data-layer]")
    here.wait(lambda: any("ball.ply" in name for name in layers.all_inner_texts()), "its turn")
    (here.served.root / "large.tck").unlink()
