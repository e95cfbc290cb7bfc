"""The OpenGL engine: it renders fiblets to a G-buffer on a moderngl context. No VTK, no PyVista.

>>> renderer = FibletRenderer(ctx, fiblets)                                             # doctest: +SKIP
>>> gbuffer = renderer.render(View((1920, 1080), model_view_projection), FibletStyle())       # doctest: +SKIP

Life cycle: a new renderer copies the fiblets to the GPU and keeps them until :meth:`FibletRenderer.release`.
:meth:`FibletRenderer.render` renders again only after a change of the view or the style. It returns the G-buffer,
which the mappers resolve into VTK's image. The shader sources are in the repository's ``shaders`` folder.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..support.lazy_imports import names_from

if TYPE_CHECKING:
    from .errors import EngineError
    from .fiblets.renderer import FibletRenderer
    from .fiblets.style import FibletStyle
    from .gbuffer import GBuffer
    from .view import View


__all__ = ["EngineError", "FibletRenderer", "FibletStyle", "GBuffer", "View"]

_HOME = {
    "EngineError": "errors",
    "FibletRenderer": "fiblets.renderer",
    "FibletStyle": "fiblets.style",
    "GBuffer": "gbuffer",
    "View": "view",
}

__getattr__, __dir__ = names_from(__name__, _HOME)
