"""Volumes from files of every format, images and arrays: the right number at the right place, and what is refused."""

from __future__ import annotations

import bz2
import gzip
import tracemalloc
import zlib

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from hypothesis import given
from hypothesis import strategies as st
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from pvfiblets.errors import FormatError
from pvfiblets.images.metaimage import read_metaimage
from pvfiblets.images.nrrd import read_nrrd
from pvfiblets.plotting.fiblets.sources import as_volume
from pvfiblets.volumes import RaycastVolume, as_raycast_volume

from .small_volume import AFFINE, AXES, ORIGIN, SHAPE, SPACING, VALUES, assert_is_the_volume, image

# nibabel


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz", ".mgz"])
def test_files_of_nibabel(tmp_path, suffix):
    path = tmp_path / f"brain{suffix}"
    made = (nib.MGHImage if suffix == ".mgz" else nib.Nifti1Image)(VALUES, AFFINE)
    nib.save(made, path)
    assert_is_the_volume(as_raycast_volume(path), "brain", atol=1e-5)
    assert_is_the_volume(as_raycast_volume(str(path)), "brain", atol=1e-5)
    assert_is_the_volume(as_raycast_volume(nib.load(path)), atol=1e-5)
    colours = as_volume(path)
    np.testing.assert_array_equal(as_raycast_volume(path).affine, colours.affine)
    np.testing.assert_array_equal(as_raycast_volume(path).values, colours.values)


def test_plain_nifti_is_mapped_and_scaled_ones_are_scaled(tmp_path):
    nib.save(nib.Nifti1Image(VALUES, AFFINE), tmp_path / "a.nii")
    mapped = as_raycast_volume(tmp_path / "a.nii").values
    while mapped is not None and not isinstance(mapped, np.memmap):
        mapped = mapped.base
    assert mapped is not None
    scaled = nib.Nifti1Image(VALUES, AFFINE)
    scaled.header.set_slope_inter(0.25, 5.0)
    nib.save(scaled, tmp_path / "b.nii.gz")
    stored = nib.load(tmp_path / "b.nii.gz")
    got = as_raycast_volume(tmp_path / "b.nii.gz").values
    assert got.dtype == np.float32
    np.testing.assert_allclose(got, stored.get_fdata(), rtol=1e-6)
    np.testing.assert_array_equal(as_raycast_volume(nib.Nifti1Image(VALUES[..., None], AFFINE)).values, VALUES)


