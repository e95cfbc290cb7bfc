"""Where planes lie, glyphs, tables of labels, and colours, against dipy, NumPy and formulas."""

from __future__ import annotations

import warnings

import matplotlib as mpl
import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from dipy.core.sphere import Sphere
from dipy.reconst.shm import sh_to_sf

from pvfiblets.errors import FormatError
from pvfiblets.slices import colours, glyphs
from pvfiblets.slices.frames import ORIENTATIONS, covered, grid_of, letters, nearest_frame, plane_axes
from pvfiblets.slices.image import SliceImage
from pvfiblets.slices.labels import LabelTable, as_label_table, distinct_colours
from pvfiblets.slices.spherical_harmonics import degrees, sh_matrix
from pvfiblets.slices.vectors import fsl_axes, in_scanner_axes

SHEARED = np.array([[2.0, 0.7, 0.3, -20.0], [-0.4, 1.5, 0.2, 5.0], [0.1, 0.5, 3.0, 9.0], [0.0, 0.0, 0.0, 1.0]])


def image(affine=SHEARED, shape=(6, 7, 5)):
    return SliceImage(np.zeros((*shape, 1), np.float32), affine)


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_what_a_plane_shows_holds_every_point_of_it_in_the_image(orientation):
    one = image()
    along, up = plane_axes(np.eye(3), orientation)
    position = one.center + (0.3, -0.2, 0.4)
    low_u, high_u, low_v, high_v = covered([one.corners], position, along, up)
    rng = np.random.default_rng(0)
    u, v = rng.uniform(-60, 60, (2, 200_000))
    at = position + u[:, None] * along + v[:, None] * up
    voxels = nib.affines.apply_affine(np.linalg.inv(SHEARED), at)
    inside = ((voxels >= -0.5) & (voxels <= np.array(one.shape) - 0.5)).all(axis=1)
    assert inside.sum() > 500
    for found, ends in ((u[inside], (low_u, high_u)), (v[inside], (low_v, high_v))):
        assert ends[0] <= found.min() < ends[0] + 1.0
        assert ends[1] - 1.0 < found.max() <= ends[1]


def test_a_plane_that_misses_shows_nothing_and_letters_name_its_sides():
    along, up = plane_axes(np.eye(3), "axial")
    assert covered([image().corners], np.array([0.0, 0.0, 1000.0]), along, up) is None
    for axis, pair in enumerate(("RL", "AP", "SI")):
        assert (letters(np.eye(3)[axis]), letters(-np.eye(3)[axis])) == tuple(pair)
    assert letters(np.array([0.0, 0.8, -0.6])) == "AI"
    assert letters(np.array([0.99, 0.05, 0.0])) == "R"
    with pytest.raises(ValueError, match="invertible"):
        image(np.diag([1.0, 0.0, 1.0, 1.0]))


def test_pixels_fill_the_rectangle_and_voxel_edges_are_pixel_edges():
    one = image(np.diag([2.0, 2.0, 2.0, 1.0]))
    along, up = plane_axes(np.eye(3), "coronal")
    bounds = covered([one.corners], one.center, along, up)
    grid = grid_of(bounds, one.center, along, up, 1.0)
    assert grid.shape == (12, 10)
    np.testing.assert_allclose(grid.corner, [-1.0, one.center[1], -1.0])
    np.testing.assert_allclose(grid.positions()[3, 4], grid.corner + 4.5 * grid.along + 3.5 * grid.up)


@pytest.mark.parametrize("codes", ["RAS", "LPI", "SAR", "PIL", "ARS"])
def test_the_nearest_frame_of_an_image_stored_along_other_axes_is_the_scanner_s(codes):
    stored = nib.orientations.axcodes2ornt(codes)
    affine = np.zeros((4, 4))
    affine[3, 3] = 1.0
    for axis, (world, sign) in enumerate(stored):
        affine[int(world), axis] = sign * (axis + 1.0)
    np.testing.assert_allclose(nearest_frame(affine), np.eye(3), atol=1e-12)


