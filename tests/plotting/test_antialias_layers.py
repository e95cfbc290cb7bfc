"""All samples of a picture of lines in one frame, beside the same samples one after the other."""

from __future__ import annotations

import gc
import re
import signal
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.engine.effects.sample_positions import sample_positions, sample_squares
from pvfiblets.engine.errors import EngineError
from pvfiblets.engine.fiblets import sample_layers
from pvfiblets.engine.fiblets.data import chunks
from pvfiblets.engine.fiblets.renderer import FibletRenderer
from pvfiblets.engine.fiblets.sample_layers import SampleLayers
from pvfiblets.engine.gl import shaders
from pvfiblets.mappers.frames import idle_windows
from pvfiblets.mappers.frames.idle_windows import Finishing
from pvfiblets.mappers.picture.picture import Picture
from pvfiblets.regions import Box
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines
from tests.gl_calls import possible, recording

from .refined_scene import Renders, grabbed, real_default, shot  # noqa: F401 - a fixture

SIZE = (180, 140)


@pytest.fixture(scope="module")
def lines():
    return brain_streamlines(250, step=2.0, seed=3)


@pytest.fixture
def scene(lines):
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("black", top="blue")
    # What a line shows is the same all along it: then lighting it once a pixel changes nothing.
    colours = np.random.default_rng(0).uniform(size=len(lines))
    actor = plotter.add_fiblets(lines, scalars=colours, lighting=False, show_scalar_bar=False)
    yield plotter, actor
    plotter.close()


def cut(_plotter, actor):
    actor.clip(((0.0, 0.0, 1.0), (0.0, 0.0, 3.0)))


def hide(_plotter, actor):
    actor.subset(every=3)


def add_sets(plotter, actor):
    """Add lines that run among those of the others, some that stand aside, and some that are hidden."""
    for color, shift, size, visible in [("white", 0, 1.0, True), ("red", 70, 0.3, True), ("green", 0, 1.0, False)]:
        lines = [shift + size * line + 0.3 for line in actor.fiblets.decompress()]
        added = plotter.add_fiblets(lines, color=color, lighting=False, opacity=1.0, line_width=1.6)
        added.visibility = visible


def look_close(plotter, actor):
    actor.line_width = 0.7
    plotter.enable_parallel_projection()
    plotter.camera.zoom(2.0)


def write(plotter, _actor):
    plotter.add_text("above")


def add_meshes(plotter, _actor):
    """Add what hides lines and is hidden by them, in front of all and nowhere, lit and not."""
    plotter.add_mesh(pv.Sphere(radius=30.0), color="tan")
    plotter.add_mesh(pv.Cone(center=(-40.0, 0.0, 0.0), height=50.0, radius=25.0), color="red", lighting=False)
    plotter.add_mesh(pv.Cube(center=(60.0, -20.0, 30.0), x_length=25.0, y_length=25.0, z_length=25.0), color="white")
    plotter.add_mesh(pv.Sphere(radius=80.0), color="green").visibility = False


def add_meshes_and_sets(plotter, actor):
    add_meshes(plotter, actor)
    add_sets(plotter, actor)


def add_tubes(plotter, _actor):
    """Add tubes, and lines with halos, whose samples are not drawn at once."""
    plotter.add_spline_tubes([[(0.0, 0.0, -50.0), (0.0, 20.0, 0.0), (0.0, 0.0, 50.0)]], radius=6.0)
    plotter.add_halo_lines([np.array([(-50.0, 0.0, 40.0), (50.0, 20.0, 40.0)])])


def nothing(_plotter, _actor):
    """Leave the scene as it is."""


def shown(plotter, monkeypatch, *, singly=False):
    """Return a screenshot and the frames that it took, drawn anew."""
    with monkeypatch.context() as patch:
        if singly:
            patch.setattr(Picture, "_lines_at_once", lambda *_: ([], []))
        plotter.renderer.Modified()
        plotter.picture.antialias = "off"
        plotter.picture.antialias = "refined"
        plotter.render()
        renders = Renders(plotter)
        return shot(plotter), renders.since()


def off_by(one, other):
    """Return how far pictures are apart in each pixel of lines, levels."""
    lit = (one != one[:, :1]).any(axis=-1) | (other != other[:, :1]).any(axis=-1)
    return np.abs(one - other).max(axis=-1)[lit]


