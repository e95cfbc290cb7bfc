"""The command: what it prints, writes and returns, called as a user calls it."""

import argparse
import gzip
import io
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from PIL import Image

from pvfiblets import formats, regions
from pvfiblets.cli.command import main, make_parser
from pvfiblets.codec.fibletset import FibletSet
from pvfiblets.engine.gl.capabilities import PIPELINES
from pvfiblets.formats.recognise import suffix_by_content
from pvfiblets.report.studies.codec.errors import direction_angles
from pvfiblets.streamlines import Streamlines
from pvfiblets.support import memory
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


def test_refusals_of_arrays_list_those_that_exist(tractogram, tmp_path, capsys):
    words = ["--per-point", "none", "--per-point", "fa"]
    assert "give all, or none, or names" in fails(capsys, "convert", tractogram[0], tmp_path / "a.fiblets", *words)
    assert "fa" in fails(capsys, "convert", tractogram[0], tmp_path / "a.fiblets", "--per-point", "md")
    assert "curvature" in fails(capsys, "screenshot", tractogram[0], "-o", tmp_path / "a.png", "--scalars", "md")


def test_convert_keeps_the_colours_of_a_real_file(shared_data, tmp_path, capsys):
    source, target = shared_data / "trxpy_small.trx", tmp_path / "a.fiblets"
    assert main(["convert", str(source), str(target), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["dropped"] == {}
    original, back = formats.read(source), formats.read(target)
    assert set(back.per_point) == set(original.per_point) == {"fa", "color_x", "color_y", "color_z"}
    for name, values in original.per_point.items():
        values = values.astype(float).ravel()
        np.testing.assert_allclose(back.per_point[name].ravel(), values, atol=0.002 * np.ptp(values))


def test_convert_keeps_the_error_and_the_directions_that_were_asked_for(tractogram, tmp_path, capsys):
    main(["convert", str(tractogram[0]), str(tmp_path / "a.fiblets"), "--max-error", "0.004", "--json"])
    assert json.loads(capsys.readouterr().out)["error_mm"]["max"] <= 0.004 * 1.01
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
        ((reason, count),) = dropped.items()
        assert f"{count}: {reason}" in capsys.readouterr().out
        assert main(["table", str(tmp_path / name), str(tmp_path / "a.csv")]) == 0
        assert f"{reason}: {count}" in capsys.readouterr().err


@pytest.mark.filterwarnings("default:.*reading left out")
@pytest.mark.parametrize("options", ["--voxel 2", "--voxel 2 --contrast direction", "--like grid.nii"])
def test_a_command_says_once_what_reading_left_out(tmp_path, capsys, options):
    source, said = tmp_path / "nan.vtp", "(non-finite points: 2)"  # of both segments that end there
    pv.lines_from_points(np.array([[0.0, 1, 0], [9, 1, 0], [np.nan, 3, 0], [0, 5, 0], [9, 5, 0]])).save(source)
    formats.write(tmp_path / "one.trk", Streamlines(np.array([[0.0, 0, 0], [9.0, 9, 0]]), [0, 2]))
    assert main(["density", str(tmp_path / "one.trk"), str(tmp_path / "grid.nii"), "--voxel", "3"]) == 0
    capsys.readouterr()
    words = options.replace("grid.nii", str(tmp_path / "grid.nii")).split()
    assert main(["density", str(source), str(tmp_path / "d.nii"), *words]) == 0
    out, error = capsys.readouterr()
    assert error.count(said) == 1
    assert re.search(r"^(count|direction) +0 to", out, re.MULTILINE)
    assert main(["convert", str(source), str(tmp_path / "n.fiblets")]) == 0
    assert main(["verify", str(tmp_path / "n.fiblets"), str(source)]) == 0
    assert capsys.readouterr().out.count("2: non-finite points") == 2  # once by each
    assert main(["verify", str(tmp_path / "n.fiblets"), str(source), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["dropped"]["non-finite points"] == 2


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


def test_verify_finds_flipped_bits_a_moved_point_and_another_original(compressed, tractogram, tmp_path, capsys):
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
    # A direction code may be any byte: only the checksum knows.
    from pvfiblets.codec.fibletset import FibletSet

    codes = FibletSet.open(compressed).codes
    data = bytearray(compressed.read_bytes())
    data[codes.offset + len(codes) // 2] ^= 1
    changed = tmp_path / "changed.fiblets"
    changed.write_bytes(data)
    assert "changed bytes in codes.npy" in fails(capsys, "verify", changed)


def test_help_is_exit_code_0_and_every_command_and_argument_says_what_it_does(capsys):
    commands = next(action for action in make_parser()._actions if isinstance(action, argparse._SubParsersAction))
    for name, command in commands.choices.items():
        assert command.description, name
        silent = [action.dest for action in command._actions if not action.help]
        assert not silent, name
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
    command = [sys.executable, "-m", "pvfiblets", "info", str(tractogram[0])]
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
    assert re.search(r"more memory than --max-memory, [\d.]+ .B \(it says that it takes .*; give a larger limit", said)
    assert memory.limited_to() == before


@pytest.mark.parametrize("command", [["serve"], ["batch", "convert", "a.tck", "-o", "out"]])
def test_the_limit_of_memory_has_one_word_and_its_older_one(command):
    for word in ("--max-memory", "--memory"):
        assert make_parser().parse_args([*command, word, "3G"]).memory == "3G"


@needs_limit
def test_a_limit_of_memory_that_is_none_is_refused(tractogram, tmp_path, capsys):
    target = tmp_path / "a.fiblets"
    assert "'much' is no size of memory" in fails(capsys, "convert", tractogram[0], target, "--max-memory", "much")
    assert "are needed to start" in fails(capsys, "info", tractogram[0], "--max-memory", "5M")
    assert not target.exists()


@needs_limit
def test_a_program_that_has_much_memory_can_run_a_command(tractogram, tmp_path, capsys, monkeypatch):
    """As tests do, and notebooks: what they have was not taken by the command."""
    monkeypatch.setattr(memory, "taken", lambda: 2 * memory.of_machine())
    assert main(["convert", str(tractogram[0]), str(tmp_path / "a.fiblets")]) == 0
    assert memory.limited_to() is None
    assert "are needed to start" in fails(capsys, "info", tractogram[0], "--max-memory", "40%")


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
    from pvfiblets.codec.files import convert

    source, target = tractogram[0], tmp_path / "a.fiblets"
    plain, written, write = tmp_path / "plain.fiblets", [], convert.write
    assert main(["convert", str(source), str(plain), "--no-exact"]) == 0
    capsys.readouterr()
    monkeypatch.setattr(convert, "write", lambda path, *more, **how: written.append(path) or write(path, *more, **how))
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


def test_gl_lists_the_driver_its_limits_and_every_pipeline_also_as_json(gl, capsys):
    assert gl.info["GL_VERSION"]
    assert main(["gl"]) == 0
    text = capsys.readouterr().out
    assert gl.info["GL_RENDERER"] in text
    assert gl.info["GL_VERSION"] in text
    assert f"{gl.info['GL_MAX_TEXTURE_SIZE']:,}" in text
    for name in PIPELINES[1:]:
        assert sum(line.split()[:1] == [name] for line in text.splitlines()) == 1
    assert text.count("(auto)") == 1
    assert gl.extensions
    assert gl.info
    assert main(["gl", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["renderer"] == gl.info["GL_RENDERER"]
    assert set(report["extensions"]) == set(gl.extensions)
    assert {entry["name"] for entry in report["pipelines"]} == set(PIPELINES[1:])
    assert all(entry["available"] == (entry["why_not"] is None) for entry in report["pipelines"])
    assert report["auto"] == next(entry["name"] for entry in report["pipelines"] if entry["available"])


def test_without_opengl_there_is_one_sentence_and_exit_code_1():
    nothing = {"GLCONTEXT_LINUX_LIBEGL": "libnothing.so", "GLCONTEXT_LINUX_LIBGL": "libnothing.so"}
    result = subprocess.run(
        [sys.executable, "-m", "pvfiblets", "gl"],
        capture_output=True, text=True, check=False, env=os.environ | nothing,
    )  # fmt: skip
    assert (result.returncode, result.stdout, result.stderr.count("\n")) == (1, "", 1)
    assert result.stderr.startswith("pvfiblets: no OpenGL 3.2 or later could be started on this machine (egl: ")
    assert "Install a graphics driver" in result.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mistakes")
    brain = brain_streamlines(20, 2.0, seed=3, fa=True)
    formats.write(folder / "a.trx", brain)
    formats.write(folder / "a b ü.tck", brain)
    assert main(["convert", str(folder / "a.trx"), str(folder / "a.fiblets"), "--quiet"]) == 0
    (folder / "folder").mkdir()
    (folder / "empty.tck").touch()
    (folder / "text.tck").write_text("hello")
    nib.save(nib.Nifti1Image(np.zeros((4, 4, 4), np.int16), np.eye(4)), folder / "zeros.nii")
    return folder


MISUSED = [
    ("convert a.trx b.fiblets --max-eror 1", "unrecognized arguments: --max-eror 1; did you mean --max-error?"),
    ("compres a.trx b.fiblets", "invalid choice: 'compres'"),
    ("infos a.trx", "did you mean info?"),
    ("convert a.trx b.fiblets --effort hihg", "did you mean high?"),
    ("convert a.trx b.fiblets c.fiblets", "unrecognized arguments: c.fiblets"),
    ("convert a.trx", "the following arguments are required: OUT"),
    ("convert a.trx b.fiblets --max-error big", "--max-error: 'big' is no number"),
    ("convert a.trx b.fiblets --max-error 0", "--max-error: 0 is not above zero"),
    ("convert a.trx b.fiblets --max-error -1", "--max-error: -1 is not above zero"),
    ("convert a.trx b.fiblets --max-angle 900", "--max-angle: 900 is not above 0 and up to 90 degrees, or none"),
    ("convert a.trx b.fiblets --per-point-bits 12", "invalid choice: 12 (choose from"),
    ("demo --streamlines 1.5", "--streamlines: '1.5' is no whole number"),
    ("density a.trx d.nii", "one of the arguments --voxel --like is required"),
    ("screenshot a.trx -o a.png --size 10", "'10' is not WIDTHxHEIGHT, such as 1200x900"),
    ("screenshot a.trx -o a.png --size 10x16385", "10x16385: each side must be from 1 to 16384 pixels"),
    ("screenshot a.trx -o a.png --clim 1", "--clim: expected 2 arguments"),
    ("batch convert a.trx", "the following arguments are required: -o/--output"),
    ("screenshot a.trx -o a.png --view sideways", "argument --view"),
    ("screenshot a.trx -o a.png --antialias much", "argument --antialias"),
    ("convert a.trx b.fiblets --step -1", "argument --step"),
    ("convert a.trx b.fiblets --max-error nan", "argument --max-error"),
    ("demo --streamlines 0", "argument --streamlines"),
]

WRONG = [
    ("info missing.tck", "missing.tck: No such file"),
    ("info folder", "folder is a folder; give a file of one of .*.fiblets, .*.tck"),
    ("info zeros.nii", "zeros.nii: no format has this suffix; .*.fiblets, .*.tck"),
    ("info '~/missing.tck'", "missing.tck: No such file"),
    ("info 'no such ü.tck'", "no such ü.tck: No such file"),
    ("convert '*.nothing' b.fiblets", r"\*.nothing: no format has this suffix"),
    ("convert a.trx b", "b: no format has this suffix; .*.fiblets, .*.tck"),
    ("convert a.trx b.trk.gz", r"b.trk.gz: the format .trk.gz has no write\(\); formats that have: .fib, .fiblets"),
    ("convert a.trx nowhere/b.tck", "nowhere/b.tck: there is no folder .*nowhere; make it first"),
    ("convert a.trx ./a.trx", "a.trx would be overwritten by itself; give another name"),
    ("convert a.trx b.fiblets --per-point md", "no per-point array 'md'; the streamlines have: fa"),
    ("convert a.trx b.trk --max-error 1", "--max-error, .* are for .fiblets files; b.trk is of another format"),
    ("convert empty.tck b.fiblets", "empty.tck, byte 0: found b'', expected the line 'mrtrix tracks'"),
    ("convert text.tck b.fiblets", "text.tck, byte 0: found b'hello', expected the line"),
    ("convert https://example.org/a.tck b.fiblets", "https://example.org/a.tck is an address; .*fetch the file first"),
    ("convert a.trx https://example.org/b.tck", "https://example.org/b.tck is an address, but output must be"),
    ("screenshot https://example.org/a.tck -o a.png", "https://example.org/a.tck is an address; .*fetch the file"),
    ("convert a.trx b.fiblets --max-memory much", "'much' is no size of memory; give one such as 4G"),
    ("verify a.trx a.fiblets", "a.trx is no .fiblets file; give the compressed file first, then its original"),
    ("verify a.fiblets text.tck", "text.tck, byte 0: found b'hello'"),
    ("table a.trx t.csv --group AF", "a.trx has no group 'AF'; it has: callosum"),
    ("table a.trx nowhere/t.csv", "nowhere/t.csv: there is no folder .*nowhere; make it first"),
    ("density a.trx d.png --voxel 2", "d.png is no name of an image; let it end in .nii"),
    ("density a.trx d.nii --voxel 1 2", "--voxel has 2 numbers; give one side in mm, or three"),
    ("density a.trx d.nii --voxel 2 --contrast md", "a.trx has no array 'md' of single numbers; there are: bundle, fa"),
    ("connectome a.trx zeros.nii m.xyz", "m.xyz has no suffix of a matrix; use one of .csv"),
    ("connectome a.trx zeros.nii m.csv --radius -1", "radius is -1.0; give mm, 0 or more"),
    ("screenshot a.trx -o a.doc", "a.doc: pictures are written as .png, .jpg, .bmp or .tif"),
    ("screenshot missing.tck -o a.png", "missing.tck: No such file"),
    ("serve missing.tck --port 0", "missing.tck: No such file"),
    ("serve a.trx --port 99999999", "--port 99999999: a port is from 0 to 65535"),
    ("serve --root nowhere", "nowhere: not a folder; --root names the one"),
    ("report --only nothing -o out", "no study 'nothing'; choose among antialias"),
    ("report -o a.trx", "a.trx: it is a file; name a folder"),
    ("demo --output a.trx", "a.trx: it is a file; name a folder"),
]  # fmt: skip

DRAWN = [
    ("screenshot a.trx -o nowhere/a.png", "nowhere/a.png: there is no folder .*nowhere; make it first"),
    ("screenshot a.trx -o a.png --scalars md", "no array 'md'. Per point: "),
    ("screenshot a.trx -o a.png --color blurple", "Invalid color input: .blurple."),
    ("screenshot a.trx -o a.png --cmap blurple", "cmap is 'blurple', which is no colour map; give a name"),
    ("screenshot a.trx -o a.png --groups AF", "no group 'AF'; there are: 'callosum'"),
    ("screenshot a.trx -o a.png --clip blob", "the kind of --clip is 'blob'; choose one of plane, slab"),
]  # fmt: skip


@pytest.fixture
def here(folder, monkeypatch, tmp_path):
    monkeypatch.chdir(folder)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("DISPLAY", raising=False)
    before = sorted(folder.iterdir())
    yield folder
    left = [path for path in sorted(folder.iterdir()) if path not in before]
    assert all(path.name == "out" for path in left), left  # a report's folder is made first


@pytest.mark.parametrize(("words", "says"), MISUSED)
def test_misused_commands_end_with_2_and_say_how_to_use_them(here, capsys, words, says):
    with pytest.raises(SystemExit) as done:
        main(shlex.split(words))
    assert done.value.code == 2
    said = capsys.readouterr().err
    assert said.startswith("usage: pvfiblets ")
    last = said.splitlines()[-1]
    assert says in last
    assert last.startswith("pvfiblets")
    command = words.split()[0]
    assert command in ("compres", "infos") or f"usage: pvfiblets {command}" in said


@pytest.mark.parametrize(("words", "says"), [*WRONG, *DRAWN])
def test_what_cannot_be_done_ends_with_1_and_one_sentence(here, capsys, words, says):
    assert main(shlex.split(words)) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert re.match(f"pvfiblets: (|.*/|there is |--step, ){says}", captured.err), captured.err


def test_names_with_blanks_and_other_letters_are_as_good(here, capsys, tmp_path):
    target = tmp_path / "ö ü.fiblets"
    assert main(["convert", "a b ü.tck", str(target), "--json"]) == 0
    assert main(["info", str(target)]) == 0
    assert "ö ü.fiblets" in capsys.readouterr().out
    assert Path(target).exists()


WRITTEN = (".tck", ".trk", ".trx", ".vtk", ".vtp", ".fiblets")


@pytest.fixture(scope="module")
def brain():
    return brain_streamlines(60, 1.0, seed=3)


@pytest.fixture(scope="module")
def files(brain, tmp_path_factory):
    folder = tmp_path_factory.mktemp("pipes")
    for suffix in (".tck", ".trk", ".trx", ".vtk", ".vtp"):
        formats.write(folder / f"a{suffix}", brain)
    assert main(["convert", str(folder / "a.trx"), str(folder / "a.fiblets"), "--no-exact"]) == 0
    return folder


@pytest.fixture
def shell(monkeypatch, capfdbinary):
    """Run a command with bytes as its standard input; return exit code, standard output and standard error."""

    def run(data, *words):
        monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(data), isatty=lambda: False))
        capfdbinary.readouterr()
        code = main([str(word) for word in words])
        out, err = capfdbinary.readouterr()
        return code, out, err.decode()

    return run


@pytest.mark.parametrize("suffix", WRITTEN)
def test_each_format_goes_in_and_out(shell, files, brain, suffix, tmp_path):
    source = (files / f"a{suffix}").read_bytes()
    code, out, err = shell(source, "convert", "-", "-", "--format", "tck")
    assert code == 0, err
    assert out.startswith(b"mrtrix tracks")
    (tmp_path / "a.tck").write_bytes(out)
    points = nib.streamlines.load(tmp_path / "a.tck").streamlines.get_data()
    np.testing.assert_allclose(points, brain.points, atol=0.11 if suffix == ".fiblets" else 1e-4)
    assert "standard output: 60 streamlines" in err
    assert "of standard input" in err
    assert "pvfiblets-pipe" not in err
    code, out, err = shell(b"", "convert", files / "a.tck", "-", "--format", suffix)
    assert code == 0, err
    (tmp_path / f"b{suffix}").write_bytes(out)
    assert suffix_by_content(tmp_path / f"b{suffix}") == suffix
    assert len(formats.read(tmp_path / f"b{suffix}")) == 60


@pytest.mark.parametrize("name", ["nv_stroke.trk.gz", "trxrs_tinytrack_small.tt.gz", "trxpy_small_compressed.trx",
                                  "nv_colby.trx", "nib_complex_big_endian.trk", "vtk_track1.binary.vtk"])  # fmt: skip
def test_real_files_are_known_by_their_content(shared_data, name):
    assert name.endswith(suffix_by_content(shared_data / name))


def test_what_is_said_of_standard_input(shell, files):
    code, out, _ = shell((files / "a.trk").read_bytes(), "info", "-", "--json")
    facts = json.loads(out)
    assert (code, facts["file"], facts["format"], facts["streamlines"]) == (0, "standard input", ".trk", 60)
    assert facts["bytes"] == (files / "a.trk").stat().st_size
    code, out, _ = shell((files / "a.fiblets").read_bytes(), "verify", "-", files / "a.trx", "--json")
    assert json.loads(out)["kept"] is True
    code, out, _ = shell((files / "a.trx").read_bytes(), "verify", files / "a.fiblets", "-", "--json")
    assert json.loads(out)["kept"] is True
    code, out, _ = shell((files / "a.trx").read_bytes(), "table", "-")
    assert out.count(b"\n") == 61


def test_volumes_matrices_and_pictures_leave_clean(shell, files, tmp_path):
    tracks = (files / "a.tck").read_bytes()
    code, out, err = shell(tracks, "density", "-", "-", "--voxel", "5", "--format", "nii.gz")
    assert code == 0, err
    (tmp_path / "a.nii.gz").write_bytes(out)
    image = nib.load(tmp_path / "a.nii.gz")
    (tmp_path / "b.nii").write_bytes(shell(tracks, "density", "-", "-", "--voxel", "5")[1])
    np.testing.assert_array_equal(nib.load(tmp_path / "b.nii").get_fdata(), image.get_fdata())
    assert image.get_fdata().max() >= 1
    labels = nib.Nifti1Image((image.get_fdata() > 0).astype(np.int16), image.affine)
    nib.save(labels, tmp_path / "labels.nii")
    code, out, err = shell(tracks, "connectome", "-", tmp_path / "labels.nii", "-")
    assert code == 0, err
    assert out == b",1\n1,60\n"
    code, out, err = shell(tracks, "screenshot", "-", "-o", "-", "--size", "60x40")
    assert code == 0, err
    assert Image.open(io.BytesIO(out)).size == (60, 40)


@pytest.mark.parametrize(
    ("data", "words", "says"),
    [
        (b"", ["info", "-"], "standard input is empty"),
        (b"GIF89a", ["info", "-"], "has no known first bytes; add --format"),
        (b"TRACK", ["info", "-"], "standard input"),
        (b"mrtrix tracks\n", ["convert", "-", "b.fiblets"], "standard input"),
        (b"TRACK", ["info", "-", "--format", "xyz"], "no format has this suffix"),
        (b"TRACK", ["info", "a.trk", "--format", "tck"], "no file is -"),
        (b"TRACK", ["convert", "-", "-"], "add --format"),
        (b"TRACK", ["convert", "a.trk", "-"], "add --format"),
        (b"TRACK", ["verify", "-", "-"], "one standard input"),
        (b"TRACK", ["screenshot", "-", "-", "-o", "b.png"], "one standard input"),
        (b"TRACK", ["convert", "-", "b.tck", "--format", "trk", "--format", "tck"], "only one -"),
    ],
)
def test_what_cannot_be_is_one_sentence_without_temporary_names(shell, tmp_path, monkeypatch, data, words, says):
    monkeypatch.chdir(tmp_path)
    code, out, err = shell(data, *words)
    assert (code, out) == (1, b"")
    assert says in err
    assert err.count("\n") == 1
    assert "pvfiblets-pipe" not in err
    assert not list(tmp_path.iterdir())


def test_terminals_are_neither_read_nor_filled_with_bytes(monkeypatch, capsys, files):
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(isatty=lambda: True))
    assert main(["info", "-"]) == 1
    assert ", a terminal;" in capsys.readouterr().err
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    assert main(["convert", str(files / "a.tck"), "-", "--format", "trk"]) == 1
    assert ", a terminal;" in capsys.readouterr().err


@pytest.mark.more
def test_programs_joined_by_a_shell(files, brain, tmp_path):
    """Through three processes and real pipes; and into one that does not read, without a word."""
    command = f"{sys.executable} -m pvfiblets"
    line = (
        f"{command} convert {files}/a.trx - --format trk | {command} convert - - --format fiblets --quiet"
        f" | {command} convert - {tmp_path}/b.tck"
    )
    done = subprocess.run(["bash", "-o", "pipefail", "-c", line], capture_output=True, check=False, timeout=200)
    assert done.returncode == 0, done.stderr
    assert len(formats.read(tmp_path / "b.tck")) == len(brain)
    line = f"{command} convert {files}/a.trx - --format vtk | true; {command} info {files}/a.trx | true"
    done = subprocess.run(["bash", "-c", line], capture_output=True, check=False, timeout=200)
    assert b"Traceback" not in done.stderr
    assert b"Broken" not in done.stderr
