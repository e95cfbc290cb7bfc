"""What the page about cohorts says, run as it stands there but on workers that are there already."""

import gc
import re
import shlex
from pathlib import Path

import nibabel as nib
import numpy as np
import pyarrow.parquet
import pytest

import pvfiblets as pf
from pvfiblets.cli.command import main
from pvfiblets.synthetic import brain_streamlines
from tests.cluster.conftest import AFFINE

pytestmark = pytest.mark.more

PAGE = Path(__file__).resolve().parents[2] / "docs" / "clusters.md"


def test_the_page_runs(client, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for folder in ("atlas", "fa"):
        Path(folder).mkdir()
    for n, name in enumerate(("01", "02")):
        Path(f"study/sub-{name}/dwi").mkdir(parents=True)
        pf.write(f"study/sub-{name}/dwi/sub-{name}_tracts.trk", brain_streamlines(60, 2.0, seed=n, fa=True))
        nib.save(nib.Nifti1Image(np.arange(8000, dtype=np.int16).reshape(20, 20, 20) % 5, AFFINE),
                 f"atlas/sub-{name}.nii.gz")  # fmt: skip
        nib.save(nib.Nifti1Image(np.ones((20, 20, 20), np.float32), AFFINE), f"fa/sub-{name}.nii.gz")
    blocks = re.findall(r"^```(sh|python)\n(.*?)^```", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    assert [language for language, _ in blocks] == ["sh", "python"]
    commands = [shlex.split(line) for line in blocks[0][1].splitlines()]
    assert len(commands) == 7
    for command in commands:
        extra = ["--no-exact", "--per-point", "fa"] if command[2] == "convert" else []
        assert main([*command[1:], *extra, "--cluster", client.scheduler.address]) == 0, command
        gc.collect()  # a closed client that is collected while another starts waits for that one's lock, and hangs
        table = pyarrow.parquet.read_table(Path(command[command.index("-o") + 1]) / f"{command[2]}.parquet")
        assert set(table["subject"].to_pylist()) == {"01", "02"}
    capsys.readouterr()
    text = blocks[1][1].replace("values=", "cluster=client, values=")
    exec(text, {"__name__": "__main__", "client": client})  # the page's own words
    assert capsys.readouterr().out.endswith("2 {}\n")
    assert Path("along.png").stat().st_size > 10_000
