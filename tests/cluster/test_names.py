"""What names of files say, by BIDS, and which files patterns mean."""

from pathlib import PurePosixPath

import pytest

from pvfiblets.cluster.bids import entities, filled, study_root
from pvfiblets.cluster.sources import find_sources


@pytest.mark.parametrize(
    ("path", "says"),
    [
        ("sub-01/ses-b/dwi/sub-01_ses-b_acq-hi_desc-sift_tractography.trk.gz",
         {"subject": "01", "session": "b", "acquisition": "hi", "description": "sift", "suffix": "tractography"}),
        ("sub-x1/AF_left.trk", {"subject": "x1"}),
        ("brain.tck", {}),
        ("sub-01_bundle-CST.trx", {"subject": "01", "bundle": "CST"}),
        ("derivatives/sub-007/tracts/sub-007_hemi-L_bundle-AF_streamlines.tt.gz",
         {"subject": "007", "hemisphere": "L", "bundle": "AF", "suffix": "streamlines"}),
        ("subject-01/my_brain.trk", {}),
    ],
)  # fmt: skip
def test_names_say_what_bids_has_them_say(path, says):
    assert entities(PurePosixPath(path)) == says


def test_the_study_is_above_its_subjects():
    assert study_root(PurePosixPath("/data/study/sub-01/dwi/a.trk")) == PurePosixPath("/data/study")
    assert study_root(PurePosixPath("/data/study/a.trk")) is None


def test_names_between_braces():
    assert filled("a/{subject}/{stem}.nii", {"subject": "1", "stem": "b"}, "f") == "a/1/b.nii"
    assert filled("plain.nii", {}, "f") == "plain.nii"
    with pytest.raises(ValueError, match="asks for run, which the name of f.trk does not say; it says subject 1"):
        filled("{run}", {"subject": "1"}, "f.trk")
    with pytest.raises(ValueError, match="no path with names between braces"):
        filled("a{", {}, "f")


def test_results_lie_as_sources_do(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("s/sub-1/dwi/a.trk", "s/sub-2/dwi/a.trk", "plain/x/b.tck", "plain/y/b.tck", "z.fiblets/manifest.json"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()

    def names(*patterns):
        return [source.name for source in find_sources(patterns)]

    assert names("s/sub-*/dwi/*.trk") == ["sub-1/dwi/a.trk", "sub-2/dwi/a.trk"]
    assert names("s/sub-1/dwi/a.trk") == ["sub-1/dwi/a.trk"]  # the same alone
    assert names("plain/*/*.tck") == ["x/b.tck", "y/b.tck"]
    assert names("plain/*/*.tck", "plain/x/b.tck") == ["x/b.tck", "y/b.tck"]
    assert names("plain/x/b.tck", "plain/y/b.tck") == ["x/b.tck", "y/b.tck"]
    assert names("**/*.tck") == ["plain/x/b.tck", "plain/y/b.tck"]
    assert names("z.fiblets") == ["z.fiblets"]
    (tmp_path / "link").mkdir()
    (tmp_path / "link" / "sub-3_tracts.trk").symlink_to(tmp_path / "s/sub-1/dwi/a.trk")
    assert names("link/*.trk") == ["sub-3_tracts.trk"]
