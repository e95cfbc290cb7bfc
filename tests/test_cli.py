"""The command: what it prints, writes and returns, called as a user calls it."""

from __future__ import annotations

import argparse
import gzip
import json
import os
import re
import subprocess
import sys

import nibabel as nib
import numpy as np
import pytest
from PIL import Image

from pvfiblets import formats, memory, regions
from pvfiblets.cli import main, make_parser
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.report.errors_and_times import direction_angles
from pvfiblets.streamlines import Streamlines
from pvfiblets.synthetic import brain_streamlines

CONVERT_KEYS = {
    "streamlines", "points", "fiblets", "bytes", "bytes_per_point", "error_mm", "error_steps", "error_degrees",
    "seconds", "points_per_second", "dropped",
}  # fmt: skip


@pytest.fixture(scope="module")
def tractogram(tmp_path_factory):
    """A small whole-brain-like file with one per-point array, and its streamlines."""
    brain = brain_streamlines(300, 0.5, seed=4, fa=True)
    path = tmp_path_factory.mktemp("cli") / "brain.trx"
    formats.write(path, brain)
    return path, brain


@pytest.fixture
def compressed(tractogram, tmp_path, capsys):
    path = tmp_path / "brain.fiblets"
    assert main(["convert", str(tractogram[0]), str(path), "--json"]) == 0
    capsys.readouterr()
    return path


def fails(capsys, *arguments):
    """Run, expect exit code 1, and return the one sentence on standard error."""
    assert main([str(argument) for argument in arguments]) == 1
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert "Traceback" not in captured.err
    return captured.err


def test_convert_reports_what_it_made(tractogram, tmp_path, capsys):
    source, brain = tractogram
    target = tmp_path / "out.fiblets"
    assert main(["convert", str(source), str(target), "--per-point", "fa", "--json"]) == 0
    captured = capsys.readouterr()
    result = json.loads(captured.out)
    assert set(result) >= CONVERT_KEYS
    assert result["streamlines"] == 300
    assert result["points"] == brain.n_points
    assert result["bytes"] == target.stat().st_size
    assert result["bytes_per_point"] == pytest.approx(target.stat().st_size / brain.n_points)
    assert result["dropped"] == {}
    assert set(result["error_mm"]) == set(result["error_steps"]) == {"max", "mean", "p999"}
    assert captured.err == ""

    back = formats.read(target)
    error = np.linalg.norm(back.points.astype(float) - brain.points.astype(float), axis=1)
    assert result["error_mm"]["max"] == pytest.approx(error.max(), rel=0.02)
    assert result["error_mm"]["mean"] == pytest.approx(error.mean(), rel=0.02)
    assert result["error_steps"]["max"] == pytest.approx(error.max() / 0.5, rel=0.02)
    firsts = FibletSet.open(target).fiblet_points()
    angles = direction_angles(brain.points, back.points, brain.offsets, firsts)
    assert result["error_degrees"]["max"] == pytest.approx(angles.max(), rel=0.02)
    assert result["error_degrees"]["mean"] == pytest.approx(angles.mean(), rel=0.02)
    assert result["error_degrees"]["p99"] == pytest.approx(np.quantile(angles, 0.99), rel=0.05)
    np.testing.assert_allclose(back.per_point["fa"].ravel(), brain.per_point["fa"], atol=0.003)


