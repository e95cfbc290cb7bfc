"""What a declaration says: checks and their words, what None means, headers of arguments, and what is refused."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.mappers.effects.resolve import assemble
from pvfiblets.plotting.fiblets.settings import FibletSettings
from pvfiblets.plotting.halos.settings import HaloLineSettings, HaloPointSettings
from pvfiblets.plotting.settings.places import PROPERTY
from pvfiblets.plotting.settings.settings import Argument, Given, NoSetting, Setting, Settings, arguments
from pvfiblets.plotting.tubes.settings import TubeSettings
from pvfiblets.plotting.volumes.settings import VolumeSettings

ALL = [FibletSettings, TubeSettings, HaloLineSettings, HaloPointSettings, VolumeSettings]


class Lamp(Settings):
    """A thing with settings."""

    power = Setting(1.0, "How bright.", kind="float", low=0.0, high=10.0, unit="watts", where=PROPERTY)
    depth = Setting(0.0, "How deep.", kind="float", low=0.0, where=PROPERTY)
    colour = Setting("red", "Its colour.", kind="str", choices=("red", "blue"), where=PROPERTY)
    hidden = Setting(0.0, "Set later.", kind="float", argument=False, where=PROPERTY)
    label = Argument(None, "A name.", kind="str | None")
    heat = NoSetting("a lamp has no {name}: it is cold")

    def __init__(self):
        self.prop = SimpleNamespace(power=1.0)


@pytest.mark.parametrize("good", [0, 10.0, 2.5, np.float32(3), np.array(4)])
def test_numbers_in_their_range_are_kept_as_floats(good):
    lamp = Lamp()
    lamp.power = good
    assert (lamp.power, type(lamp.power)) == (float(good), float)


@pytest.mark.parametrize("bad", [-0.1, 10.1, math.nan, "2", None, [1.0], 1j])
def test_other_values_are_refused_and_change_nothing(bad):
    lamp = Lamp()
    with pytest.raises(ValueError, match=r"^power is .*; give watts from 0 to 10$"):
        lamp.power = bad
    with pytest.raises(ValueError, match="^power is "):
        Given(Lamp, {"power": bad})
    assert lamp.power == 1.0
    with pytest.raises(ValueError, match="depth is -1; give a number, 0 or more"):
        lamp.depth = -1


def test_what_is_not_given_has_its_default_and_none_is_what_others_say():
    assert Given(Lamp) == {"power": 1.0, "depth": 0.0, "colour": "red", "label": None}
    assert Given(Lamp, {"power": 2, "label": None, "other": 3})["power"] == 2.0
    assert Given(FibletSettings, {"lighting": None})["lighting"] is None  # its kind says that it may be
    assert Given(Lamp).at(PROPERTY) == {"power": 1.0, "depth": 0.0, "colour": "red"}


def test_an_argument_is_no_property_and_a_later_setting_no_argument():
    assert list(arguments(Lamp)) == ["power", "depth", "colour", "label"]
    assert not hasattr(Lamp(), "label")
    with pytest.raises(AttributeError, match="a lamp has no heat: it is cold"):
        Lamp().heat = 1


def test_headers_and_docs_say_type_default_and_choices():
    told = {name: one.header for name, one in arguments(Lamp).items()}
    assert told == {
        "power": "float, default: 1.0", "depth": "float, default: 0.0",
        "colour": '{"red", "blue"}, default: "red"', "label": "str, optional",
    }  # fmt: skip
    assert Lamp.colour.__doc__ == "Its colour.\n\n``'red'`` or ``'blue'``."
    with pytest.raises(AttributeError, match="a setting has no colour"):
        Lamp.power.but(colour=1)


@pytest.mark.parametrize("settings", ALL, ids=lambda settings: settings.__name__)
def test_every_setting_is_described_and_has_a_default_of_its_own_kind(settings):
    for name, one in settings.DECLARED.items():
        assert one.name == name
        assert one.argument_doc.rstrip().endswith(".")
        if one.choices:
            assert one.default in one.choices
        if isinstance(one, Setting) and one.is_argument and one.default is not None:
            assert one.check(one.default) == one.default


def test_a_piece_of_the_resolve_that_has_no_file_is_refused():
    with pytest.raises(ValueError, match="unknown resolve features \\['no_such_piece'\\]"):
        assemble(frozenset({"gbuffer", "no_such_piece"}))
