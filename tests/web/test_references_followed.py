"""No reader opens a file that another file names outside of the root: the system itself says which are opened."""

import contextlib
import ctypes
import gzip
import json
import os
import sys
import zipfile

import numpy as np
import pytest

from pvfiblets.errors import FibletsError
from pvfiblets.web.scene.files.loading import Files
from pvfiblets.web.session.document import Source

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="inotify is Linux's")

IN_ACCESS, IN_OPEN = 0x1, 0x20
KINDS = (None, "tractogram", "tubes", "volume", "image", "labels", "colours", "mesh")

XML = (
    '<?xml version="1.0"?><!DOCTYPE VTKFile [<!ENTITY e SYSTEM "{0}">]>'
    '<VTKFile type="{1}" version="0.1" byte_order="LittleEndian" xmlns:xi="http://www.w3.org/2001/XInclude">'
    '<xi:include href="{0}" parse="text"/><{1} Source="{0}" WholeExtent="0 1 0 1 0 1" Origin="0 0 0" Spacing="1 1 1">'
    '<Piece Source="{0}" file="{0}" Extent="0 1 0 1 0 1" NumberOfPoints="8" NumberOfCells="0" NumberOfVerts="0" '
    'NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0"><PointData><DataArray type="UInt8" Name="a" '
    'format="{2}" offset="0" source="{0}" file="{0}" href="{0}">&e;</DataArray></PointData><Points>'
    '<DataArray type="Float32" NumberOfComponents="3" format="{2}" offset="0" file="{0}">&e;</DataArray></Points>'
    '</Piece></{1}><AppendedData encoding="raw" file="{0}" href="{0}">_&e;</AppendedData></VTKFile>'
)
LEGACY = "# vtk DataFile Version 3.0\n{0}\nASCII\nDATASET {1}\n"
TEXTS = {
    "field.vtk": LEGACY + "FIELD FieldData 1\nfile 1 1 string\n{0}\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"
    "METADATA\nINFORMATION 1\nNAME file LOCATION {0}\nDATA {0}\n\n",
    "pieces.vtk": '<File version="pvtk-1.0" dataType="vtkPolyData" numberOfPieces="1"><Piece fileName="{0}"/></File>',
    "a.ply": "ply\nformat ascii 1.0\ncomment TextureFile {0}\nobj_info file {0}\nelement vertex 3\nproperty float x\n"
    "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "a.stl": "solid {0}\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid {0}\n",
    "a.off": "OFF\n# {0}\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n{0}\n",
    "a.obj": "MTLLIB\t{0}\nmtllib {0}\nmap_Kd {0}\nusemtl {0}\ncall {0}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "named.obj": "shadow_obj {0}\ntrace_obj {0}\nmaplib {0}\nusemap {0}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "plain.obj": "map_Kd {0}\ncall {0}\ncsh cat {0}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "a.tck": "mrtrix tracks\ndatatype: Float32LE\nfile: {0} 0\ncount: 0\nEND\n",
    "a.trk": "TRACK\0{0}",
    "list.nhdr": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: LIST\n{0}\n",
    "pattern.nhdr": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: {0}%d 1 1 1\n\n",
    "twice.nhdr": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nDATA FILE: inside.raw\n"
    "Data File: {0}\nDataFile: {0}\n\n",
    "first.nrrd": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nDATA FILE: {0}\n"
    "datafile: inside.raw\n\n",
    "list.mhd": "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nELEMENTDATAFILE = LIST\n{0}\n{0}\n",
    "pattern.mha": "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = {0}%d 1 1 1\n",
    "twice.mhd": "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = {0}\n"
    "ElementDataFile = LOCAL\n",
    "a.mif": "mrtrix image\ndim: 2,2,2\nlayout: +0,+1,+2\ndatatype: UInt8\nfile: {0} 0\nEND\n",
    "UPPER.MIH": "mrtrix image\nDIM: 2,2,2\nLAYOUT: +0,+1,+2\nDATATYPE: UInt8\nFILE: {0}\nEND\n",
    "a.gii": '<!DOCTYPE GIFTI [<!ENTITY e SYSTEM "{0}">]><GIFTI Version="1.0" NumberOfDataArrays="1"><DataArray '
    'Intent="NIFTI_INTENT_POINTSET" DataType="NIFTI_TYPE_UINT8" ArrayIndexingOrder="RowMajorOrder" Dimensionality="2" '
    'Dim0="4" Dim1="2" Encoding="ExternalFileBinary" Endian="LittleEndian" ExternalFileName="{0}" '
    'ExternalFileOffset="0"><Data>&e;</Data></DataArray></GIFTI>',
    "UPPER.MHD": "NDIMS = 3\nDIMSIZE = 2 2 2\nELEMENTTYPE = MET_UCHAR\nELEMENTDATAFILE = {0}\n",
}
GLTF = (
    '{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}], '
    '"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0}}]}}], '
    '"accessors": [{{"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}}], '
    '"bufferViews": [{{"buffer": 0, "byteLength": 12}}], '
    '"materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}], "textures": [{{"source": 0}}], '
    '"images": [{{{1}}}], "buffers": [{{{0}, "byteLength": 12}}]}}'
)
INSIDE = '"uri": "inside.raw"'


