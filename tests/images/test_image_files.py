"""Images of files lie where nibabel, or the format, says, with all of their axes."""

from __future__ import annotations

import gzip
from pathlib import Path

import nibabel as nib
import numpy as np
import pytest

from pvfiblets.errors import FormatError
from pvfiblets.images.files import read_image
from pvfiblets.images.mif import read_mif

AFFINE = np.array([[2.0, 0.7, 0.3, -20.0], [-0.4, 1.5, 0.2, 5.0], [0.1, 0.5, 3.0, 9.0], [0.0, 0.0, 0.0, 1.0]])


def mif(path, values, layout, datatype="Float32LE", transform=None, vox="2,1.5,3", extra=(), data=None):
    """Write a file of MRtrix, whose numbers are put one by one where its layout says."""
    places = [abs(int(word)) for word in layout.split(",")]
    order = np.argsort(places)
    stored = values[tuple(slice(None, None, -1 if w.strip().startswith("-") else 1) for w in layout.split(","))]
    raw = stored.transpose(order).tobytes(order="F") if data is None else data
    lines = ["mrtrix image", f"dim: {','.join(map(str, values.shape))}", f"vox: {vox}", f"layout: {layout}",
             f"datatype: {datatype}", *extra]  # fmt: skip
    lines += [f"transform: {','.join(map(str, row))}" for row in (() if transform is None else transform[:3])]
    text = "\n".join(lines)
    start = len(text) + 32
    start += -start % 4
    head = f"{text}\nfile: . {start}\nEND\n".encode()
    whole = head.ljust(start, b"\0") + raw
    path.write_bytes(gzip.compress(whole) if path.suffix == ".gz" else whole)
    return path


@pytest.mark.parametrize("layout", ["+0,+1,+2", "-0,-1,+2", "+2,-0,+1", "-2,+1,-0"])
@pytest.mark.parametrize("suffix", [".mif", ".mif.gz"])
def test_a_mif_has_its_numbers_by_axes_whatever_their_order_in_memory(tmp_path, layout, suffix):
    values = np.random.default_rng(0).normal(size=(4, 5, 6)).astype("<f4")
    turn = np.linalg.qr(AFFINE[:3, :3])[0]
    transform = np.column_stack([turn, [-3.0, 4.0, 5.0]])
    found = read_mif(mif(tmp_path / f"a{suffix}", values, layout, transform=transform))
    np.testing.assert_array_equal(found.values, values)
    np.testing.assert_allclose(found.affine[:3, :3], turn @ np.diag([2.0, 1.5, 3.0]))
    np.testing.assert_allclose(found.affine[:3, 3], [-3.0, 4.0, 5.0])


def test_a_mif_of_four_axes_bits_and_scaled_numbers(tmp_path):
    rng = np.random.default_rng(1)
    four = rng.integers(-9, 9, size=(3, 4, 5, 2)).astype(">i2")
    made = mif(tmp_path / "a.mif", four, "+1,+2,+3,+0", "Int16BE", vox="1,1,1,nan", extra=["scaling: 5,0.5"])
    found = read_mif(made)
    np.testing.assert_array_equal(found.values, four * 0.5 + 5.0)
    np.testing.assert_allclose(found.affine[:3, 3], [-1.0, -1.5, -2.0])  # without a transform, the middle is the origin
    bits = rng.integers(0, 2, size=(3, 5, 4)).astype(np.uint8)
    packed = np.packbits(bits.ravel(order="F")).tobytes()
    np.testing.assert_array_equal(read_mif(mif(tmp_path / "b.mif", bits, "+0,+1,+2", "Bit", data=packed)).values, bits)


def test_a_mih_names_the_file_of_its_data(tmp_path):
    values = np.arange(24, dtype="<u2").reshape(2, 3, 4)
    (tmp_path / "a b.dat").write_bytes(b"1234" + values.tobytes(order="F"))
    (tmp_path / "a.mih").write_text(
        "mrtrix image\ndim: 2,3,4\nvox: 1,1,1\nlayout: +0,+1,+2\ndatatype: UInt16LE\nfile: a b.dat 4\nEND\n"
    )
    np.testing.assert_array_equal(read_mif(tmp_path / "a.mih").values, values)


