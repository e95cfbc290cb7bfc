"""Every command and every piece of Python on these pages runs, in their order, as a reader would run them."""

import ast
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from PIL import Image


def _pages():
    spec = importlib.util.spec_from_file_location("docs_pages", Path(__file__).with_name("pages.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


pages = _pages()


@pytest.mark.more
@pytest.mark.parametrize("page", pages.GIVEN)
def test_a_page_runs(page, tmp_path):
    script = tmp_path / "page.py"
    script.write_text(pages.program(page))
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "PYVISTA_OFF_SCREEN": "true",
        "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow",
        "MPLBACKEND": "Agg",
    }
    environment.pop("GALLIVM_PERF", None)  # in large pictures optimised shaders soon make up for their compilation
    command = [sys.executable, "-W", "error", str(script)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr
    named = set(re.findall(r'screenshot\("([^"]+)"', pages.program(page)))
    assert named <= {path.name for path in tmp_path.iterdir()}
    for name in pages.COLOURED.get(page, ()):
        with Image.open(tmp_path / name) as picture:
            lines = np.asarray(picture.convert("RGB"))[: picture.height * 4 // 5]  # without the scalar bar
        assert len(np.unique(lines.reshape(-1, 3), axis=0)) > 100, f"{name} of {page} has hardly any colours"


@pytest.mark.more
def test_every_page_with_something_to_run_is_run():
    assert pages.pages_with_blocks() == {*pages.GIVEN, *pages.RUN_ELSEWHERE}


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


EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("[0-9]*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_every_example_begins_with_a_title_and_asks_for_nothing_else(example):
    names = {node.id for node in ast.walk(ast.parse(example.read_text())) if isinstance(node, ast.Name)}
    assert "__file__" not in names, "sphinx-gallery defines no __file__: take sys.argv[0]"
    title, line, *rest = (ast.get_docstring(ast.parse(example.read_text())) or "\n").splitlines()
    assert set(line) == {"="}
    assert len(line) == len(title)
    assert f"python examples/{example.name}" in " ".join(rest)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_every_example_fits_on_a_screen(example):
    assert len(example.read_text().splitlines()) <= 39
