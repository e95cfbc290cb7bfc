"""Cohorts: what is made, what is skipped, what fails, and what becomes of workers that die."""

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import nibabel as nib
import numpy as np
import pyarrow.parquet
import pytest
import pyvista as pv

import pvfiblets as pf
from pvfiblets import regions
from pvfiblets.cli.command import main
from pvfiblets.cluster import batch, operations
from pvfiblets.query.measures.profile import mean_profile
from tests.cluster.conftest import AFFINE, SUBJECTS

pytestmark = pytest.mark.more

PATTERN = "sub-0[123]/ses-a/dwi/*.trx"


def name_of(subject, suffix=".trx"):
    return f"sub-{subject}/ses-a/dwi/sub-{subject}_ses-a_bundle-all_tractography{suffix}"


def rows_of(result, subject):
    return [row for row in result.read().to_pylist() if row["subject"] == subject]


def column(rows, name):
    return np.array([np.nan if row[name] is None else row[name] for row in rows])


def test_files_are_those_of_one_machine_and_a_damaged_one_is_named(client, cohort, tmp_path):
    result = batch("convert", cohort / "sub-*/ses-a/dwi/*.trx", tmp_path / "out", cluster=client, exact=False)
    assert result.done == tuple(name_of(s) for s in SUBJECTS)
    assert list(result.failed) == [name_of("04")]
    assert "found" in result.failed[name_of("04")]
    assert "expected" in result.failed[name_of("04")]
    assert not result.ok
    for subject in SUBJECTS:
        alone = tmp_path / f"{subject}.fiblets"
        told = pf.compress_file(cohort / name_of(subject), alone, exact=False)
        assert (tmp_path / "out" / name_of(subject, ".fiblets")).read_bytes() == alone.read_bytes()
        (row,) = rows_of(result, subject)
        assert (row["session"], row["bundle"], row["suffix"]) == ("a", "all", "tractography")
        assert row["file"] == name_of(subject)
        assert row["streamlines"] == told["streamlines"] == 60
        assert row["bytes"] == alone.stat().st_size
        assert row["error_mm_max"] == pytest.approx(told["error_mm"]["max"])
    assert not list((tmp_path / "out").glob(".batch-*"))


def test_what_is_finished_is_skipped_and_what_changed_is_not(client, cohort, tmp_path):
    study, out = tmp_path / "study", tmp_path / "out"
    shutil.copytree(cohort, study)

    def run(**options):
        return batch("convert", study / PATTERN, out, cluster=client, **options)

    assert len(run().done) == 3
    with pytest.raises(ValueError, match=r"3 finished files; give --resume .* --overwrite"):
        run()
    before = {s: (out / name_of(s, ".fiblets")).stat().st_mtime_ns for s in SUBJECTS}
    again = run(resume=True)
    assert (again.done, len(again.skipped), again.read().num_rows) == ((), 3, 3)
    assert before == {s: (out / name_of(s, ".fiblets")).stat().st_mtime_ns for s in SUBJECTS}

    os.utime(study / name_of("01"))  # the same bytes at another time
    made = out / name_of("02", ".fiblets")
    data = bytearray(made.read_bytes())
    data[-40] ^= 1
    made.write_bytes(data)
    shutil.copy(study / name_of("01"), study / name_of("03"))
    assert run(resume=True).done == (name_of("02"), name_of("03"))
    (out / name_of("02", ".fiblets")).unlink()
    assert run(resume=True).done == (name_of("02"),)
    (out / ".convert" / f"{name_of('02')}.parquet").unlink()
    assert run(resume=True).done == (name_of("02"),)
    assert len(run(resume=True, max_error=0.5).done) == 3  # something else was asked
    assert len(run(overwrite=True).done) == 3
    lines = (out / "convert.jsonl").read_bytes()
    (out / "convert.jsonl").write_bytes(lines[:-30])  # a writer that was killed
    assert len(run(resume=True).skipped) == 2
    assert run(resume=True).read().num_rows == 3


