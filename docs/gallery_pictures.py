"""What the gallery shows of an example: the pictures that it has written."""

from __future__ import annotations

from pathlib import Path
from typing import Any

__all__ = ["Pictures"]


class Pictures:
    """Takes what an example has written into its folder, which is what its user finds there."""

    def __repr__(self) -> str:
        return "Pictures"  # the gallery compares configurations by this

    def __call__(self, block: tuple[Any, ...], block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:  # noqa: ARG002 - as of all scrapers
        """Move new pictures to where the gallery wants them, and return the text that shows them."""
        from sphinx_gallery.scrapers import figure_rst

        names = []
        here = Path(str(block_vars["src_file"])).parent
        for found in sorted(here.glob("*.png"), key=lambda path: path.stat().st_mtime_ns):
            name = next(block_vars["image_path_iterator"])
            found.replace(name)
            names.append(name)
        return figure_rst(names, gallery_conf["src_dir"])
