"""Files that name other files are opened only if those lie in the served folder; uploads have plain names."""

import asyncio
import json

import aiohttp
import pytest
import pyvista as pv
from aiohttp import web

from pvfiblets.errors import FibletsError
from pvfiblets.web.scene.files.loading import Files
from pvfiblets.web.session.document import Source
from tests.web.desk import Desk

HEADERS = {
    ".nhdr": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nbyte skip: 0\ndata file: {}\n\n",
    ".nrrd": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nbyte skip: -1\ndatafile: {}\n\n",
    ".mhd": "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nHeaderSize = -1\nElementDataFile = {}\n",
    ".mha": "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = {}\n",
    ".gltf": '{{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{}", "byteLength": 8}}]}}',
    ".mif": "mrtrix image\ndim: 2,2,2\nvox: 1,1,1\nlayout: +0,+1,+2\ndatatype: UInt8\nfile: {} 0\nEND\n",
    ".mih": "mrtrix image\ndim: 2,2,2\nvox: 1,1,1\nlayout: +0,+1,+2\ndatatype: UInt8\nfile: {}\nEND\n",
    ".gii": '<GIFTI Version="1.0" NumberOfDataArrays="1"><DataArray Intent="NIFTI_INTENT_SHAPE" DataType='
    '"NIFTI_TYPE_UINT8" ArrayIndexingOrder="RowMajorOrder" Dimensionality="1" Dim0="8" Encoding="ExternalFileBinary" '
    'Endian="LittleEndian" ExternalFileName="{}" ExternalFileOffset="0"><Data/></DataArray></GIFTI>',
    ".obj": "mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
}


@pytest.fixture
def home(tmp_path):
    root = tmp_path / "home"
    root.mkdir()
    secret = tmp_path / "secret.raw"
    secret.write_bytes(bytes(range(8)))
    secret.chmod(0o600)
    (root / "link.raw").symlink_to(secret)
    (root / "inside.raw").write_bytes(bytes(range(8)))
    return root


@pytest.mark.parametrize("suffix", HEADERS)
def test_references_out_of_the_root_are_refused_with_one_sentence(home, suffix):
    outside = home.parent
    said = set()
    beside = outside / f"{home.name}-of-another"  # begins with the root's name
    beside.mkdir()
    (beside / "secret.raw").write_bytes(bytes(8))
    (home / "aside.raw").symlink_to(beside / "secret.raw")
    names = ["../secret.raw", "link.raw", f"{outside}/none.raw", "../none.raw", f"../{beside.name}/secret.raw"]
    for named in (f"{outside}/secret.raw", *names, f"{beside}/secret.raw", "aside.raw"):
        (home / f"a{suffix}").write_text(HEADERS[suffix].format(named))
        with pytest.raises(PermissionError) as caught:
            Files(home).load(Source(f"a{suffix}"))
        said.add(str(caught.value))
    assert len(said) == 1
    assert "secret" not in said.pop()


@pytest.mark.parametrize("uri", ["file:///etc/passwd", "%2e%2e/secret.raw", "..%2Fsecret.raw", "FILE:x", "http://a/b"])
def test_addresses_in_gltf_are_refused(home, uri):
    (home / "a.gltf").write_text(HEADERS[".gltf"].format(uri))
    with pytest.raises(PermissionError):
        Files(home).resolve("a.gltf")
    text = json.dumps({"buffers": [{"uri": uri}]}).encode()
    glb = b"glTF" + (2).to_bytes(4, "little") + (20 + len(text)).to_bytes(4, "little")
    (home / "a.glb").write_bytes(glb + len(text).to_bytes(4, "little") + b"JSON" + text)
    with pytest.raises(PermissionError):
        Files(home).resolve("a.glb")


@pytest.mark.parametrize("suffix", HEADERS)
def test_references_in_the_root_are_followed(home, suffix):
    for named in ("inside.raw", f"{home}/inside.raw"):
        (home / f"a{suffix}").write_text(HEADERS[suffix].format(named))
        assert Files(home).resolve(f"a{suffix}") == home / f"a{suffix}"
    if suffix in (".nhdr", ".mhd", ".mif", ".mih"):
        from pvfiblets.volumes import as_raycast_volume

        assert as_raycast_volume(home / f"a{suffix}").values.ravel("F").tolist() == list(range(8))


@pytest.mark.parametrize(
    "suffix", [".vtm", ".pvd", ".pvti", ".pvtu", ".pvtp", ".vtmb", ".xdmf", ".case", ".dem", ".hdr", ".img"]
)
def test_formats_whose_references_nobody_finds_are_refused(home, suffix):
    (home / f"a{suffix}").write_text("<VTKFile/>")
    with pytest.raises(FibletsError, match="not opened here"):
        Files(home).resolve(f"a{suffix}")


def upload(scene, folder, names, body):
    """Send files over a socket; return statuses, texts, and what is in the folder afterwards."""

    async def go():
        desk = Desk(scene, folder)
        app = web.Application()
        app.router.add_post("/upload", desk.files.receive)
        runner = web.AppRunner(app)
        await runner.setup()
        await web.TCPSite(runner, "127.0.0.1", 0).start()
        address = f"http://127.0.0.1:{runner.addresses[0][1]}/upload"
        answers = []
        async with aiohttp.ClientSession() as client:
            for name in names:
                async with client.post(address, params={"name": name}, data=body) as answer:
                    answers.append((answer.status, await answer.text()))
        await asyncio.gather(*desk.tasks, return_exceptions=True)
        await runner.cleanup()
        return answers

    return asyncio.run(go())


def test_names_that_no_page_should_show_are_refused(scene, folder):
    before = sorted(folder.iterdir())
    names = ["a" * 260 + ".ply", "a\n.ply", "\x1b.ply", ".a.ply", "<b>.ply", "CON.ply", "../a.ply", "a.exe", ""]
    for status, text in upload(scene, folder, names, b"x"):
        assert status == 400
        assert "\n" not in text
        assert str(folder) not in text
    assert sorted(folder.iterdir()) == before


def test_what_exists_says_so_and_what_cannot_be_opened_is_not_kept(scene, folder, tmp_path):
    before = sorted(folder.iterdir())
    [(status, text)] = upload(scene, folder, ["ball.ply"], b"x")
    assert status == 409
    assert "exists already" in text
    outside = HEADERS[".nhdr"].format("/etc/passwd").encode()
    assert upload(scene, folder, ["a.nhdr"], outside)[0][0] == 200
    assert sorted(folder.iterdir()) == before
    pv.Sphere().save(tmp_path / "b.ply")
    assert upload(scene, folder, ["b.ply"], (tmp_path / "b.ply").read_bytes())[0][0] == 200
    assert (folder / "b.ply").is_file()
