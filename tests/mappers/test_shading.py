"""Shading and selections through VTK: effects in the picture, and what they leave behind."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from pvfiblets.mappers import Colouring
from pvfiblets.mappers.effects.highlight import Highlight
from pvfiblets.mappers.effects.shading import AmbientOcclusion, DepthCue, Halos, Illuminated, Ink, Silhouette
from pvfiblets.mappers.frames import windows

ALL = {
    "illuminated": Illuminated(),
    "ambient_occlusion": AmbientOcclusion(radius=15.0),
    "ink": Ink((0.2, 0.3, 0.4)),
    "depth_cue": DepthCue(),
    "halos": Halos(width=2.0, depth=5.0),
}
DISTANCE = 200.0


# Scenes


def rods(tools, *ends):
    """Streamlines from pairs of ends."""
    lines = [np.linspace(a, b, 60) for a, b in ends]
    return type(tools.helices(1, 2)).from_list(lines)


@pytest.fixture
def scene(make_plotter, make_fibres, tools):
    """Return a function that draws rods from -y with effects and returns the plotter, picture and mapper."""

    def run(ends, effects, *, color=(1.0, 1.0, 0.0), parallel=True, prepare=None, lighting=False, **options):
        fibres = make_fibres(rods(tools, *ends))
        mapper, actor = fibres.actor(lighting=lighting, colouring=Colouring("solid", color=color))
        mapper.detail = 0.5  # rods lie between two rows of pixels, where a thousandth of a pixel would decide
        for name, effect in effects.items():
            mapper.set_effect(name, effect)
        plotter = make_plotter(**{"window_size": (120, 100)} | options)
        plotter.add_actor(actor, reset_camera=False)
        plotter.camera_position = [(0, -DISTANCE, 0), (0, 0, 0), (0, 0, 1)]
        if parallel:
            plotter.enable_parallel_projection()
            plotter.camera.parallel_scale = 25.0  # 2 pixels per mm
        if prepare:
            prepare(plotter, actor)
        plotter.renderer.ResetCameraClippingRange()
        return plotter, tools.picture(plotter, mapper), mapper

    return run


CROSS = (((-20, 0, 0), (20, 0, 0)), ((0, 6, -20), (0, 6, 20)))  # the upright one 6 mm behind


def is_color(image, *color):
    return (np.abs(image.astype(int) - color) <= 1).all(axis=-1)


@pytest.mark.parametrize("parallel", [True, False])
def test_halos_show_and_cut_what_is_behind(scene, parallel):
    _, image, _ = scene(CROSS, {"halos": Halos(width=3.0, depth=4.0, color=(1, 0, 0))}, parallel=parallel)
    red, yellow = is_color(image, 255, 0, 0), is_color(image, 255, 255, 0)
    assert (red | yellow | is_color(image, 0, 0, 0)).all()
    rows = np.flatnonzero(yellow[:, 50])
    assert len(rows) == 1
    wide = 6 if parallel else 3.0 * 100 / (2 * np.tan(np.radians(15)) * DISTANCE)
    above = np.flatnonzero(red[:, 50])
    assert len(above) == 2 * int(wide)
    crossing = np.flatnonzero(yellow.sum(axis=0) > 10)  # the column of the upright one
    column = int(crossing[np.argmin(np.abs(crossing - 60))])
    cut = ~yellow[:, column]
    assert cut[rows[0] - int(wide) : rows[0]].all()
    assert yellow[rows[0], column]
    assert not cut[rows[0] - int(wide) - 2]


@pytest.mark.parametrize("wall", [40.0, 6.0])
def test_a_halo_is_as_deep_in_the_scene_as_it_says(scene, wall):
    """Before a wall that makes the far plane, beyond which nothing can lie, and cut off by one that is nearer."""

    def prepare(plotter, _):
        box = pv.Box((-30, 30, wall, wall + 1, -30, 30))
        plotter.add_mesh(box, color="blue", lighting=False, reset_camera=False)

    plotter, image, _ = scene(CROSS[:1], {"halos": Halos(width=5.0, depth=12.0)}, prepare=prepare)
    depth, column = -plotter.get_image_depth(fill_value=np.nan), image[:, 60]
    row, away = int(np.flatnonzero(is_color(column, 255, 255, 0))[0]), np.arange(-9, 10)
    assert np.allclose(depth[row + away, 60], DISTANCE + np.minimum(1.2 * np.abs(away), wall), atol=0.05)
    assert is_color(column[row - 4 : row], 255, 255, 255).all()
    assert is_color(column[row - 9 : row - 5], *((0, 0, 255) if wall == 6.0 else (255, 255, 255))).all()


def test_halos_without_a_colour_are_the_background(scene):
    def shade(plotter, _):
        plotter.set_background("red", top="blue")

    _, image, _ = scene(CROSS, {"halos": Halos(width=3.0, depth=4.0, color=None)}, prepare=shade)
    plain = image[:, 2]
    assert not is_color(plain, *plain[0]).all()
    inside = ~is_color(image, 255, 255, 0)
    assert np.abs(image.astype(int) - plain[:, None])[inside].max() <= 2


def test_halos_reach_beyond_the_bounds_of_the_data(scene):
    flat = (((-20, 0, 0), (20, 0, 0)),)
    _, image, _ = scene(flat, {"halos": Halos(width=10.0, depth=4.0)})
    assert is_color(image, 255, 255, 255)[:, 60].sum() == 40
    _, image, _ = scene(flat, {"halos": Halos(width=20.0, depth=4.0)})
    assert is_color(image, 255, 255, 255)[:, 60].sum() == 48  # 24 pixels are the most


def test_halos_are_as_translucent_as_their_actor_and_never_inked(scene):
    halos = Halos(width=3.0, depth=4.0)
    _, image, _ = scene(CROSS, {"halos": halos}, prepare=lambda _, actor: actor.GetProperty().SetOpacity(0.5))
    assert is_color(image, 128, 128, 0).any()
    assert is_color(image, 128, 128, 128).any()
    _, image, _ = scene(CROSS, {"ink": Ink((0, 0, 1)), "halos": halos}, lighting=True)
    seen = {tuple(map(int, color)) for color in np.unique(image.reshape(-1, 3), axis=0)}
    assert seen == {(0, 0, 0), (0, 0, 255), (255, 255, 255)}


STAIRS = tuple(((-20, y, z), (20, y, z)) for y, z in ((-10, -8), (0, 0), (15, 8)))


@pytest.mark.parametrize("parallel", [True, False])
def test_depth_cueing_is_linear_in_the_distance(scene, parallel):
    _, image, _ = scene(STAIRS, {"cue": DepthCue(0.8, (1, 0, 1), (185, 220))}, parallel=parallel, color=(1, 1, 0))
    for y, row in zip((-10, 0, 15), np.flatnonzero(image[:, 60].any(axis=-1))[::-1], strict=True):
        share = 0.8 * (DISTANCE + y - 185) / 35
        assert np.allclose(image[row, 60], 255 * np.array([1, 1 - share, share]), atol=2)


def test_depth_cueing_by_default_goes_over_the_data_to_the_background(scene):
    _, image, _ = scene(STAIRS, {"cue": DepthCue(1.0)}, prepare=lambda plotter, _: plotter.set_background("blue"))
    rows = np.flatnonzero(~is_color(image, 0, 0, 255)[:, 60])
    shares = (10 / 25, 0.0)  # the farthest has become the background
    for share, row in zip(shares, rows, strict=True):
        assert np.allclose(image[row, 60], 255 * np.array([1 - share, 1 - share, share]), atol=2)


def test_a_camera_in_the_data_has_no_depth_behind_it(scene):
    def inside(plotter, _):
        plotter.camera_position = [(0, 5, 4), (0, 20, 4), (0, 0, 1)]

    _, image, _ = scene(STAIRS, {"cue": DepthCue(), "halos": Halos(), "ao": AmbientOcclusion()}, prepare=inside)
    assert np.isfinite(image).all()


def test_occlusion_darkens_lines_behind_a_bundle_and_nothing_else(scene):
    wall = [((-20, 4, z / 2), (20, 4, z / 2)) for z in range(-30, 31)]
    bar = [((x / 4, 0, -15), (x / 4, 0, 15)) for x in range(-8, 9)]
    _, plain, _ = scene([*wall, *bar], {}, color=(1, 1, 1))
    _, image, _ = scene([*wall, *bar], {"ao": AmbientOcclusion(radius=8.0)}, color=(1, 1, 1))
    assert np.array_equal(plain.any(axis=-1), image.any(axis=-1))
    strip, shown = image[35:65, :, 0], plain[35:65, :, 0] > 0
    brightness = {x: strip[:, x][shown[:, x]].mean() for x in (60, 67, 71, 75, 95)}
    assert brightness[60] > 250
    assert brightness[67] < 225
    assert brightness[67] < brightness[71] < brightness[75] <= brightness[95]
    assert brightness[95] == 255


def test_a_silhouette_goes_around_what_is_chosen(scene):
    chosen = np.array([True, False])
    _, image, _ = scene(CROSS, {"outline": Silhouette(chosen, (0, 1, 1), 2.0)})
    cyan, yellow = is_color(image, 0, 255, 255), is_color(image, 255, 255, 0)
    row = int(np.flatnonzero(yellow[:, 30])[0])
    assert cyan[[row - 2, row - 1, row + 1, row + 2], 30].all()
    assert cyan[:, 30].sum() == 4
    with pytest.raises(ValueError, match="3 values for 2 streamlines"):
        scene(CROSS, {"outline": Silhouette(np.zeros(3, bool))})
    # The other line is drawn over where it passes near, and stays elsewhere.
    column = int(np.flatnonzero(yellow[row + 10])[0])
    assert cyan[[row - 2, row + 2], column].all()
    assert not cyan[row + 10].any()


@pytest.mark.parametrize("name", ALL)
def test_what_is_taken_away_leaves_nothing(make_plotter, lines, tools, name):
    mapper, actor = lines.actor(lighting=True)
    plotter = make_plotter()
    plotter.add_actor(actor)
    before, shaders = tools.picture(plotter, mapper), mapper.features
    bare = actor.GetShaderProperty().GetNumberOfShaderReplacements()
    mapper.set_effect(name, ALL[name])
    with_it = tools.picture(plotter, mapper)
    assert not np.array_equal(before, with_it)
    slot = windows.contexts_with(mapper)[0].slot(mapper)
    assert name in slot.effects
    mapper.set_effect(name, None)
    assert np.array_equal(tools.picture(plotter, mapper), before)
    assert mapper.features == shaders
    assert actor.GetShaderProperty().GetNumberOfShaderReplacements() == bare
    assert not slot.effects


# Values


@pytest.mark.parametrize(
    ("make", "message"),
    [(lambda: AmbientOcclusion(radius=0.0), "radius of ambient occlusion is 0.0"),
     (lambda: AmbientOcclusion(radius=np.nan), "radius of ambient occlusion is nan"),
     (lambda: AmbientOcclusion(samples=0), "samples of ambient occlusion is 0"),
     (lambda: AmbientOcclusion(samples=2.5), "samples of ambient occlusion is 2.5"),
     (lambda: AmbientOcclusion(strength=1.5), "strength of ambient occlusion is 1.5"),
     (lambda: DepthCue(strength=-1), "strength of depth cueing is -1"),
     (lambda: DepthCue(range=(5, 5)), r"range of depth cueing is \(5, 5\)"),
     (lambda: DepthCue(color=(1, 2, 3)), "color of depth cueing"), (lambda: Halos(width=-1), "width of halos is -1"),
     (lambda: Halos(depth=np.inf), "depth of halos is inf"), (lambda: Halos(color=(1, 1)), "color of halos"),
     (lambda: Ink((np.nan, 0, 0)), "color of ink"),
     (lambda: Silhouette(np.zeros(3)), "selected of a silhouette is float64"),
     (lambda: Silhouette([True], width=17), "width of a silhouette is 17")],
)  # fmt: skip
def test_values_that_cannot_be_drawn_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.fixture
def many_rods(make_plotter, make_fibres, tools):
    """Return rods along x at 40 heights, in red, seen from -y, and a function: colours of each in the picture."""
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


def test_others_fade_towards_the_background_and_the_chosen_keep_their_colour(many_rods):
    plotter, mapper, colours = many_rods
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


def test_colours_can_be_given_and_another_selection_changes_bits_alone(many_rods):
    _, mapper, colours = many_rods
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
    from pvfiblets.mappers.frames.windows import contexts_with

    return [context.slots[mapper.GetAddressAsString("")] for context in contexts_with(mapper)]


def test_more_streamlines_than_a_row_of_the_texture_holds(make_plotter):
    from pvfiblets.mappers.effects.highlight import _Bits
    from pvfiblets.mappers.frames.windows import borrowed_context

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
