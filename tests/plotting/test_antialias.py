"""Pictures at rest are the mean of many samples a pixel: of what, when, and what stays exact."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray

from pvfiblets.antialias import VARIABLE
from pvfiblets.engine.effects.sample_positions import sample_positions
from pvfiblets.engine.fiblets.pipelines import compute
from pvfiblets.mappers.frames.shifted_cameras import shifted
from tests.gl_calls import possible, recording

from .refined_scene import SIZE, Renders, drawn, fill, grabbed, ours, real_default, shot  # noqa: F401 - a fixture


@pytest.fixture
def scene():
    with drawn() as plotter:
        yield plotter


def mean_of_pictures(plotter, n, *, renderer=None, size=SIZE, of=np.asarray, **how):
    """Draw the pictures apart, with a camera that is moved by hand, and let NumPy say their mean."""
    plotter.picture.antialias = "off"
    camera = (renderer or plotter.renderer).GetActiveCamera()
    total = 0.0
    for position in sample_positions(n):
        with shifted(camera, size, position):
            plotter.render_window.Render()
            total = total + of(shot(plotter, **how))
    plotter.render()
    return total / n


@pytest.mark.parametrize(("value", "n"), [("refined", 16), (3, 3), (8, 8)])
def test_the_picture_is_the_mean_of_pictures_drawn_apart(scene, value, n):
    scene.picture.antialias = value
    scene.render()
    found = shot(scene)
    assert scene.picture.samples == n
    if value == 8:  # transparent backgrounds have the mean of alpha
        clear = multiplied(shot(scene, transparent_background=True))
        wanted = mean_of_pictures(scene, 8, of=multiplied, transparent_background=True)
        assert np.abs(clear - wanted).max() <= 1.0
        assert len(np.unique(clear[..., 3])) > 4
    wanted = mean_of_pictures(scene, n)
    assert np.abs(found - wanted).max() <= 1.0
    plain = shot(scene)
    red = (plain[..., 0] > 0) & (plain[..., 1] == 0)
    assert set(np.unique(plain[red][:, 0])) == {255}
    assert len(np.unique(found[red][:, 0])) > n // 3  # VTK's own edges
    assert len(np.unique(found[..., 1])) >= n  # and the lines'


def test_it_is_the_default_of_still_pictures_with_something_of_ours(scene):
    assert scene.picture.antialias == "refined"
    scene.camera.Azimuth(1.0)
    renders = Renders(scene)
    scene.render()
    assert renders.since() == 1
    finished = shot(scene)
    assert renders.since() == 16
    assert scene.picture.samples == 16
    assert np.array_equal(shot(scene), finished)
    assert renders.since() == 0
    scene.render()  # VTK draws, as it was told
    assert np.array_equal(shot(scene), finished)
    assert renders.since() == 1
    buffers = {row["name"]: row["bytes"] for row in scene.picture.explain()["buffers"]}
    assert buffers.keys() == {"coverage", "refinement"}
    assert buffers["refinement"] == SIZE[0] * SIZE[1] * 16
    scene.picture.antialias = "off"
    scene.render()
    assert scene.picture.explain() == {"buffers": []}


def test_a_scene_of_other_things_only_is_left_alone(scene, plotter):
    plotter.add_mesh(pv.Cone(), color="red", lighting=False)
    plotter.show(auto_close=False)
    assert plotter.renderer.GetViewProps().GetNumberOfItems() == 1
    assert len(np.unique(shot(plotter)[..., 0])) == 2
    plotter.picture.antialias = 4  # unless it is asked for
    plotter.render()
    assert len(np.unique(shot(plotter)[..., 0])) == 5
    plotter.close()
    scene.remove_actor(ours(scene))  # the last of ours
    assert scene.picture._picture().refinement is None
    assert scene.renderer.GetViewProps().GetNumberOfItems() == 2
    fill(scene)
    assert scene.picture._picture().refinement is not None


@pytest.mark.more
def test_any_change_begins_anew(scene):
    renders = Renders(scene)
    changes = [
        lambda: scene.camera.Azimuth(2.0),
        lambda: setattr(ours(scene), "color", "lime"),
        lambda: setattr(ours(scene), "line_width", 3),
        lambda: setattr(ours(scene).prop, "opacity", 0.7),
        lambda: ours(scene).select([1]),
        lambda: ours(scene).criterion("length", (0.0, 63.0)),
        lambda: setattr(list(scene.renderer.actors.values())[1], "visibility", False),
        lambda: scene.add_mesh(pv.Cube(), color="white", render=False),
        lambda: scene.set_background("gray"),
        lambda: setattr(scene.picture, "gamma", 1.5),
        lambda: setattr(scene, "window_size", (130, 120)),
        lambda: scene.enable_parallel_projection(),
    ]
    before = shot(scene)
    for change in changes:
        renders.since()
        change()
        scene.render()
        renders.since()
        after = shot(scene)
        assert (renders.since(), scene.picture.samples) == (16, 16)
        assert not np.array_equal(before, after)
        before = after
    for change in (lambda: scene.add_light(pv.Light()), lambda: scene.enable_depth_peeling()):
        change()
        scene.render()
        renders.since()
        shot(scene)
        assert (renders.since(), scene.picture.samples) == (16, 16)


@pytest.mark.few(1)
@pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
@pytest.mark.parametrize("style", ["lines", "density", "translucent"])
def test_samples_do_not_wait_for_the_gpu(style, monkeypatch):
    """Samples of sums go by the range of their picture, too: they are parts of one."""
    monkeypatch.setattr(compute, "READ_LISTS", False)  # as on a card
    with recording() as calls, drawn() as scene:
        actor = ours(scene)
        if style == "translucent":
            actor.opacity = 0.5
        elif style == "density":
            actor.scalars = "density"
        scene.render()
        scene.render()
        range_shown = actor.lookup_table.scalar_range
        calls.forget()
        while scene.picture.refine():
            assert actor.lookup_table.scalar_range == range_shown
        assert calls.waits == []
        assert scene.picture.samples == 16


def test_what_is_not_drawn_yet_is_not_in_the_picture(scene):
    """PyVista's screenshot is of the last frame; samples of another scene must not be mixed with it."""
    scene.picture.refine()
    before = shot(scene)
    ours(scene).color = "lime"
    assert np.array_equal(shot(scene), before)
    assert not scene.picture.refine()


