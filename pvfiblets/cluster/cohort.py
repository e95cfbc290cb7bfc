"""One operation on each file of a cohort, by the workers of a cluster."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import socket
import sys
import time
import uuid
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets.errors import sentence
from pvfiblets.support import memory as limits
from pvfiblets.support.nifti_space import chosen
from pvfiblets.support.progress_bar import progress_bar
from pvfiblets.support.surface_space import tkras_chosen
from pvfiblets.support.vtk_space import unnamed
from pvfiblets.support.whole_files import made_folder

from .bids import filled
from .connection import SHARE, connected, default_workers
from .operations import OPERATIONS, Operation
from .record import Entry, Record, fingerprint
from .sources import SourceFile, find_sources
from .tables import join_parts
from .task import Job, run

if TYPE_CHECKING:
    from distributed import Client

LEAST_MEMORY = 512 << 20  # bytes that an idle worker with its libraries has, or nearly
_SCRATCH = re.compile(r"\.batch-(?P<host>.*)-(?P<pid>\d+)-[0-9a-f]{8}")


@dataclass(frozen=True)
class BatchResult:
    """What became of a batch.

    Attributes
    ----------
    operation : str
    folder : Path
        Where its results are.
    done, skipped : tuple of str
        Sources that were done now, and that had been done before.
    failed : dict of str to str
        By source: why, in one sentence.
    table : Path or None
        The Parquet file with all numbers, of now and before; ``None`` where nothing was done.
    seconds : float
    """

    operation: str
    folder: Path
    done: tuple[str, ...] = ()
    skipped: tuple[str, ...] = ()
    failed: Mapping[str, str] = field(default_factory=dict)
    table: Path | None = None
    seconds: float = 0.0

    @property
    def ok(self) -> bool:
        """Whether no file failed."""
        return not self.failed

    def read(self) -> Any:
        """Return the table, as :class:`pyarrow.Table`; its ``to_pandas()`` is a data frame where pandas is installed.

        Raises
        ------
        ValueError
            If there is none.
        """
        import pyarrow.parquet

        if self.table is None:
            raise ValueError("there is no table: no file of this batch could be done")
        return pyarrow.parquet.read_table(self.table, partitioning=None)


def batch(
    operation: str,
    sources: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    folder: str | os.PathLike[str],
    *,
    cluster: Any = None,
    workers: int | None = None,
    memory: int | str | None = None,
    resume: bool = False,
    overwrite: bool = False,
    progress: bool = False,
    dashboard: bool = True,
    **options: Any,
) -> BatchResult:
    """Do one thing to each of many files.

    Parameters
    ----------
    operation : {'convert', 'verify', 'density', 'select', 'profile', 'connectome', 'sample'}
    sources : str, PathLike or sequence of these
        Files, or patterns such as ``'sub-*/dwi/*.trk'``.
    folder : str or PathLike
        Where results go: files in folders as the sources are, the table ``OPERATION.parquet``, and the record
        ``OPERATION.jsonl`` of what was done.
    cluster : str or distributed.Client, optional
        Address of a scheduler, the path of its file (``.json``), or a client. By default processes of this machine are
        started, and ended when all is done.
    workers : int, optional
        How many processes; one a core by default, and no more than files.
    memory : int or str, optional
        Most that a worker may have, bytes or such as ``'4G'``. By default 80 % of this machine's memory, divided by the
        workers; none that is enforced on other clusters.
    resume : bool, default: False
        Skip files that an earlier run has finished: same bytes, same options, unchanged result.
    overwrite : bool, default: False
        Do all again, whatever is there.
    progress : bool, default: False
        Show a bar and the dashboard's address on standard error.
    dashboard : bool, default: True
        Whether processes that are started here have a page that shows their work.
    **options
        Of the operation. In paths ``{subject}``, ``{session}``, ``{stem}``, ``{folder}`` and other parts of a source's
        name stand for themselves: ``labels='atlas/sub-{subject}.nii.gz'``.

    Returns
    -------
    BatchResult
        A file that fails is named there, and the others are done.

    Raises
    ------
    ValueError
        If there are no such files, two of them would make the same, or results are there and neither `resume` nor
        `overwrite` is given.
    TypeError
        If the operation has no such option.
    ClusterError
        If dask is not installed, or no scheduler answers.

    Notes
    -----
    A worker that dies loses nothing: its file is begun again by another one, up to ten times.
    """
    begin = time.perf_counter()
    if operation not in OPERATIONS:
        raise ValueError(f"operation is {operation!r}; expected one of {', '.join(map(repr, OPERATIONS))}")
    if resume and overwrite:
        raise ValueError("resume and overwrite exclude each other; give one of them")
    kind = OPERATIONS[operation]
    given = kind.checked(options)
    out = Path(folder).expanduser().resolve()
    files = find_sources(sources)
    n_workers = default_workers(len(files)) if workers is None else workers
    if n_workers < 1:
        raise ValueError(f"workers is {workers}; at least 1 is needed")
    size = _memory(memory, n_workers, ours=cluster is None)
    record = Record(out / f"{operation}.jsonl")
    jobs, failed = _jobs(kind, files, out, given, size)
    _refuse_collisions(jobs, files)
    before = dict(record.entries)
    if not (resume or overwrite):
        _refuse_old(record, jobs, out)
    made_folder(out)
    skipped = [] if overwrite else [
        job.name for job in jobs if job.name in before and before[job.name].holds(Path(job.source), job.asked, out)
    ]  # fmt: skip
    left = [job for job in jobs if job.name not in set(skipped)]
    record.begin(afresh=overwrite)
    done: list[str] = []
    try:
        for name, why in failed.items():
            record.add(Entry(name, "", error=why))
        with closing(
            _run(left, out, cluster, min(n_workers, max(len(left), 1)), size, progress, dashboard)
        ) as entries:  # closed at once where this is interrupted: workers end, and nothing half is left
            for entry in entries:
                record.add(entry)
                if entry.error:
                    failed[entry.name] = entry.error
                else:
                    done.append(entry.name)
    finally:
        record.close()
    whole = {*done, *skipped}
    parts = [out / job.rows for job in jobs if job.name in whole]
    table = out / f"{operation}.parquet" if parts else None
    if table is not None:
        join_parts(parts, table)
    return BatchResult(
        operation, out, tuple(sorted(done)), tuple(skipped), dict(sorted(failed.items())), table,
        time.perf_counter() - begin,
    )  # fmt: skip


def _memory(given: int | str | None, workers: int, *, ours: bool) -> int | None:
    """Bytes for each worker; ``None`` where others have set a limit."""
    if given is None:
        machine = limits.of_machine()
        return max(int(SHARE * machine / workers), LEAST_MEMORY) if ours and machine else None
    size = limits.parse(given) if isinstance(given, str) else int(given)
    if size < LEAST_MEMORY:
        raise ValueError(
            f"memory is {limits.shown(size)}, less than a worker takes before it does anything; give at least "
            f"{limits.shown(LEAST_MEMORY)}"
        )
    return size


def _jobs(
    kind: Operation, files: list[SourceFile], out: Path, options: dict[str, Any], size: int | None
) -> tuple[list[Job], dict[str, str]]:
    """Return the tasks, and the files that cannot be processed, with the reason."""
    jobs, failed, images = [], {}, chosen()
    space, tkras = unnamed(), tkras_chosen()
    places = {"nifti": None if images == (None, "mm") else images, "space": space, "tkras": tkras}
    chosen_places = {key: value for key, value in places.items() if value}
    for file in files:
        try:
            kind.check_source(file.path)
            own = {name: _own(value, file) if name in kind.paths else value for name, value in options.items()}
        except ValueError as error:
            failed[file.name] = sentence(error)
            continue
        target = f"{file.stem}{options['to']}" if kind.check_file else ""
        rows = f".{kind.name}/{file.name}.parquet"
        asked = _asked(kind.name, own | chosen_places)
        jobs.append(
            Job(
                kind.name, str(file.path), file.name, target, rows, str(out), "", own, file.said, asked, size, images,
                space, tkras,
            )
        )  # fmt: skip
    return jobs, failed


def _own(value: Any, file: SourceFile) -> Any:
    """An option's value for one source."""
    if isinstance(value, (list, tuple)):
        return [_own(v, file) for v in value]
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    return _absolute(filled(value, file.fields, file.name)) if isinstance(value, str) else value


