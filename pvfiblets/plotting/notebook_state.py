"""State that a page in a notebook shares with the kernel: camera, and the picked streamline (anywidget).

The page is a frame that the notebook keeps; this model has no view. Where the notebook has it, ``notebook_state.js``
passes messages on between it and the frames of its name.
"""

from __future__ import annotations

from pathlib import Path

import anywidget
import traitlets

_VECTORS = ("position", "focal_point", "up")
_NUMBERS = ("view_angle", "parallel_scale")


class NotebookState(anywidget.AnyWidget):
    """State that a page in a notebook shares with the kernel."""

    _esm = Path(__file__).with_suffix(".js")
    name = traitlets.Unicode().tag(sync=True)  # of the page's frame
    # `position`, `focal_point`, `up` (3 floats each, world mm), `view_angle` (degrees), `parallel` and `parallel_scale`
    camera = traitlets.Dict().tag(sync=True)
    # `layer` (number), `streamline` (number) and `place` (3 floats, world mm); None: nothing
    picked = traitlets.Dict(allow_none=True, default_value=None).tag(sync=True)

    @traitlets.validate("camera")
    def _whole_camera(self, proposal: dict[str, dict[str, object]]) -> dict[str, object]:
        camera = proposal["value"]
        whole = all(_is_vector(camera.get(key)) for key in _VECTORS)
        if not whole or not all(_is_number(camera.get(key)) for key in _NUMBERS) or "parallel" not in camera:
            raise traitlets.TraitError(
                f"camera is {camera!r}; give position, focal_point and up of three numbers, view_angle, parallel, and "
                "parallel_scale"
            )
        return camera


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and abs(value) < 1e30


def _is_vector(value: object) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 3 and all(map(_is_number, value))
