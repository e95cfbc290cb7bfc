"""Every program of the engine is valid for Khronos' reference compiler, in all versions of GLSL that drivers are given.

`make test` compiles every stage with each feature on and off, and checks whole programs with as much on as goes
together; `make test-all` checks whole programs with each pair of features, which takes four minutes.
"""

import itertools
import os
import random
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from pvfiblets.engine.gl.bindings import STORAGE
from tests.reference_compiler import check, complaints

from . import shader_programs
from .shader_programs import KINDS, rows, varied

pytestmark = pytest.mark.more

ROOT = Path(__file__).resolve().parents[2]
SPV_14 = "FEATURE_MESH_EXT 1"  # the compiler has no such stages but where it makes SPIR-V


def test_all_stages_are_among_the_programs():
    files = {p.relative_to(ROOT / "shaders").as_posix() for p in (ROOT / "shaders").rglob("*") if p.is_file()}
    # Those of pages are of another language, GLSL ES; browsers compile them (tests/page).
    files = {name for name in files if not name.startswith("page/")}
    assert {name for name in files if not name.endswith(".glsl")} == {
        name for kind in KINDS.values() for name in kind.stages.values()
    }


@pytest.mark.parametrize("name", ["compute depth", "geometry line", "volumes/cast", "halos strips"])
def test_every_pair_that_can_occur_does(name):
    """Choices made at random have no pair of features that the covering array lacks."""
    kind, names, draw = KINDS[name], varied(KINDS[name]), random.Random(7)

    def pairs(on):
        return set(itertools.combinations([(feature, feature in on) for feature in names], 2))

    covered = set().union(*(pairs(on) for on in rows(name)))
    empty = shader_programs.Choice({**shader_programs.NEEDS, **kind.needs}, draw, frozenset(), frozenset(kind.never))
    empty = empty.having(kind.always)
    for _ in range(30):
        some = shader_programs._filled(shader_programs._decoding(empty, names), names)
        assert pairs(some.on) <= covered
    assert len(rows(name)) < 60


def written(folder, cases):
    """A file for each distinct source of some programs."""
    distinct = {
        (stage, text)
        for name, on, version in cases
        for stage, text in KINDS[name].sources(on, version).items()
        if SPV_14 not in text
    }
    paths = []
    for number, (stage, text) in enumerate(sorted(distinct)):
        paths.append(folder / f"{number}.{stage}")
        paths[-1].write_text(text)
    return paths


def cases(size):
    return [(name, on, version) for name in KINDS for on in rows(name, size) for version in KINDS[name].versions]


def test_every_stage_compiles_with_each_feature(tmp_path):
    paths = written(tmp_path, cases(1))
    assert len(paths) > 500
    assert complaints(paths) == []
    # It looks at all of them: what is wrong with one is told.
    broken = next(path for path in paths[len(paths) // 2 :] if "void main() {" in path.read_text())
    broken.write_text(broken.read_text().replace("void main() {", "void main() { nonsense();"))
    (one,) = {line.split(":")[0] for line in complaints(paths[-3:] + [broken])}
    assert one == str(broken)


def wrong(folder, some):
    """What is wrong with programs, by name, features and version of GLSL."""

    def one(number_and_case):
        number, (name, on, version) = number_and_case
        place = folder / str(number)
        place.mkdir()
        said = check(place, KINDS[name].sources(on, version))
        return f"{name} {version} {sorted(on)}:\n{said}" if said else None

    with ThreadPoolExecutor(min(os.cpu_count() or 1, 8)) as threads:
        return [said for said in threads.map(one, enumerate(some)) if said]


def test_whole_programs_are_valid_for_opengl(tmp_path):
    """The choice of each program with most features on, for the oldest OpenGL that has the program."""
    some = [(name, max(rows(name, 1), key=len), KINDS[name].versions[0]) for name in KINDS]
    assert wrong(tmp_path, some) == []


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", KINDS)
def test_whole_programs_are_valid_with_each_pair_of_features(tmp_path, name):
    assert wrong(tmp_path, [(name, on, version) for on in rows(name) for version in KINDS[name].versions]) == []


def test_storage_buffers_are_no_more_than_opengl_promises():
    """Eight in a stage."""
    for name, on, version in cases(1):
        for source in KINDS[name].sources(on, version).values():
            bindings = {int(number) for number in re.findall(r"std430, binding = (\d+)", source)}
            bindings.discard(STORAGE["rotations"])  # only where drivers have it
            assert len(bindings) <= (9 if "INT64_ATOMICS" in on else 8), f"{name} {sorted(on)}"
