"""Selected streamlines stand out; the others fade."""

from __future__ import annotations

import numpy as np
import pytest

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.highlight import Highlight


@pytest.fixture
def rods(make_plotter, make_fibres, tools):
    """Return rods along x at 40 heights, in red, seen from -y, and a function: colours of each rod in the picture."""
    along = np.linspace(0, 40, 41)[:, None] * np.array((1.0, 0.0, 0.0))
    lines = [along + np.array((0, 0, 2.0 * i)) for i in range(40)]
    mapper, actor = make_fibres(type(tools.helices(1, 2)).from_list(lines)).actor(
        colouring=Colouring("solid", color=(1.0, 0.0, 0.0))
    )
    plotter = make_plotter()
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.reset_camera()

    def colours():
        image = tools.picture(plotter, mapper)
        found = []
        for i in range(40):
            plotter.renderer.SetWorldPoint(20.0, 0.0, 2.0 * i, 1.0)
            plotter.renderer.WorldToDisplay()
            x, y, _ = plotter.renderer.GetDisplayPoint()
            row = image.shape[0] - 1 - round(y)
            part = image[row - 1 : row + 2, int(x)]
            away = np.abs(part.astype(int) - np.round(255 * np.array(plotter.background_color.float_rgb)))
            found.append(part[away.sum(axis=1).argmax()])
        return np.array(found)

    return plotter, mapper, colours


def mask(*chosen):
    selected = np.zeros(40, bool)
    selected[list(chosen)] = True
    return selected


def test_others_fade_towards_the_background_and_the_chosen_keep_their_colour(rods):
    plotter, mapper, colours = rods
    plotter.set_background((0.0, 0.0, 1.0))
    before = colours()
    assert (before == (255, 0, 0)).all()
    chosen = mask(0, 7, 31, 32, 39)
    mapper.set_effect("selection", Highlight(chosen, dim=0.75))
    after = colours()
    assert (after[chosen] == (255, 0, 0)).all()
    assert (np.abs(after[~chosen].astype(int) - (64, 0, 191)) <= 1).all()
    mapper.set_effect("selection", None)
    assert (colours() == before).all()


def test_colours_can_be_given_and_another_selection_changes_bits_alone(rods):
    _, mapper, colours = rods
    mapper.set_effect("selection", Highlight(mask(3), color=(0.0, 1.0, 0.0), dim=0.5, faded=(1.0, 1.0, 1.0)))
    first = colours()
    assert (first[3] == (0, 255, 0)).all()
    assert (np.abs(first[4].astype(int) - (255, 128, 128)) <= 1).all()
    kept = [slot.effects["selection"][1] for slot in slots(mapper)]
    textures = [bits.texture for bits in kept]
    mapper.set_effect("selection", Highlight(mask(35), color=(0.0, 1.0, 0.0), dim=0.0))
    second = colours()
    assert (second[35] == (0, 255, 0)).all()
    assert (second[3] == (255, 0, 0)).all()
    assert [slot.effects["selection"][1].texture for slot in slots(mapper)] == textures


def slots(mapper):
    from pvfiblets.mappers.windows import contexts_with

    return [context.slots[mapper.GetAddressAsString("")] for context in contexts_with(mapper)]


def test_more_streamlines_than_a_row_of_the_texture_holds(make_plotter):
    from pvfiblets.mappers.highlight import _Bits
    from pvfiblets.mappers.windows import borrowed_context

    plotter = make_plotter(window_size=(31, 31))
    plotter.show(auto_close=False)
    selected = np.random.default_rng(1).random(300_001) < 0.3
    with borrowed_context(plotter.render_window) as ctx:
        bits = _Bits(ctx)
        texture = bits.update(selected)
        words = np.frombuffer(texture.read(), "<u4")
        ids = np.arange(len(selected))
        assert texture.size[0] <= 4096
        assert np.array_equal((words[ids // 32] >> (ids % 32)) & 1, selected)
        bits.release()
        bits.release()


def test_bad_input_is_refused():
    with pytest.raises(ValueError, match="one bool for each streamline"):
        Highlight(np.arange(3))
    with pytest.raises(ValueError, match=r"dim is 1\.5"):
        Highlight(np.ones(3, bool), dim=1.5)
