"""Scenes from the command line: what options show is what the same calls in Python show."""

import subprocess
import sys

import nibabel as nib
import numpy as np
import pytest
import pyvista as pv
from PIL import Image

from pvfiblets import Streamlines, formats, regions
from pvfiblets.cli.command import main
from pvfiblets.cli.pictures import UPRIGHT
from pvfiblets.cli.scene import value_of
from pvfiblets.plotting.cut_surfaces import cut_surface
from pvfiblets.plotting.viewpoints import point_camera
from pvfiblets.synthetic import brain_streamlines

SIZE = (120, 90)
GRAY = {"cmap": "gray", "show_scalar_bar": False}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A folder of a small brain's lines, an image, labels, a mesh and a surface of GIFTI."""
    folder = tmp_path_factory.mktemp("scene")
    brain = brain_streamlines(60, 1.0, seed=2)
    formats.write(folder / "lines.tck", brain)
    low, high = brain.points.min(axis=0), brain.points.max(axis=0)
    at = np.stack(np.meshgrid(*[np.linspace(-1, 1, 16)] * 3, indexing="ij"), axis=-1)
    far = np.linalg.norm(at, axis=-1)
    affine = np.diag([*((high - low) / 15), 1.0])
    affine[:3, 3] = low
    nib.save(nib.Nifti1Image((1.0 - far).astype(np.float32), affine), folder / "image.nii.gz")
    nib.save(nib.Nifti1Image((far < 0.5).astype(np.int16) * 3, affine), folder / "labels.nii.gz")
    ball = pv.Sphere(radius=0.35 * (high - low).min(), center=0.5 * (low + high), theta_resolution=12)
    ball.save(folder / "ball.vtp")
    data = [
        nib.gifti.GiftiDataArray(np.asarray(ball.points, np.float32), "NIFTI_INTENT_POINTSET"),
        nib.gifti.GiftiDataArray(ball.regular_faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE"),
    ]
    nib.save(nib.gifti.GiftiImage(darrays=data), folder / "ball.gii")
    return folder


@pytest.fixture(autouse=True)
def _one_sample(monkeypatch):
    monkeypatch.setenv("PVFIBLETS_ANTIALIAS", "off")


@pytest.fixture
def middle(files):
    return (
        0.5 * np.sum([f(formats.read(files / "lines.tck").points, axis=0) for f in (np.min, np.max)], axis=0)
    ).round(2)


@pytest.fixture
def shot(files, tmp_path):
    """Run the command on some files, and return its picture."""

    def run(names, *words):
        picture = tmp_path / "shot.png"
        paths = [str(files / name) for name in names.split()]
        assert main(["screenshot", *paths, "-o", str(picture), "--size", "120x90", *map(str, words)]) == 0
        return np.asarray(Image.open(picture).convert("RGB")).astype(int)

    return run


def drawn(add, view="oblique"):
    """The same by Python."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("black")
    add(plotter)
    point_camera(plotter, view)
    picture = np.array(plotter.screenshot(return_img=True))[..., :3].astype(int)
    plotter.close()
    return picture


def lines(files):
    return lambda p, **more: p.add_fiblets(files / "lines.tck", render=False, **more)


def comma(numbers):
    return ",".join(map(str, numbers))


def assert_same(found, right, other=None):
    assert np.mean(np.abs(found - right).max(axis=-1) > 2) < 0.002
    if other is not None:
        assert np.mean(np.abs(found - other).max(axis=-1) > 8) > 0.005


@pytest.mark.few(1)
@pytest.mark.parametrize(
    ("words", "arguments"),
    [
        ([], {}),
        (["mode=isosurface", "values=0.4", "color=tomato"], {"mode": "isosurface", "values": 0.4, "color": "tomato"}),
        (["opacity=0,0.1,0.6", "cmap=hot"], {"opacity": [0, 0.1, 0.6], "cmap": "hot"}),
    ],
)
def test_images(shot, files, words, arguments):
    found = shot("image.nii.gz", *(["--volumes", *words] if words else []))
    assert_same(found, drawn(lambda p: p.add_raycast_volume(files / "image.nii.gz", **{**GRAY, **arguments})))
    assert found.max() > 100


@pytest.mark.parametrize("name", ["ball.vtp", "ball.gii"])
def test_meshes(shot, files, name):
    found = shot(name, "--meshes", "opacity=0.5", "color=red")
    assert_same(found, drawn(lambda p: p.add_mesh(pv.read(files / "ball.vtp"), opacity=0.5, color="red")))


def test_lines_take_their_arguments(shot, files):
    found = shot("lines.tck", "--lines", "line_width=4", "lighting=false", "--color", "white")
    assert_same(found, drawn(lambda p: lines(files)(p, line_width=4, lighting=False, color="white")), shot("lines.tck"))


def test_all_of_them_cut(shot, files, middle):
    words = ["plane", "normal=0,1,0", f"origin={comma(middle)}"]
    region = regions.Plane((0, 1, 0), middle)

    def add(plotter, region=region, of=("lines", "volumes", "meshes")):
        tracts = lines(files)(plotter)
        image = plotter.add_raycast_volume(files / "image.nii.gz", mode="isosurface", values=0.2, **GRAY)
        ball = pv.read(files / "ball.vtp")
        plotter.add_mesh(cut_surface(ball, region) if "meshes" in of else ball, color="lightgray")
        for actor, kind in ((tracts, "lines"), (image, "volumes")):
            if kind in of:
                actor.clip(region)

    names, volumes = "lines.tck image.nii.gz ball.vtp", ["--volumes", "mode=isosurface", "values=0.2"]
    whole = shot(names, *volumes)
    assert_same(shot(names, *volumes, "--clip", *words), drawn(add), whole)
    assert_same(shot(names, *volumes, "--clip-away", *words), drawn(lambda p: add(p, ~region)), whole)
    some = shot(names, *volumes, "--clip", *words, "of=volumes,lines")
    assert_same(some, drawn(lambda p: add(p, of=("lines", "volumes"))), whole)


@pytest.mark.few(1)
@pytest.mark.parametrize("kind", ["slab", "box", "sphere", "mesh"])
def test_shapes(shot, files, middle, kind):
    x, y, z = middle
    bounds = [x - 20, x + 20, y - 30, y + 30, z - 10, z + 10]
    words, region = {
        "slab": (["normal=0,0,1", f"origin={comma(middle)}", "thickness=12"], regions.Slab((0, 0, 1), middle, 12)),
        "box": ([f"bounds={comma(bounds)}"], regions.Box(bounds)),
        "sphere": ([f"center={comma(middle)}", "radius=25"], regions.Sphere(middle, 25)),
        "mesh": ([f"path={files / 'ball.vtp'}"], pv.read(files / "ball.vtp")),
    }[kind]
    found = shot("lines.tck", "--clip", kind, *words)
    assert_same(found, drawn(lambda p: lines(files)(p).clip(region)), shot("lines.tck"))


@pytest.mark.more
def test_filters(shot, files, middle):
    whole, ball = shot("lines.tck"), regions.Sphere(middle, 15)
    sphere, labels = ["sphere", f"center={comma(middle)}", "radius=15"], str(files / "labels.nii.gz")
    image = nib.load(labels)
    atlas = regions.Labels(np.asarray(image.dataobj), image.affine, labels=[3])
    for words, change in (
        (["--include", *sphere], lambda actor: actor.include(ball)),
        (["--exclude", *sphere], lambda actor: actor.exclude(ball)),
        (["--include", "labels", f"path={labels}", "labels=3", "--exclude", "ends_in", *sphere],
         lambda actor: (actor.include(atlas), actor.exclude(regions.ends_in(ball)))),
        (["--criterion", "length", "50", "-"], lambda actor: actor.criterion("length", (50, None))),
        (["--subset", "every=3"], lambda actor: actor.subset(every=3)),
        (["--subset", "0.3"], lambda actor: actor.subset(0.3)),
    ):  # fmt: skip
        found = shot("lines.tck", *words)
        assert found.sum() > 0
        # The camera looks at all that is visible.
        assert_same(found, drawn(lambda p, change=change: change(lines(files)(p))), whole)


def test_lines_are_coloured_along_their_bundle(shot, files, tmp_path):
    table = tmp_path / "profile.csv"
    table.write_text("position,mean,p\n0,1,0.5\n0.5,,0.1\n1,3,0.01\n")

    def by(profile, **more):
        bar = {"color": "white", **UPRIGHT}
        return drawn(lambda p: lines(files)(p, scalar_bar_args=bar).color_along(profile, **more))

    whole = shot("lines.tck")
    assert_same(shot("lines.tck", "--color-along", table), by([1.0, np.nan, 3.0]), whole)
    assert_same(shot("lines.tck", "--color-along", table, "column=p"), by(table, column="p"), whole)
    image = files / "image.nii.gz"
    assert_same(shot("lines.tck", "--color-along", image, "n=7"), by(image, n=7), whole)


@pytest.mark.parametrize("name", ["lines.tck", "ball.vtp"])
def test_a_transparent_picture_has_the_colours_of_what_is_drawn(files, tmp_path, monkeypatch, name):
    monkeypatch.setenv("PVFIBLETS_ANTIALIAS", "4")
    picture = tmp_path / "shot.png"
    looks = ["--color", "lime"] if name == "lines.tck" else ["--meshes", "color=lime", "lighting=false", "opacity=0.5"]
    words = [*looks, "--no-lighting", "--transparent", "--size", "120x90", "-o", str(picture)]
    assert main(["screenshot", str(files / name), *words]) == 0
    found = np.asarray(Image.open(picture))
    assert ((found[..., 3] > 0) & (found[..., 3] < 255)).any()
    assert (found[found[..., 3] > 0][:, :3] == [0, 255, 0]).all()


def test_an_array_that_does_not_colour_filters(shot, files):
    x = np.linspace(-18.0, 18.0, 181)
    line = Streamlines.from_list([np.c_[x, 0 * x, 0 * x]])
    line.per_point = {"fa": np.abs(x), "q": x}
    formats.write(files / "q.trx", line)
    words = ["--view", "axial", "--scalars", "fa", "--lines", "show_scalar_bar=false"]
    whole, found = (
        np.nonzero(shot("q.trx", *words, *more).max(axis=(0, 2)))[0] for more in ([], ["--criterion", "q", 5, 10])
    )
    # From x = -18 to 18 mm; of these, 5 to 10.
    expected = np.interp([5.0, 10.0], [-18.0, 18.0], [whole[0], whole[-1]])
    assert np.abs(found[[0, -1]] - expected).max() <= 1.5


def test_a_line_of_two_points_passes_what_lies_between_them(shot, files):
    ends = np.array([[-40.0, 0, 0], [40, 0, 0], [-40, 9, 0], [40, 9, 0]])
    formats.write(files / "two.tck", Streamlines(ends, [0, 2, 4]))
    volume = np.zeros((21, 21, 21), np.int16)
    volume[8:13, 8:13, 8:13] = 3
    affine = np.diag([2.0, 2.0, 2.0, 1.0])
    affine[:3, 3] = -20.0
    nib.save(nib.Nifti1Image(volume, affine), files / "between.nii")
    sphere = ["sphere", "center=0,0,0", "radius=5"]
    found = shot("two.tck", "--include", *sphere)
    assert found.sum() > 0
    assert_same(shot("two.tck", "--include", "labels", f"path={files / 'between.nii'}", "labels=3"), found)
    assert shot("two.tck", "--include", "passes", *sphere, "sampling=points").sum() == 0


def test_numbers_need_no_digit_on_both_sides_of_the_point():
    assert value_of(".5,-.25,3.,+1.5,1e3") == [0.5, -0.25, 3.0, 1.5, 1000.0]
    assert value_of("007,a.5") == ["007", "a.5"]


def test_groups(shot, files, tmp_path):
    brain = brain_streamlines(40, 1.0, seed=2)
    grouped = type(brain)(
        brain.points, brain.offsets, groups={"left": np.arange(0, 40, 2), "right": np.arange(1, 40, 2)}
    )
    formats.write(tmp_path / "groups.trx", grouped)
    picture = tmp_path / "groups.png"
    words = ["screenshot", str(tmp_path / "groups.trx"), "-o", str(picture), "--size", "120x90"]
    assert main([*words, "--groups", "left"]) == 0

    def left(plotter):
        plotter.add_fiblets(tmp_path / "groups.trx").groups_shown = ["left"]

    assert_same(np.asarray(Image.open(picture).convert("RGB")).astype(int), drawn(left))


def test_a_session_is_the_picture_of_the_page(files, tmp_path):
    from pvfiblets.web.scene.scene import Scene
    from pvfiblets.web.session import files as session

    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    scene = Scene(plotter, files)
    tracts = scene.open("lines.tck")
    image = scene.open("image.nii.gz")
    scene.set(image.id, "mode", "isosurface")
    scene.set(image.id, "values", [0.5])
    scene.filters.add_clip("plane", normal=[0, 0, -1], layers=[tracts.id])
    scene.set_background("#203040")
    scene.cameras.view("sagittal")
    right = scene.cameras.screenshot()[..., :3].astype(int)
    session.save(scene, "view.json")
    scene.close()
    plotter.close()
    picture = tmp_path / "session.png"
    assert main(["screenshot", str(files / "view.json"), "-o", str(picture), "--size", "120x90"]) == 0
    assert np.array_equal(np.asarray(Image.open(picture).convert("RGB")), right)
    assert (
        main(["screenshot", str(files / "view.json"), "-o", str(picture), "--size", "120x90", "--view", "axial"]) == 0
    )
    assert not np.array_equal(np.asarray(Image.open(picture).convert("RGB")), right)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["lines.tck", "--clip", "cone", "radius=3"], "the kind of --clip is 'cone'"),
        (["lines.tck", "--clip", "plane", "normal"], "--clip has 'normal'; give NAME=VALUE"),
        (["lines.tck", "--clip", "sphere", "center=0,0,0", "radius=1", "of=tubes"], "of=tubes; choose of lines"),
        (["lines.tck", "--volumes", "mode=mip"], "--volumes applies to volumes, but no FILE has any"),
        (["ball.vtp", "--subset", "0.5"], "--subset applies to streamlines"),
        (["lines.tck", "--criterion", "length", "20"], "two numbers; - means unlimited"),
        (["lines.tck", "--include", "ends_in"], "and no shape"),
        (["lines.tck", "--include", "sphere", "center=0,0,0", "radius=5", "sampling=0.5"], "choose lines or points"),
        (["image.nii.gz", "--volumes", "moed=mip"], "moed"),
        (["view.json", "lines.tck"], "give the session alone"),
        (["view.json", "--cmap", "hot"], "leave --cmap out"),
        (["bad.json"], "program is None"),
        (["labels.nii"], "No such file"),
    ],
)
def test_what_makes_no_sense_is_one_sentence(files, capsys, tmp_path, words, said):
    (files / "view.json").touch()
    (files / "bad.json").write_text("{}")
    names = [str(files / word) if "." in word and "=" not in word and not word[0].isdigit() else word for word in words]
    assert main(["screenshot", *names[:1], *names[1:], "-o", str(tmp_path / "a.png")]) == 1
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert said in error


@pytest.mark.more
def test_plain_pictures_load_no_more_than_before(files, tmp_path):
    code = (
        "import sys; from pvfiblets.cli.command import main; "
        f"main(['screenshot', {str(files / 'lines.tck')!r}, '-o', {str(tmp_path / 'a.png')!r}]); "
        "unused = ('trame', 'nibabel', 'pvfiblets.web.s', 'pvfiblets.engine.volumes'); "
        "print([m for m in sys.modules if m.startswith(unused)])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120)
    assert done.stdout.strip() == "[]"
