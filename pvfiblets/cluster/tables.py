"""Numbers of many files as one Parquet table: a part for each file, then all parts one after another.

Parts are read and written one at a time, so that a table may be larger than memory.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pvfiblets.support.whole_files import replacing

Columns = Mapping[str, Any]  # by name: numbers and texts for every row, or one for all rows


def write_part(path: Path, said: Mapping[str, str], columns: Columns) -> None:
    """Write the rows of one file."""
    import pyarrow as pa
    from pyarrow import parquet

    lengths = {len(v) for v in columns.values() if not _single(v)}
    n = lengths.pop() if lengths else 1
    rows = {**{key: value for key, value in said.items() if key not in columns}, **columns}
    arrays = {name: pa.array([v] * n if _single(v) else v) for name, v in rows.items()}
    parquet.write_table(pa.table(arrays), path, compression="zstd")


def _single(value: Any) -> bool:
    return isinstance(value, (str, bytes)) or np.ndim(value) == 0


def join_parts(parts: Iterable[Path], target: Path) -> int:
    """Write the rows of all parts to one file, which appears when it is whole."""
    # A column that a part lacks is null in its rows.
    import pyarrow as pa
    from pyarrow import parquet

    paths = list(parts)
    try:
        schema = pa.unify_schemas([parquet.read_schema(path) for path in paths], promote_options="permissive")
    except pa.ArrowTypeError as error:
        raise ValueError(f"{target}: parts of the table do not fit together: {error}") from None
    # What all names have comes first; what only some have follows, in the order in which it was met.
    rows = 0
    with replacing(target) as file, parquet.ParquetWriter(file, schema, compression="zstd") as writer:
        for path in paths:
            part = parquet.read_table(path, partitioning=None)
            rows += part.num_rows
            missing = [name for name in schema.names if name not in part.column_names]
            for name in missing:
                part = part.append_column(name, pa.nulls(part.num_rows, schema.field(name).type))
            writer.write_table(part.select(schema.names).cast(schema))
    return rows
