"""The studies on very little data, and the report that comes of them."""

import os
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

from pvfiblets import formats
from pvfiblets.cli.command import main
from pvfiblets.codec.encoding.compress import compress
from pvfiblets.report import drawing, run, studies, timing
from pvfiblets.report.record import Axes, Figure, LeftOut, Record
from pvfiblets.report.report_file import Report
from pvfiblets.report.studies.codec import data_sets
from pvfiblets.report.studies.codec import study as codec
from pvfiblets.report.studies.decode import decoders
from pvfiblets.report.studies.decode import study as decode
from pvfiblets.report.studies.decode.reference import first_frame
from pvfiblets.report.study import Budget, Options, Unavailable
from pvfiblets.streamlines import Streamlines
from tests.codec.reference import encode_direction


def quiet(_):
    pass


def little(**rest):
    return Options(quick=True, repeats=1, points=600, log=quiet, machine="m", **rest)


# --------------------------------------------------------------------------------------------------------------- data


def ragged(counts, seed=0):
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    return Streamlines(np.random.default_rng(seed).normal(size=(offsets[-1], 3)), offsets)


@pytest.mark.parametrize("limit", [50, 300, 2000, 10_000])
def test_thinned_sets_are_whole_streamlines_from_all_over(limit):
    whole = ragged(np.random.default_rng(1).integers(1, 40, 400))
    chunks = [whole[a:b] for a, b in pairwise([0, 7, 100, 101, 400])]
    kept, note = data_sets.thinned(chunks, limit)
    assert kept.n_points <= limit
    if whole.n_points <= limit:
        assert note == ""
        assert len(kept) == 400
    else:
        assert note == f"{len(kept)} of 400 streamlines"
        assert kept.n_points > 0.3 * limit
    ids = [int(np.flatnonzero((whole.points == line[0]).all(1))[0]) for line in kept if len(line)]
    assert ids == sorted(ids)
    assert ids[-1] > 0.7 * whole.n_points
    starts = whole.offsets[:-1]
    for line, first in zip(kept, ids, strict=True):
        assert first in starts
        np.testing.assert_array_equal(line, whole[int(np.searchsorted(starts, first))])


def test_files_are_taken_from_folders_and_what_cannot_be_read_is_named(tmp_path, monkeypatch):
    formats.write(tmp_path / "good.tck", ragged([20, 30]))
    (tmp_path / "bad.tck").write_bytes(b"GIF89a")
    (tmp_path / "notes.txt").write_text("no tractogram")
    formats.write(tmp_path / "empty.tck", ragged([]))
    left = []
    sets = list(data_sets.data_sets(little(files=(tmp_path,), left_out=left)))
    assert [s.name for s in sets if s.group not in ("smooth", "noisy")] == ["good.tck"]
    assert {item.what for item in left} == {"bad.tck", "empty.tck"}
    assert str(tmp_path) not in " ".join(item.reason for item in left)
    monkeypatch.setenv("PVFIBLETS_DATA", str(tmp_path))
    assert len(data_sets.files_of(())[0]) == 3
    monkeypatch.delenv("PVFIBLETS_DATA")
    assert data_sets.files_of(()) == ([], "no file was given with --data, and PVFIBLETS_DATA names no folder")
    with pytest.raises(FileNotFoundError, match="absent.trk"):
        data_sets.files_of([tmp_path / "absent.trk"])


def test_made_up_sets_have_constant_steps_and_noise_turns_them_more():
    from pvfiblets.report.studies.codec.baselines.directions import widest_turn
    from pvfiblets.report.studies.codec.errors import median_step

    smooth, noisy = (data_sets.synthetic_tracking(0.5, noise, 3000, 0) for noise in (False, True))
    for made in (smooth, noisy):
        assert median_step(made.points, made.offsets) == pytest.approx(0.5, rel=1e-4)
        assert 1000 < made.n_points <= 3000
    assert widest_turn(noisy.points, noisy.offsets) > 1.5 * widest_turn(smooth.points, smooth.offsets)


# -------------------------------------------------------------------------------------------------------------- codec


@pytest.fixture(scope="module")
def of_codec():
    left = []
    return list(codec.STUDY.run(little(left_out=left))), left