def test_a_limit_of_time_leaves_one_sample_at_least(scene):
    scene.picture.antialias_seconds = 0.0
    scene.render()
    renders = Renders(scene)
    shot(scene)
    assert renders.since() == 2  # the second, of the camera as it is, shows the mean
    assert scene.picture.samples == 1
    scene.picture.antialias_seconds = None
    scene.render()
    shot(scene)
    assert scene.picture.samples == 16


def test_picks_and_depths_are_exact_at_any_time(scene):
    def seen():
        data = vtkFloatArray()
        picked = [ours(scene).pick_at(x, y) for x in range(10, 140, 9) for y in range(10, 100, 4)]
        inside = ours(scene).pick_box((10, 10, 140, 100))
        scene.render_window.GetZbufferData(0, 0, SIZE[0] - 1, SIZE[1] - 1, data)
        return picked, inside, vtk_to_numpy(data).copy()

    def same(one, other):
        assert str(one[:2]) == str(other[:2])
        assert np.array_equal(one[2], other[2])

    scene.picture.antialias = "off"
    scene.render()
    plain = seen()
    assert any(one is not None for one in plain[0])
    scene.picture.antialias = 8
    scene.render()
    same(seen(), plain)
    for _ in range(3):
        scene.picture.refine()
    assert str(seen()[:2]) == str(plain[:2])
    shot(scene)
    same(seen(), plain)
    scene.picture.antialias = 3  # no sample is the pixel's middle
    scene.render()
    shot(scene)
    same(seen(), plain)


