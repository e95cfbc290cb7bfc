"""Graphs of connectomes against scipy's centres of mass, symmetric matrices and means of streamlines."""

import nibabel
import numpy as np
import pytest
from scipy.ndimage import center_of_mass

from pvfiblets import FormatError, Streamlines, compress
from pvfiblets.query.connectome.graph import as_graph, mean_streamlines
from pvfiblets.query.connectome.matrix import connectome, end_labels, read_matrix

SHEARED = np.array([[2.0, 0.4, 0.0, -30.0], [0.0, -1.5, 0.3, 22.0], [0.2, 0.0, 2.5, -28.0], [0.0, 0.0, 0.0, 1.0]])
LABELS = np.array([3, 5, 8, 11])


@pytest.fixture(scope="module")
def atlas():
    rng = np.random.default_rng(1)
    return rng.choice([0, 0, 0, 0, 0, 0, *LABELS], (30, 30, 24)).astype(np.int16), SHEARED


@pytest.fixture(scope="module")
def streamlines():
    rng = np.random.default_rng(2)
    lines = []
    for count in rng.integers(1, 40, 300):
        steps = rng.normal(size=3) * 0.6 + 0.1 * rng.normal(size=(count, 3))
        lines.append(rng.uniform(-35, 35, 3) + np.cumsum(steps, axis=0))
    return Streamlines.from_list([*lines, np.zeros((0, 3))])


@pytest.fixture
def weights():
    rng = np.random.default_rng(3)
    whole = rng.normal(size=(4, 4))
    return whole + whole.T


def test_nodes_lie_at_the_centres_of_mass(atlas, weights, tmp_path):
    volume, affine = atlas
    expected = np.array(center_of_mass(volume > 0, volume, LABELS)) @ affine[:3, :3].T + affine[:3, 3]
    nibabel.save(nibabel.Nifti1Image(volume, affine), tmp_path / "atlas.nii.gz")
    for given in (atlas, tmp_path / "atlas.nii.gz", nibabel.Nifti1Image(volume.astype("f4"), affine)):
        graph = as_graph(weights, given)
        np.testing.assert_allclose(graph.positions, expected, atol=1e-5)
        np.testing.assert_array_equal(graph.labels, LABELS)


def test_rows_are_labels_in_order_or_numbers_up_to_the_highest(atlas):
    weights = np.zeros((11, 11))
    weights[2, 4], weights[7, 10], weights[0, 2] = 1.0, 2.0, 5.0
    graph = as_graph(weights, atlas)  # MRtrix's: a row for each number
    four = as_graph(np.ones((4, 4)), atlas)
    assert np.isnan(graph.positions).all(axis=1).nonzero()[0].tolist() == [0, 1, 3, 5, 6, 8, 9]
    np.testing.assert_array_equal(graph.positions[LABELS - 1], four.positions)
    assert graph.pairs.tolist() == [[2, 4], [7, 10]]  # label 1 is nowhere
    for n in (3, 5, 10, 12):
        with pytest.raises(ValueError, match=rf"matrix has {n} rows, and the atlas has 4 labels, 3 to 11"):
            as_graph(np.ones((n, n)), atlas)


def test_pairs_are_those_of_weights(weights):
    weights[0, 3] = weights[3, 0] = np.nan
    weights[1, 2] = weights[2, 1] = 0.0
    graph = as_graph(weights, np.eye(4)[:, :3])
    assert graph.pairs.tolist() == [[i, j] for i in range(4) for j in range(i + 1, 4) if np.nan_to_num(weights)[i, j]]
    np.testing.assert_array_equal(graph.weights[tuple(graph.pairs.T)], weights[tuple(graph.pairs.T)])
    assert not np.diag(graph.weights).any()


@pytest.mark.parametrize("half", [np.triu, np.tril])
def test_one_triangle_is_a_matrix(weights, half):
    np.fill_diagonal(weights, 0.0)
    graph = as_graph(half(weights), np.eye(4)[:, :3])
    np.testing.assert_array_equal(graph.weights, weights)


def test_rounding_is_no_direction(weights):
    printed = np.array([[float(f"{number:.6g}") for number in row] for row in weights])
    mixed = np.triu(weights) + np.tril(printed, -1)
    np.testing.assert_allclose(as_graph(mixed, np.eye(4)[:, :3]).weights, weights * (1 - np.eye(4)), rtol=1e-5)
    weights[3, 1] += 0.01
    with pytest.raises(ValueError, match=r"not symmetric: \[1, 3\] is .* and \[3, 1\] is .*\(matrix \+ matrix.T\) / 2"):
        as_graph(weights, np.eye(4)[:, :3])