def test_every_way_is_measured_on_every_set_or_named_and_keeps_its_bound(of_codec):
    records, left = of_codec
    sets = {record.data for record in records}
    assert len(sets) == 4
    named = {item.what for item in left}
    for method in codec.variants(True):
        found = [record for record in records if (record.method, record.setting) == (method.name, method.setting)]
        assert len(found) == 4 or method.name in named
    assert all(record.default for record in records if record.label == "fiblets (default)")
    assert all(record.costs["size"].value > 0.5 for record in records)
    assert all(timing.median > 0.0 for record in records for timing in record.times.values())
    for record in of_codec[0]:
        if record.ours:
            promise = 0.1 if record.setting == codec.DEFAULT else float(record.setting.split()[0])
            assert record.errors["max in steps"].value <= promise * (1.0 + 1e-6)


def test_records_of_fewer_points():
    offsets = np.array([0, 0, 31, 60, 61])
    np.testing.assert_array_equal(codec.recut(offsets, 30), [0, 0, 30, 31, 60, 61])
    np.testing.assert_array_equal(codec.recut(offsets, 60), offsets)
    streamlines = data_sets.synthetic_tracking(0.2, False, 1500, 0)
    points, lines = streamlines.points, np.asarray(streamlines.offsets)
    packed = codec._fiblets(0.1, "fast", 15)(0.2)(points, lines)
    from pvfiblets.codec.layout import unpack

    assert unpack("last", packed.fiblets.decoding).max() == 14
    assert packed.nbytes == packed.fiblets.nbytes - 4 * (packed.fiblets.n_streamlines - len(streamlines))
    assert codec._fiblets(0.1, "fast")(0.2)(points, lines).nbytes == compress(streamlines, max_error=0.02).nbytes


def test_a_missing_package_is_named_once(monkeypatch):
    monkeypatch.setitem(sys.modules, "zstandard", None)
    left = []
    records = list(codec.STUDY.run(little(left_out=left)))
    assert [item for item in left if "zstd" in item.what] == [LeftOut("zstd of float32", "zstandard is not installed")]
    assert not any(record.method.startswith("zstd") for record in records)


# ------------------------------------------------------------------------------------------------------------- decode


def decoded(made, dtype, how):
    arrays = [np.ascontiguousarray(a.astype(dtype)) for a in (made.anchors, made.frames)]
    scratch = tuple(np.zeros((64, width), dtype) for width in (4, 9, 3))
    out = np.empty((len(made.codes), decoders.POINTS, 3), dtype)
    decoders.decode(*arrays, made.codes, made.cap, np.array([made.step], dtype), how, decoders.inputs(dtype), scratch,
                    out)  # fmt: skip
    return out


EVERY = [(order, algebra, source) for order in (0, 1) for algebra in (0, 1) for source in (0, 1, 2)]


@pytest.mark.more
@pytest.mark.parametrize(
    "cap", [pytest.param(0, marks=pytest.mark.exhaustive), 7, pytest.param(15, marks=pytest.mark.exhaustive)]
)
def test_all_variants_of_decoding_mean_the_same(cap):
    made = decode.made(20, cap, 0.2, 0)
    right = decode.exact(made)
    for how in EVERY:
        off = np.abs(decoded(made, np.float64, how) - right).max()
        # Quaternions of float32 are of unit length within 1e-7, the closed form is off by the table's rounding.
        assert off < (0.2 * 60 * 60 * 1e-4 if how[2] == decoders.CLOSED else 0.2 * 60 * 60 * 1e-6)
        assert np.abs(decoded(made, np.float32, how) - right).max() < 0.2 * 0.1
    sequential = decoded(made, np.float64, (decoders.SEQUENTIAL, decoders.QUATERNION, decoders.TABLE))
    assert np.abs(sequential - right).max() < 1e-11


def test_what_codes_mean_is_what_the_codec_decodes():
    rng = np.random.default_rng(0)
    points = np.cumsum(0.2 * np.array([1.0, 0.0, 0.0]) + rng.normal(0.0, 0.01, (60, 3)), axis=0)
    piece = encode_direction(points, points[0], 0, 0.2, 9)
    made = decode.Made(points[None, 0], first_frame(piece.shape)[1][None], piece.codes[None], 9, 0.2)
    assert np.abs(decode.exact(made)[0] - piece.points).max() < 1e-12


