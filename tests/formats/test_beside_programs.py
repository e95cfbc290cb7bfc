"""Files that MRtrix3, trx-python, DIPY, nibabel and VTK write for this project, and read from it."""

from __future__ import annotations

from contextlib import suppress
from itertools import pairwise

import h5py
import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkPartitionedDataSetCollection

import pvfiblets as pf
from pvfiblets import formats
from pvfiblets.cli.command import main
from pvfiblets.formats import registry
from pvfiblets.formats.attachments import write_scalars
from pvfiblets.images.mif import read_mif
from pvfiblets.other_libraries import streamlines_of
from pvfiblets.query.bundles import statistics
from pvfiblets.streamlines import Streamlines

OFFSETS = np.array([0, 5, 5, 12])
POINTS = np.random.default_rng(3).normal(0, 20, (12, 3)).astype(np.float32)
LINES = Streamlines(POINTS, OFFSETS)
KEPT = ["method: iFOD2", "command_history: tckgen a", "command_history: tckedit b", "output_step_size: 1"]


def tck(path, points=POINTS, offsets=OFFSETS, fields=(*KEPT, "step_size: 0.5", "timestamp: 1700000000.5"), kind="<f4"):
    """Write a file as MRtrix lays it out; keys begin with a capital, which MRtrix takes as well."""
    kind = np.dtype(kind)
    own = [f"Datatype: Float{kind.itemsize * 8}{'BE' if kind.byteorder == '>' else 'LE'}", f"Count: {len(offsets) - 1}"]
    rows = [np.r_[points[a:b], np.full((1, 3), np.nan)] for a, b in pairwise(offsets)]
    head = "\n".join(["mrtrix tracks", *own, *fields, "File: . 400", "END", ""]).encode().ljust(400, b"\0")
    path.write_bytes(head + np.concatenate([*rows, np.full((1, 3), np.inf)]).astype(kind).tobytes())
    return path


def header(path):
    """Return the lines of a header, sorted."""
    return sorted(path.read_bytes().split(b"\nEND\n")[0].decode().split("\n")[1:])


def value(path, key):
    return [line.partition(": ")[2] for line in header(path) if line.partition(": ")[0] == key]


def largest_step(points, offsets):
    return max(
        np.linalg.norm(np.diff(points[a:b].astype(float), axis=0), axis=1).max(initial=0) for a, b in pairwise(offsets)
    )


@pytest.mark.parametrize("kind", ["<f4", ">f4", "<f8"])
@pytest.mark.parametrize("way", ["read", "fiblets", "vtp", "pieces"])
def test_the_keys_of_a_tck_header_are_kept_while_the_points_are(tmp_path, kind, way):
    source, target = tck(tmp_path / "a.tck", kind=kind), tmp_path / "b.tck"
    lines = formats.read(source)
    if way == "pieces":
        lines = Streamlines.concatenate(formats.iter_chunks(source, 3))
    elif way == "vtp":
        pf.write(tmp_path / "b.vtp", lines)
        lines = pf.read(tmp_path / "b.vtp")
    elif way == "fiblets":
        pf.compress(lines, exact=True).save(tmp_path / "b.fiblets")
        lines = pf.read(tmp_path / "b.fiblets")
    pf.write(target, lines)
    wanted = sorted([*KEPT, "step_size: 0.5", "timestamp: 1700000000.5"])
    assert [line for line in header(target) if not line.startswith(("datatype", "count", "file"))] == wanted
    np.testing.assert_array_equal(nib.streamlines.load(target).streamlines.get_data(), POINTS)


def test_keys_that_do_not_hold_any_more_are_made_anew_and_told(tmp_path):
    lines = formats.read(tck(tmp_path / "a.tck"))
    lines.points *= 2
    with pytest.warns(UserWarning, match=r"timestamp from 1700000000.5 to .*, step_size from 0.5 to"):
        pf.write(tmp_path / "b.tck", lines)
    step = largest_step(POINTS * 2, OFFSETS)
    assert value(tmp_path / "b.tck", "method") == ["iFOD2"]
    for key in ("step_size", "output_step_size"):
        np.testing.assert_allclose([float(text) for text in value(tmp_path / "b.tck", key)], [step], rtol=1e-6)
    with pytest.warns(UserWarning, match="step_size from 0.5"):
        pf.write(tmp_path / "c.tck", lines[[2]])
    stamps = {*value(tmp_path / "b.tck", "timestamp"), *value(tmp_path / "c.tck", "timestamp")}
    assert len(stamps - {"1700000000.5"}) == 2


