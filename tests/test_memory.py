"""Limits of memory: what is given, what is left, and what is refused; each limit in a process of its own."""

import subprocess
import sys
from pathlib import Path

import pytest

from pvfiblets.support import memory

needs_limit = pytest.mark.skipif(not memory.CAN_LIMIT, reason="only Linux limits the data of a process")


@pytest.mark.parametrize(
    ("text", "size"),
    [("4G", 4 * 2**30), ("800M", 800 * 2**20), ("1.5g", 1.5 * 2**30), ("2 GiB", 2**31), ("25%", 250), ("100 %", 1000)],
)
def test_sizes_are_numbers_with_units_or_per_cent(text, size):
    assert memory.parse(text, 1000) == size


@pytest.mark.parametrize("text", ["", "4", "G", "-1G", "0M", "0%", "101%", "nan%", "1e3M", "4Q", "४G", "4G4G"])
def test_other_sizes_are_refused_by_name(text):
    with pytest.raises(ValueError, match="more than this machine" if text == "101%" else "no size of memory"):
        memory.parse(text, 1000)


@pytest.mark.skipif(not Path("/proc/meminfo").is_file(), reason="no /proc")
def test_the_machine_has_what_the_system_says_or_less():
    said = int(Path("/proc/meminfo").read_text().split()[1]) * 1024
    assert 0 < memory.of_machine() <= said * 1.01


def limited(code):
    """Run a program with 200 MB to spare, and return what it printed."""
    head = "import numpy as np\nfrom pvfiblets.support import memory\nmemory.limit(memory.taken() + (200 << 20))\n"
    done = subprocess.run([sys.executable, "-c", head + code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@needs_limit
def test_without_a_limit_all_is_taken():
    if memory.limited_to() is None:
        assert memory.room() is None
        memory.check_room(1 << 60)
        assert memory.within(lambda: 7) == 7


@needs_limit
def test_room_shrinks_by_what_is_taken_and_the_system_holds_to_it():
    code = """
before = memory.room()
kept = np.ones(100 << 17)  # 100 MB
print(round((before - memory.room()) / 2**20))
try:
    np.ones(150 << 17)
except MemoryError:
    print("no more")
"""
    assert limited(code).split("\n") == ["100", "no more"]


@needs_limit
def test_what_says_that_it_is_too_large_is_refused_before_memory_is_taken():
    code = """
memory.check_room(100 << 20)
try:
    memory.check_room(300 << 20)
except MemoryError as error:
    print(error)
"""
    said = limited(code)
    assert said.startswith("it says that it takes 300 MB, and 1")
    assert said.endswith("of memory are left for it")


@needs_limit
def test_what_runs_out_leaves_nothing_behind():
    """As much fits as before; what is free may lie among what is taken, where malloc finds it and room() does not."""
    code = """
def fits():
    kept = []
    try:
        while True:
            kept.append(np.ones(10 << 17))
    except MemoryError:
        return len(kept)

def work():
    kept = [np.ones(40 << 17)]
    while True:
        kept.append(np.ones(40 << 17))

before = fits()
for _ in range(3):
    try:
        memory.within(work)
    except memory.TooLargeError as error:
        print(error)
try:
    memory.within(lambda: np.ones(170 << 17))  # it fits, and hardly anything else would
except memory.TooLargeError as error:
    print(error)
print(before > 10, fits() >= before - 1)
"""
    assert limited(code).split("\n") == ["it needs more memory than is left"] * 4 + ["True True"]