def test_the_nearest_frame_follows_a_tilted_and_sheared_image():
    angle = np.radians(20.0)
    tilt = np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])
    affine = np.eye(4)
    affine[:3, :3] = tilt @ np.diag([-2.0, 2.0, 3.0])
    np.testing.assert_allclose(nearest_frame(affine), tilt, atol=1e-12)
    frame = nearest_frame(SHEARED)
    np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-12)
    assert np.linalg.det(frame) > 0.0


AFFINE = np.array([[2.0, 0.5, 0.0, -5.0], [0.0, 2.5, 0.3, 4.0], [0.1, 0.0, 3.0, 9.0], [0.0, 0.0, 0.0, 1.0]])
RNG = np.random.default_rng(0)
DIRECTIONS = RNG.normal(size=(60, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1, keepdims=True)


@pytest.mark.parametrize(("basis", "dipys", "legacy"), [
    ("mrtrix", "tournier07", False), ("tournier07_legacy", "tournier07", True),
    ("descoteaux07", "descoteaux07", False), ("descoteaux07_legacy", "descoteaux07", True),
])  # fmt: skip
@pytest.mark.parametrize(("degree", "full"), [(0, False), (4, False), (12, False), (5, True)])
def test_harmonics_are_dipys(basis, dipys, legacy, degree, full):
    n = (degree + 1) ** 2 if full else (degree + 1) * (degree + 2) // 2
    coefficients = RNG.normal(size=(7, n))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PendingDeprecationWarning)
        wanted = sh_to_sf(coefficients, Sphere(xyz=DIRECTIONS), sh_order_max=degree, basis_type=dipys,
                          full_basis=full, legacy=legacy)  # fmt: skip
    assert degrees(n, full) == degree
    with pytest.raises(ValueError, match="7 numbers per voxel"):
        degrees(7, False)
    with pytest.raises(ValueError, match="basis is"):
        sh_matrix(DIRECTIONS, 2, "fsl")
    np.testing.assert_allclose(coefficients @ sh_matrix(DIRECTIONS, degree, basis, full).T, wanted, atol=1e-9)


def test_lobes_reach_as_far_as_the_function():
    values = RNG.normal(size=(2, 3, 4, 15))
    image = SliceImage(values, AFFINE)
    voxels = np.array([[0, 1, 2], [1, 2, 3]])
    found = glyphs.lobes(image, voxels, DIRECTIONS, 1.0, True, "mrtrix", False)
    middle = voxels @ AFFINE[:3, :3].T + AFFINE[:3, 3]
    out = np.linalg.norm(found.points - middle[:, None], axis=-1)
    sphere = Sphere(xyz=DIRECTIONS)
    sf = sh_to_sf(values[tuple(voxels.T)], sphere, sh_order_max=4, basis_type="tournier07", legacy=False)
    half = 0.5 * np.linalg.norm(AFFINE[:3, :3], axis=0).min()
    np.testing.assert_allclose(out, half * np.maximum(sf, 0) / sf.max(axis=1, keepdims=True), atol=1e-9)


@pytest.mark.parametrize("tensor", ["mrtrix", "dipy", "fsl"])
def test_ellipsoids_have_the_eigenvectors_as_axes(tensor):
    turn = np.linalg.qr(RNG.normal(size=(3, 3)))[0]
    own = np.array([0.3, 0.5, 1.7])
    matrix = turn @ np.diag(own) @ turn.T
    parts = {"mrtrix": [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)],
             "dipy": [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)],
             "fsl": [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]}[tensor]  # fmt: skip
    image = SliceImage(np.array([matrix[one] for one in parts]).reshape(1, 1, 1, 6), np.diag([2.0, 2.0, 2.0, 1.0]))
    found = glyphs.ellipsoids(image, np.zeros((1, 3), int), turn.T, 1.0, True, tensor, "scanner")
    np.testing.assert_allclose(abs(found.points[0] @ turn), np.diag(own / own[-1]), atol=1e-12)
    np.testing.assert_array_equal(found.colours[0, 0], np.rint(255 * abs(turn[:, 2])))


