"""Small tractograms, and files of every format made from them by independent writers."""

import gzip
import struct
import warnings
from pathlib import Path

import numpy as np

from pvfiblets.streamlines import Streamlines

AFFINE = np.array([[-2.0, 0, 0, 90], [0, 2.5, 0, -126], [0, 0, 3, -72], [0, 0, 0, 1]])


def rich(seed: int = 0, counts=(5, 1, 12, 0, 2, 7)) -> Streamlines:
    """Streamlines with all that a format might hold, one-point and zero-point ones among them."""
    rng = np.random.default_rng(seed)
    n, m = sum(counts), len(counts)
    points = (rng.normal(size=(n, 3)) * 40).astype(np.float32)
    if n > 3:
        points[2] = points[1]  # a repeated point
    return Streamlines(
        points,
        np.cumsum([0, *counts]),
        per_point={"fa": rng.random(n).astype(np.float32), "rgb": rng.random((n, 3)).astype(np.float32)},
        per_streamline={
            "weight": rng.random(m).astype(np.float32),
            "pair": rng.integers(0, 99, (m, 2)).astype(np.float32),
        },
        groups={"left": np.arange(0, m, 2), "all of them": np.arange(m)},
        per_group={"left": {"color": np.array([1, 2, 3], np.uint8)}},
        affine=AFFINE,
        space={"dimensions": (91, 109, 91), "voxel_sizes": (2.0, 2.5, 3.0), "voxel_order": "LAS"},
    )


def same(a: Streamlines, b: Streamlines, parts=("per_point", "per_streamline"), atol=0.0) -> None:
    """Assert that two Streamlines hold the same."""
    assert np.array_equal(a.offsets, b.offsets)
    assert a.points.shape == b.points.shape
    assert np.allclose(a.points, b.points, rtol=0, atol=atol)
    for part in parts:
        ours, theirs = getattr(a, part), getattr(b, part)
        assert set(ours) == set(theirs), part
        for name in ours:
            if part == "per_group":
                assert set(ours[name]) == set(theirs[name])
                for key in ours[name]:
                    assert np.array_equal(ours[name][key], theirs[name][key])
            else:
                assert np.array_equal(ours[name], theirs[name], equal_nan=True), name


def tck_bytes(
    rows: np.ndarray,
    *,
    datatype: str = "Float32LE",
    header: str = "",
    offset: int | None = None,
    magic: str = "mrtrix tracks",
) -> bytes:
    """A tck file of the given rows, laid out by hand."""
    kind = {"32LE": "<f4", "32BE": ">f4", "64LE": "<f8", "64BE": ">f8"}[datatype[-4:]]
    at = 256 if offset is None else offset
    text = f"{magic}\ndatatype: {datatype}\n{header}file: . {at}\nEND\n".encode()
    return text.ljust(256, b"\n") + np.asarray(rows).astype(kind).tobytes()


def tt_bytes(streamlines_voxels: list[np.ndarray], *, extra=(), affine=AFFINE, blocks=1) -> bytes:
    """An inflated TinyTrack file: `streamlines_voxels` are integers in 1/32 voxel."""

    def matrix(name: str, values: np.ndarray, columns: int | None = None) -> bytes:
        tens = {"f4": 10, "i4": 20, "u2": 40, "u1": 50}[values.dtype.str[1:]]
        rows = 1 if columns is None else len(values)
        size = len(values) if columns is None else columns
        raw = name.encode() + b"\0"
        return struct.pack("<5i", tens, rows, size, 0, len(raw)) + raw + values.tobytes()

    out = matrix("dimension", np.array([91, 109, 91], "<i4"))
    out += matrix("voxel_size", np.array([2, 2.5, 3], "<f4"))
    out += matrix("trans_to_mni", np.asarray(affine, "<f4").ravel())
    for name, values in extra:
        out += matrix(name, values)
    for block in range(blocks):
        track = b""
        for points in streamlines_voxels[block::blocks]:
            flat = np.asarray(points)
            track += struct.pack("<I3i", flat.size, *flat[0].tolist())
            track += np.diff(flat, axis=0).astype(np.int8).tobytes()
        name = "track" if blocks == 1 else f"track{block}"
        out += matrix(name, np.frombuffer(track, np.uint8))
    return out