def test_points_of_another_source_get_a_step_and_a_timestamp_that_their_scalars_share(tmp_path):
    lines = Streamlines(POINTS.astype(float), OFFSETS, {"v": np.arange(12.0)})
    pf.write(tmp_path / "a.tck", lines)
    write_scalars(tmp_path / "a.tsf", lines, "v")
    assert value(tmp_path / "a.tck", "timestamp") == value(tmp_path / "a.tsf", "timestamp") != []
    step = float(value(tmp_path / "a.tck", "step_size")[0])
    np.testing.assert_allclose(step, largest_step(POINTS, OFFSETS), rtol=1e-6)
    back = formats.read(tmp_path / "a.tck")
    assert formats.attach(back, tmp_path / "a.tsf") == "per_point"
    raw = (tmp_path / "a.tsf").read_bytes()
    (tmp_path / "o.tsf").write_bytes(raw.replace(b"timestamp: 0", b"timestamp: 1"))
    with pytest.warns(UserWarning, match=r"o.tsf has the timestamp 1.*; make the .tsf file again"):
        formats.attach(back, tmp_path / "o.tsf")


def test_a_mih_header_ends_with_the_file_as_mrtrix_leaves_it(tmp_path):
    values = np.arange(24, dtype="<f4").reshape(2, 3, 4)
    (tmp_path / "a.dat").write_bytes(values.tobytes(order="F"))
    lines = ["mrtrix image", "dim: 2,3,4", "vox: 1,1,1", "layout: +0,+1,+2", "datatype: Float32LE", "file: a.dat"]
    (tmp_path / "a.mih").write_text("\n".join(lines) + "\n")
    np.testing.assert_array_equal(read_mif(tmp_path / "a.mih").values, values)


def test_points_of_a_vtk_file_are_floats_unless_doubles_are_asked_for(tmp_path):
    """tckconvert takes the bytes of doubles for floats."""
    lines = Streamlines(POINTS.astype(float) + 1e-9, OFFSETS)
    for double, kind in ((False, "float"), (True, "double")):
        formats.write(tmp_path / "a.vtk", lines, double=double)
        raw = (tmp_path / "a.vtk").read_bytes()
        words = f"POINTS 12 {kind}\n".encode()
        begin = raw.index(words) + len(words)
        found = np.frombuffer(raw, ">f8" if double else ">f4", 36, begin).reshape(-1, 3)
        np.testing.assert_array_equal(found, lines.points if double else POINTS)
    far = Streamlines(POINTS.astype(float) + 1e6, OFFSETS)
    with pytest.warns(UserWarning, match="float32 moves points by up to"):
        formats.write(tmp_path / "a.vtk", far)


@pytest.mark.parametrize("name", ["SLF & AF", "p<0.05", 'say "x"', "it's > 1", "a\ttab", "two\nlines", "&amp;"])
def test_vtk_reads_any_name_in_a_vtp_file(tmp_path, name):
    path = tmp_path / "a.vtp"
    values = {name: np.arange(12.0)}, {name: np.arange(3.0)}, {name: [1]}, {name: {name: [4.0]}}
    lines = Streamlines(POINTS, OFFSETS, *values)
    formats.write(path, lines)
    mesh = pv.read(path)
    assert name in mesh.point_data
    assert name in mesh.cell_data
    assert {f"groups/{name}", f"per_group/{name}/{name}"} <= {*mesh.field_data.keys()}
    back = formats.read(path)
    assert (list(back.groups), list(back.per_group[name])) == ([name], [name])
    lines.groups["\x01"] = np.array([1])
    with pytest.raises(ValueError, match=r"the name 'groups/\\x01' .* XML cannot hold; rename it"):
        formats.write(path, lines)


def test_trx_python_reads_a_file_of_names_with_dots(tmp_path):
    """It takes a name's part behind a dot for the number of columns."""
    from trx.trx_file_memmap import load

    values = {"fa.mean": np.arange(12.0, dtype="f4"), "fa_mean": np.ones(12, "f4"), "b.3": np.zeros((12, 3), "f4")}
    weights = {"w.sift2": np.arange(3.0, dtype="f4")}
    groups, per_group = {"AF.left": [0, 2]}, {"AF.left": {"mean.fa": [0.5]}}
    with pytest.warns(UserWarning, match=r"'fa.mean' is 'fa_mean_', 'b.3' is 'b_3'.*'AF.left' is 'AF_left'"):
        formats.write(tmp_path / "a.trx", Streamlines(POINTS, OFFSETS, values, weights, groups, per_group))
    found = load(str(tmp_path / "a.trx"))
    for name, new in {"fa.mean": "fa_mean_", "fa_mean": "fa_mean", "b.3": "b_3"}.items():
        got = found.data_per_vertex[new].get_data().reshape(values[name].shape)
        np.testing.assert_array_equal(got, values[name])
    np.testing.assert_array_equal(np.ravel(found.data_per_streamline["w_sift2"]), weights["w.sift2"])
    np.testing.assert_array_equal(found.groups["AF_left"], [0, 2])
    assert float(np.ravel(found.data_per_group["AF_left"]["mean_fa"])[0]) == 0.5
    found.close()