def glb(text, version, kind):
    text = text.encode()
    words = (version, 20 + len(text), len(text), kind)
    return b"glTF" + b"".join(word.to_bytes(4, "little") for word in words) + text


def files(named):
    """Return the contents of files that name `named` wherever a reader might look for a name."""
    found = {name: text.format(named, "POLYDATA").encode() for name, text in TEXTS.items()}
    for suffix, kind in ((".vtp", "PolyData"), (".vtu", "UnstructuredGrid"), (".vti", "ImageData")):
        for how in ("external", "appended", "ascii"):
            found[how + suffix] = XML.format(named, kind, how).encode()
        found["pieces" + suffix] = XML.format(named, "P" + kind, "ascii").encode()
    uris = {
        "plain": f'"uri": "{named}"',
        "twice": f'"uri": "{named}", {INSIDE}',
        "again": f'{INSIDE}, "uri": "{named}"',
        "escaped": f'"\\u0075ri": "{named}"',
        "upper": f'"uri": "FILE://{named}"',
        "coded": f'"uri": "{named.replace("/", "%2f")}"',
        "data": f'"uri": "data:../../{named}"',
    }
    for name, uri in uris.items():
        for where, text in (("buffer", GLTF.format(uri, INSIDE)), ("image", GLTF.format(INSIDE, uri))):
            found[f"{name}-{where}.gltf"] = text.encode()
            for version in (1, 2):
                found[f"{name}-{where}-{version}.glb"] = glb(text, version, 0x4E4F534A)
    found["other.glb"] = glb(GLTF.format(uris["plain"], INSIDE), 2, 0)
    found["binary.gltf"] = glb(GLTF.format(uris["plain"], INSIDE), 2, 0x4E4F534A)
    found["bom.gltf"] = "\ufeff".encode() + GLTF.format(uris["plain"], INSIDE).encode()
    found["more.gltf"] = GLTF.format(uris["plain"], INSIDE).encode() + b"{}"
    found["a.tt.gz"] = gzip.compress(f"{named}\0track {named}".encode())
    return found


@pytest.fixture
def home(tmp_path):
    root = tmp_path / "home"
    root.mkdir()
    (root / "inside.raw").write_bytes(bytes(16))
    (tmp_path / "secret.raw").write_bytes(bytes(range(64)))
    (tmp_path / "secret.raw").chmod(0o600)
    return root


@contextlib.contextmanager
def watched(path):
    """Yield a function that says how often a file was opened or read since it was called last."""
    system = ctypes.CDLL(None, use_errno=True)
    queue = system.inotify_init1(os.O_NONBLOCK)
    assert queue >= 0
    assert system.inotify_add_watch(queue, os.fsencode(path), IN_ACCESS | IN_OPEN) >= 0

    def count():
        try:
            return len(os.read(queue, 1 << 16)) // 16
        except BlockingIOError:
            return 0

    try:
        yield count
    finally:
        os.close(queue)


def open_all(home, name):
    """Open a file as everything that a page could say it is; return how often that went well."""
    well = 0
    for kind in KINDS:
        with contextlib.suppress(FibletsError, ValueError, OSError, TypeError, KeyError):
            Files(home).load(Source(name), kind)
            well += 1
    return well


