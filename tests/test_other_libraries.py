"""Streamlines of nibabel, dipy, trx-python and VTK: their own readers of the same data say what must come out."""

import copy

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from nibabel.streamlines import ArraySequence, LazyTractogram, Tractogram

import pvfiblets as pf
from pvfiblets.lines import gather
from pvfiblets.other_libraries import streamlines_of
from pvfiblets.streamlines import Streamlines

AFFINE = np.array([[-2.0, 0.1, 0.0, 30.0], [0.1, 2.0, 0.0, -20.0], [0.0, 0.0, 2.5, 5.0], [0.0, 0.0, 0.0, 1.0]])


def lines(n=7, seed=3):
    rng = np.random.default_rng(seed)
    return [rng.normal(0, 20, (k, 3)).astype(np.float32) for k in rng.integers(1, 9, n)]


@pytest.fixture
def tractogram():
    made = lines()
    return Tractogram(
        made,
        data_per_streamline={"weight": np.arange(7.0), "rgb": np.arange(21.0).reshape(7, 3)},
        data_per_point={"fa": [np.linspace(0, 1, len(line))[:, None] for line in made]},
        affine_to_rasmm=AFFINE,
    )


def in_ras(made, affine=AFFINE):
    return [line @ affine[:3, :3].T + affine[:3, 3] for line in made]


def check(found, wanted, rtol=0.0, atol=1e-4):
    assert isinstance(found, Streamlines)
    assert len(found) == len(wanted)
    for ours, theirs in zip(found, wanted, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=rtol, atol=atol)


@pytest.mark.parametrize("lazy", [False, True])
def test_tractograms_of_nibabel(tractogram, lazy):
    source = LazyTractogram.from_tractogram(tractogram) if lazy else tractogram
    if lazy:
        source._affine_to_rasmm = AFFINE
    found = streamlines_of(source)
    check(found, in_ras(tractogram.streamlines))
    np.testing.assert_array_equal(found.per_streamline["weight"], np.arange(7.0))
    assert found.per_streamline["rgb"].shape == (7, 3)
    np.testing.assert_allclose(found.per_point["fa"], tractogram.data_per_point["fa"].get_data()[:, 0])


@pytest.mark.parametrize("name", ["dipy_tracks300.trk", "nib_complex_big_endian.trk", "nib_standard.LPS.trk"])
def test_files_opened_lazily_are_where_they_are_opened_whole(shared_data, name):
    """Items of such a tractogram come before its affine, half a voxel off."""
    whole = nib.streamlines.load(shared_data / name)
    for source in (nib.streamlines.load(shared_data / name, lazy_load=True),) * 2:  # once more, by the same object
        for lazy in (source, source.tractogram):
            found = streamlines_of(lazy)
            check(found, list(whole.streamlines), atol=0.0)
            for theirs, ours in (
                (whole.tractogram.data_per_point, found.per_point),
                (whole.tractogram.data_per_streamline, found.per_streamline),
            ):
                assert list(ours) == list(theirs)
                for key, values in theirs.items():
                    rows = values.get_data() if hasattr(values, "get_data") else values
                    np.testing.assert_array_equal(ours[key].reshape(rows.shape), rows)


def test_lazy_tractograms_with_pending_affines_and_generators_that_run_once(tractogram):
    moved = LazyTractogram.from_data_func(lambda: iter(tractogram)).apply_affine(np.diag([2.0, 3.0, 4.0, 1.0]))
    moved.affine_to_rasmm = AFFINE
    check(streamlines_of(moved), in_ras([line * [2, 3, 4] for line in tractogram.streamlines]))
    once = iter(list(tractogram.streamlines))
    check(streamlines_of(LazyTractogram(lambda: once, affine_to_rasmm=np.eye(4))), list(tractogram.streamlines))
    empty = LazyTractogram(lambda: iter(()), data_per_point={"fa": lambda: iter(())}, affine_to_rasmm=np.eye(4))
    assert len(streamlines_of(empty)) == 0


