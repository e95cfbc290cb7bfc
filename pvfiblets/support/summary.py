"""Summaries of streamlines for people: a small table for notebooks, and a warning of what reading left out."""

from __future__ import annotations

import html
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Protocol, TypeVar


class _Read(Protocol):
    """Summary of a source with the counts of dropped data."""

    @property
    def dropped(self) -> Mapping[str, int]: ...


AnyRead = TypeVar("AnyRead", bound=_Read)


def summary_html(title: str, data: Any, more: dict[str, str] | None = None) -> str:
    """Return a table in HTML."""
    b = data.bounds
    sides = [f"{low:.4g} to {high:.4g}" for low, high in zip(b[::2], b[1::2], strict=True)]
    rows = {"Streamlines": f"{len(data):,}", "Points": f"{data.n_points:,}", **(more or {})}
    if data.n_points:
        rows |= {f"{axis} [mm]": side for axis, side in zip("XYZ", sides, strict=True)}
    named = {"Per point": "per_point", "Per streamline": "per_streamline", "Groups": "groups"}
    rows |= {label: ", ".join(getattr(data, name)) or "none" for label, name in named.items()}
    if data.dropped:
        rows["Dropped"] = ", ".join(f"{count:,} {reason}" for reason, count in data.dropped.items())
    cells = (f"<tr><th>{html.escape(k)}</th><td>{html.escape(v)}</td></tr>" for k, v in rows.items())
    return f"<table><tr><th colspan='2'>{html.escape(title)}</th></tr>{''.join(cells)}</table>"


def counting(chunks: Iterable[AnyRead], dropped: Counter[str]) -> Iterator[AnyRead]:
    """Yield the chunks of a source, and add up what reading left out of them."""
    for chunk in chunks:
        dropped.update(chunk.dropped)
        yield chunk


def warn_of_losses(name: str, dropped: Mapping[str, int], *, stacklevel: int) -> None:
    """Warn once of what reading a source left out or changed, if anything."""
    if dropped:
        parts = "; ".join(f"{reason}: {count:,}" for reason, count in dropped.items())
        warnings.warn(f"{name}: reading left out or changed parts ({parts})", UserWarning, stacklevel=stacklevel + 1)
