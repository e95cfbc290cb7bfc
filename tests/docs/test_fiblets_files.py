"""What the docs say of ``.fiblets`` files is enough to read them: the reader that they print reads what we write."""

import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

from pvfiblets.codec.encoding.compress import compress
from pvfiblets.codec.layout import SPLINE, coded_kind
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "fiblets-files.md"


@pytest.fixture(scope="module")
def reader():
    (source,) = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    names: dict = {}
    exec(compile(source, str(PAGE), "exec"), names)
    return names["read"]


def jumpy(scale: float, seed: int = 0) -> Streamlines:
    """Return lines of very different steps, some of one point and some of none."""
    random = np.random.default_rng(seed)
    lines = [np.cumsum(random.normal(size=(count, 3)) * scale * 10.0 ** random.uniform(-3, 3), axis=0)
             for count in (150, 1, 0, 2, 61, 60, 59)]  # fmt: skip
    return Streamlines.from_list([line.reshape(-1, 3) for line in lines])


SETS = {
    "tracts": lambda: (brain_streamlines(12, seed=3), {}),
    "fine": lambda: (brain_streamlines(4, seed=4), {"max_error": 1e-5}),
    "splines": lambda: (brain_streamlines(12, seed=3), {"effort": "small"}),
    "jumpy": lambda: (jumpy(1.0), {}),
    "jumpy and fine": lambda: (jumpy(0.01), {"max_error": 1e-4}),
    "jumpy and coarse": lambda: (jumpy(1.0), {"max_error": 1.0}),
    "nothing": lambda: (Streamlines.from_list([]), {}),
}


@pytest.mark.parametrize("name", SETS)
def test_the_printed_reader_decodes_every_point(reader, name, tmp_path):
    original, options = SETS[name]()
    fiblets = compress(original, **options)
    fiblets.save(tmp_path / "x.fiblets")
    lines = reader(tmp_path / "x.fiblets")
    assert [len(line) for line in lines] == np.diff(original.offsets).tolist()
    for line, start, stop in zip(lines, original.offsets[:-1], original.offsets[1:], strict=True):
        assert (np.linalg.norm(line - original.points[start:stop], axis=1) <= 1.001 * fiblets.promise).all()
    if lines:
        ours = np.asarray(fiblets.decompress().points, np.float64)
        np.testing.assert_allclose(np.concatenate(lines), ours, atol=1e-3 * fiblets.promise + 1e-6 * abs(ours).max())


def repeated(n: int) -> Streamlines:
    """Return lines of two points of which every coordinate stands there often."""
    ends = np.random.default_rng(0).normal(size=(4, 3))[np.random.default_rng(1).integers(0, 4, 2 * n)]
    return Streamlines(ends, 2 * np.arange(n + 1))


EXACT = {
    0: lambda: repeated(50),
    1: lambda: Streamlines(np.random.default_rng(0).normal(size=(300, 3)).astype(np.float32), [0, 0, 120, 121, 300]),
    2: lambda: brain_streamlines(12, seed=3),
    None: lambda: Streamlines.from_list([]),
}


@pytest.mark.parametrize("form", EXACT)
def test_the_printed_reader_reads_exact_points(reader, form, tmp_path):
    original = EXACT[form]()
    compress(original, exact=True).save(tmp_path / "x.fiblets")
    if form is not None:
        with zipfile.ZipFile(tmp_path / "x.fiblets") as archive:
            assert json.loads(archive.read("header.json"))["exact"]["form"] == form
    lines = reader(tmp_path / "x.fiblets")
    assert len(lines) == len(original)
    for line, wanted in zip(lines, original, strict=True):
        assert line.dtype == wanted.dtype
        np.testing.assert_array_equal(line, wanted)


@pytest.mark.parametrize("exact", [False, True])
def test_the_printed_reader_reads_small_files(reader, exact, tmp_path):
    lines = brain_streamlines(40, seed=3)
    lines.per_point["x"] = lines.points[:, 0].copy()
    fiblets = compress(lines, exact=exact, per_point=("x",))
    fiblets.save(tmp_path / "plain.fiblets")
    fiblets.save(tmp_path / "small.fiblets", small=True)
    header = json.loads(zipfile.ZipFile(tmp_path / "small.fiblets").read("header.json"))
    assert ("codes.npy" in header["packed"]) != exact
    for plain, small in zip(reader(tmp_path / "plain.fiblets"), reader(tmp_path / "small.fiblets"), strict=True):
        np.testing.assert_array_equal(plain, small)


def test_all_kinds_of_records_are_read():
    kinds = set()
    for make in SETS.values():
        original, options = make()
        kinds |= set(coded_kind(compress(original, **options).decoding).tolist())
    assert kinds == {0, 1, 2, 3, SPLINE}
