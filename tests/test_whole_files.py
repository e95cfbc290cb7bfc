"""Files that cannot be written: the user's path, why, what to do, and nothing half left behind."""

import ast
import errno
import io
import os
import re
import subprocess
import sys
import tokenize
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import pvfiblets
from pvfiblets.cli.command import main
from pvfiblets.formats import tck
from pvfiblets.streamlines import Streamlines
from pvfiblets.support.unfinished import locked, remove_unfinished, unfinished
from pvfiblets.support.whole_files import naming_target, replacing

SUFFIXES = (".tck", ".trk", ".trx", ".vtk", ".vtp", ".fiblets")
OURS = (".tck", ".trk", ".trx", ".fiblets")  # the others are VTK's to write


@pytest.fixture
def lines():
    return Streamlines.from_list([np.cumsum(np.full((40, 3), 0.5), axis=0)])


def written(lines, path):
    if path.suffix == ".fiblets":
        pvfiblets.compress(lines).save(path)
    else:
        pvfiblets.write(path, lines)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_is_not_there_is_named(lines, tmp_path, suffix):
    path = tmp_path / "nowhere" / f"lines{suffix}"
    for write in (written, lambda lines, path: pvfiblets.compress(lines).save(path)):
        with pytest.raises(FileNotFoundError, match="there is no folder .*nowhere; make it first") as caught:
            write(lines, path)
        assert caught.value.filename == str(path)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="/proc is a folder that nobody can write to")
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_cannot_be_written_is_named(lines, suffix):
    path = Path(f"/proc/lines{suffix}")
    with pytest.raises(OSError, match="the folder /proc cannot be written to; choose another one") as caught:
        written(lines, path)
    assert caught.value.filename == str(path)


class Full:
    """A file on a disk that has room for a few bytes."""

    def __init__(self, file, room):
        self._file, self._room = file, room

    def write(self, data):
        self._room -= len(memoryview(data).cast("B"))
        if self._room < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return self._file.write(data)

    def __getattr__(self, name):
        return getattr(self._file, name)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()


@pytest.mark.parametrize("suffix", OURS)
def test_a_full_disk_is_reported_with_its_free_space_and_keeps_the_old_file(lines, tmp_path, monkeypatch, suffix):
    path = tmp_path / f"lines{suffix}"
    path.write_bytes(b"old")
    before = Path.open
    monkeypatch.setattr(
        Path,
        "open",
        lambda self, mode="r", *more, **named: (
            Full(before(self, mode, *more, **named), 100) if mode == "wb" else before(self, mode, *more, **named)
        ),
    )
    with pytest.raises(OSError, match=r"no space is left for it \(.*free in .*MB\); make room there") as caught:
        written(lines, path)
    assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(path))
    assert path.read_bytes() == b"old"
    assert [found.name for found in tmp_path.iterdir()] == [path.name]


def test_errors_of_other_files_stay_as_they_are(tmp_path):
    with pytest.raises(FileNotFoundError) as caught, replacing(tmp_path / "out"):
        (tmp_path / "source").read_bytes()
    assert caught.value.filename == str(tmp_path / "source")
    assert not list(tmp_path.iterdir())
    broken = OSError(errno.EIO, "the source's disk is broken")
    with pytest.raises(OSError, match="is broken") as caught, naming_target(tmp_path / "out"):
        raise broken
    assert caught.value is broken