def test_the_study_of_decoding_measures_all_variants(monkeypatch):
    monkeypatch.setattr(decode, "QUICK_FIBLETS", 10)
    left = []
    records = list(decode.STUDY.run(little(left_out=left)))
    assert not left
    assert len(records) == 4 * 24
    assert sum(record.default for record in records) == 4
    by_label = {record.label: record for record in records[:24]}
    exact = by_label["sequential, float64 (quaternions, table)"]
    assert exact.errors["max in steps"].value < 1e-10
    assert exact.errors["mean at point 1"].unit == "steps"


# ---------------------------------------------------------------------------------------------------------- framework


class Clock:
    def __init__(self):
        self.now = 0.0

    def __call__(self):
        return self.now


class FakeStudy:
    """Takes so many seconds for each measurement, and asks its budget before each."""

    title, approximates, notes = "Fake", "nothing", ("a note",)
    across = ()
    axes = (Axes("cost", "costs/size", "errors/max", "x", "y"),)

    def __init__(self, name, clock, seconds, wanted):
        self.name, self.clock, self.seconds, self.wanted = name, clock, seconds, wanted

    def run(self, options):
        for i in range(self.wanted):
            if not options.allows(f"{i}"):
                continue
            self.clock.now += self.seconds
            yield Record("set", "g", "nothing", "method", f"{i}", {"max": Figure(1.0 / (i + 1), "mm")},
                         {"size": Figure(float(i + 1), "bytes")}, default=i == 0)  # fmt: skip


@pytest.fixture
def fakes(monkeypatch):
    def use(*made):
        by_name = {study.name: study for study in made}
        monkeypatch.setattr(studies, "MODULES", dict.fromkeys(by_name, ""))
        monkeypatch.setattr(studies, "find", by_name.__getitem__)

    return use


def test_a_quick_report_keeps_to_its_time(fakes, tmp_path):
    clock = Clock()
    fakes(FakeStudy("slow", clock, 7.0, 100), FakeStudy("brief", clock, 1.0, 3), FakeStudy("last", clock, 3.0, 100))
    report = run.make_report(tmp_path, quick=True, log=quiet, clock=clock)
    assert clock.now <= run.QUICK_SECONDS - run.PLOT_SECONDS
    counts = [len(study.records) for study in report.studies]
    third = (run.QUICK_SECONDS - run.PLOT_SECONDS) / 3
    assert counts[0] == third // 7
    assert counts[1] == 3
    assert counts[2] * 3.0 > third  # what the second did not need went to the third
    assert [len(study.records) + len(study.left_out) for study in report.studies] == [100, 3, 100]


def test_a_whole_report_has_no_limit_and_minutes_are_shared(fakes, tmp_path):
    clock = Clock()
    fakes(FakeStudy("slow", clock, 1000.0, 5))
    report = run.make_report(tmp_path, log=quiet, clock=clock)
    assert len(report.studies[0].records) == 5
    assert all(record.front == ["cost"] for record in report.studies[0].records)
    assert {record.machine for record in report.studies[0].records} == {report.about["name"]}
    fakes(FakeStudy("slow", clock, 50.0, 10), FakeStudy("brief", clock, 1.0, 3))
    report = run.make_report(tmp_path, minutes=10.0, log=quiet, clock=clock)
    assert [len(study.records) for study in report.studies] == [6, 3]
    assert len(report.studies[0].left_out) == 4
    assert report.about["quick"] is False


def test_a_budget_looks_at_what_the_longest_took():
    clock = Clock()
    budget = Budget(10.0, clock)
    assert budget.allows()
    clock.now = 4.0
    assert budget.allows()
    clock.now = 7.0
    assert not budget.allows()  # 3 are left, and one took 4
    assert budget.left == 3.0
    clock.now = 20.0
    assert budget.left == 0.0


def test_a_study_that_cannot_be_done_is_named_with_its_reason(fakes, tmp_path):
    class Away(FakeStudy):
        def run(self, options):
            raise Unavailable("no OpenGL context can be made here")
            yield

    fakes(Away("away", Clock(), 1.0, 1))
    report = run.make_report(tmp_path, log=quiet)
    assert report.studies[0].unavailable == "no OpenGL context can be made here"
    text = run.write_pages(report, tmp_path, log=quiet).read_text()
    assert "| away | not available | no OpenGL context can be made here |" in text


@pytest.mark.parametrize(("wrong", "said"), [({"minutes": 0.0}, "minutes is 0.0"), ({"seed": -1}, "seed is -1"),
                                             ({"minutes": float("nan")}, "minutes is nan")])  # fmt: skip