@pytest.mark.parametrize(
    ("change", "said"),
    [((b"mrtrix image", b"mrtrix tracks"), "magic line"), ((b"dim: 4,5,6", b"dim: 4,5,x"), "whole numbers"),
     ((b"dim: 4,5,6", b"dim: 4,5,9"), "bytes of data"), ((b"layout: +0,+1,+2", b"layout: +0,+1,+1"), "layout"),
     ((b"Float32LE", b"CFloat32LE"), "datatype"), ((b"\nEND", b"\nEMD"), "END|a line"),
     ((b"file: . ", b"fine: . "), "0 lines")],
)  # fmt: skip
def test_a_damaged_mif_says_what_is_wrong(tmp_path, change, said):
    path = mif(tmp_path / "a.mif", np.zeros((4, 5, 6), "<f4"), "+0,+1,+2")
    path.write_bytes(path.read_bytes().replace(*change))
    with pytest.raises(FormatError, match=said):
        _ = read_mif(path).values


@pytest.mark.parametrize("kind", [nib.Nifti1Image, nib.Nifti2Image])
def test_a_nifti_of_four_axes_lies_as_nibabel_says(tmp_path, kind):
    values = np.random.default_rng(2).normal(size=(3, 4, 5, 6)).astype(np.float32)
    image = kind(values, AFFINE)
    image.header.set_intent("label")
    nib.save(image, tmp_path / "a.nii.gz")
    found = read_image(tmp_path / "a.nii.gz")
    np.testing.assert_array_equal(found.values, values)
    np.testing.assert_allclose(found.affine, nib.load(tmp_path / "a.nii.gz").affine)
    assert (found.name, found.is_labels) == ("a", True)


def test_an_mgz_lies_as_nibabel_says(tmp_path):
    values = np.arange(60, dtype=np.int32).reshape(3, 4, 5)
    right = AFFINE.copy()
    right[:3, :3] = np.linalg.qr(AFFINE[:3, :3])[0] * [1.0, 2.0, 3.0]
    nib.save(nib.MGHImage(values, right), tmp_path / "aseg.mgz")
    found = read_image(tmp_path / "aseg.mgz")
    np.testing.assert_array_equal(found.values, values)
    np.testing.assert_allclose(found.affine, nib.load(tmp_path / "aseg.mgz").affine, atol=1e-5)


def test_a_nrrd_and_a_metaimage_with_several_numbers_per_voxel(tmp_path):
    values = np.arange(3 * 2 * 4 * 5, dtype="<f4").reshape(2, 4, 5, 3)
    raw = np.moveaxis(values, -1, 0).tobytes(order="F")
    head = (
        "NRRD0004\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 3 2 4 5\n"
        "space directions: none (2,0,0) (0,3,0) (0,0,4)\nkinds: vector domain domain domain\nendian: little\n"
        "encoding: raw\nspace origin: (10,20,30)\n\n"
    )
    (tmp_path / "a.nrrd").write_bytes(head.encode() + raw)
    wanted = np.diag([-2.0, -3.0, 4.0, 1.0])
    wanted[:3, 3] = -10.0, -20.0, 30.0
    found = read_image(tmp_path / "a.nrrd")
    np.testing.assert_array_equal(found.values, values)
    np.testing.assert_allclose(found.affine, wanted)
    (tmp_path / "a.mha").write_bytes(
        b"ObjectType = Image\nNDims = 3\nDimSize = 2 4 5\nElementSpacing = 2 3 4\nOffset = 10 20 30\n"
        b"ElementNumberOfChannels = 3\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n" + raw
    )
    found = read_image(tmp_path / "a.mha")
    np.testing.assert_array_equal(found.values, values)
    np.testing.assert_allclose(found.affine, wanted)


def test_another_suffix_is_refused(tmp_path):
    (tmp_path / "a.jpg").touch()
    with pytest.raises(ValueError, match=r"a\.jpg is no image; give a file that ends in"):
        read_image(Path(tmp_path / "a.jpg"))
    with pytest.raises(FileNotFoundError):
        read_image(Path(tmp_path / "b.jpg"))
