"""The study of reading: tractogram files of each format, beside nibabel."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from pvfiblets import formats

from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, Turns

STREAMLINES, QUICK_STREAMLINES = 80_000, 500  # of some 188 points
STEP = 0.5  # mm
SUFFIXES = (".tck", ".trk", ".trx")


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every format and reader."""
    from pvfiblets.synthetic import brain_streamlines

    count = QUICK_STREAMLINES if options.quick else STREAMLINES
    whole = brain_streamlines(count, STEP, seed=options.seed)
    with tempfile.TemporaryDirectory() as folder:
        for suffix in SUFFIXES:
            path = Path(folder) / f"brain{suffix}"
            data = f"{suffix}, {whole.n_points / 1e6:.3g} M points"
            if not options.allows(data):
                continue
            formats.write(path, whole)
            yield from _read(path, data, whole.n_points, options)

def _read(path: Path, data: str, points: int, options: Options) -> Iterator[Record]:
    readers: dict[tuple[str, str], Callable[[Path], Any]] = {
        ("pvfiblets", ""): formats.read, ("pvfiblets", "in pieces"): _in_pieces,
    }  # fmt: skip
    if path.suffix != ".trx":
        readers["nibabel", ""] = _by_nibabel
    compared = Comparison(data, options, Turns(), points, "point")
    for (method, setting), read in readers.items():
        try:
            read(path)
        except ImportError as error:
            compared.refuse(method, f"{error.name} is not installed")
            continue
        record = Record(
            data=data,
            group="files",
            approximation="nothing",
            method=method,
            setting=setting,
            errors={},
            costs={"size": Figure(path.stat().st_size / points, "bytes/point")},
            ours=method == "pvfiblets",
            default=(method, setting) == ("pvfiblets", ""),
        )
        compared.add(record, read=partial(read, path))
    yield from compared.finish()


def _in_pieces(path: Path) -> int:
    return sum(piece.n_points for piece in formats.iter_chunks(path))


def _by_nibabel(path: Path) -> Any:
    import nibabel

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it warns of what headers lack
        return nibabel.streamlines.load(path).streamlines


STUDY = Study(
    name="reading",
    title="Reading files",
    approximates="No approximation: points a second of reading files, beside nibabel.",
    axes=(Axes("read", "times/read", "costs/size", "ns per point", "bytes per point of the file"),),
    notes=(
        "A synthetic whole brain in each format; the page cache is warm, and readers take turns. *in pieces*: chunk by "
        "chunk, of which nothing is kept. nibabel reads no .trx. Times are of the processor, all threads.",
    ),
    run=run,
)
