"""The commands ``pvfiblets profile`` and ``pvfiblets table``."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.cli.files import show_progress
from pvfiblets.codec.files.open_lines import open_lines
from pvfiblets.formats import registry
from pvfiblets.images.files import SUFFIXES
from pvfiblets.images.sources import is_image
from pvfiblets.query.bundles.tract_profile import TractProfile, Weights, profile_table, tract_profile
from pvfiblets.query.measures.samples import PointWeights
from pvfiblets.query.measures.table import Table, check_parquet
from pvfiblets.support.progress_bar import progress_bar

TABLES = (".csv", ".tsv", ".parquet", ".pq")
PLOTS = (".png", ".svg", ".pdf")


def profile(
    sources: list[str], *, output: list[str], values: list[str], positions: int, group: list[str], weights: Weights,
    confidence: float, quiet: bool,
) -> None:  # fmt: skip
    """Average values along bundles, and write a row for each place, or a plot."""
    targets = output or ["-"]
    for target in targets:
        _check_target(target)
    profiles: list[TractProfile] = []
    bundles = list(_bundles(sources, group))
    with progress_bar(show_progress(quiet, False), total=len(bundles), desc="averaging", unit="bundles") as bar:
        for data, ids, name in bundles:
            for given in values:
                called = Path(given).name if is_image(given) else given
                profiles.append(
                    tract_profile(data, ids, given, positions, weights=weights, confidence=confidence, name=called,
                                  bundle=name)
                )  # fmt: skip
            bar.update(1)
    for target in targets:
        if Path(target).suffix.lower() in PLOTS:
            _plot(profiles, target)
        else:
            profile_table(profiles).save(target)


def table(source: str, target: str, *, by: str, group: list[str], image: list[str], weights: PointWeights) -> None:
    """Write a row for each streamline, or for each bundle."""
    check_parquet(target)  # before minutes of work, not after
    if by == "bundle":
        bundle_rows(source, group, image, weights).save(target)
        return
    images = _named_images(image)
    if len(group) > 1:
        raise ValueError(f"--group is given {len(group)} times; give it once, or add --by bundle")
    data = open_lines(source)
    if unknown := [name for name in group if name not in data.groups]:
        raise ValueError(f"{source} has no group {unknown[0]!r}; it has: {', '.join(data.groups) or 'none'}")
    data.table(data.groups[group[0]] if group else None, images=images, weights=weights).save(target)


def bundle_rows(source: str, groups: Sequence[str], images: Sequence[str], weights: PointWeights) -> Table:
    """Return a row for each group of a file, or one for all of it where it has none."""
    from pvfiblets.query.bundles.statistics import bundle_table

    known = _named_images(images)
    bundles = list(_bundles([source], groups))
    chosen = {name: ids for _, ids, name in bundles}
    return bundle_table(bundles[0][0], chosen, images=known, weights=weights)


def _named_images(images: Sequence[str]) -> dict[str, str]:
    """Return the paths of images by name."""
    known: dict[str, str] = {}
    for given in images:
        name, by, path = given.partition("=")
        if not by or os.sep in name:
            name, path = _stem(given), given
        if name in known:
            raise ValueError(f"two images are called {name!r}; give one another name: --image NAME={path}")
        if not is_image(path):
            raise ValueError(f"{path} is no image; give a file that ends in {', '.join(SUFFIXES)}")
        known[name] = path
    return known


def _bundles(sources: Sequence[str], groups: Sequence[str]) -> Iterator[tuple[Any, Any, str]]:
    """Yield sets, streamlines and names: groups of files, and whole files that have none."""
    for source in sources:
        data = open_lines(source)
        if unknown := [name for name in groups if name not in data.groups]:
            raise ValueError(f"{source} has no group {unknown[0]!r}; it has: {', '.join(data.groups) or 'none'}")
        before = f"{_stem(source)}: " if len(sources) > 1 and data.groups else ""
        for name in groups or data.groups:
            yield data, np.asarray(data.groups[name], np.int64), f"{before}{name}"
        if not data.groups:
            yield data, np.arange(len(data)), _stem(source)


def _stem(path: str) -> str:
    """Return a file's name without its suffix, be that ``.nii.gz``."""
    name = Path(path).name
    suffixes = sorted((*registry.suffixes(), *SUFFIXES), key=len, reverse=True)
    return next((name[: -len(one)] for one in suffixes if name.lower().endswith(one)), name)


def _check_target(target: str) -> None:
    """Raise an error before minutes of work, not after."""
    if target != "-" and Path(target).suffix.lower() not in (*TABLES, *PLOTS):
        raise ValueError(f"{target}: give a table ({', '.join(TABLES)}) or a plot ({', '.join(PLOTS)})")
    check_parquet(target)
    if not Path(target).expanduser().parent.is_dir():
        raise FileNotFoundError(f"{Path(target).parent}: there is no such folder")


def _plot(profiles: Sequence[TractProfile], target: str) -> None:
    from matplotlib.figure import Figure

    from pvfiblets.support.whole_files import replacing

    names = list(dict.fromkeys(one.name for one in profiles))
    figure = Figure(figsize=(7.0, 3.2 * len(names)), layout="constrained")
    axes = figure.subplots(len(names), squeeze=False)[:, 0]
    for ax, name in zip(axes, names, strict=True):
        for one in profiles:
            if one.name == name:
                one.plot(ax)
        ax.legend(fontsize="small")
    path = Path(target).expanduser()
    with replacing(path) as file:
        figure.savefig(file, format=path.suffix[1:].lower(), dpi=150)
