"""Shaders of pages, as they are shortened for the script: every choice of switches is still a program."""

import importlib.util
import itertools
import re
import sys
from pathlib import Path

import pytest

from pvfiblets.colour_modes import SHADERS
from tests.reference_compiler import complaints, link

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
PAIRS = [
    ("page/decode.vert", "page/none.frag"),
    ("page/segment.vert", "page/segment.frag"),
    ("page/segment.vert", "page/sum.frag"),
    ("page/surface.vert", "page/surface.frag"),
    ("page/image.vert", "page/image.frag"),
    ("page/screen.vert", "page/tile_mask.frag"),
    ("page/screen.vert", "page/far_tiles.frag"),
    ("page/tiles.vert", "page/resolve.frag"),
    ("page/tiles.vert", "page/through.frag"),
    ("page/screen.vert", "page/mixed.frag"),
    ("page/tiles.vert", "effects/picture/antialias_coverage.frag"),
]


def _script(name):
    if name not in sys.modules:
        spec = importlib.util.spec_from_file_location(name, SCRIPTS / f"{name}.py")
        sys.modules[name] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[name])
    return sys.modules[name]


@pytest.fixture(scope="module")
def engine():
    return _script("page_shaders").everything()


@pytest.fixture(scope="module")
def stages(engine):
    """Return texts of stages, put together as client/src/engine.ts does."""
    lines = engine["lines"].split("\n")
    return {
        name: "".join(f"{line}\n" for at in range(0, len(found), 2) for line in lines[found[at] : found[at + 1]])
        for name, found in engine["shaders"].items()
    }


def _switched(text, on):
    return re.sub(
        r"#define FEATURE_(\w+) [01]", lambda found: f"#define FEATURE_{found[1]} {int(found[1] in on)}", text
    )


def _choices(*texts):
    """Every choice of switches with one colour mode at most, and a table's scale with its mode alone."""
    free = sorted(set(re.findall(r"#define FEATURE_(\w+)", "".join(texts))))
    colours = [name for name in free if name.startswith("COLOUR_")]
    free = [name for name in free if name not in colours]
    modes = [{colour} for colour in colours] or [set()]
    some = [set(chosen) for n in range(len(free) + 1) for chosen in itertools.combinations(free, n)]
    return [
        chosen | mode
        for chosen in some
        for mode in modes
        if not colours or "TABLE_LOGARITHM" not in chosen or "COLOUR_POINT_SCALAR" in mode
    ]


def test_every_choice_of_switches_compiles(stages, tmp_path):
    paths = []
    for name, text in stages.items():
        for sprites in ("false", "true") if "SPRITES" in text else ("false",):
            for i, on in enumerate(_choices(text)):
                path = tmp_path / f"{name.replace('/', '-').rpartition('.')[0]}-{i}-{sprites}.{name.rpartition('.')[2]}"
                path.write_text(
                    _switched(text, on).replace("const bool SPRITES=false", f"const bool SPRITES={sprites}")
                )
                paths.append(path)
    assert len(paths) > 40
    assert not complaints(paths)


@pytest.mark.parametrize("pair", PAIRS)
def test_stages_link_with_all_switches_on_and_off(pair, stages, tmp_path):
    texts = [stages[name] for name in pair]
    for on in (_choices(*texts)[0], _choices(*texts)[-1]):
        done = link(tmp_path, dict(zip(("vert", "frag"), (_switched(text, on) for text in texts), strict=True)))
        assert done.returncode == 0, done.stdout


def test_nothing_is_named_that_the_client_does_not_have(engine, stages):
    client = SCRIPTS.parent / "client" / "src"
    text = (client / "renderer.ts").read_text() + (client / "fiblets.ts").read_text()
    asked = set(re.findall(r'"((?:page|effects)/[\w/]+\.(?:vert|frag))"', text))
    assert asked == set(stages)
    free = set(re.findall(r"#define FEATURE_(\w+)", "".join(stages.values())))
    colours = {name for name in free if name.startswith("COLOUR_")}
    assert colours == {mode.feature for mode in SHADERS.values() if mode.reads != "colours"}  # by lines.ts
    assert {name for name in free - colours if f'"{name}"' not in text} == set()


