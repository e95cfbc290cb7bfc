"""Data of the benchmarks of ray-cast volumes, by name; `pvfiblets.report.studies.volumes.scene` is what is shown."""

from __future__ import annotations

import re
from pathlib import Path

from pvfiblets.volumes import RaycastVolume, as_raycast_volume

MODES = ("composite", "mip", "isosurface")
TEMPLATE = "nv_MNI152_2009_template.nii.gz"
FOLDER = Path(__file__).resolve().parents[2] / "shared" / "data"
"""Where the template of a brain may lie."""


def make_data(name: str, seed: int = 0, folder: Path = FOLDER) -> RaycastVolume:
    """Return a volume by name, of 16 bits: bytes are interpolated to bytes by software OpenGL.

    Parameters
    ----------
    name : str
        ``vessels-N``, a tree of vessels of N^3 voxels; ``brain``, the template in the folder if it is there, else made
        up; ``brain-N``, synthetic.
    seed : int
    folder : Path
    """
    from pvfiblets.synthetic.vessels import brain_like, vessel_tree

    kind, _, count = known_data(name).partition("-")
    if kind == "vessels":
        return vessel_tree(int(count), seed, "uint16")
    if not count and (folder / TEMPLATE).is_file():
        return as_raycast_volume(folder / TEMPLATE)
    return brain_like(int(count or 192), seed, "uint16")


def known_data(name: str) -> str:
    """Return the name of data if it is one."""
    import argparse

    if not re.fullmatch(r"(vessels-|brain-)(?!0*[01]?$)\d+|brain", name):
        raise argparse.ArgumentTypeError(f"unknown data {name!r}, expected vessels-N, brain-N or brain")
    return name