SCANNER = np.array([[1, 2, 3], [-2, 1, 0.5], [0, 0, 1]]) / np.sqrt([[14], [5.25], [1]])
"""Directions in the scanner's axes."""
OBLIQUE = np.array([[-2.11486244, -0.25335181, 1.05308151], [1.13436055, -1.89819956, 1.2550137],
                    [0.70041627, 2.30925345, 1.1471529]])  # fmt: skip
OF_MRTRIX = np.array(
    [[-0.241081, 0.256393, 0.936025], [-0.997569, -0.034459, -0.060571], [-0.280166, 0.769751, 0.573576]]
)
"""The same in FSL's axes, as ``mrconvert -export_grad_fsl`` of MRtrix 3.0.3 writes them for this affine."""


@pytest.mark.parametrize("flip", [1.0, -1.0])
def test_fsls_axes_are_those_of_mrtrix(flip):
    """With the third axis of the image reversed, its part changes sign, and x as well: the determinant does."""
    found = SCANNER @ fsl_axes(OBLIQUE * [1.0, 1.0, flip])
    np.testing.assert_allclose(found, OF_MRTRIX * [flip, 1.0, flip], atol=1e-6)


AXES_OF_IMAGES = {
    "positive": np.diag([2.0, 2.0, 2.0]), "negative": np.diag([-2.0, 2.0, 2.0]), "oblique": OBLIQUE,
    "oblique, negative": OBLIQUE * [1.0, 1.0, -1.0], "permuted": np.eye(3)[[2, 0, 1]],
}  # fmt: skip


@pytest.mark.parametrize("name", AXES_OF_IMAGES)
def test_tensors_and_vectors_of_fsl_are_turned(name):
    """A tensor and a vector along (1, 1, 0) of the scanner, written along the image's axes, x as FSL has it."""
    affine = np.eye(4)
    affine[:3, :3] = AXES_OF_IMAGES[name]
    units = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    into = units.T.copy()
    if np.linalg.det(affine[:3, :3]) > 0:
        into[0] = -into[0]
    along, across = np.array([1.0, 1, 0]) / np.sqrt(2), np.array([-1.0, 1, 0]) / np.sqrt(2)
    matrix = into @ (0.2 * np.eye(3) + 1.5 * np.outer(along, along)) @ into.T
    image = SliceImage(matrix[[0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]].reshape(1, 1, 1, 6), affine)
    voxel, half = np.zeros((1, 3), int), 0.5 * np.linalg.norm(affine[:3, :3], axis=0).min()
    found = glyphs.ellipsoids(image, voxel, np.stack([along, across]), 1.0, True, "fsl").points[0] / half
    np.testing.assert_allclose(found, [along, across * 0.2 / 1.7], atol=1e-6)
    in_dipys_order = SliceImage(image.values[..., [0, 1, 3, 2, 4, 5]], affine)
    again = glyphs.ellipsoids(in_dipys_order, voxel, np.stack([along, across]), 1.0, True, "dipy", "fsl").points[0]
    np.testing.assert_allclose(again / half, found)
    peaks = in_scanner_axes(SliceImage((into @ along).reshape(1, 1, 1, 3), affine), "fsl")
    np.testing.assert_allclose(peaks.values[0, 0, 0], along, atol=1e-6)
    integers = SliceImage(np.array([1, 2, 3], np.uint8).reshape(1, 1, 1, 3), affine, is_colours=True)
    np.testing.assert_allclose(in_scanner_axes(integers, "fsl").values[0, 0, 0], into.T @ [1, 2, 3], rtol=1e-6)