def test_wrong_minutes_and_seeds_are_told(fakes, tmp_path, wrong, said):
    fakes(FakeStudy("brief", Clock(), 1.0, 1))
    with pytest.raises(ValueError, match=said):
        run.make_report(tmp_path, log=quiet, **wrong)


def test_a_run_that_is_cut_keeps_every_record_before(fakes, tmp_path):
    clock = Clock()

    class Cut(FakeStudy):
        def run(self, options):
            for record in super().run(options):
                if len(kept()) == 3:
                    raise KeyboardInterrupt
                yield record

    def kept():
        path = tmp_path / "report.json"
        return Report.load(path).studies[0].records if path.exists() else []

    fakes(Cut("cut", clock, 1.0, 5))
    with pytest.raises(KeyboardInterrupt):
        run.make_report(tmp_path, log=quiet, clock=clock)
    assert len(kept()) == 3


def test_saving_takes_a_small_part_of_the_time(fakes, tmp_path, monkeypatch):
    clock, save = Clock(), Report.save

    def slow(self, folder):
        clock.now += 2.0
        return save(self, folder)

    monkeypatch.setattr(Report, "save", slow)
    fakes(FakeStudy("brief", clock, 1.0, 1000))
    run.make_report(tmp_path, log=quiet, clock=clock)
    assert 1000 < clock.now < 1000 * (1.0 + 1.5 * run.SAVE_SHARE) + 4.0


@pytest.mark.parametrize("name", [*studies.MODULES])
def test_registered_studies_are_what_they_say(name):
    study = studies.find(name)
    assert study.name == name
    assert study.title
    assert study.axes or name == "stability"  # whose cases are told in words
    assert (name in studies.chosen_names()) != (name in studies.ONLY_NAMED)
    assert studies.chosen_names([name]) == [name]


def test_the_commands_help_names_all_studies(capsys):
    with pytest.raises(SystemExit):
        main(["report", "--help"])
    told = " ".join(capsys.readouterr().out.split())
    assert set(studies.MODULES) <= set(told.replace(",", " ").replace(";", " ").replace(":", " ").split())


def test_a_study_that_draws_has_a_context_and_the_report_its_driver(gl, monkeypatch, tmp_path):
    class Drawing:
        name, title, approximates, axes, notes, across = "drawing", "Drawing", "", (), (), ()

        def run(self, options):
            with drawing.drawing_context(options) as ctx:
                self.version = ctx.info["GL_VERSION"]
                yield from ()

    study = Drawing()
    monkeypatch.setattr(studies, "MODULES", {"drawing": ""})
    monkeypatch.setattr(studies, "find", lambda name: study)
    report = run.make_report(tmp_path, log=lambda line: None)
    assert report.about["driver"] == f"{gl.info['GL_RENDERER']}, {study.version}"


def test_pictures_that_the_processor_draws_are_timed_by_its_time(gl):
    turns = timing.turns_of(gl)
    turns.add(gl.finish)
    software = "llvmpipe" in gl.info["GL_RENDERER"] or "softpipe" in gl.info["GL_RENDERER"]
    assert turns.timing(0, 1, "frame").clock == ("cpu" if software else "wall")


def test_without_opengl_a_study_is_unavailable_with_the_reason(monkeypatch):
    code = (
        "from pvfiblets.report.drawing import drawing_context\n"
        "from pvfiblets.report.study import Options, Unavailable\n"
        "try:\n"
        "    with drawing_context(Options()):\n"
        "        print('there is one')\n"
        "except Unavailable as error:\n"
        "    print(error)"
    )
    nothing = {"GLCONTEXT_LINUX_LIBEGL": "libnothing.so", "GLCONTEXT_LINUX_LIBGL": "libnothing.so"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          env=os.environ | nothing)  # fmt: skip
    assert done.stdout.startswith("no OpenGL 3.2 or later could be started on this machine")
    monkeypatch.setitem(sys.modules, "moderngl", None)
    with pytest.raises(Unavailable, match="moderngl"), drawing.drawing_context(Options()):
        pass


@pytest.mark.parametrize("name", ["culling", "features", "halos", "tubes", "volumes"])
def test_a_study_that_draws_is_unavailable_without_opengl(name, monkeypatch):
    monkeypatch.setitem(sys.modules, "moderngl", None)
    with pytest.raises(Unavailable, match="moderngl"):
        list(studies.find(name).run(little()))