def test_subplots_are_refined_each_by_itself():
    plotter = pv.Plotter(off_screen=True, shape=(1, 2), border=False, window_size=(2 * SIZE[0], SIZE[1]))
    plotter.disable_anti_aliasing()
    for column in range(2):
        plotter.subplot(0, column)
        actor = fill(plotter)
        plotter.picture.antialias = 4
    plotter.show(auto_close=False)
    plotter.camera.Azimuth(7.0)
    plotter.render()
    assert plotter.picture.samples == 1
    plotter.subplot(0, 0)
    assert plotter.picture.samples == 4
    both = shot(plotter)
    one = mean_of_pictures(plotter, 4)
    assert np.abs(both - one)[:, : SIZE[0]].max() <= 1.0
    plotter.subplot(0, 1)
    other = mean_of_pictures(plotter, 4)
    assert np.abs(both - other)[:, SIZE[0] :].max() <= 1.0
    plotter.renderers[0].add_actor(actor)  # an actor in both goes with the last of them
    plotter.renderer.remove_actor(actor)
    assert len(plotter.fiblets) == 2
    plotter.renderers[0].remove_actor(actor)
    assert len(plotter.fiblets) == 1
    plotter.close()


@pytest.mark.more
def test_what_lies_over_the_picture_is_drawn_once(plotter):
    plotter.add_fiblets([[(-9, 0, 0), (0, 4, 0), (9, 9, 0)]], color="red", lighting=False)
    mesh = pv.Plane(i_size=10, j_size=10)
    mesh["height"] = mesh.points[:, 0]
    plotter.add_mesh(mesh, lighting=False, scalar_bar_args={"color": "white"})
    plotter.add_text("over", color="white", font_size=12)
    plotter.add_point_labels([(0.0, -9.0, 0.0)], ["label"], shape=None, text_color="white", always_visible=True)
    plotter.camera_position = "xy"
    plotter.camera.zoom(0.5)
    plotter.picture.antialias = "off"
    plotter.show(auto_close=False)
    before = shot(plotter)
    plotter.picture.antialias = "refined"
    plotter.render()
    shown = []
    while plotter.picture.refine():
        shown.append(grabbed(plotter))
    after = shot(plotter)
    assert len(shown) == 16  # the last is behind the mean: thin lines have their width in samples only
    over = np.ones(before.shape[:2], bool)
    over[40:160, 40:160] = False  # the plane and the line, and no text
    label = np.s_[150:200, 60:140]
    assert before[over].any()
    assert before[label].any()
    for picture in [*shown, after]:
        assert np.array_equal(picture[over], before[over])
        assert np.array_equal(picture[label], before[label])
    assert not np.array_equal(after, before)


@pytest.mark.few(2)
@pytest.mark.parametrize(
    "how", ["msaa", "ssaa", "peeling", "ssao", "edl", "background", "tone", "depth of field", "parallel"]
)
def test_with_everything_that_draws_otherwise(plotter, how, tmp_path):
    plotter.window_size = SIZE
    fill(plotter, **({"opacity": 0.5, "transparency": 2} if how == "peeling" else {}))
    plotter.picture.antialias = "off"
    {
        "msaa": lambda: plotter.enable_anti_aliasing("msaa", multi_samples=4),
        "ssaa": lambda: plotter.enable_anti_aliasing("ssaa"),
        "peeling": lambda: plotter.enable_depth_peeling(4),
        "ssao": lambda: plotter.enable_ssao(),
        "edl": lambda: plotter.enable_eye_dome_lighting(),
        "background": lambda: plotter.add_background_image(gradient(tmp_path)),
        "tone": lambda: setattr(plotter.picture, "tone", {"operator": "aces", "exposure": 2.0}),
        "depth of field": lambda: setattr(plotter.picture, "depth_of_field", {"focal_distance": 92.0}),
        "parallel": lambda: plotter.enable_parallel_projection(),
    }[how]()
    plotter.show(auto_close=False)
    wanted = mean_of_pictures(plotter, 5)
    plotter.picture.antialias = 5
    plotter.render()
    found = shot(plotter)
    assert plotter.picture.samples == 5
    # VTK's supersampling is no linear filter of its samples.
    assert np.abs(found - wanted).max() <= (12.0 if how == "ssaa" else 1.0)
    assert np.abs(found - wanted).mean() < 0.3