@pytest.mark.parametrize(
    ("words", "kept"),
    [
        ([], ["height", "tensor"]),
        (["--per-point-bits", "16"], ["height"]),
        (["--per-point", "all"], ["height", "tensor", "wide"]),
        (["--per-point", "none"], []),
        (["--per-point", "wide", "--per-point", "height"], ["wide", "height"]),
    ],
)
def test_convert_keeps_values_of_points_and_names_those_that_stay_behind(tmp_path, capsys, words, kept):
    """By default those are kept that fit into 16 bytes a point: 1 + 9 of 1 + 9 + 9; at 16 bits 2 of 2 + 18 + 18."""
    rng = np.random.default_rng(0)
    values = {"height": rng.random(60), "tensor": rng.random((60, 9)), "wide": rng.random((60, 9)) * 100.0}
    lines = Streamlines(np.cumsum(rng.random((60, 3)), axis=0), [0, 20, 60], per_point=values)
    source, target = tmp_path / "a.trx", tmp_path / "a.fiblets"
    formats.write(source, lines)
    assert main(["convert", str(source), str(target), *words, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    flat = {
        f"{name}[{k}]" if values[name].ndim > 1 else name: values[name].reshape(60, -1)[:, k]
        for name in kept
        for k in range(values[name].size // 60)
    }
    assert result["per_point"] == list(flat)
    back = formats.read(target)
    assert list(back.per_point) == list(flat)
    for name, column in flat.items():
        np.testing.assert_allclose(back.per_point[name].ravel(), column, atol=0.003 * np.ptp(column))
    behind = [name for name in values if name not in kept]
    for command in (["convert", str(source), str(target), *words], ["info", str(target)]):
        assert main(command) == 0
        out = capsys.readouterr().out
        assert all(name in out for name in [*flat, *behind])
        assert ("not kept" in out) == bool(behind)


def test_an_array_named_beside_all_or_none_is_refused(tractogram, tmp_path, capsys):
    words = ["--per-point", "none", "--per-point", "fa"]
    assert "give all, or none, or names" in fails(capsys, "convert", tractogram[0], tmp_path / "a.fiblets", *words)


def test_convert_keeps_the_colours_of_a_real_file(shared_data, tmp_path, capsys):
    source, target = shared_data / "trxpy_small.trx", tmp_path / "a.fiblets"
    assert main(["convert", str(source), str(target), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["dropped"] == {}
    original, back = formats.read(source), formats.read(target)
    assert set(back.per_point) == set(original.per_point) == {"fa", "color_x", "color_y", "color_z"}
    for name, values in original.per_point.items():
        values = values.astype(float).ravel()
        np.testing.assert_allclose(back.per_point[name].ravel(), values, atol=0.002 * np.ptp(values))


def test_convert_keeps_the_promise_that_was_asked_for(tractogram, tmp_path, capsys):
    main(["convert", str(tractogram[0]), str(tmp_path / "a.fiblets"), "--max-error", "0.004", "--json"])
    assert json.loads(capsys.readouterr().out)["error_mm"]["max"] <= 0.004 * 1.01


def test_convert_keeps_the_directions_that_were_asked_for(tractogram, tmp_path, capsys):
    largest = []
    for angle in ("none", "1.5"):
        words = ["--max-error", "0.2", "--max-angle", angle, "--json"]
        assert main(["convert", str(tractogram[0]), str(tmp_path / "a.fiblets"), *words]) == 0
        largest.append(json.loads(capsys.readouterr().out)["error_degrees"]["max"])
    assert largest[0] > 2.0 > largest[1]  # these lines turn by more than 1.5 degrees wherever a fiblet could begin
    assert main(["convert", str(tractogram[0]), str(tmp_path / "a.trk"), "--max-angle", "none"]) == 1
    assert "--max-angle" in capsys.readouterr().err


def test_convert_speaks_to_people_too(tractogram, tmp_path, capsys):
    assert main(["convert", str(tractogram[0]), str(tmp_path / "a.fiblets")]) == 0
    out = capsys.readouterr().out
    assert "300 streamlines" in out
    assert "steps" in out
    assert "directions: max" in out
    assert "per point" in out


@pytest.mark.parametrize("suffix", [".tck", ".trk"])
def test_convert_out_of_the_compressed_form_is_read_by_nibabel(compressed, tractogram, tmp_path, capsys, suffix):
    target = tmp_path / f"back{suffix}"
    assert main(["convert", str(compressed), str(target), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert set(result) >= CONVERT_KEYS
    assert result["error_mm"] is result["error_degrees"] is None
    loaded = nib.streamlines.load(target).streamlines
    assert len(loaded) == 300
    np.testing.assert_allclose(loaded.get_data(), tractogram[1].points, atol=0.06)


@pytest.mark.filterwarnings("default:.*reading left out")
def test_info_and_table_state_what_a_header_gets_wrong(tmp_path, capsys):
    """Counts of the file, and the bytes that a .trk header leaves out (988: number of streamlines)."""
    lines = Streamlines(np.random.default_rng(0).random((9, 3)).astype(np.float32), [0, 3, 6, 9])
    for name in ("a.trk", "a.tck"):
        formats.write(tmp_path / name, lines)
    data = bytearray((tmp_path / "a.trk").read_bytes())
    data[988:992] = (2).to_bytes(4, "little")
    (tmp_path / "a.trk").write_bytes(data)
    (tmp_path / "a.tck").write_bytes((tmp_path / "a.tck").read_bytes().replace(b"count: 3", b"count: 9"))
    for name, found, dropped in (
        ("a.trk", (2, 6), {"bytes after the last streamline": 40}),
        ("a.tck", (3, 9), {"streamlines that the header's count promises and the file lacks": 6}),
    ):
        assert main(["info", str(tmp_path / name), "--json"]) == 0
        facts = json.loads(capsys.readouterr().out)
        assert ((facts["streamlines"], facts["points"]), facts["dropped"]) == (found, dropped)
        assert main(["info", str(tmp_path / name)]) == 0
        (reason, count), = dropped.items()
        assert f"{count}: {reason}" in capsys.readouterr().out
        assert main(["table", str(tmp_path / name), str(tmp_path / "a.csv")]) == 0
        assert f"{reason}: {count}" in capsys.readouterr().err


def test_convert_writes_doubles_if_asked(tmp_path, capsys):
    source, target = tmp_path / "a.trx", tmp_path / "a.tck"
    formats.write(source, Streamlines(np.full((2, 3), 1e6 + 0.1), [0, 2]))
    assert main(["convert", str(source), str(target), "--double"]) == 0
    assert formats.info(target)["dtype"] == "float64"
    assert "--double is for .tck and .vtk files" in fails(capsys, "convert", source, tmp_path / "a.trk", "--double")


def test_info_of_both_forms_agrees(compressed, tractogram, capsys):
    facts = []
    for path in (compressed, tractogram[0]):
        assert main(["info", str(path), "--json"]) == 0
        facts.append(json.loads(capsys.readouterr().out))
        assert facts[-1]["bytes"] == path.stat().st_size
        assert main(["info", str(path)]) == 0
        assert "streamlines" in capsys.readouterr().out
    assert facts[0]["streamlines"] == facts[1]["streamlines"] == 300
    assert facts[0]["points"] == facts[1]["points"] == tractogram[1].n_points


def test_verify_measures_against_the_original(compressed, tractogram, capsys):
    assert main(["verify", str(compressed), str(tractogram[0]), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["kept"] is result["directions_kept"] is True
    assert 0.0 < result["error_mm"]["max"] <= result["promise_mm"]
    assert 0.0 < result["error_degrees"]["mean"] < result["error_degrees"]["p99"] < result["error_degrees"]["max"]
    tight = f"{0.5 * result['error_degrees']['max']}"
    assert main(["verify", str(compressed), str(tractogram[0]), "--max-angle", tight, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["directions_kept"] is False
    assert main(["verify", str(compressed)]) == 0


def test_verify_finds_a_flipped_bit_a_moved_point_and_another_original(compressed, tractogram, tmp_path, capsys):
    moved = tmp_path / "moved.trx"
    brain = tractogram[1][:]
    brain.points = brain.points.copy()
    brain.points[1000] += 1.0
    formats.write(moved, brain)
    assert "more than" in fails(capsys, "verify", compressed, moved)

    other = tmp_path / "other.tck"
    formats.write(other, brain_streamlines(300, seed=9))
    assert "was not made from" in fails(capsys, "verify", compressed, other)

    content = bytearray(compressed.read_bytes())
    content[len(content) // 2] ^= 4
    damaged = tmp_path / "damaged.fiblets"
    damaged.write_bytes(content)
    assert "damaged.fiblets" in fails(capsys, "verify", damaged, tractogram[0])


def test_verify_alone_finds_a_changed_byte_that_leaves_sense(compressed, tmp_path, capsys):
    """A direction code may be any byte: only the checksum knows."""
    from pvfiblets.codec.fibletset import FibletSet

    codes = FibletSet.open(compressed).codes
    data = bytearray(compressed.read_bytes())
    data[codes.offset + len(codes) // 2] ^= 1
    changed = tmp_path / "changed.fiblets"
    changed.write_bytes(data)
    assert "changed bytes in codes.npy" in fails(capsys, "verify", changed)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["info", "missing.trk"], "missing.trk"),
        (["convert", "missing.trk", "a.fiblets"], "missing.trk"),
        (["convert", "missing.trk", "a.xyz"], "suffix"),
        (["convert", "same.tck", "same.tck"], "overwritten by itself"),
        (["verify", "missing.tck"], "no .fiblets file"),
        (["screenshot", "missing.tck", "-o", "a.png"], "missing.tck"),
        (["screenshot", "missing.tck", "-o", "a.doc"], "a.doc"),
    ],
)
def test_failures_are_one_plain_sentence(arguments, says, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert says in fails(capsys, *arguments)
    assert not list(tmp_path.iterdir())


def test_a_broken_file_is_one_plain_sentence_and_leaves_nothing(tmp_path, capsys):
    (tmp_path / "a.trk").write_bytes(b"TRACK" + bytes(300))
    assert "a.trk" in fails(capsys, "convert", tmp_path / "a.trk", tmp_path / "b.fiblets")
    assert [path.name for path in tmp_path.iterdir()] == ["a.trk"]


def test_an_unknown_array_lists_those_that_exist(tractogram, tmp_path, capsys):
    assert "fa" in fails(capsys, "convert", tractogram[0], tmp_path / "a.fiblets", "--per-point", "md")
    assert "curvature" in fails(capsys, "screenshot", tractogram[0], "-o", tmp_path / "a.png", "--scalars", "md")


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["compress", "a.trk"],
        ["convert", "a.trk"],
        ["convert", "a.trk", "b.fiblets", "--step", "-1"],
        ["convert", "a.trk", "b.fiblets", "--max-error", "nan"],
        ["screenshot", "a.trk"],
        ["screenshot", "a.trk", "-o", "a.png", "--size", "big"],
        ["screenshot", "a.trk", "-o", "a.png", "--size", "0x5"],
        ["screenshot", "a.trk", "-o", "a.png", "--view", "sideways"],
        ["screenshot", "a.trk", "-o", "a.png", "--antialias", "much"],
        ["serve", "--antialias", "1"],
        ["demo", "--streamlines", "0"],
    ],
)
def test_wrong_usage_is_exit_code_2(arguments, capsys):
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    assert exit_.value.code == 2
    assert "usage:" in capsys.readouterr().err


def test_every_command_and_each_of_its_arguments_says_what_it_does():
    commands = next(action for action in make_parser()._actions if isinstance(action, argparse._SubParsersAction))
    for name, command in commands.choices.items():
        assert command.description, name
        silent = [action.dest for action in command._actions if not action.help]
        assert not silent, name


def test_help_and_version_are_exit_code_0(capsys):
    for arguments in (["--help"], ["--version"], ["convert", "--help"]):
        with pytest.raises(SystemExit) as exit_:
            main(arguments)
        assert exit_.value.code == 0
    assert "pvfiblets" in capsys.readouterr().out


@pytest.mark.parametrize("view", ["axial", "coronal", "sagittal", "oblique"])
def test_a_screenshot_shows_the_brain_the_right_way_up(tractogram, tmp_path, view):
    picture = tmp_path / f"{view}.png"
    source, brain = tractogram
    arguments = ["screenshot", str(source), "-o", str(picture), "--size", "300x200", "--view", view]
    assert main([*arguments, "--color", "white", "--no-lighting"]) == 0
    pixels = np.asarray(Image.open(picture).convert("L")) > 0
    assert pixels.shape == (200, 300)
    rows, columns = np.nonzero(pixels)
    assert len(rows) > 2000
    if view == "oblique":
        return
    # Project the points by hand: which axis grows to the right, and which one upwards.
    right, up = {"axial": (0, 1), "coronal": (0, 2), "sagittal": (1, 2)}[view]
    to_the_right = {"axial": 1, "coronal": -1, "sagittal": -1}[view] * brain.points[:, right]
    aspect = np.ptp(to_the_right) / np.ptp(brain.points[:, up])
    assert np.ptp(columns) / np.ptp(rows) == pytest.approx(aspect, rel=0.15)
    # Where the far half of the brain is wide, so is the picture: the outline is not upside down.
    edges = np.linspace(brain.points[:, up].min(), brain.points[:, up].max(), 9)
    counts, _ = np.histogram(brain.points[:, up], edges)
    drawn, _ = np.histogram(-rows, np.linspace(-rows.max() - 0.5, -rows.min() + 0.5, 9))
    assert np.corrcoef(counts, drawn)[0, 1] > np.corrcoef(counts[::-1], drawn)[0, 1]


def test_a_screenshot_with_a_scalar_bar_and_with_two_files(tractogram, compressed, tmp_path):
    picture = tmp_path / "two.png"
    arguments = ["screenshot", str(compressed), str(tractogram[0]), "-o", str(picture), "--scalars", "length"]
    assert main([*arguments, "--cmap", "plasma", "--clim", "20", "150", "--line-width", "2", "--size", "400x300"]) == 0
    colours = np.unique(np.asarray(Image.open(picture).convert("RGB")).reshape(-1, 3), axis=0)
    assert len(colours) > 100


def test_screenshots_are_refined_as_they_are_told(tractogram, tmp_path):
    colours = []
    for how in ("off", "2", "refined"):
        picture = tmp_path / f"{how}.png"
        arguments = ["screenshot", str(tractogram[0]), "-o", str(picture), "--size", "90x60", "--color", "white"]
        assert main([*arguments, "--no-lighting", "--antialias", how]) == 0
        colours.append(len(np.unique(np.asarray(Image.open(picture).convert("L")))))
    assert colours == [2, 3, 17]


def test_show_says_that_there_is_no_display(tractogram, capsys, monkeypatch):
    if not sys.platform.startswith("linux"):
        pytest.skip("needs Linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert "no display" in fails(capsys, "show", tractogram[0])


def test_the_demo_writes_and_prints_what_it_promises(tmp_path, capsys):
    assert main(["demo", "--output", str(tmp_path / "demo"), "--streamlines", "400"]) == 0
    out = capsys.readouterr().out
    assert "bytes per point" in out
    assert {path.name for path in (tmp_path / "demo").iterdir()} == {"brain.tck", "brain.fiblets", "brain.png"}
    assert np.asarray(Image.open(tmp_path / "demo" / "brain.png")).any()


def test_the_installed_command_runs_and_survives_a_closed_pipe(tractogram):
    command = [sys.executable, "-m", "pvfiblets.cli", "info", str(tractogram[0])]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert done.stderr == ""
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as gone:
        done = subprocess.run(command, stdout=gone, stderr=subprocess.PIPE, text=True, check=False)
    assert "Traceback" not in done.stderr


needs_limit = pytest.mark.skipif(not memory.CAN_LIMIT, reason="only Linux limits the data of a process")


@needs_limit
def test_what_takes_more_memory_than_it_may_is_one_sentence(tmp_path, capsys):
    path = tmp_path / "a.tt.gz"  # which is read whole
    path.write_bytes(gzip.compress(bytes(400 << 20), 1))
    before = memory.limited_to()
    most = f"{memory.taken() // 2**20 + 300}M"
    said = fails(capsys, "convert", path, tmp_path / "a.fiblets", "--max-memory", most)
    assert re.search(r"more memory than the [\d.]+ .B of --max-memory \(it says that it takes .*; give it more", said)
    assert memory.limited_to() == before


@pytest.mark.parametrize("command", [["serve"], ["batch", "convert", "a.tck", "-o", "out"]])
def test_the_limit_of_memory_has_one_word_and_its_older_one(command):
    for word in ("--max-memory", "--memory"):
        assert make_parser().parse_args([*command, word, "3G"]).memory == "3G"


@needs_limit
def test_a_limit_of_memory_that_is_none_is_refused(tractogram, tmp_path, capsys):
    target = tmp_path / "a.fiblets"
    assert "'much' is no size of memory" in fails(capsys, "convert", tractogram[0], target, "--max-memory", "much")
    assert "are needed to begin with" in fails(capsys, "info", tractogram[0], "--max-memory", "5M")
    assert not target.exists()


@needs_limit
def test_a_program_that_has_much_memory_can_run_a_command(tractogram, tmp_path, capsys, monkeypatch):
    """As tests do, and notebooks: what they have was not taken by the command."""
    monkeypatch.setattr(memory, "taken", lambda: 2 * memory.of_machine())
    assert main(["convert", str(tractogram[0]), str(tmp_path / "a.fiblets")]) == 0
    assert memory.limited_to() is None
    assert "are needed to begin with" in fails(capsys, "info", tractogram[0], "--max-memory", "40%")


@pytest.mark.parametrize("points", [np.zeros((1, 3)), np.zeros((2, 3)), np.full((4, 3), 7.5), np.full((3, 3), 1e-310)])
def test_sets_without_extent_are_told_in_sensible_numbers(points, tmp_path, capsys):
    source, target = tmp_path / "a.trx", tmp_path / "a.fiblets"
    formats.write(source, Streamlines(points, [0, len(points)]))
    assert main(["convert", str(source), str(target), "--no-exact"]) == 0
    assert main(["info", str(target)]) == 0
    assert main(["verify", str(target), str(source)]) == 0
    said = capsys.readouterr().out
    assert not re.search(r"\bnan\b|\binf\b|None|e-[0-9]{3}", said), said
    assert "less than 1e-30" in said or "promise_mm       0" in said or "e-" in said


def test_convert_keeps_a_spatial_index_and_says_what_it_takes(tractogram, tmp_path, capsys, monkeypatch):
    from pvfiblets.codec import convert

    source, target = tractogram[0], tmp_path / "a.fiblets"
    plain, written, write = tmp_path / "plain.fiblets", [], convert.write_archive
    assert main(["convert", str(source), str(plain), "--no-exact"]) == 0
    capsys.readouterr()
    monkeypatch.setattr(convert, "write_archive", lambda path, *more: written.append(path) or write(path, *more))
    assert main(["convert", str(source), str(target), "--no-exact", "--index", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    data = FibletSet.open(target)
    assert result["index_bytes"] == regions.index_of(data).nbytes > 0
    assert result["index_seconds"] > 0.0 == regions.index_of(data).seconds
    assert result["bytes"] == target.stat().st_size
    assert len(written) == 1  # with its index at once
    other, data = regions.index_of(FibletSet.open(plain)), regions.index_of(data)
    for name in ("order", "leaves", "pieces"):
        np.testing.assert_array_equal(getattr(data, name), getattr(other, name))
    assert main(["info", str(target), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["index_bytes"] == result["index_bytes"]
    assert main(["convert", str(source), str(target), "--exact", "--index"]) == 0
    assert "index    none" in capsys.readouterr().out
    assert "leave it out" in fails(capsys, "convert", source, tmp_path / "a.tck", "--index")
