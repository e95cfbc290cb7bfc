"""Recognition of bundles by models (RecoBundles); needs dipy.

Source: Garyfallidis et al., "Recognition of white matter bundles using local and global streamline-based registration
and clustering", NeuroImage 170 (2018) 283-295. dipy computes it; this module reads the models and decodes the
streamlines.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...codec.progress import Progress
from ...support.progress_bar import progress_bar
from .resampled import check_count, check_distance

if TYPE_CHECKING:
    from ...codec.fibletset import FibletSet
    from ...streamlines import Streamlines

Ints = npt.NDArray[np.int64]
LEAST = 5  # streamlines of a model, below which nothing can be aligned to it


def recognise(
    data: FibletSet | Streamlines,
    models: str | os.PathLike[str] | dict[str, Any],
    *,
    model_threshold: float = 5.0,
    reduction_threshold: float = 15.0,
    pruning_threshold: float = 10.0,
    align: bool = True,
    refine: bool = True,
    cluster_threshold: float = 15.0,
    n_points: int = 20,
    seed: int = 0,
    progress: Progress = False,
) -> dict[str, Ints]:
    """Find the streamlines of known bundles in a whole brain (RecoBundles).

    Parameters
    ----------
    data : FibletSet or Streamlines
        A whole brain, roughly aligned with the models: by ``dipy_slr`` or a registration of the brains.
    models : path or dict
        A folder of tractograms, one for each bundle and named after it; or streamlines by name.
    model_threshold : float, default: 5.0
        Clustering threshold of the model, mm.
    reduction_threshold : float, default: 15.0
        mm: clusters of the brain farther than this from the model's clusters are skipped.
    pruning_threshold : float, default: 10.0
        mm: streamlines farther than this from the aligned model are omitted.
    align : bool, default: True
        Align the searched streamlines with the model first.
    refine : bool, default: True
        Search a second time, starting from the first result.
    cluster_threshold : float, default: 15.0
        Clustering threshold of the whole brain, mm.
    n_points : int, default: 20
        Number of points to which streamlines are resampled.
    seed : int, default: 0
        Seed of the random numbers.
    progress : bool or callable
        Show a progress bar; or call this with the current step and its share of the work, from 0 to 1, before each
        model. An exception raised in it ends the work.

    Returns
    -------
    dict of str to numpy.ndarray
        ``(k,)`` int64 streamlines of each bundle, rising; empty if none was found. Add them as groups with
        ``fiblets.bundles.add_all(found)``.

    Raises
    ------
    ImportError
        If dipy is not installed.
    FileNotFoundError, NotADirectoryError
        If the folder does not exist, or is a file.
    ValueError
        If the folder holds no tractogram, a model has fewer than 5 streamlines, or a number is out of range.

    Notes
    -----
    All points are decoded: memory for 12 bytes a point, and for dipy's copy of the same size.
    """
    try:
        from dipy.segment.bundles import RecoBundles
    except ImportError as error:
        raise ImportError(
            "recognise() needs dipy, which is not installed; run `pip install dipy`, or use clusters() and similar()"
        ) from error
    from nibabel.streamlines import ArraySequence

    for name, value in (
        ("model_threshold", model_threshold), ("reduction_threshold", reduction_threshold),
        ("pruning_threshold", pruning_threshold), ("cluster_threshold", cluster_threshold),
    ):  # fmt: skip
        check_distance(value, name)
    check_count(n_points)
    known = _models(models)
    if callable(progress):
        progress("clustering the whole brain", 0.0)
    lines: Any = data if not hasattr(data, "decompress") else data.decompress(dtype=np.float32)
    there = np.flatnonzero(lines.counts > 1)  # a point alone has no course
    if not len(there):
        return {name: np.empty(0, np.int64) for name in known}
    brain = ArraySequence(np.asarray(line, np.float32) for line in lines[there])
    finder = RecoBundles(
        brain, greater_than=-1, less_than=np.inf, clust_thr=cluster_threshold, nb_pts=n_points,
        rng=np.random.default_rng(seed), verbose=False,
    )  # fmt: skip
    found = {}
    with progress_bar(progress is True, total=len(known), desc="recognising", unit="bundles") as bar:
        for done, (name, model) in enumerate(known.items()):
            if callable(progress):  # clusters of the whole brain were the first step
                progress(f"recognising {name}", (done + 1) / (len(known) + 1))
            options: dict[str, Any] = {
                "model_clust_thr": model_threshold, "reduction_thr": reduction_threshold,
                "pruning_thr": pruning_threshold, "slr": align, "num_threads": None,
            }  # fmt: skip
            some, labels = finder.recognize(model, **options)
            if refine and len(some) > LEAST:
                del options["num_threads"]
                _, labels = finder.refine(model, some, **options)
            found[name] = np.sort(there[np.asarray(labels, np.int64)])
            bar.update(1)
    return found


def _models(given: Any) -> dict[str, Any]:
    from nibabel.streamlines import ArraySequence

    from ... import formats

    if isinstance(given, (str, os.PathLike)):
        folder = Path(given).expanduser()
        if not folder.exists():
            raise FileNotFoundError(f"there is no folder {folder}")
        if not folder.is_dir():
            raise NotADirectoryError(f"{folder} is a file; give the folder that holds a tractogram for each bundle")
        suffixes = sorted(formats.registry.suffixes(), key=len, reverse=True)
        given = {}
        for path in sorted(folder.iterdir()):
            suffix = next((s for s in suffixes if path.name.lower().endswith(s)), None)
            if suffix is not None and path.is_file():
                given[path.name[: -len(suffix)]] = formats.read(path)
        if not given:
            raise ValueError(f"{folder} holds no tractogram; give a folder with a file for each bundle")
    models = {}
    for name, lines in given.items():
        if hasattr(lines, "decompress"):
            lines = lines.decompress()
        rows = [np.asarray(line, np.float32) for line in lines]
        models[name] = ArraySequence(row for row in rows if len(row) > 1)
        if len(models[name]) < LEAST:
            raise ValueError(f"the model {name!r} has {len(models[name])} streamlines; at least {LEAST} are needed")
    return models
