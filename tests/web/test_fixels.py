"""Fixel directories on the page: how they open, what is set, sessions and scripts, and where their files must lie."""

import numpy as np
import pytest

from pvfiblets.web.session import files as session
from tests.slices.test_fixels import AFFINE, write_mif
from tests.web.desk import assert_script_draws, scene_of_views


@pytest.fixture
def scene(tmp_path):
    made = tmp_path / "root" / "fixels"
    made.mkdir(parents=True)
    counts = np.zeros((6, 6, 6, 2), np.uint32)
    counts[1:5, 1:5, 1:5, 0] = 1
    counts[1:5, 1:5, 1:5, 1] = np.arange(64).reshape(4, 4, 4)
    write_mif(made / "index.mif", counts, AFFINE)
    write_mif(made / "directions.mif", np.tile(np.float32([1, 0, 0]), (64, 1))[..., None])
    write_mif(made / "fd.mif", np.linspace(0.5, 1.0, 64, dtype=np.float32)[:, None, None])
    with scene_of_views(tmp_path / "root") as scene:
        yield scene


def red(picture):
    return int(((picture[..., 0] > 200) & (picture[..., 1:].max(axis=-1) < 60)).sum())


def test_a_file_of_fixels_opens_as_lines_and_is_kept(scene, tmp_path):
    layer = scene.open("fixels/fd.mif")
    assert (layer.kind, layer.settings["glyphs"]) == ("image", "fixels")
    scene.images.set_slices(layout="axial", cross_hair=False)
    assert red(scene.cameras.screenshot()) > 50  # along x
    scene.set(layer.id, "glyph_colour", "fd")
    scene.set(layer.id, "cmap", "gray")
    scene.set(layer.id, "clim", [0.0, 1.0])
    scene.set(layer.id, "glyph_length", "fd")
    picture = scene.cameras.screenshot()
    assert red(picture) == 0
    folder = tmp_path / "root"
    assert_script_draws(scene, folder, picture)
    kept = session.to_dict(scene)
    scene.remove(layer.id)
    session.from_dict(scene, kept)
    assert np.abs(scene.cameras.screenshot().astype(int) - picture).max() <= 2
    assert scene.open("fixels/index.mif").settings["glyphs"] == "fixels"


def test_files_beside_must_lie_in_the_open_folder(scene, tmp_path):
    inside, outside = tmp_path / "root" / "fixels", tmp_path / "elsewhere.mif"
    (inside / "directions.mif").rename(outside)
    (inside / "directions.mif").symlink_to(outside)
    with pytest.raises(PermissionError, match="not in the folder"):
        scene.open("fixels/fd.mif")
    (inside / "directions.mif").unlink()
    header = "mrtrix image\ndim: 64,3,1\nlayout: +0,+1,+2\nfile: ../../elsewhere.mif\nEND\n"
    (inside / "directions.mif").write_text(header)
    with pytest.raises(PermissionError, match="not in the folder"):
        scene.open("fixels/fd.mif")
