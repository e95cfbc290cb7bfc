"""``pvfiblets profile`` and ``pvfiblets table --by bundle``, against NumPy and dipy."""

import csv
import io

import nibabel
import numpy as np
import pytest

import pvfiblets
from pvfiblets import Streamlines, formats
from pvfiblets.cli.command import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two groups of twenty curves each with ``fa``, in a file with groups, one without, and an image."""
    home = tmp_path_factory.mktemp("bundles")
    rng = np.random.default_rng(4)
    t = np.linspace(0.0, 1.0, 41)[:, None]
    lines = []
    for k in range(40):
        course = np.hstack([60 * t, (20 if k < 20 else 40) * np.sin(3 * t), 10 * t]) + rng.normal(0.0, 1.5, 3)
        lines.append(course if k % 3 else course[::-1])
    fa = np.concatenate([(line[:, 0] / 80.0 + 0.1) for line in lines])
    whole = Streamlines.from_list(
        lines, per_point={"fa": fa}, per_streamline={"age": np.arange(40.0)},
        groups={"low": np.arange(20), "high, wide": np.arange(20, 40)},
    )  # fmt: skip
    pvfiblets.write(home / "brain.trx", whole)
    pvfiblets.write(home / "arc.trk", whole[:20])
    pvfiblets.compress(whole, per_point=["fa"], per_point_bits=16, exact=True).save(home / "brain.fiblets")
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in (30, 40, 16)), indexing="ij"), axis=-1) * 3.0 - 10.0
    affine = np.diag([3.0, 3.0, 3.0, 1.0])
    affine[:3, 3] = -10.0
    nibabel.save(nibabel.Nifti1Image((grid @ [1.0, -2.0, 0.5]).astype("f8"), affine), home / "plane.nii.gz")
    return home


def rows(text, between=","):
    return list(csv.DictReader(io.StringIO(text), delimiter=between))


def along(path, name, n):
    """Values along each streamline of a group at places of equal arc length, turned as the first, by NumPy."""
    data = pvfiblets.read(path)
    places, values = [], []
    for k in data.groups[name]:
        line = np.asarray(data[int(k)], np.float64)
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        at = np.linspace(0.0, arc[-1], n)
        fa = data.per_point["fa"][data.offsets[k] : data.offsets[k + 1]].ravel()
        place = np.stack([np.interp(at, arc, line[:, i]) for i in range(3)], axis=1)
        value = np.interp(at, arc, fa)
        if (
            places
            and np.linalg.norm(place[::-1] - places[0], axis=1).mean()
            < np.linalg.norm(place - places[0], axis=1).mean()
        ):
            place, value = place[::-1], value[::-1]
        places.append(place)
        values.append(value)
    return np.array(places), np.array(values)


@pytest.mark.parametrize("file", ["brain.trx", "brain.fiblets"])
def test_profiles_are_means_along_groups(folder, capsys, file):
    asked = ["profile", str(folder / file), "--values", "fa", "--positions", "21", "--weights", "equal"]
    assert main(asked) == 0
    found = rows(capsys.readouterr().out)
    assert [row["bundle"] for row in found] == ["low"] * 21 + ["high, wide"] * 21
    for name in ("low", "high, wide"):
        mine = [row for row in found if row["bundle"] == name]
        places, values = along(folder / "brain.trx", name, 21)
        assert np.allclose([float(row["position"]) for row in mine], np.linspace(0, 1, 21))
        assert np.allclose([float(row["mean"]) for row in mine], values.mean(axis=0), atol=1e-4)
        assert np.allclose([float(row["std"]) for row in mine], values.std(axis=0, ddof=1), atol=1e-4)
        core = np.array([[float(row[axis]) for axis in "xyz"] for row in mine])
        assert np.allclose(core, places.mean(axis=0), atol=1e-3)


def test_weights_of_the_core_and_images(folder, tmp_path):
    image, target = str(folder / "plane.nii.gz"), tmp_path / "p.tsv"
    asked = ["profile", str(folder / "brain.trx"), "--values", image, "--positions", "15", "--group", "low", "--quiet"]
    assert main([*asked, "-o", str(target), "-o", str(tmp_path / "p.png"), "-o", str(tmp_path / "p.parquet")]) == 0
    found = rows(target.read_text(), "\t")
    assert {row["bundle"] for row in found} == {"low"}
    assert {row["value"] for row in found} == {"plane.nii.gz"}
    places, _ = along(folder / "brain.trx", "low", 15)
    for k in range(15):  # of a linear image the values are those of its formula
        values = places[:, k] @ [1.0, -2.0, 0.5]
        apart = places[:, k] - places[:, k].mean(axis=0)
        inverse = np.linalg.pinv(apart.T @ apart / len(apart), rcond=1e-9)
        weight = 1.0 / np.sqrt(np.einsum("ni,ij,nj->n", apart, inverse, apart))
        assert float(found[k]["mean"]) == pytest.approx(np.average(values, weights=weight), abs=1e-3)
    assert (tmp_path / "p.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / "p.parquet").read_bytes()[:4] == b"PAR1"


def test_dipys_profile_is_the_same_where_all_count_alike(folder, capsys):
    stats = pytest.importorskip("dipy.stats.analysis")
    from dipy.tracking.streamline import orient_by_streamline

    data = pvfiblets.read(folder / "arc.trk")
    lines = [np.asarray(line, np.float64) for line in data]
    turned = orient_by_streamline(lines, lines[0])
    loaded = nibabel.load(folder / "plane.nii.gz")
    wanted = stats.afq_profile(loaded.get_fdata(), turned, affine=loaded.affine, n_points=30)
    image = str(folder / "plane.nii.gz")
    assert main(["profile", str(folder / "arc.trk"), "--values", image, "--positions", "30", "--weights", "equal"]) == 0
    found = rows(capsys.readouterr().out)
    assert {row["bundle"] for row in found} == {"arc"}
    assert np.allclose([float(row["mean"]) for row in found], wanted, atol=0.05)


def test_files_are_bundles_and_told_apart(folder, capsys):
    files = [str(folder / "brain.trx"), str(folder / "arc.trk")]
    assert main(["profile", *files, "--values", "curvature", "--positions", "3"]) == 0
    found = rows(capsys.readouterr().out)
    assert list(dict.fromkeys(row["bundle"] for row in found)) == ["brain: low", "brain: high, wide", "arc"]


def test_a_row_for_each_bundle(folder, tmp_path, capsys):
    target = tmp_path / "bundles.csv"
    image = f"plane={folder / 'plane.nii.gz'}"
    words = ["--by", "bundle", "--image", image, "--weights", "points"]
    assert main(["table", str(folder / "brain.trx"), str(target), *words]) == 0
    found = rows(target.read_text())
    data = pvfiblets.read(folder / "brain.trx")
    for row, (name, ids) in zip(found, data.groups.items(), strict=True):
        lines = [np.asarray(data[int(k)], np.float64) for k in ids]
        lengths = np.array([np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines])
        assert row["bundle"] == name
        assert int(row["count"]) == 20
        assert float(row["length_mean"]) == pytest.approx(lengths.mean(), rel=1e-5)
        assert float(row["length_std"]) == pytest.approx(lengths.std(), rel=1e-3)
        points = np.concatenate(lines)
        assert float(row["mean_plane"]) == pytest.approx((points @ [1.0, -2.0, 0.5]).mean(), abs=1e-3)
        assert float(row["mean_age"]) == pytest.approx(np.asarray(ids).mean())
    assert main(["table", str(folder / "arc.trk"), "--by", "bundle"]) == 0
    (row,) = rows(capsys.readouterr().out)
    assert (row["bundle"], row["count"]) == ("arc", "20")
    assert main(["table", str(folder / "brain.trx"), "--by", "bundle", "--group", "low"]) == 0
    assert [row["bundle"] for row in rows(capsys.readouterr().out)] == ["low"]


PLANE = np.array([1.0, -2.0, 0.5])  # the image is this slope, which is linear between voxels, too


@pytest.mark.parametrize("file", ["brain.trx", "brain.fiblets"])
def test_a_row_for_each_streamline_has_means_of_images(folder, capsys, file):
    assert main(["table", str(folder / file), "--image", str(folder / "plane.nii.gz"), "--group", "low"]) == 0
    found = rows(capsys.readouterr().out)
    for row, line in zip(found, pvfiblets.read(folder / file)[:20], strict=True):
        steps = np.linalg.norm(np.diff(line.astype(float), axis=0), axis=1)
        wanted = np.average(line @ PLANE, weights=np.convolve(steps, [0.5, 0.5]))
        assert float(row["mean_plane"]) == pytest.approx(wanted, abs=1e-3)


@pytest.mark.parametrize("file", ["brain.trx", "brain.fiblets"])
@pytest.mark.parametrize("target", ["a.tsf", "a.npy", "a.csv", "a.txt", "a.trx", "a.fiblets"])
def test_values_of_an_image_are_written_in_every_form(folder, tmp_path, file, target):
    lines, path = pvfiblets.read(folder / file), tmp_path / target
    assert main(["sample", str(folder / file), str(folder / "plane.nii.gz"), str(path)]) == 0
    tractogram = path.suffix in (".trx", ".fiblets")
    found = pvfiblets.read(path) if tractogram else lines[:]
    if not tractogram:
        assert formats.attach(found, path, "plane") == "per_point"
    assert np.ravel(found.per_point["plane"]) == pytest.approx(found.points @ PLANE, abs=0.5 if tractogram else 1e-3)
    assert set(lines.per_point) <= set(found.per_point)
    if path.suffix == ".tsf":
        return
    assert main(["sample", str(folder / file), str(folder / "plane.nii.gz"), str(path), "--statistic", "max"]) == 0
    found = pvfiblets.read(path) if tractogram else lines[:]
    if not tractogram:
        assert formats.attach(found, path, "plane") == "per_streamline"
    wanted = [(line @ PLANE).max() for line in found]
    assert np.ravel(found.per_streamline["plane"]) == pytest.approx(wanted, abs=0.5 if tractogram else 1e-3)


@pytest.mark.filterwarnings("always")
def test_points_without_a_value_are_0_in_a_tsf_and_told_of(folder, tmp_path, capsys):
    small = nibabel.Nifti1Image(np.ones((2, 3, 4), np.float32), np.diag([3.0, 3.0, 3.0, 1.0]))
    nibabel.save(small, tmp_path / "b0.nii")
    lines = pvfiblets.read(folder / "arc.trk")
    values = pvfiblets.sample(lines, tmp_path / "b0.nii")
    assert main(["sample", str(folder / "arc.trk"), str(tmp_path / "b0.nii"), str(tmp_path / "a.tsf")]) == 0
    assert f"{np.isnan(values).sum()} of {len(values)} points have no value in" in capsys.readouterr().err
    formats.attach(lines, tmp_path / "a.tsf")
    np.testing.assert_allclose(lines.per_point["a"], np.nan_to_num(values), rtol=1e-6)


def test_samples_go_through_pipes(folder, capfdbinary, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO((folder / "arc.trk").read_bytes())))
    assert main(["sample", "-", str(folder / "plane.nii.gz"), "-", "--statistic", "min"]) == 0
    found = np.loadtxt(io.BytesIO(capfdbinary.readouterr().out))
    assert found == pytest.approx([(line @ PLANE).min() for line in pvfiblets.read(folder / "arc.trk")], abs=1e-3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["profile", "brain.trx", "--values", "md"], "md"),
        (["profile", "brain.trx", "--values", "length"], "length"),
        (["profile", "brain.trx", "--values", "fa", "--group", "none"], "no group 'none'; it has: low, high, wide"),
        (["profile", "brain.trx", "--values", "fa", "-o", "out.xls"], "out.xls: give a table"),
        (["profile", "brain.trx", "--values", "fa", "-o", "nowhere/out.csv"], "no such folder"),
        (["profile", "brain.trx", "--values", "fa", "--confidence", "1.5"], "1.5"),
        (["profile", "brain.trx", "--values", "fa", "--positions", "1"], "2 or more"),
        (["table", "brain.trx", "--image", "brain.trx"], "brain.trx is no image; give a file that ends in .nii"),
        (["sample", "brain.trx", "none.nii", "a.txt"], "none.nii"),
        (["sample", "brain.trx", "arc.trk", "a.txt"], "arc.trk is no image; give a file that ends in .nii"),
        (["sample", "brain.trx", "plane.nii.gz", "a.tsf", "--statistic", "mean"], "a.tsf: a .tsf file has a value per"),
        (["sample", "brain.trx", "plane.nii.gz", "a.png"], "a.png"),
        (["table", "brain.trx", "--group", "low", "--group", "low"], "--group is given 2 times"),
        (["table", "brain.trx", "--by", "bundle", "--image", "a=brain.trx"], "brain.trx is no image"),
        (["table", "brain.trx", "--by", "bundle", "--image", "plane.nii.gz", "--image", "plane=x.nii"], "'plane'"),
        (["table", "brain.trx", "--by", "bundle", "--group", "none"], "no group 'none'"),
    ],
)
def test_mistakes_are_one_sentence(folder, monkeypatch, capsys, arguments, message):
    monkeypatch.chdir(folder)
    assert main(arguments) == 1
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""
