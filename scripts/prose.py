"""Count turns of phrase that make a reader read twice, and fail above a ceiling per 1,000 words.

``python scripts/prose.py`` prints the counts by area; ``--files`` adds each file, ``--lines`` each phrase.
"""

from __future__ import annotations

import argparse
import ast
import re
import subprocess
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

NO_QUESTION = r"(?![^.;]{0,80}\?)"
PATTERNS = {
    "is told, is asked": r"\b(?:is|are|was|were|be|been) (?:told|asked|answered|said)\b",
    "says so": r"\b(?:says?|said|tells?) so\b",
    "what is": r"\bwhat (?:is|are|was|were|has|have|had|it|they|lies?|stands?|shows?|comes?|remains?)\b" + NO_QUESTION,
    "who": r"\b(?:who|whom|whoever)\b" + NO_QUESTION,
    "of which": r"\b(?:of|for|by|with|than|beside|behind) (?:which|whom)\b",
    "nobody": r"\b(?:nobody|no one|none of (?:ours|these|them|it))\b",
    "as many": r"\bas (?:many|much)\b(?! as\b)",
    "those that": r"\bthose (?:that|of|who|which|with|in|at|to)\b",
    "of these": r"(?:^|[.:;] )Of (?:these|those|them|it)\b",
    "nothing but": r"\bnothing but\b|\bis nothing\b",
    "such": r"\bof such\b|\bsuch (?:are|is|one|ones)\b",
}
FOUND = {name: re.compile(pattern) for name, pattern in PATTERNS.items()}

CEILINGS = {"docs": 0.3, "messages": 0.4, "package": 0.8}
"""Turns per 1,000 words that each area may have."""

LEFT_OUT = ("tests/", "findings/", "docs/benchmarks/report/", "docs/reference/programs.md", "scripts/prose.py")
RECORD = re.compile(r"docs/benchmarks/(?!README|details)")


def words(text: str) -> int:
    """Return how many words a text has."""
    return len(re.findall(r"[A-Za-z][\w'-]*", text))


def page(text: str) -> Iterator[tuple[int, str]]:
    """Yield the paragraphs of a Markdown page, without its blocks of code, and where each begins."""
    text = re.sub(r"^```.*?^```", lambda block: "\n" * block[0].count("\n"), text, flags=re.DOTALL | re.MULTILINE)
    for part in re.finditer(r"(?:.+\n?)+", text):
        yield text.count("\n", 0, part.start()) + 1, re.sub(r"`[^`\n]*`|\]\([^)]*\)", "x", part[0])


def python(path: Path) -> Iterator[tuple[str, int, str]]:
    """Yield (area, line, text) of the docstrings, comments and messages of a module."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    nodes = list(ast.walk(tree))
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    formatted = [node for node in nodes if isinstance(node, ast.JoinedStr)]
    pieces = {id(piece) for node in formatted for piece in node.values}
    for node in formatted:
        values = [str(piece.value) if isinstance(piece, ast.Constant) else "x" for piece in node.values]
        yield "messages", node.lineno, "".join(values)
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in pieces:
            if id(node) in docstrings:
                yield "package", node.lineno, node.value
            elif node.value.count(" ") > 1:
                yield "messages", node.lineno, node.value
    with path.open("rb") as file:
        for token in tokenize.tokenize(file.readline):
            if token.type == tokenize.COMMENT:
                yield "package", token.start[0], token.string


def texts() -> Iterator[tuple[str, str, int, str]]:
    """Yield (area, file, line, text) of all prose of the repository, without tests and records of measurements."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in listed.splitlines():
        path, suffix = ROOT / name, Path(name).suffix
        if name.startswith(LEFT_OUT) or RECORD.match(name) or not path.is_file():
            continue
        if suffix in (".md", ".rst"):
            yield from (("docs", name, line, text) for line, text in page(path.read_text(encoding="utf-8")))
        elif suffix == ".py":
            for area, line, text in python(path):
                yield "docs" if name.startswith(("docs/", "examples/")) else area, name, line, text
        elif suffix in (".glsl", ".vert", ".frag", ".comp", ".geom", ".tesc", ".tese", ".task", ".mesh", ".ts"):
            source = path.read_text(encoding="utf-8")
            for comment in re.finditer(r"/\*.*?\*/|(?:^[ \t]*//.*\n?)+|//.*", source, re.DOTALL | re.MULTILINE):
                yield "package", name, source.count("\n", 0, comment.start()) + 1, comment[0]


def turns(text: str) -> Iterator[tuple[int, str, str]]:
    """Yield (line of the text, kind, phrase) of each turn of a text."""
    plain = re.sub(r"\s", " ", text)
    for name, pattern in FOUND.items():
        for match in pattern.finditer(plain):
            yield text.count("\n", 0, match.start()), name, plain[max(match.start() - 30, 0) : match.end() + 30]


def main(arguments: list[str] | None = None) -> int:
    """Print the counts; return 1 if an area exceeds its ceiling."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--files", action="store_true", help="list the count of each file")
    parser.add_argument("--lines", action="store_true", help="list each phrase")
    chosen = parser.parse_args(arguments)
    length: Counter[str] = Counter()
    found: Counter[str] = Counter()
    by_file: Counter[tuple[str, str]] = Counter()
    for area, name, line, text in texts():
        length[area] += words(text)
        for offset, kind, phrase in turns(text):
            found[area] += 1
            by_file[area, name] += 1
            if chosen.lines:
                print(f"{name}:{line + offset}: {area}: {kind}: {phrase}")
    if chosen.files:
        for (area, name), count in by_file.most_common():
            print(f"{count:5} {area:9} {name}")
    high = False
    for area, ceiling in CEILINGS.items():
        rate = 1000 * found[area] / max(length[area], 1)
        high |= rate > ceiling
        print(f"{area}: {found[area]} in {length[area]:,} words, {rate:.2f} per 1,000 (at most {ceiling})")
    return int(high)


if __name__ == "__main__":
    sys.exit(main())
