"""Arguments of add_mesh that are the property's are told where they belong, and VTK's light follows them."""

from __future__ import annotations

import numpy as np
import pytest

ADDS = ("add_fiblets", "add_spline_tubes", "add_halo_lines")
LIGHT = {"ambient": 0.5, "diffuse": 0.3, "specular": 1.0, "interpolation": "pbr", "metallic": 0.9, "roughness": 0.1}


@pytest.mark.parametrize("add", ADDS)
def test_light_is_told_to_be_the_propertys(plotter, three_lines, add):
    for name in ("specular", "ambient", "diffuse", "metallic", "roughness", "specular_power"):
        with pytest.raises(TypeError, match=rf"{add}\(\) takes no {name}: .*actor\.prop\.{name} = "):
            getattr(plotter, add)(three_lines, **{name: 0.5})
    with pytest.raises(TypeError, match="prop.interpolation = 'pbr'"):
        getattr(plotter, add)(three_lines, pbr=True)
    with pytest.raises(TypeError, match="smooth as they are"):
        getattr(plotter, add)(three_lines, smooth_shading=True)
    with pytest.raises(TypeError, match="unexpected keyword argument 'spekular'"):
        getattr(plotter, add)(three_lines, spekular=1.0)


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes"])
def test_light_of_the_property_is_drawn(plotter, three_lines, add):
    looks = {"radius": 3.0} if add == "add_spline_tubes" else {"line_width": 6, "lighting": True}
    actor = getattr(plotter, add)(three_lines, color="red", **looks)
    before = plotter.screenshot()
    for name, value in LIGHT.items():
        setattr(actor.prop, name, value)
        plotter.render()
        after = plotter.screenshot()
        assert np.abs(after.astype(int) - before).max() > 20, name
        before = after


@pytest.mark.parametrize("add", ADDS)
def test_nothing_to_draw_is_told(plotter, add):
    with pytest.warns(UserWarning, match="nothing is drawn"):
        getattr(plotter, add)([])


def test_tables_for_pandas_and_arrow(three_lines):
    table = three_lines.table()
    frame = pytest.importorskip("pandas").DataFrame(table)
    assert table.to_pandas().equals(frame)
    pytest.importorskip("pyarrow")
    assert table.to_arrow().column_names == list(table)
    np.testing.assert_array_equal(table.to_arrow()["weight"], three_lines.per_streamline["weight"])


def test_the_colour_cycler_colours_tubes(plotter, three_lines):
    plotter.set_color_cycler(["red", "lime", "blue"])
    found = [plotter.add_spline_tubes(three_lines).prop.color.name for _ in range(2)]
    assert found == ["red", "lime"]
    assert plotter.add_spline_tubes(three_lines, color="white").prop.color.name == "white"


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
def test_the_colour_of_highlights_leaves_lines_theirs(plotter, add):
    """VTK's ``GetColor`` mixes the two once a property has highlights."""
    line = np.linspace([0.0, 0.0, 0.0], [9.0, 5.0, 1.0], 20)
    actor = getattr(plotter, add)(line, color="red")
    actor.prop.specular_color = "blue"
    actor.prop.specular = 1.0
    assert actor.color == "red"
    actor.prop.color = "green"
    assert actor.color == "green"


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize(("name", "value"), [("style", "wireframe"), ("show_edges", True), ("culling", "front")])
def test_facets_are_none_of_lines(plotter, add, name, value):
    actor = getattr(plotter, add)(np.linspace([0.0, 0.0, 0.0], [9.0, 5.0, 1.0], 20))
    with pytest.warns(UserWarning, match=rf"prop\.{name} changes nothing here: what is drawn has no facets"):
        setattr(actor.prop, name, value)
