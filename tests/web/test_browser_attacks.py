"""Names that are HTML, templates, scripts or tricks of writing, wherever a page shows them, in a real browser."""

import base64
import json

import numpy as np
import pytest

import pvfiblets
from pvfiblets.streamlines import Streamlines
from tests.web.browsing import LOAD

pytestmark = pytest.mark.more

NAMES = (
    '<img src=x onerror="window.hacked=1">',
    "{{ constructor.constructor('window.hacked=1')() }}",
    "${window.hacked=1}",
    '"><svg onload="window.hacked=1">', "javascript:window.hacked=1", "</script><script>window.hacked=1</script>",
    "';window.hacked=1;//",
)  # fmt: skip


def unharmed(here):
    """See that no name became a part of the page."""
    assert here.page.evaluate("window.hacked") is None
    found = here.page.evaluate(
        "[...document.querySelectorAll('img[src=x], [onerror], [onload], a[href^=\"javascript:\"]')].length"
    )
    assert found == 0


@pytest.fixture
def evil(revisit):
    """Return a page with a tractogram whose values and groups have such names."""
    here = revisit("lines.fiblets")
    rng = np.random.default_rng(1)
    lines = [np.cumsum(rng.normal(size=(30, 3)), axis=0) for _ in range(12)]
    # Names of members of trx files have no slashes.
    names = [name for name in NAMES if "/" not in name]
    found = Streamlines.from_list(
        lines,
        per_point={name: rng.random(360).astype(np.float32) for name in names},
        per_streamline={f"{name} ": rng.random(12).astype(np.float32) for name in names},
        groups={name: np.arange(k + 1) for k, name in enumerate(names)},
    )
    pvfiblets.compress(found, per_point=names).save(here.served.root / "evil.fiblets")
    yield here, names
    (here.served.root / "evil.fiblets").unlink()


def test_names_in_files_are_text_wherever_they_are_shown(evil):
    here, names = evil
    here.press("o")
    here.page.click("[data-entry='evil.fiblets']")
    here.wait(lambda: here.layers() == 2, "the file")
    here.page.wait_for_selector("#dialog-open", state="hidden")
    here.page.click("[data-layer]:has-text('evil.fiblets')")
    here.wait(lambda: here.state("chosen_name") == "evil.fiblets", "the layer")
    here.page.click("[data-property=scalars] .v-select .v-field")
    listed = here.page.locator(".v-overlay--active .v-list-item")
    here.wait(lambda: any(names[0] in text for text in listed.all_inner_texts()), "the names in the list")
    unharmed(here)
    here.page.locator(".v-overlay--active .v-list-item", has_text=names[0]).first.click()
    here.wait(lambda: "scalars" in here.state("undo_label"), "colours by it")
    here.rests()
    for tab in ("clip", "filter", "selection", "info"):
        here.tab(tab)
        here.stands()
        unharmed(here)
    here.press("b")
    here.page.wait_for_selector("#pv-over[data-tool=box]")
    here.trace([(0.98, 0.98), (0.15, 0.02)])  # the tools are in one corner
    here.wait(lambda: here.state("selection").get("count"), "a selection")
    here.press("Escape")
    unharmed(here)
    here.page.click("[data-action=script]")
    script = here.page.locator("#script").inner_text()
    assert names[0] in script
    compile(script, "script", "exec")  # a name ends no string of it
    unharmed(here)


def test_names_in_sessions_are_text_wherever_they_are_shown(revisit):
    here = revisit("lines.fiblets")
    here.tab("filter")
    here.page.click("[data-region=sphere]")
    here.wait(lambda: here.state("filters")["regions"], "a region")
    here.tab("clip")
    here.page.click("[data-cut=plane]")
    here.wait(lambda: here.state("clips"), "a cut")
    saved = json.loads(here.page.evaluate("window.trame.trigger('save_session')"))
    (layer,) = saved["layers"]
    region = layer["filters"]["regions"]["of"][0]["region"]
    region["name"] = NAMES[0][:40]
    saved["layers"] = [{**layer, "id": f"layer{k + 1}", "name": name} for k, name in enumerate(NAMES)]
    saved["clips"] = [{**saved["clips"][0], "id": f"clip{k + 1}", "name": name} for k, name in enumerate(NAMES)]
    here.page.evaluate(LOAD, json.dumps(saved))
    here.wait(lambda: here.layers() == len(NAMES), "the layers")
    names = [here.page.locator("[data-layer]").nth(k).inner_text() for k in range(len(NAMES))]
    assert all(any(name in text for text in names) for name in NAMES)
    for tab in ("clip", "filter", "info"):
        here.tab(tab)
        here.stands()
        unharmed(here)
    for k in (0, 1):
        here.page.locator("[data-layer]").nth(k).click()
        here.wait(lambda k=k: here.state("chosen") == f"layer{k + 1}", "another layer")
        here.press("v")
        here.wait(lambda k=k: NAMES[k] in here.state("undo_label"), "what can be undone")
        here.page.hover("[data-action=undo]")
        here.page.locator(".v-tooltip .v-overlay__content", has_text=NAMES[k]).wait_for()
        unharmed(here)
    # Writing that turns what is beside it round, lines that break, and what moves a terminal's cursor.
    for bad in ("a\u202ebdp.exe", "a\nb", "a\x1b[2Jb", "\u2066x\u2069"):
        here.page.evaluate("window.trame.state.set('toast_open', false)")
        here.page.evaluate(LOAD, json.dumps({**saved, "layers": [{**layer, "name": bad}]}))
        here.wait(lambda: here.state("toast_open") and "printable" in here.toast(), "that it was refused")
        assert here.layers() == len(NAMES)
    here.page.evaluate(LOAD, json.dumps({**saved, "layers": [{**layer, "source": {"path": NAMES[0]}}]}))
    here.wait(lambda: "onerror" in here.toast(), "why it was not opened")
    unharmed(here)
    assert "\x1b" not in here.served.log.read_text()


def test_uploads_with_such_names_are_refused_or_text(revisit):
    here = revisit("lines.fiblets")
    content = (here.served.root / "lines.trk").read_bytes()
    for name in (*NAMES, "a\u202ekrt.exe.trk", "..\\up", "../up", ".hidden", "a\x1b[2J"):
        status = here.page.evaluate(
            """async ([name, content]) => (await fetch('/upload?name=' + encodeURIComponent(name),
                {method: 'POST', body: Uint8Array.from(atob(content), c => c.charCodeAt(0))})).status""",
            [f"{name}.trk", base64.b64encode(content[:2000]).decode()],
        )
        assert status in (200, 400)
        if status == 400:
            assert not list(here.served.root.glob("*onerror*"))
        unharmed(here)
        here.wait(lambda: not here.state("job"), "the end of it")
    unharmed(here)
    assert "\x1b" not in here.served.log.read_text()
    here.errors.clear()  # Chromium logs what was refused, and so it should be
