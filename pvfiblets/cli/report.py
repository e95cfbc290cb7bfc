"""The command ``pvfiblets report``."""

from __future__ import annotations

from pathlib import Path

from pvfiblets.report.report_file import Report
from pvfiblets.report.run import make_report, to_stderr, write_pages
from pvfiblets.support.whole_files import made_folder


def report(
    *,
    output: str,
    only: list[str] | None,
    data: list[str],
    quick: bool,
    minutes: float | None,
    seed: int,
    source: str | None,
) -> None:
    """Measure, or make page and plots of earlier measurements."""
    folder = Path(output)
    if source is not None:
        if only or data or quick or minutes is not None or seed:
            raise ValueError(
                "--from writes the page of an existing report; "
                "leave out --only, --data, --quick, --minutes and --seed, which start new measurements"
            )
        made = Report.load(source)
        if Path(source).resolve() not in (folder.resolve(), (folder / "report.json").resolve()):
            made.save(folder)
    else:
        made_folder(folder)  # before minutes of work, not after
        made = make_report(folder, only=only, data=tuple(map(Path, data)), quick=quick, minutes=minutes, seed=seed)
    page = write_pages(made, folder)
    to_stderr(f"wrote {page}, the plots beside it, and {folder / 'report.json'}")
