"""One file as one task: what a worker does.

A task works in a folder of its own below the batch's scratch folder, which lies beside the results on the same disk.
What it made is renamed into its place when all of it is there. A worker that is killed leaves nothing but that folder,
which the batch removes, and the task runs again elsewhere.

Tasks of one process take turns: numba's threads serve one caller at a time, and the memory that is promised is that of
one task.
"""

from __future__ import annotations

import logging
import shutil
import threading
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pvfiblets.errors import EXPECTED, sentence
from pvfiblets.support import memory
from pvfiblets.support.nifti_space import Matrix, Units, nifti_space
from pvfiblets.support.surface_space import as_stored
from pvfiblets.support.vtk_space import Space, unnamed_as

from .operations import OPERATIONS
from .record import Entry, Output, checksum, fingerprint
from .tables import write_part

logger = logging.getLogger(__name__)
_TURN = threading.Lock()


@dataclass(frozen=True)
class Job:
    """An operation on one file."""

    operation: str
    source: str  # absolute path
    name: str  # the source below the folder that all have in common
    target: str  # the result, below `folder`; empty where there is no file
    rows: str
    folder: str  # where results go, and where they are made
    scratch: str
    options: dict[str, Any]  # of the operation
    said: dict[str, str] = field(default_factory=dict)  # what the source's name says
    asked: str = ""  # hash of the request
    memory: int | None = None  # bytes that the process may have meanwhile
    images: tuple[Matrix | None, Units] = (None, "mm")  # what places images of NIfTI, as of `pvfiblets.nifti_space`
    space: Space | None = None  # of files of VTK that name none
    tkras: bool = False  # whether FreeSurfer's surfaces stay where their files have them


def run(job: Job) -> Entry:
    """Do it; whatever goes wrong becomes a sentence of the entry."""
    begin = time.perf_counter()
    error = ""
    outputs: tuple[Output, ...] = ()
    facts = (0, 0, "")
    with _TURN:
        try:
            images = nifti_space(job.images[0], units=job.images[1])
            with _bounded(job.memory), images, unnamed_as(job.space), as_stored(job.tkras):
                facts = (*fingerprint(Path(job.source)), checksum(Path(job.source)))
                outputs = _done(job)
        except EXPECTED as problem:
            error = sentence(problem)
            if isinstance(problem, MemoryError) and job.memory is not None:
                error += f" (the worker may have {memory.shown(job.memory)})"
        except Exception as problem:
            logger.exception("%s: %s", job.operation, job.source)
            error = f"unexpected {type(problem).__name__}: {sentence(problem)}"
    return Entry(job.name, job.asked, *facts, outputs, error, time.perf_counter() - begin)


def _done(job: Job) -> tuple[Output, ...]:
    scratch, folder = Path(job.scratch), Path(job.folder)
    if not scratch.is_dir():
        raise FileNotFoundError(
            f"this worker sees no folder {scratch}: workers need the disk that {folder} is on, under the same name"
        )
    own = scratch / uuid.uuid4().hex
    own.mkdir()
    try:
        made = own / Path(job.target or "none").name
        columns = OPERATIONS[job.operation].run(Path(job.source), made if job.target else None, **job.options)
        part = own / "rows.parquet"
        write_part(part, {"file": job.name, **job.said}, columns)
        places = [(made, folder / job.target)] if job.target else []
        places.append((part, folder / job.rows))
        for there, place in places:
            place.parent.mkdir(parents=True, exist_ok=True)
            _put(there, place)
        return tuple(Output.from_file(folder, place) for _, place in places)
    finally:
        shutil.rmtree(own, ignore_errors=True)


def _put(made: Path, place: Path) -> None:
    """Rename into place; a folder takes the place of another one."""
    if place.is_dir() and not place.is_symlink():
        shutil.rmtree(place)
    made.replace(place)


@contextmanager
def _bounded(size: int | None) -> Iterator[None]:
    """Let this process have no more than some bytes meanwhile, where the system can hold it to that."""
    if size is None or not memory.CAN_LIMIT:
        yield
        return
    import pyarrow  # noqa: F401, ICN001 - which reserves a gigabyte that it does not use: before that is looked at

    # The system counts reserved, unused memory too.
    with memory.limited(max(memory.taken() - memory.resident(), 0) + size):
        yield
