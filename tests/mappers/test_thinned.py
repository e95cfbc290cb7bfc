"""Some of a large set's streamlines, for frames of reduced detail."""

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkRenderWindow

import pvfiblets
from pvfiblets.codec.editing.restrict import even_share, restrict
from pvfiblets.mappers import thinned
from pvfiblets.mappers.frames import scene
from pvfiblets.mappers.frames.scene import reduce_detail, slack, wanted_share
from pvfiblets.synthetic import brain_streamlines

SHARE = 0.25


@pytest.fixture
def brain(monkeypatch):
    monkeypatch.setattr(thinned, "LEAST_FIBLETS", 10)
    return pvfiblets.compress(brain_streamlines(300, seed=2), exact=False)


@pytest.fixture
def plotter():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    yield plotter
    plotter.close()


def shown(plotter):
    plotter.render()
    return np.array(plotter.screenshot(return_img=True))


def thinned_sets(actor):
    from pvfiblets.mappers.frames.windows import contexts_with

    (context,) = contexts_with(actor.mapper)
    return context.slots[actor.mapper.GetAddressAsString("")].thinned


def drawn_by(engine):
    """Return the numbers of the streamlines in the last picture."""
    picture = engine._buffer
    depth = np.frombuffer(picture.depth.read(), np.uint32)
    ids = np.frombuffer(picture.ids.read(), np.uint32).reshape(len(depth), -1)[:, 0]
    return set(np.unique(ids[depth != 0xFFFFFFFF]).tolist())


def test_a_window_at_the_address_of_a_gone_one_draws_all(plotter):
    gone = vtkRenderWindow()
    reduce_detail(gone, 2.0, SHARE)
    address = gone.GetAddressAsString("")
    del gone
    scene._reduced[plotter.render_window.GetAddressAsString("")] = scene._reduced.pop(address)
    assert wanted_share(plotter.render_window) == 1.0
    assert slack(plotter.renderer) == 0.0


def test_a_share_of_the_streamlines_is_drawn_at_reduced_detail_and_all_after_it(plotter, brain):
    actor = plotter.add_fiblets(brain)
    plotter.show(auto_close=False)
    whole = shown(plotter)
    assert not thinned_sets(actor)  # nothing of it is there before
    reduce_detail(plotter.render_window, 0.0, SHARE)
    actor.mapper.Modified()
    hasty = shown(plotter)
    (engine,) = thinned_sets(actor).values()
    assert 0.1 < engine.share <= SHARE
    reduce_detail(plotter.render_window, 0.0)
    actor.mapper.Modified()
    np.testing.assert_array_equal(shown(plotter), whole)
    assert not np.array_equal(hasty, whole)
    # The picture of that share as a set of its own, whose streamlines have the same numbers.
    other = pv.Plotter(off_screen=True, window_size=(200, 160))
    other.add_fiblets(restrict(brain, even_share(brain, engine.share)))
    other.camera = plotter.camera.copy()
    other.show(auto_close=False)
    wrong = (np.abs(shown(other).astype(int) - hasty) > 8).any(-1).mean()
    other.close()
    assert wrong < 0.01


def test_filters_colours_and_picks_go_by_the_numbers_of_the_whole_set(plotter, brain):
    actor = plotter.add_fiblets(brain, scalars=np.arange(brain.n_streamlines), cmap="viridis")
    plotter.show(auto_close=False)
    kept = np.zeros(brain.n_streamlines, bool)
    kept[::3] = True
    actor.include(kept, name="every third")
    reduce_detail(plotter.render_window, 0.0, SHARE)
    actor.mapper.Modified()
    plotter.render()
    (engine,) = thinned_sets(actor).values()
    found = drawn_by(engine)
    chosen = set(even_share(brain, engine.share).tolist()) & set(np.flatnonzero(kept).tolist())
    assert len(found) > 5
    assert found <= chosen
    actor.include(~kept, name="every third")
    plotter.render()
    assert drawn_by(engine)
    assert not drawn_by(engine) & chosen


def test_small_sets_and_sums_show_all(plotter, brain, monkeypatch):
    monkeypatch.setattr(thinned, "LEAST_FIBLETS", brain.n_fiblets + 1)
    actor = plotter.add_fiblets(brain)
    plotter.show(auto_close=False)
    reduce_detail(plotter.render_window, 0.0, SHARE)
    actor.mapper.Modified()
    plotter.render()
    assert not thinned_sets(actor)
    monkeypatch.setattr(thinned, "LEAST_FIBLETS", 10)
    actor.style = "density"
    plotter.render()
    assert not thinned_sets(actor)


def test_they_go_with_the_set_and_are_counted(plotter, brain):
    actor = plotter.add_fiblets(brain)
    plotter.show(auto_close=False)
    before = actor.explain()["gpu_bytes"]
    reduce_detail(plotter.render_window, 0.0, SHARE)
    actor.mapper.Modified()
    plotter.render()
    assert actor.explain()["gpu_bytes"] > before
    (engine,) = thinned_sets(actor).values()
    actor.mapper.set_fiblets(pvfiblets.compress(pvfiblets.Streamlines.from_list([np.eye(3)])))
    plotter.render()
    assert engine.released
    assert not thinned_sets(actor)