@pytest.mark.filterwarnings("ignore")
def test_no_reader_opens_what_a_file_names_outside_of_the_root(home):
    secret = home.parent / "secret.raw"
    opened = set()
    with watched(secret) as count:
        secret.read_bytes()
        assert count() > 0  # the witness sees
        for named in (str(secret), "../secret.raw"):
            for name, content in files(named).items():
                (home / name).write_bytes(content)
                open_all(home, name)
                if count():
                    opened.add((name, named))
                (home / name).unlink()
    assert not opened


@pytest.mark.filterwarnings("ignore")
def test_the_same_files_are_followed_inside(home):
    """That readers follow what the other test refuses: else it would say nothing."""
    followed = set()
    with watched(home / "inside.raw") as count:
        names = {"plain-buffer.gltf", "plain-buffer-2.glb", "first.nrrd", "UPPER.MHD", "a.mif", "UPPER.MIH", "a.gii"}
        for name in sorted(names):
            (home / name).write_bytes(files("inside.raw")[name])
            open_all(home, name)
            if count():
                followed.add(name)
    assert followed == names


def test_an_image_of_two_files_in_one_name_stays_alone(home):
    import nibabel as nib

    image = nib.Nifti1Image(np.zeros((2, 2, 2), np.uint8), np.eye(4))
    image.to_filename(home / "a.nii")
    content = bytearray((home / "a.nii").read_bytes())
    content[344:348] = b"ni1\0"  # numbers in another file, it says
    (home / "a.nii").write_bytes(content)
    (home.parent / "secret.img").write_bytes(bytes(64))
    (home / "a.img").symlink_to(home.parent / "secret.img")
    (home / "a.mat").symlink_to(home.parent / "secret.img")
    with watched(home.parent / "secret.img") as count:
        open_all(home, "a.nii")
        assert count() == 0


def test_members_of_an_archive_are_written_nowhere(home):
    secret = home.parent / "secret.raw"
    with zipfile.ZipFile(home / "a.trx", "w") as archive:
        archive.writestr("header.json", json.dumps({"NB_VERTICES": 1, "NB_STREAMLINES": 1, "DIMENSIONS": [1, 1, 1],
                                                    "VOXEL_TO_RASMM": np.eye(4).tolist()}))  # fmt: skip
        for name in ("../positions.3.float32", "/tmp/offsets.uint32", f"{secret}", "../secret.raw"):
            archive.writestr(name, bytes(12))
        link = zipfile.ZipInfo("positions.3.float32")
        link.external_attr = 0o120777 << 16  # a symbolic link, it says
        archive.writestr(link, "../secret.raw")
    before, kept = sorted(home.parent.rglob("*")), secret.read_bytes()
    with watched(secret) as count:
        assert open_all(home, "a.trx") == 0
        assert count() == 0
    assert sorted(home.parent.rglob("*")) == before
    assert secret.read_bytes() == kept


@pytest.mark.parametrize("named", ["../secret.nhdr", "{outside}/secret.nhdr", "link.nhdr", "naming.nhdr"])
def test_sessions_name_nothing_outside(scene, folder, named):
    from pvfiblets.web.session import files as session
    from pvfiblets.web.session.files import SessionError

    outside = folder.parent / "secret.nhdr"
    header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
    outside.write_bytes(header.encode() + b"\n" + bytes(range(8)))
    (folder / "link.nhdr").symlink_to(outside)
    (folder / "naming.nhdr").write_text(f"{header}data file: ../secret.nhdr\n\n")
    scene.open("lines.trk")
    scene.open("head.nii.gz")
    text = json.dumps(session.to_dict(scene))
    data = json.loads(text.replace("head.nii.gz", named.format(outside=folder.parent)))
    with watched(outside) as count:
        with pytest.raises((SessionError, OSError, FibletsError, ValueError)):
            session.prepare(scene, data, folder, None, None)
        lines = scene.layers[0].id
        with pytest.raises((OSError, FibletsError, ValueError)):
            scene.set(lines, "scalars", {"volume": {"path": named.format(outside=folder.parent)}})
        assert count() == 0