def corpus(folder: Path) -> dict[str, Path]:
    """One small healthy file of every format and variant."""
    from pvfiblets import formats

    s = rich()
    files: dict[str, Path] = {}
    for suffix in (".tck", ".trk", ".trx", ".vtk", ".vtp"):
        path = folder / f"rich{suffix}"
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", ".*have no points", UserWarning)
            formats.write(path, s)
        files[suffix] = path
    gz = folder / "rich.trk.gz"
    gz.write_bytes(gzip.compress(files[".trk"].read_bytes(), mtime=0))
    files[".trk.gz"] = gz
    tracks = [np.cumsum(np.full((k, 3), 7), axis=0) + 900 for k in (4, 1, 9)]
    tt = folder / "small.tt.gz"
    extra = [("cluster", np.array([0, 1, 0], "<u2")), ("color", np.array([255, 65280], "<i4"))]
    tt.write_bytes(gzip.compress(tt_bytes(tracks, extra=extra), mtime=0))
    files[".tt.gz"] = tt
    mesh = s.to_polydata()
    for name, options in (("text.vtk", {"binary": False}), ("inline.vtp", {"binary": True})):
        mesh.save(folder / name, **options)
        files[name] = folder / name
    mesh.save(folder / "text.vtp", binary=False)
    files["text.vtp"] = folder / "text.vtp"
    deflated = folder / "deflated.trx"
    from zipfile import ZIP_DEFLATED, ZipFile

    with ZipFile(files[".trx"]) as old, ZipFile(deflated, "w", ZIP_DEFLATED) as new:
        for entry in old.infolist():
            new.writestr(entry.filename, old.read(entry))
    files["deflated.trx"] = deflated
    return files


def values_corpus(folder: Path) -> dict[str, Path]:
    """Values for the points, or the streamlines, of :func:`rich` in files of every kind."""
    from pvfiblets.formats.attachments import write_scalars

    s = rich()
    write_scalars(folder / "v.tsf", s, "fa")
    np.save(folder / "v.npy", s.per_point["fa"])
    np.savetxt(folder / "v.txt", s.per_streamline["weight"])
    np.savetxt(folder / "v.csv", s.per_streamline["pair"], delimiter=",")
    return {name: folder / name for name in ("v.tsf", "v.npy", "v.txt", "v.csv")}


def volume_corpus(folder: Path) -> dict[str, Path]:
    """A small volume in files of every kind that rays can be cast through, by independent writers where there are."""
    import bz2

    import nibabel as nib
    import pyvista as pv
    from vtkmodules.vtkIOImage import vtkMetaImageWriter

    values = np.random.default_rng(0).integers(0, 200, (5, 6, 7)).astype(np.int16)
    for name, kind in (("v.nii", nib.Nifti1Image), ("v.nii.gz", nib.Nifti1Image),
                       ("v.mgh", nib.MGHImage), ("v.mgz", nib.MGHImage)):  # fmt: skip
        nib.save(kind(values, AFFINE), folder / name)
    raw = values.tobytes(order="F")
    text = " ".join(map(str, values.ravel(order="F"))).encode()
    packed = {"v.nrrd": ("raw", raw), "gzip.nrrd": ("gzip", gzip.compress(raw, mtime=0)),
              "bzip2.nrrd": ("bzip2", bz2.compress(raw)), "text.nrrd": ("ascii", text)}  # fmt: skip
    header = (
        "NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 5 6 7\nendian: little\n"
        "space directions: (2,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\nencoding: {}\n"
    )
    for name, (encoding, data) in packed.items():
        (folder / name).write_bytes(header.format(encoding).encode() + b"\n" + data)
    (folder / "apart.raw").write_bytes(raw)
    (folder / "apart.nhdr").write_text(header.format("raw") + "byte skip: -1\nline skip: 0\ndata file: apart.raw\n\n")
    image = pv.ImageData(dimensions=values.shape, spacing=(2.0, 2.0, 3.0))
    image["v"] = values.ravel(order="F")
    for name, deflated in (("v.mha", False), ("deflated.mha", True), ("apart.mhd", False)):
        writer = vtkMetaImageWriter()
        writer.SetInputData(image)
        writer.SetFileName(str(folder / name))
        if name.endswith(".mhd"):
            writer.SetRAWFileName(str(folder / "apart2.raw"))
        writer.SetCompression(deflated)
        writer.Write()
    image.save(folder / "v.vti")
    image.save(folder / "text.vti", binary=False)
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    xml = vtkXMLImageDataWriter()
    xml.SetInputData(image)
    xml.SetFileName(str(folder / "deflated.vti"))
    xml.SetCompressorTypeToZLib()
    xml.SetDataModeToAppended()
    xml.Write()
    names = ("v.nii", "v.nii.gz", "v.mgh", "v.mgz", *packed, "apart.nhdr", "v.mha", "deflated.mha", "apart.mhd",
             "v.vti", "text.vti", "deflated.vti")  # fmt: skip
    return {name: folder / name for name in names}