@pytest.mark.parametrize(("matrix", "labels", "message"), [
    (np.ones((2, 3)), np.zeros((2, 3)), r"matrix has the shape \(2, 3\)"),
    (np.ones(4), np.zeros((4, 3)), r"matrix has the shape \(4,\)"),
    (np.zeros((0, 0)), np.zeros((0, 3)), r"matrix has the shape \(0, 0\)"),
    ([[0, np.inf], [1, 0]], np.zeros((2, 3)), r"inf at \[0, 1\]"),
    (np.ones((2, 2)), np.zeros((3, 3)), r"labels have the shape \(3, 3\).*\(2, 3\) positions"),
    (np.ones((2, 2)), np.zeros((4, 4, 4), int), r"labels have the shape \(4, 4, 4\).*\(array, affine\)"),
    (np.ones((2, 2)), (np.zeros((4, 4, 4), int), np.eye(4)), "has 0 labels; a row"),
])  # fmt: skip
def test_bad_input_is_named(matrix, labels, message):
    with pytest.raises(ValueError, match=message):
        as_graph(matrix, labels)


@pytest.mark.parametrize("suffix", [".csv", ".tsv", ".txt", ".npy"])
def test_files_are_read_as_they_are_written(streamlines, atlas, suffix, tmp_path):
    found = connectome(streamlines[:40], atlas, contrast="length", radius=2.0, names={3: "a, b", 5: "c\td", 8: '"'})
    assert np.isnan(found.matrix).any()
    found.save(tmp_path / f"matrix{suffix}")
    numbers, names = read_matrix(tmp_path / f"matrix{suffix}")
    np.testing.assert_allclose(numbers, found.matrix, rtol=1e-9)
    assert names == (found.names if suffix in (".csv", ".tsv") else None)


@pytest.mark.parametrize(("text", "names"), [
    ("0,1.5,2\n0,0,-3\n0,0,0\n", None),
    ("# command_history: tck2connectome brain.tck\n0 1.5 2 \n0 0 -3\n0 0 0\n\n", None),
    ("0;1.5;2\n;0;-3\n0;0;\n", None),
    (",a,b,c\na,0,1.5,2\nb,0,0,-3\nc,,0,0\n", ["a", "b", "c"]),
    ("a b c\n0 1.5 2\n0 0 -3\n0 0 0\n", ["a", "b", "c"]),
    ("\t1\t2\t3\n1\t0\t1.5\t2\n2\t0\t0\t-3\n3\t0\t0\t0\n", ["1", "2", "3"]),
])  # fmt: skip
def test_files_of_other_programs(text, names, tmp_path):
    (tmp_path / "matrix.csv").write_text(text)
    numbers, found = read_matrix(tmp_path / "matrix.csv")
    np.testing.assert_array_equal(np.nan_to_num(numbers), [[0, 1.5, 2], [0, 0, -3], [0, 0, 0]])
    assert found == names


@pytest.mark.parametrize(("text", "message"), [
    ("", "a matrix"), ("1,2\n3\n", r"rows of \[1, 2\] numbers"), ("1,2\n3,x\n", "'x'"), (",a,b\n", "a matrix"),
])  # fmt: skip
def test_damaged_files_are_refused(text, message, tmp_path):
    (tmp_path / "matrix.csv").write_text(text)
    with pytest.raises(FormatError, match=message):
        read_matrix(tmp_path / "matrix.csv")


def resampled(line, n):
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    return np.stack([np.interp(np.linspace(0, along[-1], n), along, axis) for axis in line.T], axis=1)


@pytest.mark.parametrize("coded", [False, True])
def test_streamlines_are_averaged_from_the_first_node_to_the_second(streamlines, atlas, coded):
    found = connectome(streamlines, atlas)
    ends, graph = end_labels(streamlines, atlas, 4.0), as_graph(np.ones((4, 4)), atlas)
    source = compress(streamlines, exact=True) if coded else streamlines
    means, counts = mean_streamlines(graph, source, 20)
    again, _ = mean_streamlines(as_graph(found, np.zeros((4, 3))), source, 20)
    assert len(graph.pairs) == 6
    for (low, high), mean, count in zip(LABELS[graph.pairs], means, counts, strict=True):
        lines = [resampled(np.asarray(line)[:: 1 if tuple(pair) == (low, high) else -1], 20)
                 for line, pair in zip(streamlines, ends, strict=True) if sorted(pair) == [low, high]]  # fmt: skip
        assert count == len(lines) > 3
        np.testing.assert_allclose(mean, np.mean(lines, axis=0), atol=1e-4)
    np.testing.assert_array_equal(means[found.counts[tuple(graph.pairs.T)] > 0], again)
    few, none = mean_streamlines(graph, streamlines[:2], 20)
    assert np.isnan(few[none == 0]).all()
    with pytest.raises(ValueError, match="no labels at the ends of 301 streamlines"):
        mean_streamlines(as_graph(np.ones((4, 4)), np.zeros((4, 3))), source)
