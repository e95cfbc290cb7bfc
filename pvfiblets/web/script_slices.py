"""What a script says of images that are shown as slices."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pvfiblets.web.script_code import Python

if TYPE_CHECKING:
    from pvfiblets.web.document import Layer
    from pvfiblets.web.scene import Scene

__all__ = ["has_images", "image_arguments", "slicing_lines"]


def has_images(scene: Scene) -> bool:
    """Say whether any layer is an image of slices."""
    return any(layer.kind == "image" for layer in scene.layers)


def image_arguments(layer: Layer, meaning: str, file: Callable[[str], str]) -> dict[str, Any]:
    """Return arguments that say what an image's numbers mean; ``file`` gives the Python of a path."""
    found: dict[str, Any] = {"kind": meaning}
    if meaning == "labels" and layer.source.values:
        found["labels"] = Python(file(layer.source.values[-1]))
    return found


def slicing_lines(scene: Scene) -> list[str]:
    """Return lines that look at slices as the scene does."""
    view = scene.slicing.view
    found = [f"workspace.{name} = {getattr(view, name)!r}" for name in ("layout", "convention", "thickness")]
    found += ["workspace.told = False"]
    found += [] if view.cross_hair else ["workspace.cross_hair = False"]
    if not view.planes:
        found += ["for plane in workspace.slices:", "    plane.visible = False"]
    return [*found, f"workspace.position = {view.position}", ""]
