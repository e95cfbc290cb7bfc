"""The formulas of the docs are such as browsers lay out without the network."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
FENCED = re.compile(r"^(```|~~~).*?^\1", re.DOTALL | re.MULTILINE)
DISPLAYED = re.compile(r"\$\$(.+?)\$\$", re.DOTALL)
INLINE = re.compile(r"(?<![\\$`])\$([^$\n]+?)\$")
NAMESPACE = "{http://www.w3.org/1998/Math/MathML}"


def _mathml():
    spec = importlib.util.spec_from_file_location("docs_mathml", DOCS / "mathml.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


mathml = _mathml()


def formulas(page: Path) -> list[tuple[str, bool]]:
    """Return (TeX, whether it has a line of its own) of all formulas of a page."""
    text = re.sub(r"`[^`\n]*`", "", FENCED.sub("", page.read_text()))
    displayed = [(tex, True) for tex in DISPLAYED.findall(text)]
    return displayed + [(tex, False) for tex in INLINE.findall(DISPLAYED.sub("", text))]


PAGES = sorted(page for page in (DOCS / "explanation").glob("*.md") if formulas(page))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_formula_of_a_page_becomes_mathml_with_no_tex_left_in_it(page):
    for tex, display in formulas(page):
        root = ET.fromstring(mathml.formula(tex, display=display))
        assert root.tag == NAMESPACE + "math", tex
        left = [part for part in root.itertext() if "\\" in part or "$" in part]
        assert not left, f"{tex}: {left} is no MathML"


def test_bold_letters_are_bold_by_style_since_browsers_know_no_other_way():
    assert 'style="font-weight: bold">P</mi>' in mathml.formula(r"\mathbf P", display=False)
    assert 'mathvariant="bold"' not in mathml.formula(r"\mathbf{P}_i + \mathbf X", display=True)


def test_the_four_papers_have_their_pages():
    assert {"fiblets", "tubes", "halos", "volumes"} <= {page.stem for page in PAGES}
