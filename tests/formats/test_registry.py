"""Suffixes, the table of formats, and what every format has in common."""

from __future__ import annotations

import sys
import types

import pytest

from pvfiblets import formats
from pvfiblets.formats import registry

from .samples import corpus, rich


def test_longest_suffix_wins_in_any_case():
    assert registry.suffix_of("/a.b/X.TRK.GZ") == ".trk.gz"
    assert registry.suffix_of("x.trk") == ".trk"


def test_unknown_suffix_lists_the_known():
    with pytest.raises(formats.UnknownFormatError, match=r"a\.nii.*\.tck, .*\.trx"):
        formats.read("a.nii")
    with pytest.raises(formats.UnknownFormatError, match=r"\.gz"):
        formats.read("tck.gz")


def test_a_format_registered_from_outside(monkeypatch):
    module = types.ModuleType("outside_format")
    module.read = lambda path, *, progress: rich()
    monkeypatch.setitem(sys.modules, "outside_format", module)
    monkeypatch.setattr(registry, "_MODULES", dict(registry._MODULES))
    registry.register(".outside", "outside_format")
    assert len(formats.read("a.outside")) == 6
    with pytest.raises(formats.UnknownFormatError, match=r"\.outside has no write.*\.trx"):
        formats.write("a.outside", rich())
    with pytest.raises(ValueError, match="begin with a dot"):
        registry.register("outside", "outside_format")


def test_missing_file_is_the_systems_error(tmp_path):
    for suffix in registry.suffixes():
        with pytest.raises(FileNotFoundError):
            formats.read(tmp_path / f"none{suffix}")


def test_every_format_tells_its_facts(tmp_path):
    for path in corpus(tmp_path).values():
        facts = formats.info(path)
        s = formats.read(path)
        assert facts["format"] == registry.suffix_of(path)
        assert facts["streamlines"] == len(s)
        assert facts["points"] in (None, s.n_points)
        assert facts.get("per_point", []) == list(s.per_point)
        assert facts.get("per_streamline", []) == list(s.per_streamline)


def test_pieces_need_a_size():
    with pytest.raises(ValueError, match="max_points is 0"):
        list(formats.iter_chunks("a.tck", 0))


def test_unknown_folder_is_an_error_and_leaves_nothing(tmp_path):
    for suffix in (".tck", ".trk", ".trx", ".vtk", ".vtp"):
        with pytest.raises(FileNotFoundError):
            formats.write(tmp_path / "none" / f"a{suffix}", rich())