def test_what_is_nowhere_or_cannot_be_written_is_refused(tractogram, tmp_path):
    tractogram.affine_to_rasmm = None
    with pytest.raises(ValueError, match="affine_to_rasmm is None"):
        streamlines_of(tractogram)
    with pytest.raises(TypeError, match=r"write takes a path and Streamlines, got list; Streamlines\.from_list"):
        pf.write(tmp_path / "a.trk", lines())
    assert not list(tmp_path.iterdir())
    with pytest.raises(pf.formats.UnknownFormatError, match=r"a\.xyz: no format has this suffix.*\.fiblets"):
        pf.compress(Streamlines.from_list(lines())).save(tmp_path / "a.xyz")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("chosen", [slice(None), slice(2, 6), [5, 1, 1], slice(None, None, -1)])
def test_sequences_and_parts_of_them(chosen):
    """Parts share the whole's buffer, in another order, with gaps."""
    whole = ArraySequence(lines())
    found = streamlines_of(whole[chosen])
    check(found, list(whole[chosen]), atol=0.0)
    found.points[:] = 0.0
    assert whole.get_data().any()


@pytest.mark.parametrize("suffix", [".trk", ".tck"])
def test_files_that_nibabel_opened(tmp_path, suffix):
    given = Streamlines.from_list(lines(), affine=np.diag([2.0, 2.0, 2.0, 1.0]))
    given.space = {"dimensions": (40, 50, 60), "voxel_sizes": (2.0, 2.0, 2.0), "voxel_order": "RAS"}
    pf.write(tmp_path / f"a{suffix}", given)
    found = streamlines_of(nib.streamlines.load(tmp_path / f"a{suffix}"))
    check(found, list(given))
    if suffix == ".trk":
        np.testing.assert_allclose(found.affine, given.affine)
        assert found.space["dimensions"] == (40, 50, 60)


@pytest.mark.parametrize("space", ["rasmm", "vox", "voxmm"])
@pytest.mark.parametrize("origin", ["center", "corner"])
def test_stateful_tractograms_of_dipy(space, origin):
    from dipy.io.stateful_tractogram import Space, StatefulTractogram

    image = nib.Nifti1Image(np.zeros((40, 50, 60), np.uint8), AFFINE)
    made = [np.abs(line) + 3.0 for line in lines()]
    given = StatefulTractogram(in_ras(made), image, Space.RASMM)
    wanted = [np.array(line) for line in given.streamlines]
    given.data_per_streamline["weight"] = np.arange(7.0)[:, None]
    getattr(given, f"to_{space}")()
    getattr(given, f"to_{origin}")()
    before = copy.deepcopy(given)
    found = streamlines_of(given)
    check(found, wanted, atol=1e-3)
    np.testing.assert_array_equal(found.per_streamline["weight"], np.arange(7.0))
    np.testing.assert_allclose(found.affine, AFFINE, atol=1e-6)
    assert found.space["dimensions"] == (40, 50, 60)
    assert given.space == before.space
    np.testing.assert_array_equal(given.streamlines.get_data(), before.streamlines.get_data())


def test_files_that_trx_python_opened(tmp_path):
    from trx.trx_file_memmap import load

    given = Streamlines.from_list(lines(), per_streamline={"weight": np.arange(7.0)}, groups={"some": np.array([1, 4])})
    given.per_group = {"some": {"volume": np.array([3.5])}}
    pf.write(tmp_path / "a.trx", given)
    opened = load(str(tmp_path / "a.trx"))
    found = streamlines_of(opened)
    check(found, list(given))
    np.testing.assert_array_equal(found.per_streamline["weight"], np.arange(7.0))
    assert found.groups["some"].tolist() == [1, 4]
    assert found.per_group["some"]["volume"].tolist() == [3.5]
    opened.close()


def a_mesh(seed=0):
    rng = np.random.default_rng(seed)
    mesh = pv.PolyData(rng.normal(0, 9, (8, 3)), lines=[3, 0, 1, 2, 5, 3, 4, 5, 6, 7])
    mesh.point_data["fa"] = rng.random(8)
    mesh.cell_data["weight"] = [2.0, 5.0]
    return mesh