def test_a_trk_file_that_nibabel_refuses_warns(tmp_path):
    lines = Streamlines(POINTS, OFFSETS, per_streamline={"w": np.arange(3.0)})
    with pytest.warns(UserWarning, match=r"1 streamlines have no points.*counts > 0"):
        formats.write(tmp_path / "a.trk", lines)
    assert formats.read(tmp_path / "a.trk").counts.tolist() == [5, 0, 7]
    formats.write(tmp_path / "b.trk", lines[lines.counts > 0])
    back = nib.streamlines.load(tmp_path / "b.trk")
    assert [len(line) for line in back.streamlines] == [5, 7]
    assert back.tractogram.data_per_streamline["w"].ravel().tolist() == [0, 2]


@pytest.mark.parametrize("chunk", [1, 1 << 20])
def test_means_of_bundles_weigh_by_length_as_tcksample_does(monkeypatch, chunk):
    """Its -stat_tck mean of the first line is 5.5, by trapezoids; the closed form of all lines is NumPy's trapezoid."""
    monkeypatch.setattr(statistics, "CHUNK", chunk)
    image = (np.broadcast_to(np.arange(1.0, 11)[:, None, None], (10, 10, 10)), np.diag([2.0, 2, 2, 1]))
    along = [np.array([1, 1.1, 1.2, 1.3, 17]), np.array([3.0]), np.array([]), np.array([0.0, 0.5, 9, 9, 40, 2])]
    lines = Streamlines.from_list(
        [np.c_[x, np.full((len(x), 2), 4.0)] for x in along], groups={"one": [0], "all": [0, 1, 2, 3], "point": [1]}
    )
    lines.per_point["x"] = lines.points[:, 0] ** 2
    table = statistics.bundle_table(lines, images={"i": image})
    weights = [np.convolve(np.abs(np.diff(x)), [0.5, 0.5]) if len(x) > 1 else np.zeros(len(x)) for x in along]
    w, x = np.concatenate(weights), np.concatenate(along)
    inside = x <= 19
    wanted = [np.average(x[inside] / 2 + 1, weights=w[inside]), np.average(x**2, weights=w)]
    np.testing.assert_allclose(table["mean_i"], [5.5, wanted[0], np.nan], rtol=1e-12)
    np.testing.assert_allclose(table["mean_x"][1:], [wanted[1], np.nan], rtol=1e-12)
    spread = np.average((x[inside] / 2 + 1 - wanted[0]) ** 2, weights=w[inside]) ** 0.5
    np.testing.assert_allclose(table["std_i"][1], spread, rtol=1e-12)
    plain = statistics.bundle_table(lines, images={"i": image}, weights="points")
    wanted = [np.mean(along[0] / 2 + 1), np.mean(x[inside] / 2 + 1), 2.5]
    np.testing.assert_allclose(plain["mean_i"], wanted, rtol=1e-12)
    with pytest.raises(ValueError, match="unknown weights 'size'; choose 'length' or 'points'"):
        statistics.bundle_table(lines, weights="size")


def mesh_of_lines():
    return pv.PolyData(POINTS[:8], lines=np.array([4, 0, 1, 2, 3, 4, 4, 5, 6, 7]))