@pytest.mark.skipif(sys.platform == "win32", reason="no limit on the size of files")
@pytest.mark.parametrize("name", ["a.trx", "a.tck", "a.fiblets"])
def test_a_file_beyond_the_size_limit_reports_the_size_it_needs(name, tmp_path):
    """In a process of its own, whose files may have 64 kB."""
    code = """
import resource, signal, sys
from pvfiblets.cli.command import main
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, 1 << 16))
sys.exit(main(["convert", sys.argv[1], sys.argv[2], "--quiet"]))
"""
    from pvfiblets import formats
    from pvfiblets.synthetic import brain_streamlines

    formats.write(tmp_path / "source.trx", brain_streamlines(400, 1.0))
    target = tmp_path / "made" / name
    target.parent.mkdir()
    command = [sys.executable, "-c", code, str(tmp_path / "source.trx"), str(target)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 1, done.stdout
    assert done.stderr.count("\n") == 1
    assert f"{target}: it is larger than files may be here" in done.stderr
    assert list(target.parent.iterdir()) == []


EVERY_WRITER = """
import os, resource, signal, sys
from pathlib import Path
import pvfiblets
from pvfiblets import formats
folder, limit = Path(sys.argv[2]), int(sys.argv[3])
lines = formats.read(sys.argv[1])
fiblets = pvfiblets.compress(lines, exact=True)
if limit:
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
for suffix in sys.argv[4:]:
    path = folder / f"lines{suffix}"
    path.write_bytes(b"old")
    try:
        fiblets.save(path) if suffix == ".fiblets" else formats.write(path, lines)
    except OSError as error:
        print(error.errno, error.filename, error.strerror)
    assert path.read_bytes() == b"old", suffix
    assert [found.name for found in folder.iterdir()] == [path.name], suffix
    path.unlink()
"""


@pytest.fixture(params=["limit", "disk"])
def too_small(request, tmp_path):
    """A folder for files of at most 64 kB, and that limit where the system keeps it: 0 where the disk is as small."""
    if request.param == "limit":
        if sys.platform == "win32":
            pytest.skip("no limit on the size of files")
        yield tmp_path, 1 << 16
        return
    if not sys.platform.startswith("linux") or os.geteuid() != 0:
        pytest.skip("only root can make a small disk")
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", tmp_path], check=False).returncode:
        pytest.skip("no disk can be mounted here")
    yield tmp_path, 0
    subprocess.run(["umount", tmp_path], check=True)


@pytest.mark.few(1)
def test_every_writer_says_what_was_needed_and_leaves_the_old_file(too_small, tmp_path_factory):
    """VTK's own included, which do not tell, print pages, and delete what they could not finish."""
    from pvfiblets import formats
    from pvfiblets.synthetic import brain_streamlines

    folder, limit = too_small
    source = tmp_path_factory.mktemp("source") / "source.trx"
    formats.write(source, brain_streamlines(400, 1.0))
    command = [sys.executable, "-c", EVERY_WRITER, str(source), str(folder), str(limit), *SUFFIXES]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200)
    assert (done.returncode, done.stderr) == (0, "")
    said = done.stdout.splitlines()
    assert len(said) == len(SUFFIXES)
    for suffix, sentence in zip(SUFFIXES, said, strict=True):
        assert sentence.startswith(f"{errno.EFBIG if limit else errno.ENOSPC} {folder}/lines{suffix} ")
        assert ("larger than files may be here" if limit else "no space is left for it") in sentence
        if suffix != ".vtp":  # nobody knows what zlib will make of it
            assert "it takes 0." in sentence, sentence


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no SIGKILL")
@pytest.mark.parametrize("suffix", [".fiblets", ".trk"])
def test_a_killed_conversion_leaves_source_and_old_file_whole(lines, tmp_path, suffix, capsys):
    """In the middle of writing, by a signal that nothing can catch; afterwards the same conversion goes through."""
    code = """
import os, signal, sys
from pathlib import Path
from pvfiblets.support import whole_files
from pvfiblets.cli.command import main
before = Path.replace
Path.replace = lambda self, to: os.kill(os.getpid(), signal.SIGKILL)  # all is written, and has not its name yet
sys.exit(main(["convert", sys.argv[1], sys.argv[2], "--quiet"]))
"""
    source, target = tmp_path / "source.tck", tmp_path / f"lines{suffix}"
    tck.write(source, lines)
    whole = source.read_bytes()
    target.write_bytes(b"old")
    done = subprocess.run([sys.executable, "-c", code, str(source), str(target)], timeout=200, check=False)
    assert done.returncode == -9
    assert source.read_bytes() == whole
    assert target.read_bytes() == b"old"
    left = [entry.name for entry in tmp_path.iterdir() if entry.name.startswith(".")]
    assert left
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        assert main(["convert", str(source), str(target), "--quiet"]) == 0
    said = capsys.readouterr().err
    assert f"removed what a killed conversion left in {tmp_path}: " in said
    assert all(name in said for name in left)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == sorted([source.name, target.name])
    np.testing.assert_allclose(pvfiblets.read(target).points, lines.points, atol=1e-3)