def test_axes_of_vectors_are_checked():
    image = SliceImage(np.ones((1, 1, 1, 4)), np.eye(4), "four")
    assert in_scanner_axes(image, "scanner") is image
    with pytest.raises(ValueError, match="four has 4 numbers per voxel; vectors are three each"):
        in_scanner_axes(image, "fsl")
    with pytest.raises(ValueError, match=r"vectors is 'voxel'; choose 'scanner' \(right, front, up\) or 'fsl'"):
        in_scanner_axes(image, "voxel")
    with pytest.raises(ValueError, match="vectors is of peaks and tensors, but kind is 'sh'"):
        glyphs.axes_of_glyphs("sh", "mrtrix", "fsl")


def test_lines_of_peaks_go_through_the_centres_of_voxels():
    values = np.zeros((2, 2, 2, 6), np.float32)
    values[0, 1, 1] = 0, 3, 4, 0.5, 0, 0
    image = SliceImage(values, AFFINE)
    found = glyphs.lines_of_peaks(image, np.array([[0, 1, 1]]), 1.0, 5.0)
    middle = AFFINE[:3] @ (0, 1, 1, 1)
    half = 0.5 * np.linalg.norm(AFFINE[:3, :3], axis=0).min()
    along = half * np.array([0, 0.6, 0.8])
    np.testing.assert_allclose(found.points[0], [middle - along, middle + along])
    np.testing.assert_allclose(found.points[1, 1] - middle, (0.1 * half, 0, 0), atol=1e-9)
    assert found.colours[:, 0].tolist() == [[0, 153, 204], [255, 0, 0]]


def test_a_plane_along_the_grid_takes_one_layer_and_what_is_zero_is_left_out():
    values = np.ones((4, 5, 6, 3))
    values[1, 2] = 0.0
    image = SliceImage(values, np.diag([2.0, 2.0, 2.0, 1.0]))
    for z, layer in ((4.0, 2), (4.9, 2), (3.2, 2), (5.1, 3)):
        found = glyphs.voxels_on_plane(image, np.array([0.0, 0.0, z]), np.array([0.0, 0.0, 1.0]))
        assert np.unique(found[:, 2]).tolist() == [layer]
        assert len(found) == 19
    n = np.array([0.6, 0.0, 0.8])
    found = glyphs.voxels_on_plane(image, np.array([3.0, 0.0, 5.0]), n)
    away = (found * 2.0 - (3.0, 0.0, 5.0)) @ n
    assert abs(away).max() <= 0.8 + 1e-6
    assert not len(glyphs.voxels_on_plane(image, np.array([0.0, 0.0, 100.0]), n))


def test_a_colour_table_of_freesurfer(tmp_path):
    (tmp_path / "lut.txt").write_text(
        "#$Id: FreeSurferColorLUT.txt $\n#No. Label Name:  R   G   B   A\n\n0   Unknown        0   0   0   0\n"
        "17  Left-Hippocampus   220 216 20  0\n  1002  ctx-lh-caudal anterior 125 100 160 0\n"
    )
    table = as_label_table(tmp_path / "lut.txt")
    assert table.name(17) == "Left-Hippocampus"
    assert table.colours[17] == (220, 216, 20, 255)
    assert table.name(1002) == "ctx-lh-caudal anterior"
    assert table.rows(np.array([0, 17]))[:, 3].tolist() == [0, 255]


def test_a_table_of_mrtrix(tmp_path):
    """Lines of its own ``fs_default.txt``; `labelconvert` takes the second name."""
    (tmp_path / "fs_default.txt").write_text(
        "# Lookup table\n\n0     ???     Unknown                         0   0   0   0\n\n"
        "1     L.BSTS  ctx-lh-bankssts                 25  100 40  255\n36    L.TH    Left-Thalamus   0   118 14  128\n"
        '50    R.X     "Right X"                       1   2   3   255\n'
    )
    table = as_label_table(tmp_path / "fs_default.txt")
    assert table.names == {0: "Unknown", 1: "ctx-lh-bankssts", 36: "Left-Thalamus", 50: "Right X"}
    assert table.colours == {0: (0, 0, 0, 0), 1: (25, 100, 40, 255), 36: (0, 118, 14, 128), 50: (1, 2, 3, 255)}


