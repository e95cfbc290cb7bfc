"""A program of all that a page of the docs says: its commands and its Python, in their order.

``python tests/docs/pages.py PAGE TARGET`` writes it.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INSTALLS = re.compile(r"\b(sudo|pip|source|make)\b")
WINDOWS = re.compile(r"^pvfiblets (show|serve)\b")
DEMO = re.compile(r"^(pvfiblets demo)\b(?!.*--streamlines)", re.MULTILINE)

BRAIN = """
import pyvista as pv
import pvfiblets
from pvfiblets.synthetic import brain_streamlines
pvfiblets.write("brain.trx", brain_streamlines(400, seed=1, fa=True))
"""

# An image, a surface of GIFTI, labels, and a session that was saved on the page of serve.
SCENE = """
import nibabel, numpy as np
from pvfiblets.web.session import files as session
from pvfiblets.web.scene.scene import Scene
affine = np.diag([12.0, 14.0, 12.0, 1.0])
affine[:3, 3] = -80, -100, -60
numbers = np.random.default_rng(0).integers(0, 120, (12, 12, 12)).astype(np.int16)
nibabel.save(nibabel.Nifti1Image(numbers, affine), "t1.nii.gz")
nibabel.save(nibabel.Nifti1Image(numbers % 20, affine), "atlas.nii.gz")
ball = pv.Sphere(radius=50)
arrays = [
    nibabel.gifti.GiftiDataArray(np.asarray(ball.points, np.float32), "NIFTI_INTENT_POINTSET"),
    nibabel.gifti.GiftiDataArray(ball.regular_faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE"),
]
nibabel.save(nibabel.gifti.GiftiImage(darrays=arrays), "pial.gii")
shown = pv.Plotter(off_screen=True, window_size=(200, 150))
scene = Scene(shown, ".")
scene.open("brain.trx")
session.save(scene, "view.json")
scene.close()
shown.close()
"""

# A fixel directory of MRtrix's: two fixels in each voxel.
FIXELS = """
import pathlib
pathlib.Path("fixels").mkdir()
count = np.full((12, 14, 10), 2)
first = np.arange(count.size).reshape(count.shape) * 2
place = np.stack([count, first], axis=-1).astype(np.uint32)
ways = rng.normal(size=(2 * count.size, 3, 1)).astype("f4")
density = rng.random((2 * count.size, 1, 1)).astype("f4")
for name, numbers in {"index": place, "directions": ways, "fd": density}.items():
    nibabel.save(nibabel.Nifti1Image(numbers, affine), f"fixels/{name}.nii")
"""

# Windows that a page gives no size are a quarter of the usual ones.
SMALL = """
import pyvista
pyvista.global_theme.window_size = (512, 384)
"""

# What a page takes for granted: the reader's own files and objects.
GIVEN = {
    "README.md": BRAIN + """
pvfiblets.write("brain.trk", brain_streamlines(400, seed=1, fa=True))
""",
    "docs/exploring.md": BRAIN + """
import numpy as np
atlas_array, affine = np.arange(8.0**3).reshape(8, 8, 8).astype(int) % 20, np.diag([20.0, 20.0, 20.0, 1.0])
triangulated = pv.Sphere(radius=12).triangulate()
points, triangles = np.asarray(triangulated.points), triangulated.regular_faces
ids = [1, 2, 3]
""",
    "docs/index.md": BRAIN + """
pvfiblets.write("brain.trk", brain_streamlines(400, seed=1))
""",
    "docs/reference/commands.md": BRAIN + SCENE + """
pvfiblets.write("brain.tck", brain_streamlines(400, seed=1))
""",
    "docs/density.md": BRAIN + """
import nibabel, numpy as np
pvfiblets.write("brain.tck", brain_streamlines(400, seed=1))
pvfiblets.compress_file("brain.trx", "brain.fiblets")
affine = np.array([[6.0, 1, 0, -80], [-1, 6, 0, -90], [0, 0, 6, -50], [0, 0, 0, 1]])
nibabel.save(nibabel.Nifti1Image(np.zeros((28, 32, 24), np.int16), affine), "T1.nii.gz")
np.savetxt("sift2.txt", np.linspace(0, 2, 400))
""",
    "docs/effects.md": BRAIN + """
pvfiblets.write("brain.trk", brain_streamlines(400, seed=1))
""",
    "docs/pages.md": BRAIN + """
pvfiblets.write("brain.trk", brain_streamlines(400, seed=1))
""",
    "docs/slices.md": BRAIN + """
import nibabel, numpy as np
pvfiblets.write("brain.trk", brain_streamlines(400, seed=1))
rng = np.random.default_rng(0)
affine = np.array([[12.0, 1, 0, -80], [-1, 12, 0, -90], [0, 0, 12, -50], [0, 0, 0, 1]])
labels = rng.choice([0, 17, 53], (12, 14, 10)).astype(np.int16)
for name, numbers in {
    "t1": rng.integers(0, 900, (12, 14, 10)).astype(np.int16), "fa": rng.random((12, 14, 10)).astype("f4"),
    "v1": rng.normal(size=(12, 14, 10, 3)).astype("f4"), "peaks": rng.normal(size=(12, 14, 10, 6)).astype("f4"),
    "tensor": rng.normal(size=(12, 14, 10, 6)).astype("f4"), "fod": rng.normal(size=(12, 14, 10, 15)).astype("f4"),
}.items():
    nibabel.save(nibabel.Nifti1Image(numbers, affine), f"{name}.nii.gz")
nibabel.save(nibabel.MGHImage(labels, np.diag([12.0, 12.0, 12.0, 1.0])), "aparc+aseg.mgz")
with open("FreeSurferColorLUT.txt", "w") as table:
    table.write("17  Left-Hippocampus  220 216 20 0\\n")
""" + FIXELS,
    "docs/bundles.md": BRAIN + """
import nibabel, numpy as np
pvfiblets.compress_file("brain.trx", "brain.fiblets")
numbers = np.random.default_rng(0).random((24, 28, 20)).astype("f4")
affine = np.array([[8.0, 0, 0, -90], [0, 8, 0, -110], [0, 0, 8, -60], [0, 0, 0, 1]])
nibabel.save(nibabel.Nifti1Image(numbers, affine), "fa.nii.gz")
nibabel.save(nibabel.Nifti1Image((numbers * 6).astype("i2"), affine), "atlas.nii.gz")
""",
    "docs/from-mrview.md": BRAIN + """
import nibabel, numpy as np
from pvfiblets.formats.attachments import write_scalars
pvfiblets.write("brain.tck", brain_streamlines(400, seed=1))
write_scalars("brain_fa.tsf", brain_streamlines(400, seed=1, fa=True), "fa")
np.savetxt("sift2.txt", np.linspace(0, 2, 400))
rng = np.random.default_rng(0)
affine = np.array([[12.0, 1, 0, -80], [-1, 12, 0, -90], [0, 0, 12, -50], [0, 0, 0, 1]])
for name, numbers in {
    "t1": rng.integers(0, 900, (12, 14, 10)).astype(np.int16), "fa": rng.random((12, 14, 10)).astype("f4"),
    "parcels": rng.integers(0, 9, (12, 14, 10)).astype(np.int16),
    "peaks": rng.normal(size=(12, 14, 10, 6)).astype("f4"), "fod": rng.normal(size=(12, 14, 10, 15)).astype("f4"),
}.items():
    nibabel.save(nibabel.Nifti1Image(numbers, affine), f"{name}.nii.gz")
""" + FIXELS,
    "docs/shards.md": "",
    "docs/from-vtk.md": "",
    "docs/tubes.md": "",
    "docs/halos.md": "",
    "docs/volumes.md": "",
    "docs/tutorial.md": "",
    "docs/howto.md": BRAIN + SCENE + """
pvfiblets.write("big.tck", brain_streamlines(400, seed=1, fa=True))
import nibabel, numpy as np
pvfiblets.compress_file("big.tck", "brain.fiblets")
from pvfiblets.formats.attachments import write_scalars
write_scalars("brain_fa.tsf", brain_streamlines(400, seed=1, fa=True), "fa")
image = nibabel.Nifti1Image(np.random.default_rng(0).random((8, 8, 8)), np.diag([20.0, 20.0, 20.0, 1.0]))
atlas = nibabel.Nifti1Image(np.ones((8, 8, 8), np.int16), image.affine)
""",
}  # fmt: skip
# Pictures that are to have many colours where the lines are: a range of other numbers would leave one.
COLOURED = {"docs/tutorial.md": {"first.png", "length.png", "fa.png", "some.png"}}
# Pages whose commands are no program of this kind, and what runs them.
RUN_ELSEWHERE = {
    "docs/clusters.md": "tests/cluster/test_page.py runs it on workers that are there already",
    "docs/serving.md": "a server that waits, and a tunnel to it: tests/web starts servers and opens them in a browser",
    "docs/reference/fiblets-files.md": "test_fiblets_files.py runs the reader that it prints",
}
# A smaller brain (of the demo DEMO sees to it), a smaller print, and windows that stay open for what a page says after
# it has shown them.
INSTEAD = {
    "brain_streamlines(20_000, seed=1, fa=True)": "brain_streamlines(400, seed=1, fa=True)",
    "plotter.show()": "plotter.show(auto_close=False)",
    "scale=4, one_bit=True": "scale=2, one_bit=True",
}


def blocks(page: Path) -> list[tuple[str, str]]:
    """Return (language, text) of each block of a page that is to be run."""
    return re.findall(r"^```(python|console|sh)\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)


def pages_with_blocks() -> set[str]:
    """Return the pages, of the repository's front and of the docs, that have something to be run."""
    found = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
    found += [
        page for room in ("explanation", "reference", "benchmarks") for page in (ROOT / "docs" / room).rglob("*.md")
    ]
    return {page.relative_to(ROOT).as_posix() for page in found if blocks(page)}


def program(page: str) -> str:
    """Return one program of all blocks of a page."""
    parts = ["import subprocess", SMALL, GIVEN[page]]
    for language, text in blocks(ROOT / page):
        if language != "python":
            if INSTALLS.search(text):  # of an install only what comes after it
                text = "\n".join(line for line in text.splitlines() if line.startswith("pvfiblets"))
            text = "\n".join(line for line in text.splitlines() if not WINDOWS.match(line))  # these wait for someone
            text = DEMO.sub(r"\1 --streamlines 1000", text)
            parts.append(f"subprocess.run(['bash', '-e', '-c', {text!r}], check=True)")
        else:
            for told, run in INSTEAD.items():
                text = text.replace(told, run)
            parts.append(text)
    return "\n".join(parts)


if __name__ == "__main__":
    Path(sys.argv[2]).write_text(program(sys.argv[1]))