def test_lines_among_the_cells_of_a_grid():
    """With triangles before, between and after them, which are left out with their data."""
    mesh = a_mesh()
    grid = pv.UnstructuredGrid(
        [3, 7, 6, 5, 3, 0, 1, 2, 3, 0, 1, 2, 5, 3, 4, 5, 6, 7, 3, 1, 2, 3], [5, 4, 5, 4, 5], mesh.points
    )
    grid.point_data["fa"] = mesh.point_data["fa"]
    grid.cell_data["weight"] = [0.0, 2.0, 0.0, 5.0, 0.0]
    found = streamlines_of(grid)
    check(found, list(Streamlines.from_polydata(mesh)), atol=0.0)
    np.testing.assert_array_equal(found.per_streamline["weight"], [2.0, 5.0])
    np.testing.assert_array_equal(found.per_point["fa"], mesh.point_data["fa"])
    assert found.dropped == {"cells that are not lines": 3}
    taken = gather(grid)
    assert taken.counts.tolist() == [3, 5]


def a_grouped_grid():
    mesh = a_mesh()
    mesh.field_data["groups/short"], mesh.field_data["groups/all"] = np.array([0]), np.array([0, 1])
    mesh.field_data["per_group/short/volume"] = np.array([3.5])
    mesh.field_data["affine"] = np.diag([2.0, 2.0, 2.0, 1.0])
    return mesh.cast_to_unstructured_grid()


def test_groups_of_a_grid():
    found = streamlines_of(a_grouped_grid())
    assert {name: ids.tolist() for name, ids in found.groups.items()} == {"short": [0], "all": [0, 1]}
    assert found.per_group["short"]["volume"].tolist() == [3.5]
    np.testing.assert_array_equal(found.affine, np.diag([2.0, 2.0, 2.0, 1.0]))
    again = streamlines_of(found.to_polydata().cast_to_unstructured_grid())
    assert {name: ids.tolist() for name, ids in again.groups.items()} == {"short": [0], "all": [0, 1]}
    assert not again.dropped


@pytest.mark.parametrize("counted", [True, False])
def test_groups_that_a_filter_passed_on_with_fewer_lines(counted):
    grid = a_grouped_grid()
    if counted:
        grid = streamlines_of(grid).to_polydata().cast_to_unstructured_grid()
    found = streamlines_of(grid.extract_cells([1]))
    assert (len(found), found.groups, found.per_group) == (1, {}, {})
    assert found.dropped["groups of other lines"] == 2


def test_blocks_are_groups():
    """Of blocks in blocks too; arrays that one lacks are dropped, and counted."""
    one, other = a_mesh(0), a_mesh(1)
    other.cell_data["more"] = [1.0, 1.0]
    blocks = pv.MultiBlock({"left": one, "empty": pv.PolyData(), "inner": pv.MultiBlock({"right": other})})
    blocks.append(None)
    found = streamlines_of(blocks)
    check(found, [*Streamlines.from_polydata(one), *Streamlines.from_polydata(other)], atol=0.0)
    assert found.groups["left"].tolist() == [0, 1]
    assert found.groups["right"].tolist() == found.groups["inner"].tolist() == [2, 3]
    np.testing.assert_array_equal(found.per_streamline["weight"], [2.0, 5.0, 2.0, 5.0])
    assert found.dropped == {"arrays that some blocks lack (more)": 1}
    assert gather(blocks).counts.tolist() == [3, 5, 3, 5]
    # Blocks of one name in two places are two groups, and what is no line is counted.
    inner = pv.MultiBlock({"a": a_mesh(1)})
    found = streamlines_of(pv.MultiBlock({"a": a_mesh(0), "n": inner, "ball": pv.Sphere()}))
    assert {name: ids.tolist() for name, ids in found.groups.items()} == {"a": [0, 1], "n/a": [2, 3], "n": [2, 3]}
    assert found.dropped["cells that are not lines"] == pv.Sphere().n_cells