def test_connectomes_are_rows_of_one_table(client, cohort, tmp_path):
    labels = str(cohort / "atlas" / "sub-{subject}.nii.gz")
    result = batch("connectome", cohort / PATTERN, tmp_path, cluster=client, labels=labels, contrast="length")
    for subject in SUBJECTS:
        found = pf.connectome(cohort / name_of(subject), labels.format(subject=subject), contrast="length")
        rows = rows_of(result, subject)
        assert len(rows) == 10  # of four parcels
        for row in rows:
            place = found.index(row["parcel_a"]), found.index(row["parcel_b"])
            assert row["count"] == found.counts[place]
            np.testing.assert_equal(np.nan if row["value"] is None else row["value"], found.matrix[place])
    assert sum(row["count"] for row in result.read().to_pylist()) > 10
    other = batch("connectome", cohort / PATTERN, tmp_path, cluster=client, labels="none/{run}.nii", resume=True)
    assert "asks for run, which the name of" in other.failed[name_of("01")]
    assert other.table is None


def test_profiles_of_bundles_by_arrays_and_by_images(client, cohort, tmp_path):
    result = batch("profile", cohort / PATTERN, tmp_path / "fa", cluster=client, values="fa", positions=5)
    brain = pf.read(cohort / name_of("02"))
    fiblets = pf.compress(brain, exact=True, per_point=["fa"], per_point_bits=16)
    assert fiblets.groups
    rows = rows_of(result, "02")
    for name, members in fiblets.groups.items():
        mean, std = mean_profile(fiblets, members, "fa", 5)
        own = [row for row in rows if row["bundle"] == name]
        np.testing.assert_allclose(column(own, "position"), np.linspace(0, 1, 5))
        np.testing.assert_allclose(column(own, "mean"), mean)
        np.testing.assert_allclose(column(own, "std"), std)
        assert {row["streamlines"] for row in own} == {len(members)}
    # An image whose value is x (mm) gives the mean of x at places along straight lines.
    x = AFFINE_X[0, 0] * np.arange(30.0) + AFFINE_X[0, 3]
    nib.save(nib.Nifti1Image(np.broadcast_to(x[:, None, None], (30, 4, 4)).astype(np.float32), AFFINE_X),
             tmp_path / "x.nii")  # fmt: skip
    lines = pf.Streamlines.from_list([np.linspace((0, 0, z), (40, 0, z), 21) for z in (0.0, 1.0)])
    (tmp_path / "sub-9").mkdir()
    pf.write(tmp_path / "sub-9" / "sub-9_bundle-CST_streamlines.tck", lines)
    straight = batch(
        "profile", tmp_path / "sub-9" / "*.tck", tmp_path / "x", cluster=client, values=str(tmp_path / "x.nii"),
        positions=9,
    ).read().to_pylist()  # fmt: skip
    np.testing.assert_allclose(column(straight, "mean"), np.linspace(0, 40, 9), atol=1e-3)
    assert {row["bundle"] for row in straight} == {"CST"}


def test_samples_are_those_of_each_files_image(client, cohort, tmp_path):
    """An image whose values are 1000 times its subject and x (mm); a third of the lines leave it."""
    for n, subject in enumerate(SUBJECTS):
        x = (AFFINE[0, 0] * np.arange(20.0) + AFFINE[0, 3])[:, None, None] + 1000 * n
        image = nib.Nifti1Image(np.broadcast_to(x, (20, 24, 12)).astype(np.float32), AFFINE)
        nib.save(image, tmp_path / f"{subject}.nii")
    options = {"image": str(tmp_path / "{subject}.nii")}
    result = batch("sample", cohort / PATTERN, tmp_path / "points", cluster=client, to=".npy", **options)
    means = batch("sample", cohort / PATTERN, tmp_path / "means", cluster=client, to=".trx", statistic="mean",
                  weights="points", name="x", **options)  # fmt: skip
    for n, subject in enumerate(SUBJECTS):
        lines = pf.read(cohort / name_of(subject))
        wanted = np.where(lines.points[:, 2] <= AFFINE[2, 3] + 10 * 11.5, lines.points[:, 0] + 1000.0 * n, np.nan)
        found = np.load(tmp_path / "points" / name_of(subject, ".npy"))
        np.testing.assert_allclose(found, wanted, atol=0.01)
        (row,) = rows_of(result, subject)
        assert (row["values"], row["without_value"]) == (np.isfinite(wanted).sum(), np.isnan(wanted).sum())
        assert (row["low"], row["mean"], row["high"]) == pytest.approx(
            (np.nanmin(wanted), np.nanmean(wanted), np.nanmax(wanted)), abs=0.01
        )
        of_lines = pf.read(tmp_path / "means" / name_of(subject, ".trx")).per_streamline["x"].ravel()
        known = [part[np.isfinite(part)] for part in np.split(wanted, lines.offsets[1:-1])]
        np.testing.assert_allclose(of_lines, [part.mean() if len(part) else np.nan for part in known], atol=0.01)
        assert rows_of(means, subject)[0]["values"] == sum(len(part) > 0 for part in known)


