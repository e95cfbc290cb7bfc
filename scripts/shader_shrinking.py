"""Makes shaders of pages short: what no stage uses is left out, and lines of several stages are written once.

`shrunk` keeps a stage's meaning for every choice of its switches: branches of switches that a page never sets, and
functions, constants, structs, macros and uniforms that no remaining text names, go. `pieces` tells many stages by
ranges of one list of lines; client/src/engine.ts puts them together again. `renamed` gives what only shaders name
short names.
"""

from __future__ import annotations

import itertools
import re
import string
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping

__all__ = ["pieces", "renamed", "shrunk"]

_WORDS = """
    abs all and any attribute bool break bvec2 bvec3 bvec4 case ceil clamp const continue core cos cross dFdx
    dFdy default define defined degrees determinant discard distance do dot elif else endif equal error es exp
    exp2 extension false flat float floatBitsToInt floatBitsToUint floor for fract fwidth greaterThan
    greaterThanEqual highp if ifdef ifndef in inout int intBitsToFloat inverse inversesqrt invariant isampler2D
    isinf isnan ivec2 ivec3 ivec4 layout length lessThan lessThanEqual line location log log2 lowp main mat2
    mat3 mat4 max mediump min mix mod normalize not notEqual or out outerProduct packHalf2x16 packSnorm2x16
    packUnorm2x16 packUnorm4x8 pow pragma precision radians readonly reflect refract return round roundEven
    sampler2D sampler2DArray sampler3D sign sin smooth smoothstep sqrt step struct switch tan texelFetch texture
    textureLod textureSize transpose true trunc uint uintBitsToFloat undef uniform unpackHalf2x16
    unpackSnorm2x16 unpackUnorm2x16 unpackUnorm4x8 usampler2D uvec2 uvec3 uvec4 vec2 vec3 vec4 version void
    while xor std140
"""
_LANGUAGE = frozenset(_WORDS.split())
"""Words of GLSL ES 3.00 that shaders here use; the tests' compiler finds missing ones."""
_SWIZZLE = re.compile(r"[xyzw]{1,4}|[rgba]{1,4}")

_SWITCH = re.compile(r"FEATURE_\w+|__VERSION__ >= \d+|[!()]|&&|\|\|")
_NAME = re.compile(r"\b[A-Za-z_]\w*")
_FUNCTION = re.compile(r"^(?:\w+ )?\w+ (\w+)\([^;{]*\)\{")
_STRUCT = re.compile(r"^struct (\w+)\{")
_CONSTANT = re.compile(r"^const \w+ ")
_UNIFORM = re.compile(r"^uniform (?:highp )?\w+ (\w+)(?:\[\w+\])?;$")
_MACRO = re.compile(r"^#define (?!FEATURE_)(\w+)")


def shrunk(text: str, switches: Mapping[str, bool | None]) -> str:
    """Return a stage without what no choice of switches draws with.

    Parameters
    ----------
    text : str
        GLSL, one statement or brace to a line or more, without comments.
    switches : mapping of str to bool or None
        Names of ``FEATURE_`` macros that are always on or off; macros that the page sets are missing, or None.
    """
    lines = _branches(text.replace("#define precise\n", "").replace("precise ", "").splitlines(), switches)
    while True:
        after = _without_empty(_without_unused(lines))
        if after == lines:
            return "\n".join(lines) + "\n"
        lines = after


def pieces(texts: Mapping[str, str]) -> tuple[list[str], dict[str, list[int]]]:
    """Return the lines of many texts, each once, and for each text ranges of them: begin, end, begin, end, ..."""
    lines: dict[str, int] = {}
    ranges: dict[str, list[int]] = {}
    for name, text in texts.items():
        found: list[int] = []
        for line in text.splitlines():
            at = lines.setdefault(line, len(lines))
            if found and found[-1] == at:
                found[-1] = at + 1
            else:
                found += [at, at + 1]
        ranges[name] = found
    return list(lines), ranges


def renamed(texts: Mapping[str, str], kept: Collection[str]) -> dict[str, str]:
    """Return texts with short names in the place of long ones, the same in all of them.

    Parameters
    ----------
    texts : mapping of str to str
    kept : collection of str
        Names that stay, as others use them, too.
    """
    counts = Counter(name for text in texts.values() for name in _NAME.findall(text))
    stays = _LANGUAGE.union(kept)
    free = [
        name for name in counts
        if len(name) > 2 and name not in stays and not name.startswith(("gl_", "FEATURE_")) and "__" not in name
    ]  # fmt: skip
    free = [name for name in free if not _SWIZZLE.fullmatch(name)]
    fresh = (short for short in _short_names() if short not in counts and short not in stays)
    shorter = dict(zip(sorted(free, key=lambda name: (-counts[name], name)), fresh, strict=False))
    return {
        name: _NAME.sub(lambda found: shorter.get(found[0], found[0]), text)
        for name, text in texts.items()
    }  # fmt: skip