@pytest.mark.parametrize(
    ("source", "error", "message"),
    [
        (pv.ImageData(dimensions=(3, 3, 3)), TypeError, "ImageData, which has no lines"),
        (pv.Sphere(), ValueError, r"without lines, but with 1,680 other cells.*extract_all_edges"),
        (pv.MultiBlock([pv.ImageData(dimensions=(2, 2, 2))]), TypeError, "ImageData, which has no lines"),
        (7, TypeError, "source is a int; expected a path"),
        ({"left": np.zeros((3, 3))}, TypeError, "source is a dict; give its values as a list"),
    ],
)
def test_what_holds_no_lines_is_told(source, error, message):
    plotter = pv.Plotter(off_screen=True)
    with pytest.raises(error, match=message):
        plotter.add_fiblets(source)
    plotter.close()


@pytest.mark.parametrize(
    ("source", "what"),
    [
        ([], "streamlines"),
        (pv.PolyData(), "streamlines"),
        (Streamlines(np.zeros((0, 3)), [0]), "streamlines"),
        (pf.compress(Streamlines(np.zeros((0, 3)), [0])), "streamlines"),
        (pf.compress(Streamlines(np.zeros((0, 3)), [0, 0, 0])), "points"),
        (Streamlines(np.zeros((0, 3)), [0, 0, 0]), "points"),
    ],
)
def test_nothing_at_all_is_a_warning(source, what):
    plotter = pv.Plotter(off_screen=True)
    with pytest.warns(UserWarning, match=f"the source holds no {what}: nothing is drawn"):
        plotter.add_fiblets(source)
    plotter.close()


@pytest.mark.parametrize("add", ["add_spline_tubes", "add_halo_lines"])
@pytest.mark.parametrize("source", [[], pv.PolyData(), pv.UnstructuredGrid(), pv.MultiBlock()])
def test_nothing_at_all_is_a_warning_for_tubes_and_halos(source, add):
    plotter = pv.Plotter(off_screen=True)
    with pytest.warns(UserWarning, match="the source holds no lines: nothing is drawn"):
        getattr(plotter, add)(source)
    plotter.close()


@pytest.mark.parametrize("add", ["add_fiblets", "add_spline_tubes", "add_halo_lines"])
def test_a_list_of_points_is_one_line(add):
    plotter = pv.Plotter(off_screen=True)
    line = np.linspace([0.0, 0.0, 0.0], [9.0, 5.0, 1.0], 20)
    found = [getattr(plotter, add)(source) for source in (line, line.tolist(), list(line))]
    assert len({actor.bounds for actor in found}) == 1
    plotter.close()


def test_a_tck_file_with_words_about_voxels(tmp_path):
    """As some writers put them; a header of tck holds any words."""
    given = Streamlines.from_list(lines())
    pf.write(tmp_path / "a.tck", given)
    file = nib.streamlines.load(tmp_path / "a.tck")
    file.header.update(dimensions="(157, 189, 136)", voxel_sizes="(1.0, 1.0, 1.0)")
    check(streamlines_of(file), list(given))


def test_they_are_drawn(tractogram):
    plotter = pv.Plotter(off_screen=True, window_size=(80, 60))
    actor = plotter.add_fiblets(tractogram, scalars="weight", show_scalar_bar=False)
    tubes = plotter.add_spline_tubes(ArraySequence([line for line in lines() if len(line) > 1]), radius=0.5)
    plotter.show(auto_close=False)
    assert actor.fiblets.n_streamlines == 7
    assert tubes.bounds[1] > tubes.bounds[0]
    plotter.close()


def test_a_home_folder_is_found(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    given = Streamlines.from_list(lines())
    pf.write("~/a.tck", given)
    assert (tmp_path / "a.tck").exists()
    assert len(pf.read("~/a.tck")) == 7
    pf.compress(given).save("~/a.fiblets")
    assert pf.FibletSet.open("~/a.fiblets").n_streamlines == 7
    plotter = pv.Plotter(off_screen=True)
    for name in ("~/a.tck", "~/a.fiblets"):
        assert plotter.add_fiblets(name).fiblets.n_streamlines == 7
    plotter.close()