def test_images_of_nibabel_that_are_no_volumes(tmp_path):
    rgb = np.zeros(SHAPE, [("R", "u1"), ("G", "u1"), ("B", "u1")])
    nib.save(nib.Nifti1Image(rgb, AFFINE), tmp_path / "rgb.nii")
    with pytest.raises(ValueError, match="rgb.nii holds colours, the fields R, G, B of each voxel; one number each"):
        as_raycast_volume(tmp_path / "rgb.nii")
    nib.save(nib.Nifti1Image(np.zeros((3, 4, 5, 6), np.float32), AFFINE), tmp_path / "dwi.nii.gz")
    with pytest.raises(ValueError, match=r"dwi.nii.gz has the shape \(3, 4, 5, 6\); .* as \(image\[..., 0\], affine"):
        as_raycast_volume(tmp_path / "dwi.nii.gz")
    with pytest.raises(ValueError, match="complex64"):
        as_raycast_volume(nib.Nifti1Image(np.zeros(SHAPE, np.complex64), AFFINE))
    with pytest.raises(ValueError, match="has no affine; give "):
        as_raycast_volume(nib.Nifti1Image(VALUES, None))


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz", ".nrrd", ".mha", ".vti"])
def test_damaged_files_and_missing_ones(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    with pytest.raises(FileNotFoundError):
        as_raycast_volume(path)
    path.write_bytes(b"this is no picture of anything" * 20)
    with pytest.raises(FormatError, match=f"a{suffix}"):
        as_raycast_volume(path)
    path.write_bytes(b"")
    with pytest.raises(FormatError, match=f"a{suffix}"):
        as_raycast_volume(path)


def test_nifti_that_ends_early(tmp_path):
    big = np.random.default_rng(0).integers(0, 255, (30, 30, 30), np.uint8)
    for name in ("a.nii", "a.nii.gz"):
        nib.save(nib.Nifti1Image(big, AFFINE), tmp_path / name)
        whole = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(whole[: len(whole) // 2])
        with pytest.raises(FormatError, match="what nibabel cannot read|found 13676 bytes, expected 27352"):
            as_raycast_volume(tmp_path / name)


# NRRD


def words(vectors):
    return " ".join("none" if v is None else f"({','.join(repr(float(x)) for x in v)})" for v in vectors)


def nrrd(path, values=VALUES, encoding="raw", *, affine=AFFINE, space="right-anterior-superior", data=None, **more):
    """Write a file; fields of `more` replace or, where None, leave out."""
    kinds = {"int16": "short", "uint8": "uchar", "float32": "float", "float64": "double", "uint16": "ushort"}
    fields = {
        "type": kinds[values.dtype.newbyteorder("=").name],
        "dimension": values.ndim,
        "space": space,
        "sizes": " ".join(map(str, values.shape)),
        "space directions": words(affine[:3, :3].T),
        "kinds": " ".join(["domain"] * values.ndim),
        "endian": "big" if values.dtype.str[0] == ">" else "little",
        "encoding": encoding,
        "space origin": words([affine[:3, 3]]),
    } | {key.replace("_", " "): value for key, value in more.items()}
    lines = ["NRRD0004", "# made up", *(f"{k}: {v}" for k, v in fields.items() if v is not None), "key:=value: 7"]
    raw = values.tobytes(order="F")
    packed = {
        "raw": lambda: raw, "gzip": lambda: gzip.compress(raw), "bzip2": lambda: bz2.compress(raw),
        "ascii": lambda: " ".join(map(str, values.ravel(order="F"))).encode(),
    }[encoding]() if data is None else data  # fmt: skip
    if "data file" in fields:
        (path.parent / fields["data file"]).write_bytes(packed)
        path.write_text("\n".join(lines) + "\n")
    else:
        path.write_bytes("\n".join(lines).encode() + b"\n\n" + packed)
    return path


@pytest.mark.parametrize("encoding", ["raw", "gzip", "bzip2", "ascii"])
@pytest.mark.parametrize("order", ["<", ">"])
def test_nrrd_encodings(tmp_path, encoding, order):
    path = nrrd(tmp_path / "t1.nrrd", VALUES.astype(f"{order}i2"), encoding)
    assert_is_the_volume(as_raycast_volume(path), "t1")
    assert isinstance(read_nrrd(path).values, np.memmap) == (encoding == "raw")


@pytest.mark.parametrize(
    ("space", "signs"),
    [("left-posterior-superior", (-1, -1)), ("LPS", (-1, -1)), ("right-anterior-superior", (1, 1)), ("RAS", (1, 1)),
     ("left-anterior-superior", (-1, 1)), ("LAS", (-1, 1)), ("scanner-xyz", (1, 1)), ("3D-right-handed", (1, 1)),
     ("right_anterior_superior", (1, 1))],
)  # fmt: skip
def test_nrrd_spaces_become_ras(tmp_path, space, signs):
    turned = AFFINE.copy()
    turned[:2] *= np.array(signs)[:, None]
    assert_is_the_volume(as_raycast_volume(nrrd(tmp_path / "a.nrrd", affine=turned, space=space)))


def test_nrrd_with_data_apart_and_things_before_them(tmp_path):
    raw = VALUES.tobytes(order="F")
    apart = nrrd(tmp_path / "a.nhdr", data_file="a.img")
    assert_is_the_volume(as_raycast_volume(apart))
    skipped = nrrd(tmp_path / "b.nhdr", data_file="b.img", data=b"one\ntwo\n123" + raw, line_skip="2", byte_skip="3")
    assert_is_the_volume(as_raycast_volume(skipped))
    last = nrrd(tmp_path / "c.nhdr", data_file="c.img", data=b"any header" + raw, byte_skip="-1")
    assert_is_the_volume(as_raycast_volume(last))
    (tmp_path / "a.img").unlink()
    whole = apart.read_text()
    for name in ("a.img", ".", "x" * 3000):
        apart.write_text(whole.replace("a.img", name))
        with pytest.raises(FileNotFoundError, match="its data are in '.*', and there is no file"):
            as_raycast_volume(apart)
    plain = {"space": None, "space_directions": None, "space_origin": None, "kinds": None}
    spaced = as_raycast_volume(nrrd(tmp_path / "d.nrrd", **plain, spacings="2 3 nan"))
    np.testing.assert_allclose(spaced.affine, np.diag([2.0, 3.0, 1.0, 1.0]))
    np.testing.assert_allclose(as_raycast_volume(nrrd(tmp_path / "e.nrrd", **plain)).affine, np.eye(4))


def test_nrrd_axes_of_one_entry_go(tmp_path):
    directions = words([None, *AFFINE[:3, :3].T])
    first = nrrd(tmp_path / "a.nrrd", VALUES[None], kinds="list domain domain domain", space_directions=directions)
    assert_is_the_volume(as_raycast_volume(first))
    four = VALUES[None].repeat(3, axis=0)
    colours = nrrd(tmp_path / "b.nrrd", four, kinds="RGB-color domain domain domain", space_directions=directions)
    with pytest.raises(ValueError, match=r"b.nrrd has the shape \(3, 4, 5, 3\), as RGB colours have; three axes"):
        as_raycast_volume(colours)
    with pytest.raises(FormatError, match="found 2 axes of the sizes 3 x 4"):
        read_nrrd(nrrd(tmp_path / "c.nrrd", VALUES[..., 0], space_directions=words(np.eye(2))))


@pytest.mark.parametrize(
    ("more", "message"),
    [({"sizes": None}, "no field 'sizes' in the header"), ({"sizes": "3 4 x"}, "sizes: x, expected a whole number"),
     ({"sizes": "3 4"}, "sizes: 3 4, expected 3 whole numbers above 0"),
     ({"type": "block"}, "type: block, expected one of signed char"),
     ({"encoding": "hex", "data": b""}, "encoding: hex, expected raw, gzip, bzip2 or ascii"),
     ({"endian": "middle"}, "endian: middle"), ({"sizes": "30 4 5"}, "120 bytes of data, expected 1200"),
     ({"sizes": "30 4 5", "encoding": "gzip", "data": gzip.compress(b"12")}, "found 1 numbers, expected 600"),
     ({"encoding": "gzip", "data": b"nonsense"}, "damaged gzip data"),
     ({"encoding": "gzip", "data": gzip.compress(bytes(1000))[:-12]}, "damaged gzip data"),
     ({"encoding": "ascii", "data": b"1 2 three"}, "other than numbers"),
     ({"space_directions": "(1,0,0) (0,1,0) (0,0,"}, "expected vectors such as"),
     ({"space_directions": "(1,0) (0,1) (0,0)"}, "expected a vector of three numbers for each axis"),
     ({"space_directions": "(1,0,0) (0,1,0) (1,1,0)"}, "flattens space"),
     ({"sizes": "9223372036854775807 4 5"}, "from the header's sizes and type"),
     ({"byte_skip": "-5"}, "byte skip: -5, expected -1, or a number of bytes"),
     ({"line_skip": "1000000000000"}, "0 bytes of data"),
     ({"data_file": "LIST"}, "expected data in one file: join them first"),
     ({"data_file": "slice%03d.raw 1 5 1"}, "expected data in one file")],
)  # fmt: skip
def test_bad_nrrd(tmp_path, more, message):
    path = nrrd(tmp_path / "a.nrrd", **more)
    with pytest.raises(ValueError, match=message):
        as_raycast_volume(path)


# MetaImage


def metaimage(path, *, compressed=False, msb=False, header="", data="LOCAL", values=VALUES, affine=AFFINE):
    """Write what ITK would: axis by axis, LPS+."""
    lps = affine.copy()
    lps[:2] *= -1
    spacing = np.linalg.norm(lps[:3, :3], axis=0)
    raw = values.astype(">i2" if msb else "<i2").tobytes(order="F")
    packed = zlib.compress(raw) if compressed else raw
    lines = [
        "ObjectType = Image", "NDims = 3", "BinaryData = True", f"BinaryDataByteOrderMSB = {msb}",
        f"CompressedData = {compressed}", *([f"CompressedDataSize = {len(packed)}"] if compressed else []),
        "TransformMatrix = " + " ".join(repr(float(x)) for x in (lps[:3, :3] / spacing).T.ravel()),
        "Offset = " + " ".join(repr(float(x)) for x in lps[:3, 3]), "CenterOfRotation = 0 0 0",
        "AnatomicalOrientation = RAI", "ElementSpacing = " + " ".join(repr(float(x)) for x in spacing),
        "DimSize = " + " ".join(map(str, values.shape)), *([header] if header else []), "ElementType = MET_SHORT",
        f"ElementDataFile = {data}",
    ]  # fmt: skip
    path.write_bytes("\n".join(lines).encode() + b"\n" + (packed if data == "LOCAL" else b""))
    if data != "LOCAL":
        (path.parent / data).write_bytes(packed)
    return path


def test_metaimages_and_bad_ones(tmp_path):
    for more in ({}, {"compressed": True}, {"msb": True}):
        assert_is_the_volume(as_raycast_volume(metaimage(tmp_path / "ct.mha", **more)), "ct")
    path = metaimage(tmp_path / "a.mhd", data="a.raw")
    assert_is_the_volume(as_raycast_volume(path), "a")
    (tmp_path / "a.raw").unlink()
    with pytest.raises(FileNotFoundError, match=r"its data are in 'a\.raw'"):
        as_raycast_volume(path)
    colours = metaimage(tmp_path / "b.mha", header="ElementNumberOfChannels = 3")
    with pytest.raises(ValueError, match=r"b.mha has the shape \(3, 4, 5, 3\), as RGB colours have; three axes"):
        as_raycast_volume(colours)
    short = metaimage(tmp_path / "c.mha")
    short.write_bytes(short.read_bytes()[:-40])
    with pytest.raises(FormatError, match=r"c\.mha"):
        as_raycast_volume(short)
    placed = metaimage(tmp_path / "d.mha", header="Offset = 1 2")  # the later one counts
    with pytest.raises(FormatError, match="offset = 1 2, expected 3 numbers"):
        as_raycast_volume(placed)


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8"])  # of long integers VTK writes half
@pytest.mark.parametrize("deflated", [False, True])
def test_metaimages_are_what_vtk_reads(tmp_path, kind, deflated):
    from vtkmodules.vtkIOImage import vtkMetaImageReader, vtkMetaImageWriter

    values = np.random.default_rng(0).integers(0, 120, (3, 4, 5)).astype(kind)
    image = pv.ImageData(dimensions=values.shape, spacing=(2.0, 3.0, 4.0), origin=(1.0, 2.0, 3.0))
    image["v"] = values.ravel(order="F")
    writer = vtkMetaImageWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(tmp_path / "a.mha"))
    writer.SetCompression(deflated)
    writer.Write()
    got = read_metaimage(tmp_path / "a.mha")
    reader = vtkMetaImageReader()
    reader.SetFileName(str(tmp_path / "a.mha"))
    reader.Update()
    theirs = pv.wrap(reader.GetOutput()).active_scalars.reshape(values.shape, order="F")
    assert got.values.dtype == values.dtype == theirs.dtype
    np.testing.assert_array_equal(got.values, theirs)
    np.testing.assert_allclose(got.affine @ (0, 0, 0, 1), (-1.0, -2.0, 3.0, 1.0))


def test_metaimages_without_a_place_and_with_text_or_bytes_before_the_data(tmp_path):
    VALUES.tofile(tmp_path / "a.raw")
    head = "NDims = 3\nDimSize = 5 4 3\nElementType = MET_SHORT\n"
    (tmp_path / "a.mhd").write_text(f"{head}ElementDataFile = a.raw\n")
    np.testing.assert_array_equal(read_metaimage(tmp_path / "a.mhd").affine, np.diag([-1.0, -1.0, 1.0, 1.0]))
    (tmp_path / "a.raw").write_bytes(b"header" + VALUES.tobytes())
    for size in (6, -1):
        (tmp_path / "a.mhd").write_text(f"{head}HeaderSize = {size}\nElementDataFile = a.raw\n")
        np.testing.assert_array_equal(read_metaimage(tmp_path / "a.mhd").values, VALUES.T)
    text = " ".join(map(str, VALUES.ravel()))
    (tmp_path / "b.mha").write_text(f"{head}BinaryData = False\nElementDataFile = LOCAL\n{text}\n")
    np.testing.assert_array_equal(read_metaimage(tmp_path / "b.mha").values, VALUES.T)
    (tmp_path / "b.mha").write_text(f"{head}BinaryData = False\nElementDataFile = LOCAL\n{text[:-9]} x\n")
    with pytest.raises(FormatError, match="other than numbers"):
        _ = read_metaimage(tmp_path / "b.mha").values


@pytest.mark.parametrize(
    ("change", "message"),
    [("DimSize = 3 4 5.5", "expected three whole numbers above 0"),
     ("DimSize = 3 4 0", "expected three whole numbers above 0"),
     ("DimSize = 3 4 nan", "expected three whole numbers above 0"),
     ("DimSize = 30000 40000 50000", "expected 120000000000000 behind the skipped bytes"),
     ("ElementType = MET_COLOUR", "ElementType = MET_COLOUR, expected one of MET_CHAR"),
     ("HeaderSize = many", "HeaderSize = many, expected -1, or a number of bytes"),
     ("ElementDataFile = LIST", "join them first"), ("CompressedData = True", "damaged zlib data")],
)  # fmt: skip
def test_what_metaimages_say_is_not_taken_at_their_word(tmp_path, change, message):
    VALUES.tofile(tmp_path / "a.raw")
    fields = {"NDims": "3", "DimSize": "5 4 3", "ElementType": "MET_SHORT", "HeaderSize": "0"}
    name, _, value = change.partition(" = ")
    fields |= {"ElementDataFile": "a.raw", name: value}
    fields["ElementDataFile"] = fields.pop("ElementDataFile")  # always the last
    (tmp_path / "a.mhd").write_text("".join(f"{key} = {text}\n" for key, text in fields.items()))
    with pytest.raises(FormatError, match=message):
        _ = read_metaimage(tmp_path / "a.mhd").values


@pytest.mark.few(4)
@pytest.mark.parametrize("packing", ["gzip", "bzip2", "zlib"])
@pytest.mark.parametrize("where", ["nrrd", "mha", "nii.gz"])
def test_small_files_that_swell_take_no_memory(tmp_path, packing, where):
    """A hundred megabytes of zeros are a hundred kilobytes: no more of them is unpacked than the header asks for."""
    pack = {"gzip": gzip.compress, "bzip2": bz2.compress, "zlib": zlib.compress}[packing]
    path = tmp_path / f"a.{where}"
    if where == "nrrd" and packing != "zlib":
        nrrd(path, encoding=packing, data=pack(VALUES.tobytes(order="F") + bytes(100_000_000)))
    elif where == "mha" and packing == "zlib":
        head = "NDims = 3\nDimSize = 5 4 3\nElementType = MET_SHORT\nCompressedData = True\nElementDataFile = LOCAL\n"
        path.write_bytes(head.encode() + pack(VALUES.tobytes() + bytes(100_000_000)))
    elif where == "nii.gz" and packing == "gzip":
        made = nib.Nifti1Image(VALUES, AFFINE)
        made.header.set_data_shape((3000, 4000, 5000))
        path.write_bytes(pack(made.header.binaryblock + bytes(1_000_000)))
    else:
        return
    tracemalloc.start()
    try:
        if where == "nii.gz":
            with pytest.raises(FormatError, match="found 100[0-9]* bytes, expected 12000000[0-9]*,"):
                as_raycast_volume(path)
        else:
            assert as_raycast_volume(path).shape in (SHAPE, SHAPE[::-1])
        assert tracemalloc.get_traced_memory()[1] < 8_000_000
    finally:
        tracemalloc.stop()


@given(
    st.tuples(*[st.integers(2, 6)] * 3),
    st.sampled_from(["u1", "<i2", ">i2", "<u2", ">f4", "<f8"]),
    st.sampled_from(["raw", "gzip", "bzip2", "ascii"]),
    st.integers(0, 1000),
)
def test_any_volume_is_the_same_from_nrrd_and_metaimage(tmp_path_factory, shape, kind, encoding, seed):
    rng = np.random.default_rng(seed)
    values = rng.integers(0, 200, shape).astype(kind)
    folder = tmp_path_factory.mktemp("any")
    got = read_nrrd(nrrd(folder / "a.nrrd", values, encoding))
    np.testing.assert_array_equal(got.values, values)
    msb, packed = kind[0] == ">", encoding == "gzip"
    short = values.astype(">i2" if msb else "<i2")
    got = read_metaimage(metaimage(folder / "a.mha", values=short, compressed=packed, msb=msb))
    np.testing.assert_array_equal(got.values, values)
    np.testing.assert_allclose(got.affine, AFFINE, atol=1e-12)


# Bare numbers, and all of them together


@pytest.mark.parametrize("name", ["a.raw", "a.bin", "noending"])
def test_bare_numbers(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(VALUES.astype(">i2").tobytes(order="F"))
    volume = as_raycast_volume(path, shape=SHAPE, dtype=">i2", affine=AFFINE)
    assert_is_the_volume(volume, path.stem)
    path.write_bytes(VALUES.astype("u1").tobytes(order="F"))
    small = as_raycast_volume(path, shape=SHAPE, dtype="uint8", spacing=SPACING)
    assert isinstance(small.values.base, np.memmap)
    np.testing.assert_array_equal(small.spacing, SPACING)


def test_bare_numbers_need_a_valid_shape_and_type(tmp_path):
    path = tmp_path / "a.raw"
    path.write_bytes(bytes(60))
    with pytest.raises(ValueError, match=r"a.raw has none of the suffixes .* of bare numbers say shape=\(nx, ny, nz\)"):
        as_raycast_volume(path)
    with pytest.raises(ValueError, match=r"has 60 bytes; 3 x 4 x 5 voxels of int16 take 120: check shape and dtype"):
        as_raycast_volume(path, shape=SHAPE, dtype="int16")
    for shape in ((3, 4), (3, 4, 0), (3.0, 4.0, 5.0)):
        with pytest.raises(ValueError, match="expected \\(nx, ny, nz\\), three whole numbers above 0"):
            as_raycast_volume(path, shape=shape, dtype="uint8")
    with pytest.raises(ValueError, match="dtype='bytes of some kind'; expected a type of numbers"):
        as_raycast_volume(path, shape=SHAPE, dtype="bytes of some kind")
    with pytest.raises(FileNotFoundError):
        as_raycast_volume(tmp_path / "b.raw")


# Real files


def at(volume, mm):
    """The nearest voxel's value at points in mm."""
    voxels = np.rint(mm @ volume.inverse[:3, :3].T + volume.inverse[:3, 3]).astype(int)
    return volume.values[tuple(voxels.T)]


def test_one_brain_in_two_orientations(shared_data):
    one, two = (as_raycast_volume(shared_data / f"nv_space_{axes}.nii.gz") for axes in ("LPS", "SAR"))
    assert one.shape != two.shape
    np.testing.assert_allclose(one.bounds, two.bounds, atol=1e-3)
    rng = np.random.default_rng(0)
    voxels = rng.integers(0, one.shape, (500, 3))
    mm = voxels @ one.affine[:3, :3].T + one.affine[:3, 3]
    np.testing.assert_allclose(at(two, mm), one.values[tuple(voxels.T)], atol=1e-4)


def test_real_volumes(shared_data):
    mni = as_raycast_volume(shared_data / "nv_MNI152_2009_template.nii.gz")
    assert (mni.shape, mni.values.dtype, mni.name) == ((193, 229, 193), np.int16, "nv_MNI152_2009_template")
    np.testing.assert_allclose(mni.bounds, (-96, 96, -132, 96, -78, 114))
    head = as_raycast_volume(shared_data / "HeadMRVolume.mhd")
    assert (head.shape, head.values.dtype) == ((48, 62, 42), np.uint8)
    np.testing.assert_array_equal(head.values.ravel(order="F"), np.fromfile(shared_data / "HeadMRVolume.raw", np.uint8))
    np.testing.assert_allclose(head.bounds, (-188, 0, -244, 0, 0, 164))
    carotid = as_raycast_volume(pv.read(shared_data / "vtk_carotid.vtk"), scalars="scalars")
    assert carotid.shape == (76, 49, 45)
    np.testing.assert_allclose(carotid.bounds, (100, 175, 80, 128, 1, 45))
    fa = as_raycast_volume(shared_data / "tractseg_FA.nii.gz", smooth=0.7)
    assert isinstance(fa, RaycastVolume)
    assert 0.0 <= fa.value_range[0] < fa.value_range[1] <= 1.3


def written(path, made, mode, packer="ZLib", *, wide=False, pieces=1):
    """Write an image by VTK; 'Encoded' is appended in base64."""
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(made)
    (writer.SetDataModeToAppended if mode == "Encoded" else getattr(writer, f"SetDataModeTo{mode}"))()
    writer.SetEncodeAppendedData(mode == "Encoded")
    getattr(writer, f"SetCompressorTypeTo{packer}")()
    (writer.SetHeaderTypeToUInt64 if wide else writer.SetHeaderTypeToUInt32)()
    writer.SetNumberOfPieces(pieces)
    assert writer.Write()


@pytest.mark.parametrize("wide", [False, True], ids=["32-bit", "64-bit"])
@pytest.mark.parametrize("packer", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended", "Encoded"])
def test_every_way_to_write_vti(tmp_path, mode, packer, wide):
    made = image(other=np.arange(60.0))
    made.cell_data["cells"] = np.arange(made.n_cells)
    made.field_data["note"] = ["one", "two"]
    made.field_data["numbers"] = np.arange(7)
    written(tmp_path / "a.vti", made, mode, packer, wide=wide, pieces=2)
    assert_is_the_volume(as_raycast_volume(tmp_path / "a.vti", scalars="ct"), "ct", atol=1e-6)
    assert as_raycast_volume(tmp_path / "a.vti", scalars="other").value_range == (0.0, 59.0)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [('WholeExtent="0 2 0 3 0 4"', 'WholeExtent="0 2 0 3 0 2147483646"', "60 points in pieces"),
     ('Extent="0 2 0 3 0 4"', 'Extent="0 2 0 3 0 2147483646"', "bytes in a file of"),
     ('WholeExtent="0 2 0 3 0 4"', 'WholeExtent="0 2 0 -3 0 4"', "a point along each axis"),
     ('WholeExtent="0 2 0 3 0 4"', 'WholeExtent="0 2 0 3 0"', "six whole numbers"),
     ('type="ImageData"', 'type="PolyData"', "VTKFile of type 'ImageData'"), ("AQAAAACAAA", "AQ99999999", "blocks of")],
)  # fmt: skip
def test_sizes_that_a_vti_cannot_hold(tmp_path, old, new, words):
    written(tmp_path / "a.vti", image(), "Binary")
    text = (tmp_path / "a.vti").read_text()
    assert old in text
    head, found, tail = text.rpartition(old) if old.startswith("Extent") else text.partition(old)
    assert found
    (tmp_path / "a.vti").write_text(head + new + tail)
    with pytest.raises(FormatError, match=words):
        as_raycast_volume(tmp_path / "a.vti")


# Images of VTK


def test_an_image_lies_where_its_points_are():
    grid = image()
    volume = as_raycast_volume(grid)
    assert_is_the_volume(volume, "ct")
    assert volume.values.dtype == np.int16
    assert np.shares_memory(volume.values, grid["ct"])
    voxels = np.stack(np.meshgrid(*[np.arange(n) for n in SHAPE], indexing="ij"), -1).reshape(-1, 3, order="F")
    np.testing.assert_allclose(voxels @ volume.affine[:3, :3].T + volume.affine[:3, 3], grid.points, atol=1e-5)
    np.testing.assert_allclose(volume.bounds, grid.bounds, atol=1e-5)


def test_an_extent_that_begins_elsewhere():
    part = image().extract_subset([1, 2, 0, 3, 2, 4])
    part.offset = (5, -2, 1)
    volume = as_raycast_volume(part)
    np.testing.assert_array_equal(volume.values, part["ct"].reshape(part.dimensions, order="F"))
    np.testing.assert_allclose(volume.affine[:3, 3], part.points[0], atol=1e-5)
    np.testing.assert_allclose(volume.bounds, part.bounds, atol=1e-5)


def test_a_plain_image_of_vtk():
    from vtkmodules.vtkCommonDataModel import vtkImageData

    plain = vtkImageData()
    plain.ShallowCopy(image())
    plain.GetPointData().SetActiveScalars("ct")
    assert_is_the_volume(as_raycast_volume(plain))
    only = vtkImageData()
    only.CopyStructure(plain)
    only.GetPointData().AddArray(plain.GetPointData().GetArray("ct"))
    assert only.GetPointData().GetScalars() is None
    assert_is_the_volume(as_raycast_volume(only))


def test_arrays_are_chosen():
    grid = image(other=np.arange(60, dtype=np.float32))
    grid.set_active_scalars("ct")
    assert as_raycast_volume(grid).name == "ct"
    other = as_raycast_volume(grid, scalars="other")
    np.testing.assert_array_equal(other.values.ravel(order="F"), np.arange(60))
    given = as_raycast_volume(grid, scalars=np.arange(60)[::-1])
    np.testing.assert_array_equal(given.values.ravel(order="F"), np.arange(60)[::-1])


def test_cells_become_points_as_in_add_volume():
    grid = pv.ImageData(dimensions=(4, 5, 6), spacing=(1, 2, 3), origin=(7, 8, 9))
    grid.cell_data["fa"] = np.random.default_rng(0).random(grid.n_cells)
    expected = grid.cell_data_to_point_data()["fa"].reshape(4, 5, 6, order="F")
    for scalars in (None, "fa", grid.cell_data["fa"]):
        volume = as_raycast_volume(grid, scalars=scalars)
        np.testing.assert_allclose(volume.values, expected, rtol=1e-6)
        np.testing.assert_allclose(volume.bounds, grid.bounds)
    grid = image()  # active cells are taken before points
    grid.cell_data["fa"] = np.ones(grid.n_cells)
    grid.set_active_scalars("fa", preference="cell")
    np.testing.assert_array_equal(as_raycast_volume(grid).values, 1.0)


# Arrays, and places that are given


def test_arrays():
    volume = as_raycast_volume(VALUES)
    assert np.shares_memory(volume.values, VALUES)
    np.testing.assert_array_equal(volume.affine, np.eye(4))
    assert_is_the_volume(as_raycast_volume(VALUES, affine=AFFINE))
    assert_is_the_volume(as_raycast_volume((VALUES, AFFINE)))
    assert_is_the_volume(as_raycast_volume(VALUES[..., None], spacing=SPACING, origin=ORIGIN, direction=AXES))
    assert_is_the_volume(as_raycast_volume(VALUES, spacing=SPACING, origin=ORIGIN, direction=AXES.ravel()))
    assert_is_the_volume(as_raycast_volume(VALUES.tolist(), affine=AFFINE))
    np.testing.assert_array_equal(as_raycast_volume(VALUES, spacing=2).spacing, 2.0)
    masked = as_raycast_volume(np.ma.masked_less(VALUES, 0))
    np.testing.assert_array_equal(masked.missing, VALUES < 0)
    assert masked.value_range[0] == VALUES[VALUES >= 0].min()
    values = np.where(VALUES == VALUES[1, 1, 1], np.nan, VALUES)
    volume = as_raycast_volume(values, smooth=1.0, spacing=2.0)  # smoothing comes last
    in_mm = as_raycast_volume(values, smooth=2.0, smooth_unit="mm", spacing=2.0)
    np.testing.assert_array_equal(volume.values, in_mm.values)
    assert volume.n_missing == np.isnan(values).sum()
    assert np.ptp(volume.values) < 0.8 * np.ptp(VALUES)


def test_what_is_given_takes_the_place_of_the_sources():
    grid = image()
    np.testing.assert_allclose(as_raycast_volume(grid, affine=np.eye(4)).affine, np.eye(4))
    spaced = as_raycast_volume(grid, spacing=(1, 2, 3))
    np.testing.assert_allclose(spaced.spacing, (1, 2, 3))
    np.testing.assert_allclose(spaced.affine[:3, :3] / (1, 2, 3), AXES)
    moved = as_raycast_volume(as_raycast_volume(grid), origin=(0, 0, 1))
    np.testing.assert_allclose(moved.affine[:3, 3], (0, 0, 1))
    np.testing.assert_allclose(moved.affine[:3, :3], AFFINE[:3, :3])
    missing = np.where(VALUES > 250, np.nan, VALUES)
    kept = as_raycast_volume(as_raycast_volume(missing), spacing=3.0)
    np.testing.assert_array_equal(kept.missing, VALUES > 250)
    volume = as_raycast_volume(VALUES)
    assert as_raycast_volume(volume) is volume


@pytest.mark.parametrize(
    ("source", "given", "error", "message"),
    [
        (VALUES, {"spacing": (1, 0, 1)}, ValueError,
         r"spacing=\(1, 0, 1\); expected one or three finite lengths above 0"),
        (VALUES, {"spacing": (1, 1)}, ValueError, "spacing="),
        (VALUES, {"spacing": np.nan}, ValueError, "spacing=nan"),
        (VALUES, {"origin": (1, 1)}, ValueError, r"origin=\(1, 1\); expected three finite coordinates"),
        (VALUES, {"direction": np.eye(2)}, ValueError, "expected a finite"),
        (VALUES, {"direction": 2 * np.eye(3)}, ValueError,
         r"have the lengths \[2.0, 2.0, 2.0\]; expected 1: lengths belong into spacing"),
        (VALUES, {"direction": np.eye(3)[[0, 0, 1]]}, ValueError, "lengths"),
        (VALUES, {"direction": [[1, 1, 0], [0, 0, 0], [0, 0, 1]]}, ValueError, "flattens space"),
        (VALUES, {"affine": np.eye(4), "spacing": 1}, ValueError, "affine says spacing, origin and direction too"),
        (VALUES, {"affine": np.zeros((4, 4))}, ValueError, "ends in the row"),
        (VALUES, {"shape": SHAPE}, ValueError, "shape and dtype are of files of bare numbers, such as .raw; leave"),
        (VALUES, {"scalars": "fa"}, ValueError, "scalars='fa' chooses among the arrays of a VTK image; leave it out"),
        (np.zeros((4, 4, 4, 3)), {}, ValueError, r"\(4, 4, 4, 3\), as RGB colours have; .* as \(image\[..., 0\]"),
        (np.zeros((4, 4)), {}, ValueError, r"the shape \(4, 4\); three axes \(nx, ny, nz\)"),
        ([[1, 2], [3]], {}, ValueError, "rows are of unlike lengths"),
        (5, {}, TypeError, "cannot be cast through a int; give a pyvista.ImageData"),
        ({"a": 1}, {}, TypeError, "cannot be cast through a dict"),
        (pv.ImageData(dimensions=SHAPE), {}, ValueError, r"no active scalars among its arrays \[\]"),
        (pv.ImageData(dimensions=(4, 4, 1)), {}, ValueError, "no active scalars"),
        (pv.Sphere(), {}, TypeError, "cannot be cast through a PolyData; sample it on a grid first"),
        (pv.StructuredGrid(np.eye(3), np.eye(3), np.eye(3)), {}, TypeError, "cast through a StructuredGrid"),
        (pv.MultiBlock([image()]), {}, TypeError, "a MultiBlock is no grid"),
        (image(), {"scalars": "fa"}, ValueError,
         r"no array 'fa' of numbers among its arrays \['ct'\]; choose one by scalars="),
        (image(), {"scalars": np.zeros(7)}, ValueError,
         r"shape \(7,\); expected one number for each of the image's 60 points or 24 cells"),
        (image(rgb=np.zeros((60, 3), np.uint8)), {"scalars": "rgb"}, ValueError,
         "'rgb' has 3 numbers per voxel, RGB colours perhaps; one is needed"),
    ],
)  # fmt: skip
def test_what_is_no_volume_or_place_is_refused(source, given, error, message):
    with pytest.raises(error, match=message):
        as_raycast_volume(source, **given)
