"""Examples are such as the gallery can run."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("[0-9]*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_an_example_asks_for_nothing_that_the_gallery_does_not_give(example):
    names = {node.id for node in ast.walk(ast.parse(example.read_text())) if isinstance(node, ast.Name)}
    assert "__file__" not in names, "sphinx-gallery defines no __file__: take sys.argv[0]"


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_an_example_begins_with_a_title_and_says_how_to_run_it(example):
    title, line, *rest = (ast.get_docstring(ast.parse(example.read_text())) or "\n").splitlines()
    assert set(line) == {"="}
    assert len(line) == len(title)
    assert f"python examples/{example.name}" in " ".join(rest)
