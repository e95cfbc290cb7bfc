"""Drawing of overlays after VTK's render passes, if one of these changes the finished frame.

PyVista has VTK's ambient occlusion and eye-dome lighting change a picture that scalar bars and texts are in already.
Effects on the picture belong after those passes and before the texts, which VTK has no place for. So the texts are kept
out of the passes, and drawn when the renderer is done.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pvfiblets.mappers.frames.scene import items_of

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

LAST = ("vtkSSAOPass", "vtkEDLShading")  # passes that leave the depth of their result in VTK's framebuffer


class Overlay:
    """The overlay of one renderer's picture."""

    def __init__(self) -> None:
        self._held: tuple[Any, Any] | None = None

    def hold(self, renderer: vtkRenderer) -> None:
        """Keep it out of this frame's passes, if one of them comes last that should come before the effects."""
        outermost = renderer.GetPass()
        if outermost is None or outermost.GetClassName() not in LAST:
            return
        steps = _steps(outermost)
        if steps is not None and steps.GetOverlayPass() is not None:
            self._held = steps, steps.GetOverlayPass()
            steps.SetOverlayPass(None)

    def let_go(self, renderer: vtkRenderer) -> None:
        """Draw it, if it has been kept out; the renderer is done."""
        held, self._held = self._held, None
        if held is None:
            return
        steps, overlay = held
        steps.SetOverlayPass(overlay)
        if renderer.GetSelector() is not None:
            return
        width, height, x, y = [0], [0], [0], [0]
        renderer.GetTiledSizeAndOrigin(width, height, x, y)
        window: Any = renderer.GetRenderWindow()  # an OpenGL one
        state = window.GetState()
        state.vtkglViewport(x[0], y[0], width[0], height[0])
        state.vtkglScissor(x[0], y[0], width[0], height[0])
        for prop in items_of(renderer.GetViewProps()):
            if prop.GetVisibility():
                prop.RenderOverlay(renderer)


def _steps(render_pass: Any) -> Any:
    """Return the pass that draws a renderer's props step by step, the innermost; None where there is none."""
    while render_pass is not None:
        if render_pass.GetClassName() == "vtkRenderStepsPass":
            return render_pass
        if render_pass.GetClassName() == "vtkSequencePass":
            inner = render_pass.GetPasses()
            found = [_steps(inner.GetItemAsObject(index)) for index in range(inner.GetNumberOfItems())]
            return next((steps for steps in found if steps is not None), None)
        render_pass = render_pass.GetDelegatePass() if hasattr(render_pass, "GetDelegatePass") else None
    return None