def test_fractions_are_colours_and_other_lines_are_named(tmp_path):
    (tmp_path / "lut.txt").write_text("# names\n1 V1 0.5 0.25 1.0 0\n2 V2 127.6 20.0 3 0\n3 V3 red\n\n4 V4 1 0 255 0\n")
    with pytest.warns(UserWarning, match=r"lut.txt: left out line 4, which names no label: '3 V3 red'"):
        table = as_label_table(tmp_path / "lut.txt")
    assert table.colours == {1: (128, 64, 255, 255), 2: (128, 20, 3, 255), 4: (1, 0, 255, 255)}
    (tmp_path / "lut.txt").write_text("1 V1 0.5 0.25 1.0 0\n2 V2 1 0 0 0\n")
    assert as_label_table(tmp_path / "lut.txt").colours == {1: (128, 64, 255, 255), 2: (255, 0, 0, 255)}


def test_a_description_of_itk_snap(tmp_path):
    (tmp_path / "seg.label").write_text(
        '#####\n# IDX -R- -G- -B- -A-- VIS MSH LABEL\n    0     0    0    0        0  0  0    "Clear Label"\n'
        '    1   255    0    0        1  1  1    "White matter"\n    2     0  255    0      0.5  1  0    "Grey"\n'
        '    3     0    0  255        1  0  1    "Hidden"\n'
    )
    table = as_label_table(tmp_path / "seg.label")
    assert table.name(1) == "White matter"
    assert table.colours[1] == (255, 0, 0, 255)
    assert table.colours[2] == (0, 255, 0, 128)
    assert table.colours[3][3] == 0


def test_a_table_of_bids(tmp_path):
    (tmp_path / "atlas_dseg.tsv").write_text(
        "index\tname\tabbreviation\tcolor\n1\tGray Matter\tGM\t#ff53bb\n2\tWM\tWM\tn/a\n"
    )
    table = as_label_table(tmp_path / "atlas_dseg.tsv")
    assert table.names == {1: "Gray Matter", 2: "WM"}
    assert table.colours == {1: (255, 0x53, 0xBB, 255)}
    (tmp_path / "b.tsv").write_text("a\tb\n1\t2\n")
    with pytest.raises(FormatError, match="the columns a, b"):
        as_label_table(tmp_path / "b.tsv")


def test_gifti_and_mappings_are_tables_and_other_kinds_are_refused(tmp_path):
    gifti = nib.gifti
    table = gifti.GiftiLabelTable()
    for key, name, colour in ((0, "???", (0, 0, 0, 0)), (5, "V1", (1.0, 0.5, 0.0, 1.0))):
        label = gifti.GiftiLabel(key, *colour)
        label.label = name
        table.labels.append(label)
    array = gifti.GiftiDataArray(np.zeros(4, np.int32), intent="NIFTI_INTENT_LABEL")
    nib.save(gifti.GiftiImage(darrays=[array], labeltable=table), tmp_path / "a.label.gii")
    found = as_label_table(tmp_path / "a.label.gii")
    assert (found.name(5), found.colours[5]) == ("V1", (255, 128, 0, 255))
    table = as_label_table({1: "one", 2: ("two", "red"), 3: "#00ff00", 4: (0, 0, 255)})
    assert table.names == {1: "one", 2: "two"}
    assert table.colours == {2: (255, 0, 0, 255), 3: (0, 255, 0, 255), 4: (0, 0, 255, 255)}
    assert table.name(9) == "9"
    (tmp_path / "a.txt").write_text("nothing of the kind\n")
    for source, error, said in (
        (tmp_path / "a.txt", FormatError, "table of labels"), (3, TypeError, "labels is a int"),
        (tmp_path / "b.txt", FileNotFoundError, "b.txt"),
    ):  # fmt: skip
        with pytest.raises(error, match=said):
            as_label_table(source)


