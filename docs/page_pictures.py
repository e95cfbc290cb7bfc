"""Makes pictures of how-to pages: ``python docs/page_pictures.py [PICTURE…]``.

Most come from the pages' own programs, with a larger brain in place of the tests' small one. The scene of docs/howto.md
is of real data, in the folder that ``PVFIBLETS_DATA`` names, or in ``../shared/data``.
"""

from __future__ import annotations

import argparse
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image, ImageChops

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "docs")]

from pages import blocks, program  # noqa: E402 - the programs that the tests run

import pvfiblets  # noqa: E402
from pvfiblets.synthetic import brain_streamlines  # noqa: E402
from pvfiblets.synthetic.vessels import vessel_lines, vessel_tree  # noqa: E402
from tests.page.conftest import WEBGL  # noqa: E402 - the tests' way to open a page
from tests.page.pages import Page  # noqa: E402
from tests.web.browsing import FLAGS, launched  # noqa: E402

DATA = Path(os.environ.get("PVFIBLETS_DATA", ROOT.parent / "shared" / "data"))
QUALITY, MARGIN = 88, 30
ENVIRONMENT = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow", "PYVISTA_OFF_SCREEN": "true"} | os.environ


def run(page: str, folder: Path) -> None:
    """Run all of a page in a folder."""
    text = program(page).replace("brain_streamlines(400,", "brain_streamlines(20_000,")
    text = text.replace("import pyvista\npyvista.global_theme.window_size = (512, 384)\n", "")
    (folder / "page.py").write_text(text, encoding="utf-8")
    subprocess.run([sys.executable, "page.py"], cwd=folder, check=True, env=ENVIRONMENT)


def shards(folder: Path) -> Image.Image:
    """The shards of a set, each in a colour."""
    run("docs/shards.md", folder)
    return Image.open(folder / "shards.png")


def tutorial(folder: Path) -> Image.Image:
    """The figure of the tutorial, at half its size."""
    run("docs/tutorial.md", folder)
    return Image.open(folder / "figure.png").reduce(2)


def page(folder: Path) -> Image.Image:
    """An exported page in the browser."""
    run("docs/pages.md", folder)
    with launched([*(flag for flag in FLAGS if flag != "--disable-gpu"), *WEBGL]) as browser:
        opened = Page(browser, folder / "figure.html", size=(1280, 720))
        opened.page.locator("#panel > summary").click()
        opened.page.get_by_role("button", name="Left").click()
        opened.settled()
        opened.page.screenshot(path=folder / "page.png")
    return Image.open(folder / "page.png")


def scene(folder: Path) -> Image.Image:
    """The scene that a command renders, of real data in place of the files that the page names."""
    files = {"brain.fiblets": "wholebrain_eudx_0.5mm_fifth.tck", "t1.nii.gz": "tractseg_FA.nii.gz"}
    (text,) = (text for _, text in blocks(HERE / "howto.md") if "half.png" in text)
    command = shlex.split(text.replace("\\\n", " ").replace("values=60", "values=0.15"))
    command = [str(DATA / files[word]) if word in files else word for word in command]
    subprocess.run([sys.executable, "-m", *command], cwd=folder, check=True, env=ENVIRONMENT)
    picture = Image.open(folder / "half.png").convert("RGB")
    left, top, right, bottom = ImageChops.difference(picture, Image.new("RGB", picture.size)).getbbox() or (0, 0, 1, 1)
    return picture.crop((left - MARGIN, top - MARGIN, right + MARGIN, bottom + MARGIN))


def cohort(folder: Path) -> Image.Image:
    """FA along a bundle in synthetic subjects, whose FA differs in height and on a part of the bundle."""
    random = np.random.default_rng(0)
    for n in range(12):
        brain = brain_streamlines(6_000, seed=n, fa=True)
        bundle = brain[brain.groups["callosum"]]
        dip = 1.0 - random.uniform(0.0, 0.3) * np.exp(-(((bundle.points[:, 0] - random.uniform(-25, 25)) / 12) ** 2))
        bundle.per_point = {"fa": (bundle.per_point["fa"] * dip * random.uniform(0.9, 1.1)).astype(np.float32)}
        target = folder / f"study/sub-{n + 1:02}/dwi/sub-{n + 1:02}_bundle-callosum.trk"
        target.parent.mkdir(parents=True)
        pvfiblets.write(target, bundle)
    commands, text = (text for _, text in blocks(HERE / "clusters.md"))
    (folder / "page.py").write_text(text, encoding="utf-8")
    for words in (["-m", *shlex.split(commands.splitlines()[0])], ["page.py"]):
        subprocess.run([sys.executable, *words], cwd=folder, check=True, env=ENVIRONMENT)
    return Image.open(folder / "along.png")


def volume_filters(_folder: Path) -> Image.Image:
    """A surface of coarse vessels by four ways to find it."""
    plotter = pv.Plotter(off_screen=True, window_size=(1400, 900), shape=(2, 2), border=False)
    tree, way = vessel_tree(96), vessel_lines().get_cell(0).points
    plotter.set_background("black", all_renderers=True)
    for n, settings in enumerate(({"refine": "none", "step": 1.0}, {}, {"filter": "nearest"}, {"filter": "tricubic"})):
        plotter.subplot(*divmod(n, 2))
        plotter.add_raycast_volume(tree, mode="isosurface", values=90, color="#e8a08c", **settings)
        plotter.camera_position = [way[9] + (26, -70, 20), way[9], (0, 0, 1)]
        words = ", ".join(f"{name}={value!r}" for name, value in settings.items()) or "default: exact, trilinear"
        plotter.add_text(words, position=(16, 12), font_size=14, color="white")
    drawn = Image.fromarray(plotter.screenshot(None))
    plotter.close()
    return drawn


PICTURES = {one.__name__: one for one in (tutorial, shards, page, scene, cohort, volume_filters)}


def main() -> None:
    """Make the named pictures."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0] + ".")
    parser.add_argument("picture", nargs="*", metavar="PICTURE", choices=[[], *PICTURES], help=", ".join(PICTURES))
    for name in parser.parse_args().picture or PICTURES:
        with tempfile.TemporaryDirectory() as folder:
            target = HERE / "pictures" / f"{name}.jpg"
            PICTURES[name](Path(folder)).convert("RGB").save(target, quality=QUALITY, optimize=True)
            print(target)


if __name__ == "__main__":
    main()
