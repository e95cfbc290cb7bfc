"""Fields that show a value of the server, while somebody types into them, in a real browser."""

from __future__ import annotations

import pytest

pytestmark = pytest.mark.more

# Replies wait in the browser while window.late is a list.
LATE = """
window.late = null;
window.WebSocket = class extends WebSocket {
  set onmessage(take) { super.onmessage = (event) => window.late ? window.late.push(() => take(event)) : take(event) }
};
"""
ARRIVE = "() => { const all = window.late; window.late = null; for (const one of all) one() }"


def opened(visit):
    """Open a page whose replies can be made late, with slices."""
    here = visit("lines.fiblets", opened=False)
    here.page.add_init_script(LATE)
    here.open()
    here.tab("slices")
    here.page.click("[data-action=open-slices]")
    here.page.click("#dialog-open .v-list-item:has-text('head.nii.gz')")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    here.rests()
    return here


def test_a_late_reply_leaves_what_is_typed(visit):
    here = opened(visit)
    fields = [here.page.locator(f"[data-place=position] input >> nth={axis}") for axis in range(3)]
    told = lambda: [float(part) for part in here.state("slicing")["position"]]  # noqa: E731
    # The first is on its way while the second is typed, and arrives before it is left.
    here.page.evaluate("window.late = []")
    fields[0].fill("20")
    here.press("Tab")
    here.page.keyboard.type("2")
    here.wait(lambda: here.page.evaluate("window.late.length"), "a reply")
    assert fields[0].input_value() == "20"  # not what was there before
    here.page.evaluate(ARRIVE)
    here.wait(lambda: told()[0] == 20.0 and fields[0].input_value() == "20.0", "the first")
    assert fields[1].input_value() == "2"
    here.page.keyboard.type("4")
    here.press("Tab")
    here.wait(lambda: told()[1] == 24.0 and fields[1].input_value() == "24.0", "the second")
    # Escape gives back what the server has, the newest, and sends nothing.
    before = fields[2].input_value()
    fields[2].fill("1")
    here.press("Escape")
    assert fields[2].input_value() == before
    fields[2].fill("12 mm")
    here.page.evaluate("window.trame.trigger('step_slice', [0.1, 0.1, 0, 0, 1])")
    here.wait(lambda: any(f"{told()[axis]:.1f}" != was for axis, was in enumerate(["20.0", "24.0", before])), "a step")
    assert fields[2].input_value() == "12 mm"
    at = told()
    here.press("Escape")
    assert fields[2].input_value() == f"{at[2]:.1f}"
    here.press("Tab")
    here.rests()
    assert told() == at
    # A value that is refused is not left standing; nor is one that the server has already.
    here.page.click("[data-action=panes]")
    radius = here.page.locator("input[aria-label='Slab, mm']")
    usual = radius.input_value()
    for text in ("-5", f" {usual} mm"):
        radius.fill(text)
        here.press("Enter")
        here.wait(lambda: radius.input_value() == usual, "the value as it was")