def test_colours_that_no_table_gives_differ_and_stay():
    labels = np.arange(1, 60)
    found = distinct_colours(labels)
    assert len(np.unique(found, axis=0)) == 59
    np.testing.assert_array_equal(found[10:20], distinct_colours(labels[10:20]))
    assert (abs(np.diff(found[:, :3].astype(int), axis=0)).sum(axis=1) > 100).all()
    np.testing.assert_array_equal(LabelTable().rows(labels), found)


def test_numbers_take_the_colours_of_the_window():
    table = np.array(pv.LookupTable("viridis", n_values=256).values, np.uint8)
    values = np.linspace(-1.0, 3.0, 50).reshape(5, 10)
    found = colours.mapped(values, table, (0.0, 2.0), False)
    wanted = mpl.colormaps["viridis"](np.clip(values / 2.0, 0.0, 1.0))
    assert abs(found - wanted).max() < 0.02
    powers = 10.0 ** np.linspace(0, 4, 9)[None]
    found = colours.mapped(powers, table, (1.0, 1e4), True)
    assert abs(found - mpl.colormaps["viridis"](np.linspace(0, 1, 9))[None]).max() < 0.02
    vectors = np.array([[[3.0, 0, 0], [0, 2.0, 2.0], [0, 0, 0]]])  # directions are colours, brighter by weights
    found = colours.direction_colours(vectors, np.array([[0.5, 1.0, 1.0]]), (0.0, 1.0))
    np.testing.assert_allclose(found[0, :, :3], [[0.5, 0, 0], [0, 0.5**0.5, 0.5**0.5], [0, 0, 0]], atol=1e-6)


def test_thresholds_hide_and_so_does_what_is_no_number():
    values = np.array([[0.0, 1.0, 2.0, 3.0, np.nan, np.inf]])
    assert colours.shown(values, 1.0, 2.0).tolist() == [[False, True, True, False, False, False]]
    assert colours.shown(values, None, None).sum() == 4


def test_over_and_add_are_what_they_are_in_every_textbook():
    rng = np.random.default_rng(0)
    bottom, top = rng.random((2, 3, 4, 4)).astype(np.float32)
    all_of_it = np.ones((3, 4), bool)
    under = colours.blend(None, bottom, all_of_it, 0.8, "over")
    over = colours.blend(under.copy(), top, all_of_it, 0.5, "over")
    a, b = 0.5 * top[..., 3:], 0.8 * bottom[..., 3:]
    np.testing.assert_allclose(over[..., 3:], a + b * (1 - a), rtol=1e-6)
    np.testing.assert_allclose(over[..., :3], top[..., :3] * a + bottom[..., :3] * b * (1 - a), rtol=1e-5)
    add = colours.blend(under.copy(), top, all_of_it, 0.5, "add")
    alpha = a + b * (1 - a)
    np.testing.assert_allclose(add[..., :3], np.minimum(top[..., :3] * a + bottom[..., :3] * b, alpha), rtol=1e-5)
    shown = np.arange(12).reshape(3, 4) % 2 == 0  # what is hidden leaves what lies below
    found = colours.blend(under.copy(), top, shown, 0.5, "over")
    np.testing.assert_array_equal(found[~shown], under[~shown])
    np.testing.assert_array_equal(found[shown], over[shown])
    plain = colours.to_bytes(over)
    np.testing.assert_allclose(plain[..., 3], 255 * over[..., 3], atol=0.51)
    np.testing.assert_allclose(plain[..., :3], 255 * over[..., :3] / over[..., 3:], atol=0.51)


def test_outlines_are_where_the_neighbour_is_another():
    codes = np.zeros((6, 6), int)
    codes[2:4, 2:4] = 1
    edge = colours.outlines(codes)
    assert edge[2:4, 2:4].all()
    assert edge[1, 2]
    assert not edge[0].any()