@pytest.mark.parametrize(
    ("change", "parts"),
    [
        *[(nothing, 1), (cut, 1), (cut, 12), (hide, 1), (look_close, 1), (write, 1), (add_sets, 1), (add_sets, 5)],
        *[(add_meshes, 1), (add_meshes, 12), (add_meshes_and_sets, 1), (add_meshes_and_sets, 5), (add_tubes, 1)],
    ],
)
def test_the_picture_is_that_of_samples_one_after_the_other(scene, change, parts, monkeypatch):
    monkeypatch.setattr(sample_layers, "MOST_TEXELS", 16 * SIZE[0] * SIZE[1] // parts)
    plotter, actor = scene
    change(plotter, actor)
    plotter.show(auto_close=False)
    at_once, frames = shown(plotter, monkeypatch)
    assert frames == 1 + (change in (add_meshes, add_meshes_and_sets, add_tubes))
    mean, frames = shown(plotter, monkeypatch, singly=True)
    assert frames >= 15
    assert np.sqrt((off_by(at_once, mean) ** 2.0).mean()) < 3.0, "lines beyond those of the layers are left out"
    with monkeypatch.context() as patch:
        patch.setattr(sample_layers, "LAYERS", sample_layers.SAMPLES)
        at_once = shown(plotter, monkeypatch)[0]
    apart = off_by(at_once, mean)
    assert apart.size > 5000
    assert (apart > 1).mean() <= 0.025  # where points within a sample are left out
    assert apart.max() <= 48  # three samples
    actor.lighting = True
    actor.scalars = None
    at_once, mean = shown(plotter, monkeypatch)[0], shown(plotter, monkeypatch, singly=True)[0]
    assert np.sqrt((off_by(at_once, mean) ** 2.0).mean()) < 6.0


@pytest.mark.parametrize("clustered", [1 << 21, 1])
def test_what_is_hidden_changes_no_sample(lines, clustered, monkeypatch):
    monkeypatch.setattr(chunks, "CLUSTERED", clustered)
    pictures = []
    for culling in (None, "two-phase"):
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        actor = plotter.add_fiblets([*lines, *(0.9 * line for line in lines)], culling=culling, line_width=2.0)
        plotter.show(auto_close=False)
        for zoom in (1.0, 1.7):
            plotter.camera.zoom(zoom)
            plotter.camera.azimuth = 25.0 * zoom
            picture, frames = shown(plotter, monkeypatch)
            assert frames == 1
            pictures.append(picture)
        counts = actor.explain()["fiblets"]
        plotter.close()
    assert counts["drawn"] < counts["in_frustum"], "the last one's culling finds something"
    np.testing.assert_array_equal(pictures[:2], pictures[2:])


@pytest.mark.parametrize("colours", ["values", "arc length", "image", "tangents", "kept"])
def test_points_that_lie_within_a_pixel_leave_the_picture_as_it_is(colours, monkeypatch):
    turn = np.linspace(0.0, 12.0, 3000)
    spirals = [np.stack([(4 + turn) * np.cos(turn + i), (4 + turn) * np.sin(turn + i), turn * i], 1) for i in range(4)]
    image = pv.ImageData(dimensions=(40, 40, 20), spacing=(1.0, 1.0, 2.0), origin=(-20.0, -20.0, -1.0))
    image["x"] = image.points[:, 0]
    scalars = {"values": "wave", "arc length": "arc_length", "image": image, "tangents": None, "kept": None}[colours]
    wave = np.tile(np.sin(3.0 * turn), 4).astype(np.float32)
    lines = Streamlines.from_list(spirals, per_point={"wave": wave})
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    actor = plotter.add_fiblets(lines, scalars=scalars, lighting=colours == "tangents", show_scalar_bar=False)
    actor.line_width = 5.0
    if colours == "kept":
        actor.criterion("wave", (-0.5, 0.9))
    plotter.show(auto_close=False)
    at_once, mean = shown(plotter, monkeypatch)[0], shown(plotter, monkeypatch, singly=True)[0]
    # A pixel's line is lit once, by one of its samples; edges lie by less than a sample off.
    assert np.median(off_by(at_once, mean)) <= 6.0
    assert abs((at_once.astype(float) - mean).mean()) < 0.3
    plotter.close()


def add_glass(plotter, _actor):
    plotter.add_mesh(pv.Sphere(radius=30.0), opacity=0.5)


def add_wires(plotter, _actor):
    """Add lines of VTK, which are thinner without multisampling."""
    plotter.add_mesh(pv.Sphere(radius=30.0), show_edges=True)


def thicken(_plotter, actor):
    actor.tube_radius = 0.5


def fade(_plotter, actor):
    actor.opacity = 0.5


def keep_outside(_plotter, actor):
    actor.clip(~Box((-20, 20, -20, 20, -20, 20)))


def occlude(_plotter, actor):
    actor.ambient_occlusion = True


@pytest.mark.parametrize("change", [add_glass, add_wires, thicken, fade, keep_outside, occlude])
def test_other_pictures_have_one_sample_after_the_other(scene, change, monkeypatch):
    plotter, actor = scene
    change(plotter, actor)
    plotter.show(auto_close=False)
    plotter.picture.antialias = 4
    plotter.render()
    monkeypatch.setattr(SampleLayers, "draw", None)
    monkeypatch.setattr("pvfiblets.mappers.picture.antialias_refinement.SAMPLES", 4)
    renders = Renders(plotter)
    shot(plotter)
    assert renders.since() >= 4


@pytest.mark.parametrize("width", [1.0, 0.7])
def test_picks_depths_and_memory_are_those_of_the_picture_before(scene, width):
    plotter, actor = scene
    actor.line_width = width
    plotter.show(auto_close=False)

    def seen():
        found = [actor.GetMapper().pick_at(x, y, tolerance=0) for x in range(60, 120, 7) for y in range(40, 100, 7)]
        return found, plotter.get_image_depth(), actor.explain()["fiblets"]

    plotter.picture.antialias = "off"
    plotter.render()
    picks, depths, counts = seen()
    assert any(picks)
    plotter.picture.antialias = "refined"
    plotter.render()
    before = {buffer["name"] for buffer in actor.explain()["buffers"]}
    shot(plotter)
    after = seen()
    assert after[0] == picks
    assert after[2] == counts
    np.testing.assert_array_equal(after[1], depths)
    assert {buffer["name"] for buffer in actor.explain()["buffers"]} == before


@pytest.mark.parametrize("change", [nothing, add_meshes_and_sets, add_tubes])
def test_behind_the_mean_lies_the_picture_that_was_drawn_before(scene, change, monkeypatch):
    plotter, actor = scene
    change(plotter, actor)
    plotter.show(auto_close=False)
    plotter.camera.azimuth += 5
    plotter.render()
    drawn = []
    draw = FibletRenderer._draw
    monkeypatch.setattr(FibletRenderer, "_draw", lambda *given: drawn.append(given) or draw(*given))
    shot(plotter)
    assert plotter.picture.samples == 16
    assert not drawn
    plotter.camera.azimuth += 5
    plotter.render()
    assert len(drawn) == sum(1 for one in plotter.fiblets if one.visibility)


def test_beside_slices_lines_stay_in_all_views(lines, monkeypatch):
    plotter = pv.Plotter(off_screen=True, window_size=(2 * SIZE[0], 2 * SIZE[1]), shape=(2, 2))
    image = np.random.default_rng(0).uniform(size=(20, 20, 20)).astype(np.float32), np.diag([8.0, 8.0, 8.0, 1.0])
    workspace = plotter.slices.workspace(image, thickness=4.0)
    actor = plotter.add_fiblets(lines, color="yellow", lighting=False)
    picture = shot(plotter)
    assert plotter.picture.samples == 16
    views = [plotter.renderer, *(pane.renderer for pane in workspace.panes.values())]
    assert all(view.HasViewProp(actor) for view in views)
    assert list(plotter.fiblets) == [actor]
    with monkeypatch.context() as patch:
        patch.setattr(Picture, "_lines_at_once", lambda *_: ([], []))
        for view in views:
            view.Modified()
        plotter.picture.antialias = "off"
        plotter.picture.antialias = "refined"
        plotter.render()
        singly = shot(plotter)
    assert np.abs(picture - singly).mean() < 0.5
    plotter.close()


def test_a_cross_hair_leaves_panes_all_samples_at_once(lines, monkeypatch):
    plotter = pv.Plotter(off_screen=True, window_size=(2 * SIZE[0], 2 * SIZE[1]), shape=(2, 2))
    image = np.random.default_rng(0).uniform(size=(20, 20, 20)).astype(np.float32), np.diag([8.0, 8.0, 8.0, 1.0])
    workspace = plotter.slices.workspace(image, thickness=4.0)
    plotter.add_fiblets(lines, color="yellow", lighting=False)
    plotter.render_window.SetMultiSamples(0)  # singly, samples of samples would widen edges
    shot(plotter)

    def moved(place):
        workspace.position = place
        plotter.render()
        renders = Renders(plotter)
        return shot(plotter), renders.since()

    moved((10.0, 0.0, 0.0))
    at_once, frames = moved((3.0, 5.0, 7.0))
    assert frames <= 3
    with monkeypatch.context() as patch:
        patch.setattr(Picture, "_lines_at_once", lambda *_: ([], []))
        moved((10.0, 0.0, 0.0))
        singly, frames = moved((3.0, 5.0, 7.0))
    assert frames >= 15
    assert np.sqrt(((at_once - singly) ** 2.0).mean()) < 3.0
    plotter.close()


def test_selected_streamlines_stay_selected_beside_meshes(scene):
    plotter, actor = scene
    add_meshes(plotter, actor)
    actor.select([3, 5])
    shot(plotter)
    before = plotter.renderer.GetViewProps().GetNumberOfItems()
    plotter.camera.azimuth += 5
    shot(plotter)
    assert plotter.renderer.GetViewProps().GetNumberOfItems() == before
    assert sorted(actor.selection) == [3, 5]


@pytest.mark.parametrize("act", ["add", "remove", "stop"])
def test_what_others_change_while_samples_are_drawn_stays_changed(scene, act):
    plotter, actor = scene
    add_meshes(plotter, actor)
    plotter.show(auto_close=False)
    plotter.camera.azimuth += 5
    plotter.render()
    mesh = pv.Sphere(radius=4.0)
    done = []

    def started(*_):
        if not done and not plotter.renderer.HasViewProp(actor):
            if act == "add":
                done.append(plotter.add_mesh(mesh, name="new", render=False))
            elif act == "remove":
                done.append(next(one for one in plotter.renderer.actors.values() if one is not actor))
                plotter.remove_actor(done[0], render=False)
            else:
                plotter.picture.antialias = "off"
                done.append(None)

    plotter.renderer.AddObserver("StartEvent", started)
    shot(plotter)
    assert done
    assert plotter.renderer.HasViewProp(actor)
    if act != "stop":
        assert plotter.renderer.HasViewProp(done[0]) == (act == "add")
    shot(plotter)


@pytest.mark.parametrize("sets", [1, 2])
def test_lines_beside_the_picture_are_not_in_it(lines, sets):
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    for shift in range(sets):
        plotter.add_fiblets([line + shift for line in lines], show_scalar_bar=False)
    before = plotter.camera_position = [(0, -400, 0), (0, 0, 0), (0, 0, 1)]
    seen = shot(plotter)
    assert seen.std() > 10.0
    for focus in ((-900, 0, 0), (900, 0, 0), (0, 0, 900), (0, 0, -900)):
        plotter.camera_position = [before[0], focus, (0.1, 0, 1)]
        plotter.render()
        assert shot(plotter).std() == 0.0
    plotter.camera_position = before
    plotter.render()
    np.testing.assert_array_equal(shot(plotter), seen)
    plotter.close()


def test_where_memory_lacks_samples_come_one_after_the_other(scene, monkeypatch):
    plotter, _ = scene
    plotter.show(auto_close=False)
    mean, _ = shown(plotter, monkeypatch, singly=True)

    def lacking(*_args):
        raise EngineError("no memory")

    monkeypatch.setattr(SampleLayers, "draw", lacking)
    found, frames = shown(plotter, monkeypatch)
    assert frames >= 16
    np.testing.assert_array_equal(found, mean)


def test_samples_lie_where_those_one_after_the_other_do():
    text = shaders.read_shader("fiblets/compute/software_raster/cover_wide.glsl")
    places = np.array([[float(n) for n in pair] for pair in re.findall(r"vec2\((-?\d\.\d+), (-?\d\.\d+)\)", text)])
    squares = np.stack(np.meshgrid(np.arange(4), np.arange(4)), axis=-1).reshape(-1, 2)
    found = (squares + 0.5 + places) / 4.0 - 0.5
    wanted = np.array(sample_positions(16))
    place = [4 * row + column for column, row in sample_squares(4)]
    np.testing.assert_allclose(found[place], wanted, atol=1e-5)
    assert np.abs(places).max() < float(re.search(r"ASIDE = (0\.\d+)", text)[1])
    assert np.abs(found).max() <= 0.5  # or culling would have to look beyond the picture


@pytest.fixture
def interruptible():
    """Have Ctrl-C do what it usually does, in a process of the background, too."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize("at_once", [True, False])
def test_an_interrupt_leaves_the_picture_so_far_and_the_next_one_goes_on(scene, at_once, monkeypatch):
    plotter, _ = scene
    plotter.show(auto_close=False)
    finished, _ = shown(plotter, monkeypatch, singly=not at_once)
    plain = shown_plain(plotter)
    monkeypatch.setattr(sample_layers, "MOST_TEXELS", 16 * SIZE[0] * SIZE[1] // 4)
    if not at_once:
        monkeypatch.setattr(Picture, "_lines_at_once", lambda *_: ([], []))
    reach, count = Finishing.reach, 2

    def interrupted(self, done):
        nonlocal count
        count -= 1
        if count == 0:
            signal.raise_signal(signal.SIGINT)
        return reach(self, done)

    monkeypatch.setattr(Finishing, "reach", interrupted)
    plotter.picture.antialias = "off"
    plotter.picture.antialias = "refined"
    plotter.render()
    with pytest.warns(RuntimeWarning, match=r"stopped after \d+ of 16 samples"):
        np.testing.assert_array_equal(shot(plotter), plain)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    assert np.percentile(off_by(shot(plotter), finished), 99) <= 1.0


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_while_meshes_are_sampled_leaves_the_plain_picture(scene, monkeypatch):
    plotter, actor = scene
    add_meshes(plotter, actor)
    plotter.show(auto_close=False)
    finished, _ = shown(plotter, monkeypatch)
    plain = shown_plain(plotter)

    def interrupted(self, done):
        signal.raise_signal(signal.SIGINT)
        assert done == 8, "of the work, meshes are a half"
        return False

    plotter.picture.antialias = "refined"
    plotter.render()
    with monkeypatch.context() as patch:
        patch.setattr(Finishing, "reach", interrupted)
        with pytest.warns(RuntimeWarning, match="stopped after 0 of 16 samples"):
            np.testing.assert_array_equal(shot(plotter), plain)
    np.testing.assert_array_equal(shot(plotter), finished)


def test_meshes_are_sampled_a_few_at_a_time_where_somebody_waits(scene, monkeypatch):
    plotter, actor = scene
    add_meshes(plotter, actor)
    plotter.show(auto_close=False)
    finished, _ = shown(plotter, monkeypatch)
    monkeypatch.setattr("pvfiblets.mappers.picture.picture.PATIENCE", 0.0)
    props = [plotter.renderer.GetViewProps().GetItemAsObject(i) for i in range(6)]
    plotter.picture.antialias = "off"
    plotter.picture.antialias = "refined"
    plotter.render()
    renders, seen = Renders(plotter), []
    while plotter.picture.refine():
        seen += [grabbed(plotter)] * bool(renders.since())
    assert len(seen) == 4, "of four samples each"
    for picture in seen:
        np.testing.assert_array_equal(picture, seen[0])
    np.testing.assert_array_equal(grabbed(plotter), finished)
    assert props == [plotter.renderer.GetViewProps().GetItemAsObject(i) for i in range(6)]
    costs = [one["name"] for one in plotter.picture._picture().explain()["buffers"]]
    assert "samples of others" not in costs


@pytest.mark.parametrize("lacking", ["bytes", "textures"])
def test_where_memory_lacks_for_samples_of_meshes_all_come_one_after_the_other(scene, lacking, monkeypatch):
    plotter, actor = scene
    add_meshes(plotter, actor)
    plotter.show(auto_close=False)
    mean, _ = shown(plotter, monkeypatch, singly=True)

    def fails(*_args, **_named):
        raise EngineError("no memory")

    if lacking == "bytes":
        monkeypatch.setattr("pvfiblets.mappers.picture.picture.MOST_BYTES", 1000)
    else:
        monkeypatch.setattr("pvfiblets.engine.effects.picture.PictureEffects.copy", fails)
    found, frames = shown(plotter, monkeypatch)
    assert frames >= 16
    np.testing.assert_array_equal(found, mean)


def shown_plain(plotter):
    """Return the picture with smooth edges of one sample."""
    plotter.picture.antialias = "coverage"
    plotter.render()
    return shot(plotter)


@pytest.mark.parametrize("change", [nothing, look_close, hide, "remove", "close"])
def test_between_frames_parts_are_drawn_until_something_changes(scene, change, monkeypatch):
    monkeypatch.setattr(sample_layers, "MOST_TEXELS", 16 * SIZE[0] * SIZE[1] // 4)
    plotter, actor = scene
    plotter.show(auto_close=False)
    plotter.picture.antialias = "off"
    plotter.picture.antialias = "refined"
    plotter.render()
    renders = Renders(plotter)
    assert plotter.picture.refine()
    assert plotter.picture.refine()
    assert renders.since() == 0
    if change == "close":
        return
    if change == "remove":
        plotter.remove_actor(actor)
        plotter.render()
        while plotter.picture.refine():
            pass
        assert not (shot(plotter)[..., 0]).any()
        return
    change(plotter, actor)
    if change is not nothing:
        plotter.render()
    while plotter.picture.refine():
        pass
    assert plotter.picture.samples == 16
    assert renders.since() == (1 if change is nothing else 2)
    found = shot(plotter)
    np.testing.assert_array_equal(found, shown(plotter, monkeypatch)[0])


@pytest.mark.parametrize("parts", [1, 4])
def test_an_actor_in_two_renderers_has_the_samples_of_each(lines, parts, monkeypatch):
    monkeypatch.setattr(sample_layers, "MOST_TEXELS", 8 * SIZE[0] * SIZE[1] // parts)
    plotter = pv.Plotter(off_screen=True, window_size=SIZE, shape=(1, 2))
    actor = plotter.add_fiblets(lines, color="white", lighting=False)
    plotter.subplot(0, 1)
    plotter.add_actor(actor)
    plotter.camera_position = "xz"
    plotter.show(auto_close=False)

    def finished(singly):
        with monkeypatch.context() as patch:
            if singly:
                patch.setattr(Picture, "_lines_at_once", lambda *_: ([], []))
            for column in (0, 1):
                plotter.subplot(0, column)
                plotter.picture.antialias = "off"
                plotter.picture.antialias = "refined"
            plotter.render()
            renders = Renders(plotter)
            return shot(plotter), renders.since()

    (at_once, frames), (mean, _) = finished(False), finished(True)
    assert frames == 1
    assert np.sqrt((off_by(at_once, mean) ** 2.0).mean()) < 3.0
    plotter.close()


@pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
def test_a_window_that_is_gone_between_parts_is_left_alone(lines, monkeypatch):
    """Names of OpenGL's objects may be those of another window by then."""
    monkeypatch.setattr(sample_layers, "MOST_TEXELS", 16 * SIZE[0] * SIZE[1] // 4)
    with recording() as calls:
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        plotter.add_fiblets(lines)
        plotter.show(auto_close=False)
        plotter.picture.antialias = "off"
        plotter.picture.antialias = "refined"
        plotter.render()
        assert plotter.picture.refine()
        plotter.render_window.Finalize()
        calls.forget()
        plotter.close()
        del plotter
        gc.collect()
        assert not calls.counts


def test_progress_is_shown_after_a_while(scene, monkeypatch):
    plotter, _ = scene
    plotter.show(auto_close=False)
    told = []

    @contextmanager
    def bar(show, **how):
        told.append((show, how["total"]))
        yield SimpleNamespace(update=told.append)

    monkeypatch.setattr(idle_windows, "progress_bar", bar)
    monkeypatch.setattr(idle_windows, "PATIENCE", 600.0)
    shown(plotter, monkeypatch, singly=True)
    assert told == []
    monkeypatch.setattr(idle_windows, "PATIENCE", 0.0)
    shown(plotter, monkeypatch, singly=True)
    assert told[0][1] == 16
    assert sum(told[1:]) >= 15
    told.clear()
    shown(plotter, monkeypatch)
    assert sum(told[1:]) >= 8  # parts but the last