@pytest.mark.parametrize("added", [None, "outline", "edges", "points"])
def test_samples_do_without_vtks_own_where_all_others_are_surfaces(scene, added):
    window = scene.render_window
    window.SetMultiSamples(4)
    scene.picture.antialias = 16
    if added is not None:
        how = {"outline": {}, "edges": {"show_edges": True}, "points": {"style": "points"}}[added]
        ball = pv.Sphere(radius=4.0)
        scene.add_mesh(ball.outline() if added == "outline" else ball, reset_camera=False, **how)
    drawn = []
    scene.renderer.AddObserver("StartEvent", lambda *_: drawn.append(window.GetMultiSamples()))
    scene.camera.azimuth += 3.0
    scene.render()
    found = shot(scene)
    # The picture as it is; samples; the last of them, then the mean, with what lies over the picture.
    assert drawn[0] == 4
    assert drawn[1:16] == [4 if added else 0] * 15
    assert set(drawn[16:]) == {4}
    assert window.GetMultiSamples() == 4
    assert scene.picture.samples == 16
    wanted = mean_of_pictures(scene, 16)
    if added:
        assert np.abs(found - wanted).max() <= 1.0
        return
    window.SetMultiSamples(0)
    exact = mean_of_pictures(scene, 64)
    # Multisampled ones blur edges over two pixels.
    assert np.sqrt(((found - exact) ** 2).mean()) < min(2.0, np.sqrt(((wanted - exact) ** 2).mean()))


def gradient(folder):
    """Write a picture of slanted colours."""
    x, y = np.meshgrid(np.arange(60), np.arange(40))
    path = folder / "gradient.png"
    Image.fromarray(np.stack([4 * x, 5 * y, x + y], axis=-1).astype(np.uint8)).save(path)
    return str(path)


def multiplied(picture):
    """Return a picture whose colours are multiplied by its opacity, as means are."""
    share = picture[..., 3:] / 255.0
    return np.concatenate([share * picture[..., :3], picture[..., 3:]], axis=-1)


def test_frames_of_movies_and_pictures_that_shows_return_are_finished(scene, tmp_path):
    frames = []
    scene.mwriter = type(
        "Writer",
        (),
        {"append_data": lambda _, data: frames.append(np.asarray(data).astype(int)), "close": lambda _: None},
    )()
    for _ in range(2):
        scene.camera.Azimuth(3.0)
        scene.write_frame()
        assert scene.picture.samples == 16
        assert np.array_equal(shot(scene), frames[-1])
    assert not np.array_equal(*frames)
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.disable_anti_aliasing()
    plotter.set_background("black")
    fill(plotter)
    image = plotter.show(screenshot=str(tmp_path / "shown.png"), return_img=True)
    assert len(np.unique(image[..., 1])) > 10
    assert np.array_equal(pv.read(tmp_path / "shown.png").point_data.values()[0].shape, (SIZE[0] * SIZE[1], 3))


def test_other_values_are_refused_and_the_environment_names_another_default(plotter, monkeypatch):
    plotter.picture.antialias = 4
    for bad in ("on", 1, 0, 257, 3.5, True, None, "16"):
        with pytest.raises(ValueError, match="antialias is .*; give 'off', 'coverage', 'refined' or a number of"):
            plotter.picture.antialias = bad
    assert plotter.picture.antialias == 4
    with pytest.raises(ValueError, match="antialias_seconds is -1; give seconds, 0 or more"):
        plotter.picture.antialias_seconds = -1
    other = pv.Plotter(off_screen=True)
    for text, value in (("off", "off"), ("8", 8), ("coverage", "coverage")):
        monkeypatch.setenv(VARIABLE, text)
        assert other.picture.antialias == value
    monkeypatch.setenv(VARIABLE, "much")
    with pytest.raises(ValueError, match="PVFIBLETS_ANTIALIAS is 'much'; give"):
        other.add_fiblets([[(0, 0, 0), (1, 1, 1)]])
    other.close()


def test_passes_that_draw_into_no_textures_leave_edges_as_they_are(three_lines):
    """PyVista's blur: an effect that somebody asked for is an error there, smooth edges are not."""
    plotter = pv.Plotter(off_screen=True, window_size=(120, 120))
    plotter.add_fiblets(three_lines, color="black")
    sharp = plotter.screenshot()
    plotter.add_blurring()
    plotter.render()
    blurred = plotter.screenshot()
    assert 1 < len(np.unique(sharp)) < len(np.unique(blurred))
    assert (blurred[..., 0] < 255).sum() > (sharp[..., 0] < 255).sum()
    plotter.camera.azimuth += 20.0
    plotter.render()
    plotter.close()
