"""The interface of all kinds of occlusion culling."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from ..gbuffer import GBuffer
from ..view import Style, View

if TYPE_CHECKING:
    import moderngl


class Occlusion(Protocol):
    """A texture of depth that fiblets are tested against by ``hidden()`` of ``shaders/culling/occlusion.glsl``."""

    feature: str
    """Key of :data:`pvfiblets.engine.gl.shaders.FEATURES` that a testing program needs."""

    halfway: bool
    """Whether it is made of the picture itself, by :meth:`build`, once what the last one showed is drawn; otherwise
    it is there before the picture, and every fiblet is tested."""

    outside: moderngl.Texture | None
    """Depth of other things in the scene, as keys, that hides fiblets too; for one picture."""

    predicts: bool
    """Whether the last picture predicts what will show: ``shaders/culling/visibility_prediction.glsl``."""

    def before(self, target: GBuffer, view: View, style: Style) -> None:
        """Prepare for a picture; the target still holds the last one."""
        ...

    def forget(self) -> None:
        """Forget the last picture: the next one shows other things, which it does not hide."""
        ...

    def build(self, target: GBuffer) -> None:
        """Make the texture of the depth drawn so far in this picture."""
        ...

    def after(self, target: GBuffer, view: View, style: Style) -> None:
        """Finish the picture."""
        ...

    def bind(self, program: Any) -> None:
        """Bind the texture and tell a program where it is."""
        ...

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory."""
        ...

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        ...