AFFINE_X = np.array([[2.0, 0, 0, -4], [0, 2.0, 0, -2], [0, 0, 2.0, -2], [0, 0, 0, 1]])


@pytest.mark.parametrize("suffix", [".trx", ".trk", ".vtp", ".tck"])
def test_selections_of_lines_with_gaps_are_their_pieces(tmp_path, suffix):
    gap = np.array([[0, 0, 0], [1, 0, 0], [np.nan, 0, 0], [3, 0, 0], [4, 0, 0]], np.float32)
    inside, outside = np.full((3, 3), [[50.0, 0, 0]], np.float32), np.full((3, 3), [[90.0, 0, 0]], np.float32)
    inside[:, 1], outside[:, 1] = [0, 1, 2], [0, 1, 2]
    source, target = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pf.write(source, pf.Streamlines.from_list([gap, outside, inside, outside]))
        found = operations.select(source, target, passes=["box:40,60,-9,9,-9,9"])
    assert (found["streamlines"], found["selected"]) == (5, 1)
    np.testing.assert_allclose(pf.read(target).points, inside, atol=1e-5)
    assert found["dropped"] >= (suffix != ".tck")


@pytest.mark.parametrize("compressed", [False, True])
def test_selections_are_those_of_numpy(client, cohort, tmp_path, compressed):
    sources, suffix = cohort / PATTERN, ".trx"
    if compressed:
        suffix = ".fiblets"
        batch("convert", sources, tmp_path / "coded", cluster=client, exact=True)
        sources = tmp_path / "coded" / "sub-*" / "ses-a" / "dwi" / "*.fiblets"
    result = batch(
        "select", sources, tmp_path / "out", cluster=client, to=".tck", passes=["box:-100,0,-100,100,-100,100"],
        avoids=["sphere:10,-20,10,30"], sampling="points",
    )  # fmt: skip
    for subject in SUBJECTS:
        lines = [np.asarray(line, float) for line in pf.read(cohort / name_of(subject))]
        keep = [
            line for line in lines
            if (line[:, 0] <= 0).any() and (np.linalg.norm(line - (10, -20, 10), axis=1) > 30).all()
        ]  # fmt: skip
        (row,) = rows_of(result, subject)
        assert row["file"] == name_of(subject, suffix)
        assert (row["streamlines"], row["selected"]) == (len(lines), len(keep))
        assert 0 < len(keep) < len(lines)
        made = pf.read(tmp_path / "out" / name_of(subject, ".tck"))
        np.testing.assert_allclose(made.points, np.concatenate(keep), atol=1e-5)


@pytest.mark.filterwarnings("ignore:.*changed step_size")
@pytest.mark.parametrize("suffix", [".tck", ".fiblets"])
def test_what_crosses_a_region_between_its_points_passes_it(tmp_path, suffix):
    """Of 21 segments that cross a ball, 12 have no point in it."""
    source = tmp_path / f"a{suffix}"
    y = np.linspace(-4.9, 4.9, 21)
    lines = [np.array([[-40.0 if k % 7 < 4 else 0.5, v, 0], [40.0, v, 0]]) for k, v in enumerate(y)]
    lines.append(lines[0] - [0, 5, 0])
    pf.write(source, pf.Streamlines.from_list(lines))
    for sampling, n in (("lines", 21), ("points", 9)):
        options = {"passes": ["sphere:0,0,0,5"], "sampling": sampling}
        assert operations.select(source, tmp_path / "out.tck", **options)["selected"] == n
        assert len(pf.read(tmp_path / "out.tck")) == n
        options = {"avoids": ["sphere:0,0,0,5"], "sampling": sampling}
        assert operations.select(source, tmp_path / "out.tck", **options)["selected"] == 22 - n


