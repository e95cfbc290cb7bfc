"""Readers reach every page of the site by two clicks, and every link and picture of a page is there."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
BUILT = {"gallery/index"}  # by Sphinx, from the examples
FENCED = re.compile(r"^```(?!\{toctree\}).*?^```", re.DOTALL | re.MULTILINE)
TOCTREE = re.compile(r"^```\{toctree\}\n(.*?)^```|^\.\. toctree::\n((?:^(?: .*)?\n)+)", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)[^)]*\)|:doc:`(?:[^`<]*<)?([^>`]+)>?`")


def pages():
    found = [*DOCS.rglob("*.md"), *DOCS.rglob("*.rst")]
    return [path for path in found if not {"_build", "gallery"} & set(path.relative_to(DOCS).parts)]


def named_page(folder, name):
    """Return the page that a table of contents names, without its suffix."""
    return next((path for suffix in (".md", ".rst") if (path := (folder / f"{name}{suffix}").resolve()).exists()), None)


def contents(page):
    """Yield the pages in the tables of contents of a page; None for one that is missing."""
    for block in map("".join, TOCTREE.findall(page.read_text(encoding="utf-8"))):
        for line in filter(None, map(str.strip, block.splitlines())):
            name = line.rpartition("<")[2].rstrip(">").strip()
            if line.startswith(":") or name in BUILT:
                continue
            if "*" in name:
                yield from (path.resolve() for path in page.parent.glob(f"{name}.md"))
            else:
                yield named_page(page.parent, name)


def links(page):
    """Yield the files of the repository that a page links or shows."""
    for match in LINK.finditer(FENCED.sub("", page.read_text(encoding="utf-8"))):
        if match[2]:
            yield named_page(DOCS if match[2].startswith("/") else page.parent, match[2].lstrip("/"))
        elif "://" not in match[1] and match[1] not in BUILT:
            yield (page.parent / match[1]).resolve()


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.relative_to(DOCS).as_posix())
def test_what_a_page_links_is_there(page):
    for target in (*contents(page), *links(page)):
        assert target is not None
        assert target.exists(), target


def test_every_page_is_two_clicks_from_the_front():
    front = DOCS / "index.md"
    reached = {front: 0}
    for clicks in (1, 2):
        for page in [page for page, at in reached.items() if at == clicks - 1]:
            # Pages of pages in a table of contents stand in it as well, where it says so.
            shown = contents(page) if ":includehidden:" in page.read_text(encoding="utf-8") else ()
            below = [target for one in shown for target in contents(one)]
            for target in (*contents(page), *links(page), *below):
                if target.suffix in (".md", ".rst"):
                    reached.setdefault(target, clicks)
    assert set(pages()) <= set(reached)


def test_every_page_but_the_front_is_in_one_table_of_contents():
    listed = [target for page in pages() for target in contents(page)]
    assert sorted(listed) == sorted(page for page in pages() if page != DOCS / "index.md")


def test_every_picture_is_shown():
    shown = {target for page in (*pages(), DOCS.parent / "README.md") for target in links(page)}
    pictures = [*DOCS.glob("*.jpg"), *(DOCS / "pictures").iterdir(), *(DOCS / "benchmarks").rglob("*.png")]
    assert [picture.name for picture in pictures if picture not in shown] == []