def image_corpus(folder: Path) -> dict[str, Path]:
    """A small image in files of MRtrix, whose data follow their header."""
    values = np.random.default_rng(0).integers(0, 200, (5, 6, 7, 3)).astype("<i2")
    header = (
        "mrtrix image\ndim: 5,6,7,3\nvox: 2,2,3,1\nlayout: +0,+1,+2,+3\ndatatype: Int16LE\n"
        "transform: 1,0,0,-5\ntransform: 0,1,0,-6\ntransform: 0,0,1,-7\nscaling: 1,0.5\nfile: . 256\nEND\n"
    )
    data = header.encode().ljust(256, b"\0") + values.tobytes(order="F")
    (folder / "v.mif").write_bytes(data)
    (folder / "v.mif.gz").write_bytes(gzip.compress(data, mtime=0))
    return {name: folder / name for name in ("v.mif", "v.mif.gz")}


def surface_corpus(folder: Path) -> dict[str, Path]:
    """A tetrahedron of FreeSurfer, with labels in both kinds of table and numbers of its corners."""
    import nibabel.freesurfer as fs

    points, faces = (
        np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9.0]]),
        np.array([[0, 1, 2], [0, 1, 3], [0, 2, 3]]),
    )
    axes = {"xras": [-1, 0, 0], "yras": [0, 0, -1], "zras": [0, 1, 0], "cras": [5.5, -17, 32]}
    volume = {"head": np.array([2, 0, 20]), "valid": "1  # volume info valid", "filename": "a.mgz",
              "volume": [256] * 3, "voxelsize": [1.0] * 3} | axes  # fmt: skip
    fs.write_geometry(folder / "s.pial", points, faces, volume_info=volume)
    table = np.array([[25, 5, 25, 0], [255, 0, 0, 0], [0, 0, 255, 0]])
    fs.write_annot(folder / "s.annot", np.array([0, 1, 2, 1]), table, ["unknown", "a", "b"], fill_ctab=True)
    fs.write_morph_data(folder / "s.thickness", np.linspace(1, 2, 4))
    return {name: folder / name for name in ("s.pial", "s.annot", "s.thickness")}


def label_corpus(folder: Path) -> dict[str, Path]:
    """Names of three labels in tables of every kind."""
    import nibabel as nib

    (folder / "v.ctab").write_text("# FreeSurfer\n17 Left-Hippocampus 220 216 20 0\n53 Right 1 2 3 0\n7 Pons 9 8 7 0\n")
    (folder / "v.label").write_text(
        '0 0 0 0 0 0 0 "Clear Label"\n17 220 216 20 1 1 1 "Left Hippocampus"\n53 1 2 3 0.5 1 0 "Right"\n'
    )
    rows = ("index name color", "17 Left-Hippocampus #dcd814", "53 Right #010203", "7 Pons n/a")
    (folder / "v.tsv").write_text("".join(row.replace(" ", "\t") + "\n" for row in rows))
    table = nib.gifti.GiftiLabelTable()
    for key, name in ((17, "Left-Hippocampus"), (53, "Right")):
        one = nib.gifti.GiftiLabel(key, 0.5, 0.25, 0.1, 1.0)
        one.label = name
        table.labels.append(one)
    array = nib.gifti.GiftiDataArray(np.array([17, 53, 17], np.int32), "NIFTI_INTENT_LABEL", "NIFTI_TYPE_INT32")
    nib.save(nib.gifti.GiftiImage(labeltable=table, darrays=[array]), folder / "v.label.gii")
    return {name: folder / name for name in ("v.ctab", "v.label", "v.tsv", "v.label.gii")}
