"""The prose check counts the turns that it names, in the texts that readers meet, and passes plain sentences."""

import runpy
import subprocess
from pathlib import Path

import pytest

PROSE = runpy.run_path(str(Path(__file__).resolve().parents[1] / "scripts" / "prose.py"))


def kinds(text):
    """Return the kinds of turns in a text."""
    return [kind for _, kind, _ in PROSE["turns"](text)]


@pytest.mark.parametrize(
    ("read_twice", "kind", "plain"),
    [
        ("Other names are answered with why.", "is told, is asked", "Unknown names raise a TypeError."),
        ("If none is left, the page says so.", "says so", "If none is left, the page shows a warning."),
        ("Return what is left.", "what is", "Return the remaining fiblets."),
        ("A bar for users; who wants none loads nothing.", "who", "Without a bar, tqdm is not imported."),
        ("No fiblet is culled of which one pixel shows.", "of which", "A culled fiblet has no visible pixel."),
        ("There is a port that nobody reads.", "nobody", "There is an unread port."),
        ("Others take as many bytes.", "as many", "Others take the same number of bytes."),
        ("Return those that differ.", "those that", "Return the differing names."),
        ("All pass. Of these, two are slow.", "of these", "All pass. Two are slow."),
        ("The picture holds nothing but lines.", "nothing but", "The image holds only lines."),
        ("A mask, or a list of such.", "such", "A mask, or a list of masks."),
    ],
)
def test_a_turn_is_counted_and_its_plain_form_is_not(read_twice, kind, plain):
    assert kind in kinds(read_twice)
    assert kinds(plain) == []


@pytest.mark.parametrize("plain", ["Who can connect?", "What is a fiblet?", "At least as many as before, such as ten."])
def test_questions_and_comparisons_are_plain(plain):
    assert kinds(plain) == []


def test_a_turn_across_lines_is_found_on_its_first_line():
    assert [(line, kind) for line, kind, _ in PROSE["turns"]("one\ntwo of\nwhich three")] == [(1, "of which")]


def test_a_module_has_documentation_and_messages(tmp_path):
    module = tmp_path / "module.py"
    module.write_text(
        '"""What is left."""\n\nNAME = "short"\n# A comment.\n'
        'def f(x):\n    raise ValueError(f"found {x}, of which none fits")\n'
    )
    assert sorted(PROSE["python"](module)) == [
        ("messages", 6, "found x, of which none fits"),
        ("package", 1, "What is left."),
        ("package", 4, "# A comment."),
    ]


def test_code_and_addresses_of_a_page_are_left_out():
    text = "# Title\n\n```python\nprint('what is left')\n```\n\nA [page](what-is.md) of `who` wrote.\nIt ends.\n"
    assert [(line, kinds(part)) for line, part in PROSE["page"](text)] == [(1, []), (7, [])]
    assert [part for _, part in PROSE["page"](text)][1] == "A [pagex of x wrote.\nIt ends.\n"


@pytest.mark.parametrize(("text", "exit_status"), [("One plain page.\n", 0), ("What is left, of which all.\n", 1)])
def test_the_check_fails_above_its_ceiling(tmp_path, text, exit_status, capsys):
    (tmp_path / "page.md").write_text(text)
    subprocess.run(["git", "init", "-q", str(tmp_path)], check=True)
    subprocess.run(["git", "-C", str(tmp_path), "add", "page.md"], check=True)
    PROSE["main"].__globals__["ROOT"] = tmp_path
    assert PROSE["main"]([]) == exit_status
    assert "docs: " in capsys.readouterr().out
