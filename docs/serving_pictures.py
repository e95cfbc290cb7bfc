"""Makes the pictures of ``pvfiblets serve`` in docs/serving.md: ``python docs/serving_pictures.py [STATE…]``.

A server is started as a user starts one, and its page is led into each state in Chromium. The tracts and the head
come from the folder that ``PVFIBLETS_DATA`` names, or of ``../shared/data``; where they are missing, made-up ones.
"""

from __future__ import annotations

import argparse
import io
import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from tests.web.browsing import FLAGS, Served, Visit, chromium  # noqa: E402 - the tests' way to drive a page

DATA = Path(os.environ.get("PVFIBLETS_DATA", HERE.parents[1] / "shared" / "data"))
LARGEST = 99_000  # bytes of a picture
EVERY = 3  # of how many streamlines one is shown
STATES: dict[str, Callable[[Any], Any]] = {}


def state(function: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Add a state that a picture is made of, by its function's name."""
    STATES[function.__name__.removesuffix("_")] = function
    return function


# What is served


def make_root(root: Path) -> None:
    """Write what the pages show into a folder."""
    import pvfiblets

    root.mkdir()
    tracts, head = _tracts(), _head()
    fiblets = pvfiblets.compress(tracts, per_point=["fa"] if "fa" in tracts.per_point else [])
    fiblets.save(root / "brain.fiblets")
    pvfiblets.write(root / "brain.trk", tracts)
    (root / "other subjects").mkdir()
    if head is None:
        _made_up_head(root / "t1.nii.gz")
    else:
        shutil.copy(head, root / "t1.nii.gz")
    _atlas(root / "atlas.nii.gz", tracts.points)
    _parcels(root / "parcels.nii.gz")
    _peaks(tracts, root / "peaks.nii.gz")
    import pyvista as pv

    pv.ParametricEllipsoid(9, 12, 8, center=(26, 4, 26)).save(root / "lesion.ply")


def _tracts() -> Any:
    """Return streamlines with ``fa`` per point and three groups."""
    import pvfiblets
    from pvfiblets.streamlines import Streamlines
    from pvfiblets.synthetic import brain_streamlines

    real, anisotropy = DATA / "wholebrain_eudx_0.5mm_fifth.tck", DATA / "tractseg_FA.nii.gz"
    if not (real.is_file() and anisotropy.is_file()):
        return brain_streamlines(3000)
    import nibabel

    lines = pvfiblets.read(real)
    lines = lines[::EVERY]
    image = nibabel.load(anisotropy)
    fa = _between_voxels(
        np.asarray(image.dataobj), nibabel.affines.apply_affine(np.linalg.inv(image.affine), lines.points)
    )
    starts = lines.offsets[:-1]
    low, high = (end.reduceat(lines.points[:, 0], starts) for end in (np.minimum, np.maximum))
    sides = {"left": high < 0, "right": low > 0, "across": (low <= 0) & (high >= 0)}
    return Streamlines(
        lines.points,
        lines.offsets,
        per_point={"fa": np.clip(fa, 0.0, 1.0).astype(np.float32)},
        groups={name: np.flatnonzero(members) for name, members in sides.items()},
    )


def _between_voxels(values: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return values at places in voxels, trilinear."""
    places = np.clip(places, 0.0, np.subtract(values.shape, 1.001))
    first = places.astype(np.int64)
    share = places - first
    found = np.zeros(len(places))
    for corner in np.ndindex(2, 2, 2):
        weight = np.where(corner, share, 1.0 - share).prod(axis=1)
        found += weight * values[tuple((first + corner).T)]
    return found


def _head() -> Path | None:
    found = DATA / "nv_MNI152_2009_template.nii.gz"
    return found if found.is_file() else None


def _atlas(path: Path, points: np.ndarray) -> None:
    """Write made-up parcels, blocks of the brain, and their names."""
    import nibabel

    side = 4.0
    low, high = points.min(axis=0) - side, points.max(axis=0) + side
    shape = np.ceil((high - low) / side).astype(int)
    block = [np.arange(n) * many // n for n, many in zip(shape, (2, 3, 2), strict=True)]
    labels = 1 + block[0][:, None, None] + 2 * (block[1][:, None] + 3 * block[2])
    affine = np.diag([side, side, side, 1.0])
    affine[:3, 3] = low
    nibabel.save(nibabel.Nifti1Image(labels.astype(np.int16), affine), path)
    names = [f"{z} {y} {x}" for z in ("lower", "upper") for y in ("back", "middle", "front") for x in ("left", "right")]
    rows = [f"{label}\t{name}" for label, name in enumerate(names, 1)]
    path.with_name("atlas.tsv").write_text("\n".join(["index\tname", *rows]) + "\n")


BALLS = {
    "left motor cortex": (-30, -22, 58), "right motor cortex": (30, -22, 58), "brain stem": (0, -30, -36),
    "left frontal pole": (-22, 56, 4), "right frontal pole": (22, 56, 4), "left occipital pole": (-18, -88, 4),
    "right occipital pole": (18, -88, 4), "left temporal pole": (-40, 12, -30), "right temporal pole": (40, 12, -30),
}  # fmt: skip
"""Middles of made-up parcels, mm."""


def _parcels(path: Path) -> None:
    """Write balls as labels, with their names beside them."""
    import nibabel

    from pvfiblets.slices.labels import distinct_colours

    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -90.0, -126.0, -72.0
    places = np.stack(np.indices((91, 109, 91)), axis=-1) * 2.0 + affine[:3, 3]
    labels = np.zeros(places.shape[:3], np.uint8)
    rows = ["index\tname\tcolor"]
    for label, (name, middle) in enumerate(BALLS.items(), 1):
        labels[np.linalg.norm(places - middle, axis=-1) < 17.0] = label
        red, green, blue, _ = distinct_colours(np.array([label]))[0].tolist()
        rows.append(f"{label}\t{name}\t#{red:02x}{green:02x}{blue:02x}")
    nibabel.save(nibabel.Nifti1Image(labels, affine), path)
    path.with_name("parcels.tsv").write_text("\n".join(rows))


def _peaks(tracts: Any, path: Path) -> None:
    """Write the direction in which most streamlines run, voxel by voxel, as long as they agree."""
    import nibabel

    ends = np.delete(np.arange(len(tracts.points)), tracts.offsets[:-1])
    steps = tracts.points[ends] - tracts.points[ends - 1]
    low, side = tracts.points.min(axis=0), 4.0
    at = ((0.5 * (tracts.points[ends] + tracts.points[ends - 1]) - low) // side).astype(np.int64)
    shape = tuple(at.max(axis=0) + 1)
    flat = np.ravel_multi_index(tuple(at.T), shape)
    tensors = np.zeros((int(np.prod(shape)), 3, 3))
    np.add.at(tensors, flat, steps[:, :, None] * steps[:, None, :])
    own, vectors = np.linalg.eigh(tensors)
    share = np.divide(own[:, 2] - own[:, 1], own.sum(axis=1), out=np.zeros(len(own)), where=own[:, 2] > 5.0)
    affine = np.diag([side, side, side, 1.0])
    affine[:3, 3] = low + 0.5 * side
    peaks = (vectors[:, :, 2] * share[:, None]).reshape(*shape, 3).astype(np.float32)
    nibabel.save(nibabel.Nifti1Image(peaks, affine), path)


def _made_up_head(path: Path) -> None:
    import nibabel

    from pvfiblets.synthetic.vessels import brain_like

    head = brain_like(144, noise=0.05)
    affine = np.diag([1.16, 1.16, 1.16, 1.0]) @ head.affine
    affine[:3, 3] += (0.0, -19.0, 2.0)
    nibabel.save(nibabel.Nifti1Image(head.values.astype(np.float32), affine), path)


# States


class Studio:
    """A browser, and servers of one folder."""

    def __init__(self, browser: Any, root: Path) -> None:
        self.browser, self.root = browser, root
        self._servers: dict[tuple[str, ...], Served] = {}
        self._visits: list[Visit] = []

    def visit(self, *arguments: str, opened: bool = True, **options: Any) -> Visit:
        """Open a page of a server with these arguments."""
        if arguments not in self._servers:
            paths = [str(self.root / part) if (self.root / part).is_file() else part for part in arguments]
            self._servers[arguments] = Served(*paths, root=self.root)
        here = Visit(self.browser, self._servers[arguments], **options)
        self._visits.append(here)
        return here.open() if opened else here

    def leave(self) -> None:
        """Close all pages."""
        while self._visits:
            self._visits.pop().close()

    def stop(self) -> None:
        """Stop all servers."""
        for server in self._servers.values():
            server.stop()


@state
def open_(studio: Studio) -> Visit:
    """As it opens."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    return here


@state
def colours(studio: Studio) -> Visit:
    """Colours that stand for values."""
    here = studio.visit("brain.fiblets")
    here.press("3")
    here.choose("scalars", "fa")
    here.choose("cmap", "inferno")
    return here


@state
def clip(studio: Studio) -> Visit:
    """Two cuts."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    here.page.click("[data-cut=slab]")
    here.wait(lambda: len(here.state("clips")) == 1, "the slab")
    here.page.click("[data-clip] [data-axis=y]")
    here.wait(lambda: here.state("clips")[0]["axis"] == "y", "the slab's new direction")
    here.page.click("[data-cut=sphere]")
    here.wait(lambda: len(here.state("clips")) == 2, "the sphere")
    here.page.locator("[data-clip]").nth(1).locator("[data-action=side]").click()
    here.wait(lambda: not here.state("clips")[1]["inside"], "the sphere's other side")
    return here


@state
def filter_(studio: Studio) -> Visit:
    """Criteria and a region."""
    here = studio.visit("brain.fiblets")
    here.press("2")
    here.tab("filter")
    here.page.click("#tab-filter .v-select:has(#add-criterion) .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('length')")
    least = here.page.locator("[data-criterion=length] input.pv-num").first
    least.fill("60")
    here.press("Tab")
    here.page.click("[data-region=sphere]")
    here.wait(lambda: len(here.state("filters")["regions"]) == 1, "the region")
    return here


@state
def selection(studio: Studio) -> Visit:
    """What a lasso took."""
    here = studio.visit("brain.fiblets")
    here.press("3")
    here.choose("scalars", "fa")
    here.rests()
    here.press("l")
    here.page.wait_for_selector("#pv-over[data-tool=lasso]")
    here.trace([(0.40, 0.28), (0.52, 0.24), (0.60, 0.30), (0.56, 0.38), (0.46, 0.38)])
    here.wait(lambda: here.state("selection")["count"] > 0, "a selection")
    here.press("Escape")
    return here


def _in_pane(here: Visit, name: str, x: float, y: float) -> tuple[float, float]:
    """Return a place in a pane as a place in the picture, both as shares from the upper left."""
    box = next(one for one in here.state("slicing")["boxes"] if one["name"] == name)
    return box["x"] + x * box["w"], box["y"] + y * box["h"]


@state
def slices(studio: Studio) -> Visit:
    """A painted region on slices, and what passes it."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    here.tab("slices")
    here.page.click("[data-action=open-slices]")
    here.page.click("[data-entry='t1.nii.gz']")
    here.wait(lambda: here.state("slicing")["shown"], "slices")
    for axis, text in enumerate(("-24", "-20", "20")):
        here.page.fill(f"[data-place=position] input >> nth={axis}", text)
        here.press("Tab")
    here.page.click("[data-action=add-painted]")
    here.page.fill("input[aria-label='Radius, mm']", "5")
    here.press("Tab")
    here.wait(lambda: here.state("brush") == 5, "the brush")
    here.page.click("[data-painted] [data-select=use] .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('pass through')")
    here.rests()
    here.trace([_in_pane(here, "axial", *at) for at in ((0.63, 0.54), (0.67, 0.72))])
    here.wait(lambda: here.state("painting")["regions"][0]["voxels"] != "0", "what is painted")
    here.rests()
    here.press("Escape")
    return here


def _with_t1(studio: Studio, *files: str, **options: Any) -> Visit:
    """Open tracts, the T1 as slices, and other images over it."""
    here = studio.visit("brain.fiblets", **options)
    for name in ("t1.nii.gz", *files):
        count = here.layers()
        here.page.evaluate("window.trame.trigger('browse', ['', 'slices'])")
        here.page.click(f"[data-entry='{name}']")
        here.wait(lambda count=count: here.layers() > count, name)
    here.rests()
    return here


@state
def atlas(studio: Studio) -> Visit:
    """What connects two labels."""
    here = _with_t1(studio, "parcels.nii.gz")
    here.press("4")
    here.tab("slices")
    here.page.click("[data-action=atlas]")
    for name in ("left motor cortex", "brain stem"):
        here.page.click(f"[data-label] >> text={name}")
        here.wait(lambda name=name: name in here.page.locator("[data-value=atlas-asked]").inner_text(), name)
    here.page.click("[data-action=panes]")
    here.page.click("input[aria-label='Slices in 3-D']")
    here.page.click("[data-action=panes]")
    here.page.click("[data-label] >> text=left motor cortex >> xpath=ancestor::div[1] >> [aria-label='Go there']")
    here.rests()
    return here


@state
def glyphs(studio: Studio) -> Visit:
    """Peaks over a T1."""
    here = _with_t1(studio, "peaks.nii.gz")
    here.page.click("[data-layer] >> text=peaks.nii.gz")
    here.page.wait_for_selector("[data-property=glyphs]")
    here.choose("glyphs", "peaks")
    here.tab("slices")
    here.page.click("[data-layout-button=axial]")
    here.rests()
    return here


@state
def phone(studio: Studio) -> Visit:
    """Slices on a phone, with a region that is painted."""
    here = _with_t1(studio, width=390, height=760, has_touch=True, is_mobile=True)
    here.page.evaluate("window.trame.state.update({right_open: true, tab: 'slices'})")
    here.page.tap("[data-action=add-painted]")
    here.page.wait_for_selector("#pv-paint[data-tool=brush]")
    here.page.evaluate("window.trame.state.update({right_open: false})")
    here.page.wait_for_timeout(500)
    here.rests()
    here.trace([_in_pane(here, "axial", *at) for at in ((0.36, 0.4), (0.4, 0.5))])
    here.wait(lambda: here.state("painting")["regions"][0]["voxels"] != "0", "what is painted")
    here.rests()
    return here


@state
def bundles(studio: Studio) -> Visit:
    """Bundles of a tractogram, and their colours."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    here.tab("bundles")
    here.page.click("[data-action=colour-by-bundle]")
    here.wait(lambda: here.state("bundles")["coloured"], "colours of bundles")
    return here


@state
def measures(studio: Studio) -> Visit:
    """Values along bundles, and a row for each."""
    here = bundles(studio)
    here.page.click("[data-action=measure-bundles]")
    here.page.click("[data-action=profile-bundles]")
    here.wait(lambda: here.state("measures")["profile"].get("rows"), "a profile")
    here.page.click("[data-action=table-bundles]")
    here.wait(lambda: here.state("measures")["table"].get("rows"), "a table")
    here.page.locator("#bundle-table").scroll_into_view_if_needed()
    return here


@state
def matrix(studio: Studio) -> Visit:
    """A matrix, and the streamlines of one of its cells."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    here.press("[")
    here.page.click("[data-action=matrix]")
    here.page.click("[data-select=matrix-labels] .v-field")
    here.page.click(".v-overlay--active .v-list-item:has-text('atlas.nii.gz')")
    here.wait(lambda: here.state("matrix")["form"]["chosen"]["names"], "its names")
    here.page.click("[data-action=make-matrix]")
    here.page.wait_for_selector("#pv-cells")
    cells = here.page.locator("#pv-cells")
    box, n = cells.bounding_box(), int(cells.get_attribute("data-n"))
    row, column = 7, 8
    here.page.mouse.click(box["x"] + (column + 0.5) / n * box["width"], box["y"] + (row + 0.5) / n * box["height"])
    here.wait(lambda: here.state("matrix")["cell"], "its streamlines")
    return here


@state
def info(studio: Studio) -> Visit:
    """What is known of a layer."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    here.rests()
    here.tab("info")
    return here


@state
def volume(studio: Studio) -> Visit:
    """A head around the tracts."""
    here = studio.visit("brain.fiblets", "--volume", str(studio.root / "t1.nii.gz"))
    here.wait(lambda: here.layers() == 2, "the volume")
    here.press("4")
    here.page.click("[data-layer] >> text=t1.nii.gz")
    here.page.wait_for_selector("[data-property=mode]")
    here.page.fill("[data-property=surface_opacity] input.pv-num", "1")
    here.press("Tab")
    colour = here.page.locator("[data-property=color] input[type=color]")
    colour.fill("#d8c0b0")
    colour.dispatch_event("change")
    here.page.click("[data-cut=plane]")
    here.wait(lambda: len(here.state("clips")) == 1, "the plane")
    here.page.click("[data-select=clip-layers] .v-field")
    for name, count in (("t1.nii.gz", 2), ("brain.fiblets", 1)):  # the head in place of the tracts
        here.page.click(f".v-overlay--active .v-list-item:has-text('{name}')")
        here.wait(lambda count=count: here.state("clips")[0]["layers"] != ["*"] and
                  len(here.state("clips")[0]["layers"]) == count, "other layers to cut")  # fmt: skip
    here.press("Escape")
    here.page.click("[data-clip] [data-action=side]")
    here.wait(lambda: not here.state("clips")[0]["inside"], "the other side")
    return here


@state
def light(studio: Studio) -> Visit:
    """Light panels, and a white background."""
    here = studio.visit("brain.fiblets")
    here.press("4")
    here.press("t")
    background = here.page.locator("input[type=color][aria-label=Background]")
    background.fill("#ffffff")
    background.dispatch_event("change")
    here.wait(lambda: here.state("background") == "#ffffff", "a white background")
    background.blur()
    return here


@state
def tablet(studio: Studio) -> Visit:
    """A narrow screen: the picture first."""
    here = studio.visit("brain.fiblets", width=820, height=1180, has_touch=True, is_mobile=True)
    here.press("1")
    return here


@state
def tablet_panel(studio: Studio) -> Visit:
    """A panel over the picture."""
    here = tablet(studio)
    here.rests()
    here.press("[")
    return here


@state
def help_(studio: Studio) -> Visit:
    """Keys and what the pointer does."""
    here = studio.visit("brain.fiblets")
    here.press("?")
    return here


@state
def files(studio: Studio) -> Visit:
    """The file browser."""
    here = studio.visit("brain.fiblets")
    here.press("o")
    return here


@state
def session(studio: Studio) -> Visit:
    """Sessions as files."""
    here = studio.visit("brain.fiblets")
    here.press("s")
    return here


@state
def script(studio: Studio) -> Visit:
    """The same picture in Python."""
    here = studio.visit("brain.fiblets")
    here.press("2")
    here.page.click("[data-cut=plane]")
    here.wait(lambda: len(here.state("clips")) == 1, "the plane")
    here.page.click("[data-action=script]")
    return here


@state
def conversion(studio: Studio) -> Visit:
    """A file that is being compressed."""
    here = studio.visit("brain.fiblets")
    here.press("o")
    here.page.click("[data-entry='brain.trk']")
    here.wait(lambda: "compress" in here.state("job").get("text", ""), "a file that is being compressed")
    return here


@state
def refused(studio: Studio) -> Visit:
    """A file that could not be opened."""
    (studio.root / "broken.trk").write_bytes(b"TRACK" + bytes(2000))
    here = studio.visit("brain.fiblets")
    here.press("o")
    here.page.click("[data-entry='broken.trk']")
    here.wait(lambda: here.state("toast_open"), "why it was not opened")
    (studio.root / "broken.trk").unlink()
    return here


@state
def empty(studio: Studio) -> Visit:
    """Nothing is open."""
    here = studio.visit("--upload", "100", opened=False)
    here.page.goto(here.served.url)
    here.page.wait_for_selector("text=Nothing is open yet")
    return here


@state
def full(studio: Studio) -> Visit:
    """The page beyond the limit of sessions."""
    studio.visit("brain.fiblets", "--limit", "1")
    here = studio.visit("brain.fiblets", "--limit", "1", opened=False)
    here.page.goto(here.served.url)
    here.page.wait_for_selector("text=All sessions are taken")
    return here


@state
def token(studio: Studio) -> Visit:
    """The page that asks for the token."""
    here = studio.visit("brain.fiblets", "--token", "auto", opened=False)
    here.page.goto(here.served.base)
    return here


# Pictures


def save(here: Visit, path: Path) -> None:
    """Write what the page shows, as JPEG of a bounded size, or whole where the path ends in .png."""
    from PIL import Image

    if here.page.locator("#pv-view").count() and not path.stem.endswith("conversion"):
        here.wait(lambda: not here.page.locator("#busy").count(), "the end of work in the background")
        here.rests()
    here.page.mouse.move(640, 719)
    here.page.wait_for_timeout(400)  # what opens and closes has come to rest
    shot = here.page.screenshot()
    if path.suffix == ".png":
        path.write_bytes(shot)
        return
    picture = Image.open(io.BytesIO(shot)).convert("RGB")
    for quality in range(88, 30, -4):
        file = io.BytesIO()
        picture.save(file, "jpeg", quality=quality, optimize=True, progressive=True)
        if file.tell() <= LARGEST:
            break
    path.write_bytes(file.getvalue())


def main() -> int:
    """Make the named pictures."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("states", nargs="*", metavar="STATE", help=f"of {', '.join(STATES)}; by default all")
    parser.add_argument("--output", type=Path, default=HERE / "pictures", help="folder")
    parser.add_argument("--png", action="store_true", help="lossless pictures, to look at closely")
    asked = parser.parse_args()
    if unknown := set(asked.states) - set(STATES):
        parser.error(f"there is no state {', '.join(sorted(unknown))}; there are {', '.join(STATES)}")
    from playwright import sync_api

    asked.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, sync_api.sync_playwright() as driver:
        root = Path(folder) / "data"
        make_root(root)
        browser = driver.chromium.launch(executable_path=chromium(), args=list(FLAGS))
        studio = Studio(browser, root)
        try:
            for name in asked.states or STATES:
                path = asked.output / f"serving_{name}.{'png' if asked.png else 'jpg'}"
                save(STATES[name](studio), path)
                studio.leave()
                print(f"{path}  {path.stat().st_size / 1000:.0f} kB", flush=True)
        finally:
            studio.stop()
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
