"""Small files that swell to hundreds of megabytes, and a session in a process of its own that opens them.

Run as a program: ``python -m tests.web.bombs FOLDER ROOM NAME...`` opens files with so many bytes of memory to spare,
and prints what became of each.
"""

import asyncio
import gzip
import io
import json
import struct
import sys
import time
import zipfile
import zlib
from pathlib import Path

import numpy as np

MEBIBYTE = 1 << 20


def zeros(target, first, size):
    """Write gzip data of some bytes and then zeros, in members of 16 MB: the last one's size is all that they tell."""
    piece = gzip.compress(bytes(16 * MEBIBYTE), 1)
    target.write_bytes(
        gzip.compress(first) + piece * (size // (16 * MEBIBYTE)) + gzip.compress(bytes(size % (16 * MEBIBYTE)))
    )


def plain_zeros(target, first, size):
    """Write gzip data of one member, whose end tells the whole size."""
    with gzip.open(target, "wb", 1) as file:
        file.write(first)
        for _ in range(size // MEBIBYTE):
            file.write(bytes(MEBIBYTE))


def _trk_header(streamlines):
    from nibabel.streamlines.trk import header_2_dtype

    header = np.zeros((), header_2_dtype)
    header["magic_number"], header["version"], header["hdr_size"] = b"TRACK", 2, 1000
    header["dimensions"], header["voxel_sizes"], header["voxel_to_rasmm"] = 1, 1, np.eye(4)
    header["voxel_order"], header["nb_streamlines"] = b"RAS", streamlines
    return header.tobytes()


def trk_of_one(target, megabytes):
    """One streamline."""
    n = megabytes * MEBIBYTE // 12
    zeros(target, _trk_header(1) + struct.pack("<i", n), n * 12 + MEBIBYTE)


def trk_that_says_so(target, megabytes):
    """Streamlines without points."""
    plain_zeros(target, _trk_header(0), megabytes * MEBIBYTE)


def trk_of_none(target, megabytes):
    """Streamlines without points, and an end that tells the size of the last 16 MB."""
    zeros(target, _trk_header(0), megabytes * MEBIBYTE)


def trx(target, megabytes):
    n = megabytes * MEBIBYTE // 12
    header = {"DIMENSIONS": [1, 1, 1], "VOXEL_TO_RASMM": np.eye(4).tolist(), "NB_VERTICES": n, "NB_STREAMLINES": 1}
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        archive.writestr("header.json", json.dumps(header))
        archive.writestr("offsets.uint64", struct.pack("<Q", 0))
        with archive.open("positions.3.float32", "w") as member:
            left = n * 12
            while left:
                member.write(bytes(min(left, MEBIBYTE)))
                left -= min(left, MEBIBYTE)


def nii(target, megabytes, scale=0.0):
    """Bytes; scaled ones become numbers of four bytes each."""
    import nibabel

    header = nibabel.Nifti1Header()
    header.set_data_dtype(np.uint8)
    header.set_data_shape((1024, 1024, megabytes))
    header["vox_offset"], header["scl_slope"], header["magic"] = 352, scale, b"n+1"
    header.set_sform(np.eye(4), 1)
    zeros(target, header.binaryblock + bytes(4), megabytes * MEBIBYTE)


def nrrd(target, megabytes):
    head = (
        f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1024 1024 {megabytes}\nencoding: gzip\n"
        "space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n"
    )
    zeros(target, b"", megabytes * MEBIBYTE)
    target.write_bytes(head.encode() + target.read_bytes())


def tt(target, megabytes):
    plain_zeros(target, struct.pack("<5i", 0, 0, 0, 0, 1), megabytes * MEBIBYTE)


def tt_that_says_less(target, megabytes):
    zeros(target, struct.pack("<5i", 50, megabytes * MEBIBYTE // 2, 1, 0, 6) + b"track\0", megabytes * MEBIBYTE)


def _vtk(target, kind, content, megabytes):
    """An array of VTK's in compressed blocks of 1 MB of zeros."""
    block = zlib.compress(bytes(MEBIBYTE), 1)
    sizes = struct.pack(f"<{3 + megabytes}Q", megabytes, MEBIBYTE, 0, *[len(block)] * megabytes)
    head = (
        f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
        f'compressor="vtkZLibDataCompressor"><{kind}{content}</{kind}><AppendedData encoding="raw">_'
    )
    target.write_bytes(head.encode() + sizes + block * megabytes + b"</AppendedData></VTKFile>")


def vti(target, megabytes):
    extent = f"0 1023 0 1023 0 {megabytes - 1}"
    array = '<DataArray type="UInt8" Name="v" format="appended" offset="0"/>'
    content = f' WholeExtent="{extent}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}">'
    _vtk(target, "ImageData", f'{content}<PointData Scalars="v">{array}</PointData></Piece>', megabytes)


def vtp(target, megabytes):
    n = megabytes * MEBIBYTE // 12
    array = '<DataArray type="Float32" Name="Points" NumberOfComponents="3" format="appended" offset="0"/>'
    counts = 'NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0"'
    _vtk(target, "PolyData", f'><Piece NumberOfPoints="{n}" {counts}><Points>{array}</Points></Piece>', megabytes)


def ply(target, megabytes):
    """As many points as it says are not there, but VTK's reader takes memory first, and ends the process."""
    n = megabytes * MEBIBYTE // 12
    target.write_text(
        f"ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty float x\nproperty float y\n"
        "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
    )


def vtk(target, megabytes):
    """The same, in a format of which nothing is looked at before."""
    target.write_text(
        f"# vtk DataFile Version 3.0\nbomb\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1024 1024 {megabytes}\n"
        f"ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA {megabytes * MEBIBYTE}\nSCALARS v unsigned_char 1\n"
        "LOOKUP_TABLE default\n1 2 3\n"
    )


def gltf(target, megabytes):
    """The same in another, with which VTK ends the process."""
    n = megabytes * MEBIBYTE // 12
    data = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 12 * n}],
        "buffers": [{"byteLength": 12 * n, "uri": "data:application/octet-stream;base64," + "A" * 48}],
    }  # fmt: skip
    target.write_text(json.dumps(data))


def _opened(folder, room, names):
    import pyvista as pv

    from pvfiblets.support import memory
    from pvfiblets.web.scene.scene import Scene
    from tests.web.desk import Desk

    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    scene = Scene(plotter, folder)
    desk = Desk(scene, folder)

    async def beat(gaps):
        while True:
            before = time.monotonic()
            await asyncio.sleep(0.01)
            gaps.append(time.monotonic() - before)

    async def open_all():
        await desk.files.open("lines.trk")  # numbers are compiled for it, and a picture is drawn
        plotter.render()
        desk.page.chosen, base = scene.layers[0].id, memory.taken()
        memory.limit(base + room)
        for name in names:
            before, gaps, said = memory.taken(), [], ""
            beats = asyncio.create_task(beat(gaps))
            started = time.monotonic()
            try:
                await desk.files.open(name)
            except Exception as error:  # noqa: BLE001 - its sentence is what is tested
                said = f"{type(error).__name__}: {error}"
            seconds = time.monotonic() - started
            beats.cancel()
            left = [path.name for path in Path(scene.files._folder.name).iterdir()]
            print(
                json.dumps(
                    {
                        "name": name, "said": said, "layers": [layer.name for layer in scene.layers], "left": left,
                        "kept": sorted(loaded.name for loaded in scene.store.loaded.values()), "job": desk.page.job,
                        "more": memory.taken() - before, "gap": max(gaps, default=0.0), "seconds": seconds,
                    }
                ),
                flush=True,
            )  # fmt: skip
        plotter.render()

    asyncio.run(open_all())
    scene.close()
    plotter.close()


if __name__ == "__main__":
    sys.stderr = io.TextIOWrapper(sys.stderr.buffer, line_buffering=True)
    _opened(Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:])