def _short_names() -> Iterator[str]:
    """Yield names of two letters, then of three, without swizzles."""
    letters = string.ascii_uppercase + string.ascii_lowercase
    for first, second in itertools.product(letters, letters + string.digits):
        if not _SWIZZLE.fullmatch(first + second):
            yield first + second
    for parts in itertools.product(string.ascii_uppercase, repeat=3):
        yield "".join(parts)


def _condition(text: str, switches: Mapping[str, bool | None]) -> bool | str:
    """Return what a condition of #if is, or, where the page decides, the condition without its constant parts."""
    tokens = _SWITCH.findall(text)
    assert "".join(tokens).replace(" ", "") == text.replace(" ", ""), text

    def joined(sign: str, part: Callable[[], bool | str], decisive: bool) -> bool | str:
        found = [part()]
        while tokens and tokens[0] == sign:
            tokens.pop(0)
            found.append(part())
        if decisive in found:
            return decisive
        free = [one for one in found if isinstance(one, str)]
        return not decisive if not free else free[0] if len(free) == 1 else f"({f' {sign} '.join(free)})"

    def either() -> bool | str:
        return joined("||", both, True)

    def both() -> bool | str:
        return joined("&&", single, False)

    def single() -> bool | str:
        token = tokens.pop(0)
        if token == "!":
            found = single()
            return f"!{found}" if isinstance(found, str) else not found
        if token == "(":
            found = either()
            assert tokens.pop(0) == ")", text
            return found
        if token.startswith("__VERSION__"):
            return False
        value = switches.get(token.removeprefix("FEATURE_"))
        return token if value is None else value

    found = either()
    assert not tokens, text
    return found


def _branches(lines: list[str], switches: Mapping[str, bool | None]) -> list[str]:
    """Leave branches out that are never taken, and conditions that always hold."""
    kept: list[str] = []
    # Of each #if: whether the branch goes along, whether one was taken for sure, and whether the #if itself stands.
    stack: list[list[bool]] = []
    for line in lines:
        word, _, condition = line.partition(" ")
        writes = all(level[0] for level in stack)
        if word in ("#if", "#ifdef", "#ifndef"):
            value = _condition(condition, switches) if word == "#if" else condition
            stack.append([value is not False, value is True, isinstance(value, str)])
            if writes and isinstance(value, str):
                kept.append(f"{word} {value}")
        elif word in ("#elif", "#else"):
            level = stack[-1]
            outside = all(other[0] for other in stack[:-1])
            value = True if word == "#else" else _condition(condition, switches)
            if level[1] or value is False:
                level[0] = False
                continue
            level[:2] = [True, value is True]
            if outside and isinstance(value, str):
                kept.append(f"{'#elif' if level[2] else '#if'} {value}")
                level[2] = True
            elif outside and level[2]:
                kept.append("#else")
        elif word == "#endif":
            level = stack.pop()
            if all(other[0] for other in stack) and level[2]:
                kept.append(line)
        elif writes:
            kept.append(line)
    return kept


def _items(lines: list[str]) -> list[list[str]]:
    """Return lines in groups: a declaration of several lines is one."""
    items: list[list[str]] = []
    depth = 0
    for line in lines:
        if depth:
            items[-1].append(line)
        else:
            items.append([line])
        if not line.startswith("#"):
            depth += line.count("{") - line.count("}")
    return items


def _named(item: list[str]) -> list[str]:
    """Return which names a declaration has that may go with them; none where it has to stay."""
    first = item[0]
    if _CONSTANT.match(first):
        return re.findall(r"(\w+)=", first) if len(item) == 1 and first.endswith(";") else []
    found = _FUNCTION.match(first) or _STRUCT.match(first) or _UNIFORM.match(first) or _MACRO.match(first)
    return [found[1]] if found and found[1] != "main" else []


def _without_unused(lines: list[str]) -> list[str]:
    """Leave declarations out that nothing names but themselves and others of their name."""
    items = _items(lines)
    everywhere = Counter(_NAME.findall("\n".join(lines)))
    own: Counter[str] = Counter()
    for item in items:
        for name in _named(item):
            own[name] += len(re.findall(rf"\b{name}\b", "\n".join(item)))
    kept = []
    for item in items:
        names = _named(item)
        if not names or any(everywhere[name] > own[name] for name in names):
            kept += item
    return kept


def _without_empty(lines: list[str]) -> list[str]:
    """Leave conditions out around nothing, and switches that nothing asks for."""
    text = "\n".join(lines)
    before = None
    while before != text:
        before = text
        text = re.sub(r"^#if[^\n]*\n#endif\n", "", text, flags=re.MULTILINE)
        text = re.sub(r"^#else\n#endif$", "#endif", text, flags=re.MULTILINE)
    for name in re.findall(r"^#define (FEATURE_\w+)", text, re.MULTILINE):
        if len(re.findall(rf"\b{name}\b", text)) == 1:
            text = re.sub(rf"^#define {name} .*\n", "", text, flags=re.MULTILINE)
    return text.splitlines()
