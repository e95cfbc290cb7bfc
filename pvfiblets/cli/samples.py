"""The command ``pvfiblets sample``."""

from __future__ import annotations

from typing import Any

from pvfiblets.query.measures.sample_files import write_samples


def sample(source: str, image: str, target: str, **how: Any) -> None:
    """Write the values of an image along streamlines, or the streamlines with these."""
    write_samples(source, image, target, **how)
