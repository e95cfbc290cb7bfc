"""The page's tables as CSV: every number in full, every name as text."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pvfiblets.web.scene.scene import Scene

MOST_ROWS = 100_000
PIECE = 5000
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")


def selection_csv(scene: Scene) -> str:
    """Return the selected streamlines of all layers, a row each."""
    total = scene.selection.count()
    if not total:
        raise ValueError("nothing is selected; pick streamlines first")
    if total > MOST_ROWS:
        raise ValueError(
            f"{total:,} streamlines are selected, and a table takes {MOST_ROWS:,}; export them as .trx, and "
            "`pvfiblets table` makes a table of all"
        )
    rows = [row for first in range(0, total, PIECE) for row in scene.selection.table(first=first, limit=PIECE)["rows"]]
    return _written(
        ("layer", "streamline", "points", "length_mm", "value", "value_of", "groups"),
        ((row["name"], row["streamline"], row["points"], row["length"], row["value"], row["of"],
          "; ".join(row["groups"])) for row in rows),
    )  # fmt: skip


def profile_csv(profile: Mapping[str, Any], title: str) -> str:
    """Return a profile of :meth:`.Scene.profile`."""
    columns = (profile["position"], profile["mean"], profile["std"])
    return _written(
        ("share_of_length", f"mean of {title}", f"standard deviation of {title}"), zip(*columns, strict=True)
    )


def table_text(table: Mapping[str, Any], *, tabs: bool = False) -> str:
    """Return columns by name as CSV, or with tabs between; missing numbers are empty."""
    columns = [column.tolist() for column in table.values()]
    rows = ([None if value != value else value for value in row] for row in zip(*columns, strict=True))
    return _written(list(table), rows, "\t" if tabs else ",")


def _written(head: Sequence[str], rows: Iterable[Sequence[Any]], between: str = ",") -> str:
    file = io.StringIO(newline="")
    writer = csv.writer(file, delimiter=between)
    writer.writerow([_cell(title) for title in head])
    writer.writerows([_cell(value) for value in row] for row in rows)
    return file.getvalue()


def _cell(value: Any) -> Any:
    """Return the text of a value, safe from formulas in spreadsheets."""
    if isinstance(value, str) and value.startswith(_FORMULA):
        return f"'{value}"
    return "" if value is None else value