def test_density_and_verify(client, cohort, tmp_path):
    result = batch("density", cohort / PATTERN, tmp_path / "maps", cluster=client, voxel=6.0)
    exact = pf.density(cohort / name_of("03"), 6.0)
    image = nib.load(tmp_path / "maps" / name_of("03", ".nii.gz"))
    np.testing.assert_array_equal(np.asarray(image.dataobj), exact.values)
    (row,) = rows_of(result, "03")
    assert (row["nx"], row["ny"], row["nz"]) == exact.values.shape
    assert row["high"] == exact.values.max()
    assert row["mean"] == pytest.approx(exact.values.mean())

    batch("convert", cohort / PATTERN, tmp_path / "coded", cluster=client, exact=False)
    damaged = tmp_path / "coded" / name_of("02", ".fiblets")
    data = bytearray(damaged.read_bytes())
    data[len(data) // 2] ^= 1
    damaged.write_bytes(data)
    checked = batch(
        "verify", tmp_path / "coded" / "sub-*/ses-a/dwi/*.fiblets", tmp_path / "checked", cluster=client,
        original=str(cohort / "{folder}" / "{stem}.trx"),
    )  # fmt: skip
    assert "changed bytes" in checked.failed[name_of("02", ".fiblets")]
    assert [(row["subject"], row["kept"]) for row in checked.read().to_pylist()] == [("01", True), ("03", True)]
    assert all(0 < row["error_mm_max"] <= row["promise_mm"] for row in checked.read().to_pylist())
    assert [row["dropped"] for row in checked.read().to_pylist()] == [0, 0]


def test_verify_counts_what_reading_left_out_of_the_original(tmp_path):
    lines = np.array([[0.0, 0, 0], [1, 0, 0], [np.nan, 0, 0], [3, 0, 0], [4, 0, 0]])
    pv.lines_from_points(lines).save(tmp_path / "a.vtp")
    pf.compress_file(tmp_path / "a.vtp", tmp_path / "a.fiblets")
    row = operations.verify(tmp_path / "a.fiblets", original=str(tmp_path / "a.vtp"))
    assert row["dropped"] == sum(pf.read(tmp_path / "a.vtp").dropped.values()) > 0
    assert "dropped" not in operations.verify(tmp_path / "a.fiblets")


@pytest.mark.parametrize("to", [".txt", ".tsf"])
def test_samples_count_what_reading_left_out_and_name_files_that_stay(to, tmp_path):
    lines = np.array([[0.0, 0, 0], [1, 0, 0], [np.nan, 0, 0], [3, 0, 0], [99, 0, 0]])
    pv.lines_from_points(lines).save(tmp_path / "a.vtp")
    nib.save(nib.Nifti1Image(np.ones((5, 5, 5), np.float32), np.eye(4)), tmp_path / "one.nii")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        row = operations.sample(tmp_path / "a.vtp", tmp_path / f"a{to}", to=to, image=str(tmp_path / "one.nii"))
    assert row["dropped"] == sum(pf.read(tmp_path / "a.vtp").dropped.values()) > 0
    assert not any(f"a{to}" in str(one.message) for one in told), "a batch writes to a name of its own first"


def test_files_that_name_no_space_are_in_that_of_the_command(tmp_path):
    source, out = tmp_path / "old.vtk", tmp_path / "out"
    line = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    pv.lines_from_points(line).save(source)
    command = ["batch", "convert", str(source), "-o", str(out), "--to", ".tck", "--workers", "1", "--quiet"]
    assert main([*command, "--space", "LPS"]) == 0
    np.testing.assert_allclose(nib.streamlines.load(out / "old.tck").streamlines[0], line * (-1, -1, 1))
    assert main([*command, "--resume"]) == 0, "another space is another result"
    np.testing.assert_allclose(nib.streamlines.load(out / "old.tck").streamlines[0], line)


def test_memory_is_bounded_and_said(client, cohort, tmp_path):
    result = batch("density", cohort / name_of("01"), tmp_path, cluster=client, voxel=0.3, memory="1G")
    assert "says that it takes" in result.failed[name_of("01")]
    assert result.failed[name_of("01")].endswith("(the worker may have 1.0 GB)")
    assert batch("density", cohort / name_of("01"), tmp_path, cluster=client, voxel=9.0, memory="2G", resume=True).ok
    with pytest.raises(ValueError, match="memory is 100 MB, less than a worker takes"):
        batch("density", cohort / name_of("01"), tmp_path, cluster=client, voxel=9.0, memory="100M")


def test_a_killed_workers_files_are_done_by_others(client, cohort, tmp_path):
    for n in range(30):
        folder = tmp_path / "in" / f"sub-{n:02d}"
        folder.mkdir(parents=True)
        shutil.copy(cohort / name_of("01"), folder / f"sub-{n:02d}_tractography.trx")
    killed = []

    def kill():
        deadline = time.monotonic() + 120
        while len(list((tmp_path / "out").glob("sub-*/*.fiblets"))) < 3:  # not in folders that come and go
            assert time.monotonic() < deadline
            time.sleep(0.01)
        pid = min(client.run(os.getpid, on_error="ignore").values())
        os.kill(pid, signal.SIGKILL)
        killed.append(pid)

    killer = threading.Thread(target=kill)
    killer.start()
    result = batch("convert", tmp_path / "in" / "sub-*" / "*.trx", tmp_path / "out", cluster=client, exact=False)
    killer.join()
    assert killed
    assert len(result.done) == 30
    assert result.ok
    first = (tmp_path / "out" / "sub-00" / "sub-00_tractography.fiblets").read_bytes()
    assert all(path.read_bytes() == first for path in (tmp_path / "out").rglob("*.fiblets"))
    assert not list((tmp_path / "out").glob(".batch-*"))


def test_the_command(client, cohort, tmp_path, capsys):
    address = client.scheduler.address
    given = ["batch", "convert", str(cohort / "sub-*/ses-a/dwi/*.trx"), "-o", str(tmp_path), "--cluster", address]
    assert main([*given, "--json"]) == 1
    said = capsys.readouterr()
    told = json.loads(said.out)
    assert (told["done"], told["skipped"], list(told["failed"])) == (3, 0, [name_of("04")])
    assert pyarrow.parquet.read_table(told["table"]).num_rows == 3
    assert said.err.count("\n") == 1
    assert main([*given]) == 1
    assert "--resume" in capsys.readouterr().err
    assert main([*given[:2], str(cohort / PATTERN), *given[3:], "--resume"]) == 0
    assert "0 done, 3 finished before" in capsys.readouterr().out
    assert main(["batch", "density", str(cohort / PATTERN), "-o", str(tmp_path), "--voxel", "1", "2"]) == 1
    assert "--voxel has 2 numbers" in capsys.readouterr().err


def test_an_interrupt_leaves_nothing_half(cohort, tmp_path):
    for n in range(40):
        (tmp_path / "in" / f"sub-{n:02d}").mkdir(parents=True)
        shutil.copy(cohort / name_of("01"), tmp_path / "in" / f"sub-{n:02d}" / "a.trx")
    out = tmp_path / "out"
    command = [sys.executable, "-m", "pvfiblets", "batch", "convert", str(tmp_path / "in" / "*" / "a.trx"), "-o",
               str(out), "--workers", "2", "--no-exact"]  # fmt: skip
    running = subprocess.Popen(
        command, start_new_session=True, stderr=subprocess.PIPE, text=True,
        # A shell starts what it runs in the background deaf to interrupts, and that is handed on.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    deadline = time.monotonic() + 120
    while not (out / "convert.jsonl").exists() or not (out / "convert.jsonl").read_bytes():
        assert time.monotonic() < deadline
        assert running.poll() is None
        time.sleep(0.05)
    os.killpg(running.pid, signal.SIGINT)  # as the terminal does: workers get it, too
    said = running.communicate(timeout=60)[1]
    assert running.returncode == 1
    assert "pvfiblets: interrupted" in said.splitlines()
    assert "Traceback" not in said
    made = list(out.rglob("*.fiblets"))
    assert 0 < len(made) < 40
    for path in made:
        assert pf.FibletSet.open(path).n_streamlines == 60
    assert not [path for path in out.rglob("*") if path.name.startswith(".batch") or path.name.endswith(".part")]
    while True:  # no process of it goes on
        try:
            os.killpg(running.pid, 0)
        except ProcessLookupError:
            break
        assert time.monotonic() < deadline
        time.sleep(0.1)


def test_what_cannot_be_begun(cohort, tmp_path):
    source = cohort / name_of("01")
    for arguments, options, says in (
        (("convert", "nothing/sub-*.trk", tmp_path), {}, "'nothing/sub-\\*.trk' matches no file; put a pattern"),
        (("paint", source, tmp_path), {}, "operation is 'paint'; expected one of 'convert'"),
        (("density", source, tmp_path), {}, "density needs voxel or like"),
        (("select", source, tmp_path), {}, "select needs passes or"),
        (("sample", source, tmp_path), {}, "sample needs image; give image="),
        (("sample", source, tmp_path), {"image": "a.nii", "to": ".tsf", "statistic": "mean"}, "a value per point"),
        (("sample", source, tmp_path), {"image": "a.nii", "to": ".nii"}, "no format has this suffix"),
        (("convert", source, tmp_path), {"workers": 0}, "workers is 0"),
        (("convert", source, tmp_path), {"to": ".trk.gz"}, "no write"),
        (("convert", source, tmp_path), {"resume": True, "overwrite": True}, "exclude each other"),
    ):
        with pytest.raises(ValueError, match=says):
            batch(*arguments, **options)
    with pytest.raises(TypeError, match="convert has no option stepp; it has to, step"):
        batch("convert", source, tmp_path, stepp=1.0)
    shutil.copy(source, tmp_path / "a.trx")
    pf.write(tmp_path / "a.trk", pf.read(source))
    with pytest.raises(ValueError, match=r"a.trk and a.trx would both make a.fiblets"):
        batch("convert", tmp_path / "a.*", tmp_path / "out")
    with pytest.raises(ValueError, match="would be overwritten by its own result"):
        batch("convert", tmp_path / "a.trx", tmp_path, to=".trx")
    (tmp_path / "a.fiblets").touch()
    with pytest.raises(ValueError, match=r"a.fiblets is there already; give"):
        batch("convert", tmp_path / "a.trx", tmp_path)
    from pvfiblets.cluster.connection import ClusterError, connected

    with pytest.raises(ClusterError, match="no scheduler of dask answers at nonsense://"):  # noqa: SIM117
        with connected("nonsense://", 1, None):
            pass


def test_regions_of_the_command_line(tmp_path):
    from pvfiblets.query.regions.region_text import parse_region

    assert parse_region("sphere:1,2,3,4") == regions.Sphere((1, 2, 3), 4)
    assert parse_region("box:0,1,0,2,0,3") == regions.Box((0, 1, 0, 2, 0, 3))
    labels = np.zeros((3, 3, 3), np.int16)
    labels[1, 1, 1], labels[2, 2, 2] = 5, 7
    nib.save(nib.Nifti1Image(labels, np.eye(4)), tmp_path / "a.nii")
    places = [(1, 1, 1), (2, 2, 2), (0, 0, 0)]
    assert parse_region(f"{tmp_path}/a.nii").contains(places).tolist() == [True, True, False]
    assert parse_region(f"{tmp_path}/a.nii:7").contains(places).tolist() == [False, True, False]
    for text in ("sphere:1,2,3", "cube:1", "box:a,b,c,d,e,f", f"{tmp_path}/a.nii:x"):
        with pytest.raises(ValueError, match="is no region; give sphere:X,Y,Z,RADIUS"):
            parse_region(text)


def test_a_folder_that_a_killed_run_left_is_removed(tmp_path):
    import socket

    from pvfiblets.cluster.cohort import _scratch

    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    dead = tmp_path / f".batch-{socket.gethostname()}-{ended.pid}-00000000"
    other = tmp_path / f".batch-elsewhere-{ended.pid}-00000000"
    alive = tmp_path / f".batch-{socket.gethostname()}-{os.getpid()}-00000000"
    for folder in (dead, other, alive):
        folder.mkdir()
    with _scratch(tmp_path) as made:
        assert made.is_dir()
        assert {p.name for p in tmp_path.iterdir()} == {other.name, alive.name, made.name}
    assert not Path(made).exists()