@pytest.mark.parametrize("name", ["a.vtp", "a.vtu", "a.vtm", "a.vtkhdf"])
def test_lines_in_files_that_pyvista_writes(tmp_path, name):
    path, mesh = tmp_path / name, mesh_of_lines()
    mesh.cell_data["w"] = [1.0, 2.0]
    if name == "a.vtp":
        mesh.save(path, compression="lz4")
    elif name == "a.vtm":
        pv.MultiBlock({"AF": mesh}).save(path)
    else:
        (mesh.cast_to_unstructured_grid() if name == "a.vtu" else mesh).save(path)
    found = formats.read(path)
    np.testing.assert_array_equal(found.points, POINTS[:8])
    assert (found.counts.tolist(), found.per_streamline["w"].tolist()) == ([4, 4], [1, 2])
    assert list(found.groups) == (["AF"] if name == "a.vtm" else [])
    assert formats.info(path)["points"] == 8
    with pytest.raises(formats.UnknownFormatError, match="has no write"):
        formats.write(path.with_suffix(".vtu"), found)
    raw = path.read_bytes()
    path.write_bytes(raw[: len(raw) // 2])
    with pytest.raises(formats.FormatError):
        formats.read(path)


def test_a_damaged_block_of_lz4_is_an_error(tmp_path):
    pv.lines_from_points(np.repeat(POINTS, 50, axis=0)).save(tmp_path / "a.vtp", compression="lz4", binary=True)
    raw = bytearray((tmp_path / "a.vtp").read_bytes())
    for at in range(len(raw) // 3, len(raw), len(raw) // 60):
        damaged = raw.copy()
        damaged[at] ^= 1
        (tmp_path / "b.vtp").write_bytes(damaged)
        with suppress(formats.FormatError):
            formats.read(tmp_path / "b.vtp")


def test_partitioned_datasets_are_read(tmp_path):
    mesh = mesh_of_lines()
    collection = vtkPartitionedDataSetCollection()
    for i, part in enumerate((mesh, mesh.translate((1, 0, 0), inplace=False))):
        collection.SetPartition(0, i, part)
    collection.SetPartition(1, 0, mesh)
    collection.GetMetaData(1).Set(vtkCompositeDataSet.NAME(), "AF")
    found = streamlines_of(collection)
    assert {name: ids.tolist() for name, ids in found.groups.items()} == {"block 0": [0, 1, 2, 3], "AF": [4, 5]}
    np.testing.assert_array_equal(found.points[8:16], POINTS[:8] + np.float32([1, 0, 0]))
    assert len(streamlines_of(pv.PartitionedDataSet([mesh, mesh]))) == 4


def test_fib_and_dpy_files_of_dipy_are_read(tmp_path):
    formats.write(tmp_path / "a.vtk", LINES)
    (tmp_path / "a.fib").write_bytes((tmp_path / "a.vtk").read_bytes())  # legacy VTK, as DIPY writes it
    np.testing.assert_array_equal(formats.read(tmp_path / "a.fib").points, POINTS)
    with h5py.File(tmp_path / "a.dpy", "w") as file:
        file.create_dataset("streamlines/tracks", data=POINTS)
        file.create_dataset("streamlines/offsets", data=OFFSETS)
    found = formats.read(tmp_path / "a.dpy")
    np.testing.assert_array_equal(found.points, POINTS)
    np.testing.assert_array_equal(found.offsets, OFFSETS)
    with h5py.File(tmp_path / "a.dpy", "a") as file:
        file["streamlines/offsets"][-1] = 13
    with pytest.raises(formats.FormatError, match="expected tracks of 3 columns, and offsets"):
        formats.read(tmp_path / "a.dpy")
    raw = (tmp_path / "a.dpy").read_bytes()
    for part in (raw[:4], raw[: len(raw) // 2]):
        (tmp_path / "a.dpy").write_bytes(part)
        with pytest.raises(formats.FormatError, match="magic|damaged HDF5"):
            formats.read(tmp_path / "a.dpy")


@pytest.mark.parametrize("suffix", [".vtk", ".vtp", ".vtu", ".vtm"])
def test_the_space_of_a_file_that_names_none_can_be_given(tmp_path, capsys, suffix):
    """DIPY writes LPS up to 1.11 and RAS from 1.12; its files are told apart by nothing."""
    path, mesh = tmp_path / f"a{suffix}", mesh_of_lines()
    made = {".vtu": mesh.cast_to_unstructured_grid(), ".vtm": pv.MultiBlock([mesh])}.get(suffix, mesh)
    made.save(path)
    turned = POINTS[:8] * np.float32([-1, -1, 1])
    np.testing.assert_array_equal(formats.read(path).points, POINTS[:8])
    np.testing.assert_array_equal(formats.read(path, space="lps").points, turned)
    np.testing.assert_array_equal(next(formats.iter_chunks(path, 4, space="LPS")).points, turned[:4])
    assert formats.info(path)["space_from"].startswith("assumed")
    assert main(["info", "--space", "lps", str(path)]) == 0
    assert "given, the file names none" in capsys.readouterr().out
    assert main(["convert", "--quiet", "--space", "LPS", str(path), str(tmp_path / "a.trx")]) == 0
    np.testing.assert_array_equal(formats.read(tmp_path / "a.trx").points, turned)
    made.field_data["SPACE"] = ["RAS"]
    made.save(path)
    np.testing.assert_array_equal(formats.read(path, space="LPS").points, POINTS[:8])
    with pytest.raises(ValueError, match="unknown space 'SCR'; choose 'RAS' or 'LPS'"):
        formats.read(path, space="SCR")
    with pytest.raises(ValueError, match="space is an option of .vtk, .vtp"):
        formats.read(tmp_path / "a.trx", space="LPS")


def test_pages_do_not_offer_what_other_libraries_read():
    """Pages take uploads by these suffixes."""
    assert not {".vtu", ".vtm", ".vtkhdf", ".pvtp", ".dpy"} & set(registry.suffixes())