def _absolute(text: str) -> str:
    """A path, with or without labels behind a colon, made absolute for workers."""
    path, colon, labels = text.rpartition(":")
    for name, rest in ((text, ""), (path, colon + labels)):
        place = Path(name).expanduser()
        # A folder beside the study may be called as an array is.
        if place.is_file() or (place.exists() and (place.suffix or place.name != name)):
            return f"{place.absolute()}{rest}"
    return text


def _asked(name: str, options: dict[str, Any]) -> str:
    """Hash of the request: the options, and size and time of files that they name."""

    def told(value: Any) -> Any:
        if isinstance(value, (list, tuple)):
            return [told(v) for v in value]
        if isinstance(value, str) and Path(value).is_file():
            return [value, *fingerprint(Path(value))]
        return value if value is None or isinstance(value, (bool, int, float, str)) else repr(value)

    plain = {key: told(value) for key, value in sorted(options.items())}
    return hashlib.sha256(json.dumps([name, plain]).encode()).hexdigest()[:32]


def _refuse_collisions(jobs: list[Job], files: list[SourceFile]) -> None:
    taken: dict[str, str] = {}
    own = {str(file.path) for file in files}
    for job in jobs:
        made = job.target or job.rows
        if made in taken:
            raise ValueError(f"{taken[made]} and {job.name} would both make {made}; run them into two folders")
        taken[made] = job.name
        if job.target and str(Path(job.folder) / job.target) in own:
            raise ValueError(f"{job.source} would be overwritten by its own result; give another folder")