def test_what_is_being_written_is_never_removed(tmp_path):
    """By this process, by another machine, by a process of that number, and by whoever holds the lock."""
    target = tmp_path / "lines.fiblets"
    ended = subprocess.run([sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, check=True)
    name = unfinished(target).name
    dead = name.replace(f"-{os.getpid()}.", f"-{int(ended.stdout)}.")
    machine = name.split(".")[-2].split("-")[0]
    other = dead.replace(machine, "0" * 8 if machine != "0" * 8 else "1" * 8)
    for one in (name, dead, other, "mine.part", ".mine.part"):
        (tmp_path / one).write_bytes(b"x")
    folder = tmp_path / dead.replace(".part", ".scratch")
    (folder / "inner").mkdir(parents=True)
    with locked(tmp_path / dead):
        with pytest.warns(UserWarning, match=f"removed what a killed conversion left in .*: {folder.name}"):
            assert remove_unfinished(tmp_path) == [folder]
        assert (tmp_path / dead).exists()
    with pytest.warns(UserWarning, match="removed"):
        assert remove_unfinished(tmp_path) == [tmp_path / dead]
    assert sorted(entry.name for entry in tmp_path.iterdir()) == sorted([name, other, "mine.part", ".mine.part"])
    assert remove_unfinished(tmp_path) == []
    assert remove_unfinished(tmp_path / "nowhere") == []


ROOT = Path(__file__).resolve().parents[1]
KINDS = ("glsl", "comp", "frag", "vert", "geom", "tesc", "tese", "task", "mesh", "py")
NAMED = re.compile(
    rf"(?<![\w/.*{{}}<>-])((?:[\w-]+/)*[a-z][\w-]*\.(?:{'|'.join(KINDS)})|shaders(?:/[\w-]+)+)(?![\w*/(-]|\.\w)"
)
FOLDERS = ("pvfiblets", "shaders", "tests", "docs", "examples", "scripts")
FILES = {
    path.relative_to(ROOT).as_posix()
    for folder in FOLDERS
    for path in (ROOT / folder).rglob("*")
    if "__pycache__" not in path.parts and "_build" not in path.parts
} | set(FOLDERS)
NAMES = {name.rpartition("/")[2] for name in FILES}
WRITTEN = re.compile(r"codec/layout\.glsl|colour/line_colour\.glsl|uniforms/\w+\.glsl")  # by the package itself
ELSEWHERE = ("shaders/resolve/emission.glsl", "wslink/chunking.py")  # an example, and another library's


def prose(source: str, python: bool) -> Iterator[tuple[int, str]]:
    """Yield lines with their numbers; of Python, comments and docstrings."""
    if not python:
        yield from enumerate(source.splitlines(), 1)
        return
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string
    for node in ast.walk(ast.parse(source)):
        value = node.value if isinstance(node, ast.Expr) else None
        if isinstance(value, ast.Constant) and isinstance(value.value, str):
            yield from enumerate(value.value.splitlines(), value.lineno)


def exists(name: str, source: str) -> bool:
    """Say whether a path is there: from the root, from a room, or from a folder that its source lies in."""
    if "/" not in name:
        return name in NAMES
    inside = source.split("/")[:-1]
    bases = ["", "shaders/", "pvfiblets/", *("/".join(inside[:end]) + "/" for end in range(1, len(inside) + 1))]
    return any(base + name in FILES for base in bases)


def unknown(path: str, text: str) -> list[str]:
    """Return what a file names that is not there."""
    if not NAMED.search(text):
        return []
    named = [(line, name) for line, words in prose(text, path.endswith(".py")) for name in NAMED.findall(words)]
    return [
        f"{path}:{line}: {name}"
        for line, name in named
        if name not in ELSEWHERE and name == name.lower() and not WRITTEN.fullmatch(name) and not exists(name, path)
    ]


def test_a_dead_pointer_is_seen():
    text = '"""See ``shaders/nowhere``\n``culling/frustum.glsl``, now.comp."""\nx = "no/code.py"  # codec/nothing.py\n'
    assert [line.split(": ") for line in unknown("pvfiblets/a.py", text)] == [
        ["pvfiblets/a.py:3", "codec/nothing.py"],
        ["pvfiblets/a.py:1", "shaders/nowhere"],
        ["pvfiblets/a.py:2", "now.comp"],
    ]


@pytest.mark.more
def test_every_named_path_is_there():
    kinds = (*(f".{kind}" for kind in KINDS), ".md", ".rst")
    sources = [name for name in FILES if name.endswith(kinds) and not name.startswith("docs/benchmarks/")]
    sources += [name for name in ("README.md", "CONTRIBUTING.md") if (ROOT / name).is_file()]
    assert len(sources) > 500
    missing = [line for name in sources for line in unknown(name, (ROOT / name).read_text(encoding="utf-8"))]
    assert not missing, "\n".join(sorted(missing))
