"""Labels of an image as a list: asking for the streamlines of one, and for what connects two."""

import asyncio
from types import SimpleNamespace

import nibabel
import numpy as np
import pytest

from pvfiblets.web.panels.tabs.atlas_tab import AtlasActions
from pvfiblets.web.session import files as session
from pvfiblets.web.session.history import History
from pvfiblets.web.session.script import as_script
from tests.web.desk import Desk
from tests.web.test_slicing import scene  # noqa: F401 - a fixture


@pytest.fixture
def desk(scene, folder):  # noqa: F811
    """Return a page with sixty lines along x and an atlas across it."""
    rows = ("index\tname\tcolor", "3\tputamen\t#ff0000", "5\tinsula\t#00ff00", "7\tcuneus\t#0000ff")
    (folder / "atlas.tsv").write_text("\n".join(rows))
    labels = np.zeros((16, 16, 16), np.int16)
    labels[:4], labels[4:8], labels[10:] = 3, 5, 7
    affine = np.diag([4.0, 4.0, 4.0, 1.0])
    affine[0, 3] = 0.3
    nibabel.save(nibabel.Nifti1Image(labels, affine), folder / "atlas.nii.gz")
    scene.open("lines.fiblets")
    scene.open("atlas.nii.gz", "image")
    desk = Desk(scene, folder)
    desk.slices = SimpleNamespace(changed=lambda: None)
    desk.atlas = AtlasActions(desk)
    return desk


def do(desk, *calls):
    async def run():
        for name, *given in calls:
            getattr(desk.atlas, name)(*given)
            await desk.done()
        desk.atlas.refresh()

    asyncio.run(run())


def shown(desk):
    return np.flatnonzero(desk.scene.actor(desk.scene.layers[0].id).shown).tolist()


def test_labels_are_listed_by_the_names_and_colours_of_their_table(desk):
    do(desk)
    page = desk.page.atlas
    assert [(row["label"], row["name"], row["color"]) for row in page["rows"]] == [
        (3, "putamen", "#ff0000"), (5, "insula", "#00ff00"), (7, "cuneus", "#0000ff"),
    ]  # fmt: skip
    assert page["asked"] == []


def test_one_label_asks_for_its_streamlines_and_two_for_what_connects_them(desk):
    history = History(desk.scene, together=0.0)
    # Lines begin at x = 0 and end at 10 + i mm; labels reach from -1.7 to 14.3, to 30.3, and from 38.3 on.
    do(desk, ("ask", 7))
    assert shown(desk) == list(range(29, 60))
    assert desk.page.atlas["asked"] == [7]
    do(desk, ("set_how", "ends_in"))
    assert shown(desk) == list(range(29, 53))  # the atlas ends at 62.3 mm
    do(desk, ("ask", 5))
    assert shown(desk) == []  # none begins in the insula
    do(desk, ("ask", 3))  # in the place of the first
    assert desk.page.atlas["asked"] == [5, 3]
    assert shown(desk) == list(range(5, 21))  # from 14.3 to 30.3 mm
    kept, text = session.to_dict(desk.scene), as_script(desk.scene)
    assert "regions.ends_in(labels_of(FOLDER / 'atlas.nii.gz', [5]))" in text
    do(desk, ("ask", 3), ("set_how", "passes"))
    assert shown(desk) == list(range(5, 60))
    do(desk, ("clear",))
    assert len(shown(desk)) == 60
    history.undo()
    history.undo()
    history.undo()
    assert shown(desk) == list(range(5, 21))
    session.from_dict(desk.scene, kept)
    do(desk)
    assert desk.page.atlas["asked"] == [5, 3]
    assert shown(desk) == list(range(5, 21))


def test_other_regions_stay_and_a_label_is_found_in_the_image(desk):
    lines = desk.scene.layers[0]
    sphere = {"kind": "sphere", "center": [4.0, 0.0, 0.0], "radius": 1.0, "name": "A"}
    desk.scene.filters.set_regions(lines.id, {"op": "and", "of": [{"how": "passes", "region": sphere}]})
    do(desk, ("ask", 3), ("go", 7))
    assert shown(desk) == [0]
    x, y, z = desk.scene.slicing.view.position
    assert 38.3 < x < 62.3
    assert desk.scene.slicing.workspace.values().images["atlas.nii.gz"] == (7, "cuneus")
    do(desk, ("clear",))
    assert shown(desk) == [0]
    with pytest.raises(ValueError, match="no label 99"):
        do(desk, ("ask", 99))


def test_labels_of_formats_that_nibabel_does_not_read_are_asked_too(scene, folder):  # noqa: F811
    from tests.images.test_image_files import mif

    labels = np.zeros((16, 16, 16), "<i2")
    labels[10:] = 7
    mif(folder / "atlas.mif", labels, "+0,+1,+2", "Int16LE", transform=np.eye(4), vox="4,4,4")
    scene.open("lines.fiblets")
    image = scene.open("atlas.mif", "image")
    scene.set(image.id, "meaning", "labels")
    desk = Desk(scene, folder)
    desk.atlas = AtlasActions(desk)
    do(desk, ("ask", 7))
    assert shown(desk)[-31:] == list(range(29, 60))
    text = as_script(scene).replace('FOLDER = Path(".")', f"FOLDER = Path({str(folder)!r})")
    line = next(one for one in text.splitlines() if ".include(" in one)
    assert "labels_of(FOLDER / 'atlas.mif', [7])" in line