def _refuse_old(record: Record, jobs: list[Job], out: Path) -> None:
    """Refuse to touch what an earlier run, or somebody else, has put there."""
    remedy = "give --resume (resume=True) to skip finished files, --overwrite (overwrite=True) to repeat everything"
    if record.entries:
        done = sum(not entry.error for entry in record.entries.values())
        raise ValueError(f"{out} holds an earlier run with {done} finished files; {remedy}")
    for job in jobs:
        if job.target and os.path.lexists(out / job.target):
            raise ValueError(f"{out / job.target} is there already; {remedy}, or another folder")


def _run(
    jobs: list[Job], out: Path, cluster: Any, workers: int, size: int | None, progress: bool, dashboard: bool
) -> Generator[Entry, None, None]:
    """Yield what becomes of each job as it ends."""
    if not jobs:
        return
    with _scratch(out) as scratch, connected(cluster, workers, size, dashboard=dashboard) as client:
        if progress:
            bound = "" if size is None else f", each of at most {limits.shown(size)}"
            page = f"; dashboard: {client.dashboard_link}" if client.dashboard_link else ""
            print(f"{len(client.nthreads())} workers{bound}{page}", file=sys.stderr)
        with progress_bar(progress, total=len(jobs), desc=jobs[0].operation, unit="file") as bar:
            for entry in _entries(client, jobs, str(scratch)):
                bar.update()
                yield entry


def _entries(client: Client, jobs: list[Job], scratch: str) -> Iterator[Entry]:
    from distributed import KilledWorker, as_completed

    batch_id = uuid.uuid4().hex[:8]
    by_key = {f"{job.operation}-{batch_id}-{n}": replace(job, scratch=scratch) for n, job in enumerate(jobs)}
    futures = [client.submit(run, job, key=key, pure=False) for key, job in by_key.items()]
    try:
        for future in as_completed(futures, loop=client.loop):
            job = by_key[future.key]
            if future.status == "finished":
                yield future.result()
            else:
                error = future.exception()
                why = f"{type(error).__name__}: {sentence(error)}" if error is not None else f"it was {future.status}"
                if isinstance(error, KilledWorker):
                    why = (
                        f"workers died {error.allowed_failures + 1} times while they were at it; it may take more "
                        "memory than a worker may have (--max-memory)"
                    )
                yield Entry(job.name, job.asked, error=why)
            future.release()
    finally:
        client.cancel(futures, force=True)


@contextmanager
def _scratch(out: Path) -> Iterator[Path]:
    """A temporary folder; also removes the folders of killed runs on this machine."""
    host = socket.gethostname()
    for old in out.glob(".batch-*"):
        match = _SCRATCH.fullmatch(old.name)
        if match and match["host"] == host and not _alive(int(match["pid"])):
            shutil.rmtree(old, ignore_errors=True)
    made = out / f".batch-{host}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    made.mkdir()
    try:
        yield made
    finally:
        shutil.rmtree(made, ignore_errors=True)


def _alive(pid: int) -> bool:
    if os.name == "nt":  # where to ask is to kill
        return True
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
