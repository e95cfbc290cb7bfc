"""Properties of layers: what they accept, refuse, and say of themselves."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st

import pvfiblets
from pvfiblets.slices.image import as_slice_image
from pvfiblets.tubes.build import as_spline_tubes
from pvfiblets.volumes import RaycastVolume
from pvfiblets.web import layers
from pvfiblets.web.document import Ids


@pytest.fixture(scope="module")
def data(lines):
    """Something that each kind of layer draws."""
    mesh = pv.Sphere()
    mesh["height"] = mesh.points[:, 2]
    return {
        "tractogram": pvfiblets.compress(lines, per_point=["fa"]),
        "selection": pvfiblets.compress(lines[:5]),
        "tubes": as_spline_tubes([np.array([(0, 0, 0), (5, 1, 0), (10, 0, 0)], float)], radius=1.0),
        "volume": RaycastVolume(np.arange(64.0).reshape(4, 4, 4)),
        "mesh": mesh,
        "image": as_slice_image(np.arange(64.0).reshape(4, 4, 4)),
    }


EVERY = [(kind, prop) for kind, table in layers.TABLES.items() for prop in table]


@pytest.mark.parametrize(("kind", "prop"), EVERY, ids=[f"{kind}-{prop.name}" for kind, prop in EVERY])
def test_defaults_are_accepted_and_nonsense_is_not(kind, prop, data):
    if not prop.read_only:
        assert layers.check(kind, prop.name, prop.default, data[kind]) == prop.default
    for nonsense in ({"a": 1}, [[1]], "\x00", object(), math.nan, 10**400):
        with pytest.raises(ValueError, match=prop.name):
            layers.check(kind, prop.name, nonsense, data[kind])


@pytest.mark.parametrize("kind", layers.KINDS)
def test_names_are_unique_and_described(kind):
    names = [prop.name for prop in layers.TABLES[kind]]
    assert len(names) == len(set(names))
    assert all(prop.label and prop.help and prop.type in layers.TYPES for prop in layers.TABLES[kind])


@pytest.mark.parametrize(
    ("kind", "name", "value", "says"),
    [
        ("tractogram", "opacity", 1.5, "from 0 to 1"),
        ("tractogram", "opacity", True, "True"),
        ("tractogram", "opacity", "1", "'1'"),
        ("tractogram", "no_such", 1, "no_such"),
        ("tractogram", "promise", "0", "only be read"),
        ("tractogram", "scalars", "height", "'height'"),
        ("tractogram", "clim", [2.0, 1.0], "low end first"),
        ("tractogram", "clim", [0.0], "2 numbers"),
        ("tractogram", "color", "no colour", "'no colour'"),
        ("tractogram", "lighting", 1, "true or false"),
        ("tractogram", "tube_radius", 1e9, "from"),
        ("tractogram", "__class__", 1, "__class__"),
        ("volume", "mode", "fog", "isosurface"),
        ("volume", "values", list(range(20)), "1 to 8"),
        ("mesh", "scalars", 0, "0"),
    ],
)
def test_errors_name_value_and_remedy(kind, name, value, says, data):
    with pytest.raises(ValueError, match=says):
        layers.check(kind, name, value, data[kind])


def test_choices_follow_the_data(data, lines):
    def choices(kind, thing):
        (prop,) = (prop for prop in layers.TABLES[kind] if prop.name == "scalars")
        return {value for value, _ in prop.choices_for(thing)}

    assert {"orientation", None, "length", "fa", "weight", "group"} <= choices("tractogram", data["tractogram"])
    plain = pvfiblets.compress(pvfiblets.Streamlines(lines.points, lines.offsets))
    assert not {"fa", "weight", "group"} & choices("tractogram", plain)
    assert "height" in choices("mesh", data["mesh"])
    assert {"radius", "arc_length"} <= choices("tubes", data["tubes"])


def test_colours_are_kept_in_one_form(data):
    assert layers.check("mesh", "color", "red", data["mesh"]) == "#ff0000"
    assert layers.check("mesh", "color", "#FF0000", data["mesh"]) == "#ff0000"


def test_other_colours_have_their_own_range():
    settings = {**layers.defaults("tractogram"), "scalars": "length", "clim": [1.0, 2.0], "log_scale": True}
    other = layers.changed("tractogram", settings, "scalars", "fa")
    assert (other["clim"], other["log_scale"]) == (None, False)
    assert layers.changed("tractogram", settings, "scalars", "length")["clim"] == [1.0, 2.0]


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8)
    | st.sampled_from(["orientation", "length", "viridis", "red", "composite", "two-phase", "layers"]),
    lambda parts: st.lists(parts, max_size=3) | st.dictionaries(st.text(max_size=4), parts, max_size=2),
    max_leaves=6,
)  # fmt: skip


@given(st.sampled_from([(kind, prop.name) for kind, prop in EVERY]), json_values)
def test_whatever_is_sent_is_refused_or_plain(which, value):
    kind, name = which
    sphere = pv.Sphere(theta_resolution=4, phi_resolution=4)  # of this, choices and limits need bounds and arrays alone
    thing = {"mesh": sphere}.get(kind)
    if thing is None:
        thing = _thing(kind)
    try:
        found = layers.check(kind, name, value, thing)
    except ValueError as error:
        said = str(error)
    else:
        said = name
        assert json.loads(json.dumps(found, allow_nan=False)) == found
        assert layers.check(kind, name, found, thing) == found
    assert name in said
    assert len(said) < 2000


def _thing(kind, made={}):  # noqa: B006 - made once
    if not made:
        line = np.array([(0, 0, 0), (5, 1, 0), (10, 0, 0)], float)
        made["tractogram"] = made["selection"] = pvfiblets.compress(pvfiblets.Streamlines.from_list([line]))
        made["tubes"] = as_spline_tubes([line], radius=1.0)
        made["volume"] = RaycastVolume(np.arange(64.0).reshape(4, 4, 4))
        made["image"] = as_slice_image(np.arange(64.0).reshape(4, 4, 4))
    return made[kind]


@pytest.mark.parametrize(
    ("file", "kind"),
    [("lines.fiblets", "tractogram"), ("vessel.vtp", "tubes"), ("head.nii.gz", "volume"), ("ball.ply", "mesh")],
)
def test_actors_do_what_settings_say(scene, file, kind):
    """What is set reads back from the actor, and its description is JSON."""
    layer = scene.open(file)
    assert layer.kind == kind
    told = {
        "tractogram": {"scalars": "fa", "cmap": "plasma", "clim": [0.1, 0.5], "opacity": 0.5, "line_width": 3.0,
                       "tube_radius": 0.5, "culling": None, "illuminated": True, "halos": True, "lighting": False},
        "tubes": {"scalars": "radius", "cmap": "hot", "min_width": 2.0, "solver": "newton", "opacity": 0.25,
                  "clim": [0.5, 2.0]},
        "volume": {"mode": "mip", "cmap": "hot", "clim": [0.0, 0.5], "step": 0.25, "thresholds": [0.1, 0.9]},
        "mesh": {"opacity": 0.5, "color": "#00ff00", "specular": 0.5},
    }[kind]  # fmt: skip
    for name, value in told.items():
        scene.set(layer.id, name, value)
    described = {entry["name"]: entry for entry in scene.properties(layer.id)}
    json.dumps(list(described.values()), allow_nan=False)
    actor = scene.actor(layer.id)
    for name, value in told.items():
        assert described[name]["value"] == value
        if kind == "mesh":
            got = getattr(actor.prop, name)
            assert got == value if name != "color" else got.hex_rgb == value
        else:
            got = getattr(actor, name)
            got = list(got) if isinstance(got, tuple) else bool(got) if value is True else got
            assert got == pytest.approx(value) if isinstance(value, (float, list)) else got == value


def test_runs_of_ids_are_what_they_were_made_of():
    ids = np.array([5, 3, 4, 9, 11, 3, 12, 0])
    runs = Ids.of(ids)
    assert runs.array().tolist() == sorted(set(ids.tolist()))
    assert (len(runs), runs.highest) == (7, 12)
    assert runs == Ids.of([0, 3, 4, 5, 9, 11, 12])
    assert hash(runs) == hash(Ids(runs.runs))
    assert (len(Ids.of([])), Ids.of([]).highest, Ids.of([]).array().tolist()) == (0, -1, [])
    for bad in ([[3, 3]], [[5, 4]], [[0, 2], [1, 3]], [[-1, 2]], [[0, 2], [2, 3]]):
        with pytest.raises(ValueError, match="rising"):
            Ids(np.array(bad))
