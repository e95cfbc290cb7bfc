"""How Sphinx builds the site: ``make docs``, without warnings and without the network."""

from __future__ import annotations

import os
import shutil
import sys
from argparse import ArgumentParser
from pathlib import Path

import pyvista
from docutils.nodes import document
from sphinx.application import Sphinx

import pvfiblets
from pvfiblets.cli.command import make_parser

# The gallery's examples run here, one after the other, and draw off screen.
os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
pyvista.OFF_SCREEN = True

project = "pvfiblets"
author = "the pvfiblets maintainers"
copyright = "the pvfiblets maintainers"  # noqa: A001 - Sphinx's name
release = version = pvfiblets.__version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.viewcode",
    "sphinx_gallery.gen_gallery",
    "mathml",
]
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath"]
myst_update_mathjax = False
myst_heading_anchors = 4
exclude_patterns = ["_build", "gallery/*.ipynb", "gallery/*.py", "gallery/*.py.md5", "gallery/*.zip"]
default_role = "py:obj"
toc_object_entries_show_parents = "hide"
autodoc_member_order = "bysource"
# What mappers, components and windows call, and users do not.
INTERNAL = """COMMON, SetProperty, arrange, changed, enter, entered, follow, leave, picking_layers, postpone, put,
raise_pending, removed_by, sampled_once, show_glyphs_on, show_glyphs_on_plane, take, take_table, watch"""
autodoc_default_options = {"exclude-members": INTERNAL}
autodoc_typehints = "none"  # numpydoc's sections say them in words
numpydoc_show_class_members = False

html_title = project  # the bar at the top has no room for more on a telephone
html_theme = "pydata_sphinx_theme"
html_theme_options = {
    "show_prev_next": False,
    "secondary_sidebar_items": ["page-toc"],
    "show_toc_level": 2,
    "header_links_before_dropdown": 6,
}
html_sidebars = {page: [] for page in ("tutorial", "contributing")}  # single pages, with none beside them
html_context = {"default_mode": "auto"}  # the browser's light or dark
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False


HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from gallery_pictures import Pictures  # noqa: E402 - of this folder

# Examples write into the folder that they lie in, so that copies of them run.
COPIES = HERE / "_build" / "examples"
shutil.rmtree(COPIES, ignore_errors=True)
shutil.copytree(HERE.parent / "examples", COPIES, ignore=shutil.ignore_patterns("__pycache__"))


def commands() -> str:
    """Return what ``pvfiblets --help`` says of each command, as a page."""
    return "\n".join(told(make_parser(), 2))


def told(parser: ArgumentParser, depth: int) -> list[str]:
    """Return the help of each command of a parser, and of theirs."""
    parts = []
    for action in parser._actions:  # noqa: SLF001
        if isinstance(action.choices, dict):
            for choice in action.choices.values():
                parts.append(f"{'#' * depth} {choice.prog}\n\n```text\n{choice.format_help()}```\n")
                parts += told(choice, depth + 1)
    return parts


os.environ["COLUMNS"] = "80"  # as many as the page is wide
(HERE / "_build" / "commands.md").write_text(commands())

sphinx_gallery_conf = {
    "examples_dirs": str(COPIES),
    "gallery_dirs": "gallery",
    "filename_pattern": r"/\d\d_",
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": (Pictures(),),
    "reset_modules": (),
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "write_computation_times": False,  # that page asks for scripts on the network
    "default_thumb_file": str(HERE / "brain.jpg"),  # of examples that draw nothing
    "abort_on_example_error": True,
    "remove_config_comments": True,
    "min_reported_time": 0,
    "capture_repr": (),  # an image array that ends a script is no output
}


def hide_tables(app: Sphinx, _doctree: document) -> None:
    """Keep the tables of records out of the search: their many words would come before the pages that explain them."""
    name = app.env.docname
    if name.startswith("benchmarks/") and name not in ("benchmarks/README", "benchmarks/details"):
        app.env.metadata[name]["nosearch"] = ""


def setup(app: Sphinx) -> None:
    """Let Sphinx call the function above."""
    app.connect("doctree-read", hide_tables)
