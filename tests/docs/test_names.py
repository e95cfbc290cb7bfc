"""Options of commands, and members of plotters and actors, that pages name in code are there."""

import re
from pathlib import Path

import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.cli.command import make_parser
from pvfiblets.plotting.fiblets.actor import FibletActor
from pvfiblets.plotting.halos.actors import HaloLineActor, HaloPointActor
from pvfiblets.plotting.slices.layer import SliceLayer
from pvfiblets.plotting.tubes.actor import TubeActor
from pvfiblets.plotting.volumes.actor import VolumeActor

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *DOCS.glob("explanation/*.md"), *DOCS.glob("reference/*.md")])
ACTORS = (FibletActor, HaloLineActor, HaloPointActor, TubeActor, VolumeActor, SliceLayer)
COMPONENTS = ("fiblets", "spline_tubes", "halo_lines", "halo_points", "raycast_volumes", "slices", "connectomes",
              "picture")  # fmt: skip
OF_OTHERS = re.compile(r"\b(?:pip|dask|card\.sh|configurable-http-proxy)\b|actor\.line\(lod")


def options(parser):
    """Yield all options of a parser and of its commands."""
    for action in parser._actions:
        yield from action.option_strings
        for command in action.choices.values() if isinstance(action.choices, dict) else ():
            yield from options(command)


def code(page):
    """Return the pieces of code on a page that are of this program."""
    text = page.read_text(encoding="utf-8")
    pieces = re.findall(r"`([^`\n]+)`", text) + re.findall(r"^```\w+\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    return [piece for piece in pieces if not OF_OTHERS.search(piece)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_names_in_code_is_there(page):
    known = set(options(make_parser()))
    plotter = pv.Plotter(off_screen=True)
    for piece in code(page):
        assert set(re.findall(r"(?<![\w-])--[a-z][\w-]*", piece)) <= known, piece
        for name in re.findall(r"\bactor\.([a-z_]\w*)", piece):
            assert any(hasattr(actor, name) for actor in ACTORS), piece
        for name in re.findall(r"\bpvfiblets\.([A-Z]\w*)", piece):
            assert hasattr(pvfiblets, name), piece
        for name in re.findall(r"\bplotter\.([a-z_]\w*)", piece):
            assert hasattr(plotter, name), piece
        for component, name in re.findall(rf"\bplotter\.({'|'.join(COMPONENTS)})\.([a-z_]\w*)", piece):
            assert hasattr(getattr(plotter, component), name), piece
    plotter.close()
