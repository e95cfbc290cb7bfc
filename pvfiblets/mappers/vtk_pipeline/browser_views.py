"""Views that draw in the browser (trame's local views, ``export_html``, ``.vtksz``): lines instead of pictures.

They ask each object of VTK for its class name and have a serializer for each; vtk.js cannot run this package's shaders.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any

_NAME = "pvfibletsMapper"
_MAPPER_OF_VTK_JS = "vtkMapper"


def class_name(readable_mapper: Callable[[Any], AbstractContextManager[None]]) -> str:
    """Return the name under which a serializer of this package's mappers is known, now at the latest."""
    from trame_vtk.modules.vtk.serializers.registry import SERIALIZERS, register_instance_serializer

    if _NAME not in SERIALIZERS:
        from trame_vtk.modules.vtk.serializers.mappers import generic_mapper_serializer

        def serialize(parent: Any, mapper: Any, mapper_id: str, context: Any, depth: int) -> Any:
            with readable_mapper(mapper):
                state = generic_mapper_serializer(parent, mapper, mapper_id, context, depth)
            if state is not None:
                state["type"] = _MAPPER_OF_VTK_JS
            return state

        register_instance_serializer(_NAME, serialize)
    return _NAME