SHRUNK = {
    "a branch that is never taken": ("#if FEATURE_OFF\nvoid f(){g();}\n#else\nint a;\n#endif\n", "int a;\n"),
    "a branch that is always taken": ("#if FEATURE_ON && !FEATURE_OFF\nint a;\n#else\nint b;\n#endif\n", "int a;\n"),
    "what the page decides": (
        "#define FEATURE_FREE 1\n#if FEATURE_FREE\nint a;\n#else\nint b;\n#endif\n",
        "#define FEATURE_FREE 1\n#if FEATURE_FREE\nint a;\n#else\nint b;\n#endif\n",
    ),
    "a chain whose first is known": (
        "#define FEATURE_FREE 1\n#if FEATURE_OFF\nint a;\n#elif FEATURE_FREE\nint b;\n#else\nint c;\n#endif\n",
        "#define FEATURE_FREE 1\n#if FEATURE_FREE\nint b;\n#else\nint c;\n#endif\n",
    ),
    "a chain whose last is known": (
        "#define FEATURE_FREE 1\n#if FEATURE_FREE\nint a;\n#elif FEATURE_ON\nint b;\n#else\nint c;\n#endif\n",
        "#define FEATURE_FREE 1\n#if FEATURE_FREE\nint a;\n#else\nint b;\n#endif\n",
    ),
    "a condition of which a part is known": (
        "#define FEATURE_FREE 1\n#if FEATURE_OFF || !(FEATURE_OFF || FEATURE_FREE)\nint a;\n#endif\n",
        "#define FEATURE_FREE 1\n#if !FEATURE_FREE\nint a;\n#endif\n",
    ),
    "a branch within one that is not taken": (
        "#if FEATURE_OFF\n#if FEATURE_FREE\nint a;\n#else\nint b;\n#endif\n#endif\nint c;\n",
        "int c;\n",
    ),
    "functions by turns": (
        "const int N=3;\nint f(int x){\nreturn N;\n}\nint f(uint x){return f(int(x));}\nint g(){return f(1);}\n"
        "void main(){}\n",
        "void main(){}\n",
    ),
    "what a branch uses that may be taken": (
        "#define FEATURE_FREE 1\nuniform int n;\nint f(){return n;}\nvoid main(){\n#if FEATURE_FREE\nf();\n#endif\n}\n",
        "#define FEATURE_FREE 1\nuniform int n;\nint f(){return n;}\nvoid main(){\n#if FEATURE_FREE\nf();\n#endif\n}\n",
    ),
    "switches that nothing asks for": ("#define FEATURE_FREE 1\n#if FEATURE_FREE\n#endif\nint a;\n", "int a;\n"),
}


@pytest.mark.parametrize("case", SHRUNK)
def test_what_is_left_out(case):
    _script("page_shaders")  # puts its folder among the places of modules
    text, expected = SHRUNK[case]
    assert _script("shader_shrinking").shrunk(text, {"ON": True, "OFF": False}) == expected


def test_names_that_only_shaders_have_become_short():
    _script("page_shaders")
    given = {
        "a": "struct Piece{vec2 start;};\nuniform float opacity;\n"
        "float taken(Piece piece){return piece.start.xy.x*opacity;}\n",
        "b": "float taken(Piece piece);\nconst float AA=1.0;\n",
    }
    texts = _script("shader_shrinking").renamed(given, {"opacity"})
    form = r"struct (\w\w)\{vec2 (\w\w);\};\nuniform float opacity;\nfloat (\w\w)\(\1 (\w\w)\)\{.*\}\n"
    struct, member, function, argument = names = re.fullmatch(form, texts["a"]).groups()
    assert len({*names, "AA"}) == 5
    assert texts["a"].endswith(f"{{return {argument}.{member}.xy.x*opacity;}}\n")
    assert texts["b"] == f"float {function}({struct} {argument});\nconst float AA=1.0;\n"
