"""Colour bars: what each covers is measured in pictures of it alone."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from pvfiblets.web.scalar_bar_layout import DOTS, Wanted, arrange

SIZES = [(760, 856), (800, 556), (320, 596), (320, 276), (276, 320), (1600, 400)]  # of pictures in pages
VALUES = ("length", "fa", "group", "weight")


def rectangle(picture):
    """Return left, right, top and bottom of what is drawn on black."""
    lit = picture.max(axis=2) > 30
    columns, rows = np.flatnonzero(lit.any(axis=0)), np.flatnonzero(lit.any(axis=1))
    return (columns[0], columns[-1] + 1, rows[0], rows[-1] + 1) if columns.size else None


def apart(one, other, least):
    """Whether two rectangles are so many pixels from each other, across or down."""
    across = max(one[0], other[0]) - min(one[1], other[1])
    down = max(one[2], other[2]) - min(one[3], other[3])
    return max(across, down) >= least


class Bars:
    """The bars of a scene, whose layers are not to be seen."""

    def __init__(self, scene, values=VALUES):
        self.scene = scene
        for name in values:
            layer = scene.open("lines.fiblets")
            scene.set(layer.id, "scalars", name)
            scene.set(layer.id, "opacity", 0.0)
        scene.screenshot()

    @property
    def shown(self):
        return {title: bar for title, bar in self.scene.plotter.scalar_bars.items() if bar.GetVisibility()}

    def alone(self, bar):
        """Return a picture of one bar alone."""
        others = [other for other in self.shown.values() if other is not bar]
        for other in others:
            other.VisibilityOff()
        try:
            return self.scene.screenshot()
        finally:
            for other in others:
                other.VisibilityOn()

    def parts(self, bar):
        """Return the rectangles of a bar's title, and of all else."""
        title, rest = bar.GetTitleTextProperty(), (bar.GetLabelTextProperty(), bar.GetAnnotationTextProperty())
        found = []
        for hidden in ((title,), (*rest, None)):
            for letters in hidden:
                letters.SetOpacity(0.0) if letters else bar.DrawColorBarOff()
            bar.SetDrawAnnotations(None not in hidden)
            found.append(rectangle(self.alone(bar)))
            for letters in hidden:
                letters.SetOpacity(1.0) if letters else bar.DrawColorBarOn()
        bar.DrawAnnotationsOn()
        return found[1], found[0]


@pytest.mark.more
@pytest.mark.parametrize(
    ("size", "dpi"),
    [*((size, 72) for size in SIZES[:1]), ((320, 276), 144),
     *(pytest.param(size, 72, marks=pytest.mark.exhaustive) for size in SIZES[1:])],
)  # fmt: skip
def test_nothing_of_a_bar_touches_anything(scene, size, dpi):
    width, height = scene.plotter.window_size = size[0] * dpi // 72, size[1] * dpi // 72
    scene.plotter.render_window.SetDPI(dpi)
    bars = Bars(scene)
    shown = bars.shown
    assert len(shown) + len(scene.bars.left_out) == 4
    assert len(shown) >= (4 if min(size) > 320 else 3)
    whole = {}
    for title, bar in shown.items():
        above, below = bars.parts(bar)
        assert apart(above, below, 2 * dpi // 72), f"the title of {title} at {above} touches what is at {below}"
        whole[title] = rectangle(bars.alone(bar))
        left, right, top, bottom = whole[title]
        scale = dpi / 72
        assert left >= 46 * scale  # where tools are
        assert right <= width - 4 * scale
        assert bottom <= height - 24 * scale  # where a line of text is
        assert top >= height / 2 + 12 * scale  # where letters are
    for one, other in itertools.combinations(shown, 2):
        assert apart(whole[one], whole[other], 6 * dpi // 72), f"{one} at {whole[one]}, {other} at {whole[other]}"


@pytest.mark.more
def test_bars_follow_the_size_of_the_window(scene):
    bars = Bars(scene)
    scene.plotter.window_size = 800, 600
    scene.screenshot()
    assert len(bars.shown) == 4
    wide = [rectangle(bars.alone(bar)) for bar in bars.shown.values()]
    scene.plotter.window_size = 200, 160
    scene.screenshot()
    assert not bars.shown
    assert scene.bars.left_out == ["length [mm]", "fa", "group", "weight"]
    assert rectangle(scene.screenshot()) is None
    scene.plotter.window_size = 800, 600
    scene.screenshot()
    assert scene.bars.left_out == []
    assert [rectangle(bars.alone(bar)) for bar in bars.shown.values()] == wide


@pytest.mark.more
def test_half_as_many_pixels_show_the_same_bars(scene):
    """As they are drawn while the camera moves: letters have half the size, too."""
    scene.plotter.window_size = 800, 600
    bars = Bars(scene, ("length", "fa"))
    whole = {title: rectangle(bars.alone(bar)) for title, bar in bars.shown.items()}
    scene.plotter.window_size = 400, 300
    scene.plotter.render_window.SetDPI(36)
    scene.screenshot()
    for title, bar in bars.shown.items():
        np.testing.assert_allclose(2 * np.array(rectangle(bars.alone(bar))), whole[title], atol=8)


def test_long_titles_are_shortened_and_no_more_bars_shown_than_fit():
    def measure(text, font):
        return 0.6 * font * len(text)

    wanted = [Wanted(f"a title of many words {k}", ("0.00", "-12.5")) for k in range(6)]
    for width, font, count in ((1600, 13, 6), (800, 13, 6), (400, 9, 6), (320, 9, 4), (120, 13, 1), (80, 0, 0)):
        places = arrange(wanted, (width, 600), 1.0, measure)
        shown = [place for place in places if place is not None]
        assert len(shown) == count
        assert places[count:] == [None] * (6 - count)  # the first layers keep theirs
        assert all(place.font >= font for place in shown)
        ends = [(place.left, place.left + place.width) for place in shown]
        assert all(start >= 48 and end <= width - 8 for start, end in ends)
        assert all(right[0] > left[1] for right, left in itertools.pairwise(ends))
        short = [place.title for place in shown if place.title.endswith(DOTS)]
        assert len(short) == (0 if width == 1600 else count)


def test_names_that_find_no_room_are_left_out():
    def measure(text, font):
        return 0.6 * font * len(text)

    def place(names, size):
        (found,) = arrange([Wanted("group", tuple(names), named=True)], size, 1.0, measure)
        return found

    assert place(["near", "far"], (320, 600)).label_font == 13
    small = place([f"part {k}" for k in range(14)], (320, 600))
    assert 7 <= small.label_font < 13
    assert place([f"part {k}" for k in range(100)], (320, 600)) is None
    assert place(["a name that is much longer than the picture is wide"], (320, 600)) is None


@pytest.mark.more
def test_enlarged_pictures_have_their_bars_where_the_page_has_them(scene):
    bars = Bars(scene, ["length"])
    scene.plotter.window_size = 400, 320
    before = np.array(rectangle(scene.screenshot()))
    after = np.array(rectangle(scene.screenshot(scale=3)))
    assert len(bars.shown) == 1
    np.testing.assert_allclose(after / 3, before, atol=3)
