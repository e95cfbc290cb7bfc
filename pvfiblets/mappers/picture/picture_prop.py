"""A prop that calls Python between a renderer's image and its overlays, and the framebuffer bound there."""

from __future__ import annotations

import ctypes
import weakref
from collections.abc import Callable
from typing import Any, Protocol

from vtkmodules.vtkPythonContext2D import vtkPythonItem
from vtkmodules.vtkRenderingContext2D import vtkContextActor
from vtkmodules.vtkRenderingContextOpenGL2 import vtkOpenGLContextActor  # noqa: F401  what VTK makes of the former

from pvfiblets.engine.effects.picture_passes import Attachment
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.mappers.frames.windows import WindowContext

COLOUR, DEPTH = 0x8CE0, 0x8D00
_DRAW_FRAMEBUFFER, _TYPE, _NAME, _COMPONENTS = 0x8CA9, 0x8CD0, 0x8CD1, 0x8211
_TEXTURE, _FLOAT = 0x1702, 0x1406


class Painted(Protocol):
    """Callbacks of a prop."""

    def paint(self) -> None:
        """Change the picture."""

    def stored(self, step: Callable[[], None]) -> None:
        """Take a step, and keep its error."""


class PictureProp(vtkContextActor):
    """The prop that calls Python when VTK reaches the overlays."""

    def hang(self, picture: Painted) -> None:
        """Call a picture, which is not kept alive."""
        self.SetPickable(False)
        self.SetUseBounds(False)
        self._item = vtkPythonItem()
        self._item.SetPythonObject(_Painter(picture))
        self.GetScene().AddItem(self._item)

    @property
    def actor(self) -> vtkContextActor:
        """Actor that a `WindowContext` reads, to see whether it is still shown."""
        return self

    def HasOpaqueGeometry(self) -> int:  # noqa: N802  VTK's name
        """Return 0: it leaves no depth that could hide anything."""
        return 0


class _Painter:
    """Methods that VTK calls."""

    def __init__(self, picture: Painted) -> None:
        self._picture = weakref.ref(picture)

    def Initialize(self, _item: Any) -> bool:  # noqa: N802  VTK's name
        """Accept any item."""
        return True

    def Paint(self, _item: Any, _context: Any) -> bool:  # noqa: N802  VTK's name
        """Be called when it is time to draw."""
        picture = self._picture()
        if picture is not None:
            picture.stored(picture.paint)
        return True


def attachment(context: WindowContext, point: int) -> Attachment:
    """Return colour or depth of the framebuffer that VTK draws into."""
    gl = GLExtras(context.ctx)
    values = []
    if gl.get_integer("GL_DRAW_FRAMEBUFFER_BINDING") != 0:
        for what in (_TYPE, _NAME, _COMPONENTS):
            value = ctypes.c_int(0)
            gl.function("glGetFramebufferAttachmentParameteriv")(_DRAW_FRAMEBUFFER, point, what, ctypes.byref(value))
            values.append(value.value)
    if not values or values[0] != _TEXTURE:
        raise RuntimeError(
            "effects on the picture need VTK to draw into textures, which it does not here; "
            "remove the render passes that were added to the renderer"
        )
    return Attachment(values[1], gl.get_integer("GL_SAMPLES"), values[2] == _FLOAT)
