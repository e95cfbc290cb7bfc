"""The renderer that is drawing an actor at this moment."""

from __future__ import annotations

from vtkmodules.vtkCommonCore import vtkCommand, vtkWeakReference
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

from pvfiblets.mappers.frames.scene import renderers_of
from pvfiblets.mappers.frames.windows import gl_viewport


class ActiveRenderer:
    """Finds the renderer on whose behalf an actor is drawn.

    VTK's ``UpdateShaderEvent`` does not name the renderer. An actor in one renderer of the current window
    leaves no doubt. An actor in several renderers (subplots) does: then the one that has fired
    ``StartEvent`` last is it, and until each has been observed once, the one whose viewport is in use.
    """

    def __init__(self) -> None:
        self._watched: dict[str, vtkWeakReference] = {}
        self._started = vtkWeakReference()

    def find(self, actor: vtkActor) -> vtkRenderer:
        """Return the renderer that draws an actor now."""
        candidates = [
            renderer
            for renderer in renderers_of(actor)
            if renderer.GetRenderWindow() is not None and renderer.GetRenderWindow().IsCurrent()
        ]
        if not candidates:
            raise RuntimeError(
                "the mapper's actor is drawn but is in no renderer of the current window; "
                "add the actor itself, not a copy of it"
            )
        # A window of EGL's says that it is current even when another is.
        rendering = [renderer for renderer in candidates if renderer.GetRenderWindow().CheckInRenderStatus()]
        candidates = rendering or candidates
        if len(candidates) == 1:
            return candidates[0]
        for renderer in candidates:
            self._watch(renderer)
        started = self._started.Get()
        if started in candidates:
            return started
        viewport = gl_viewport(candidates[0].GetRenderWindow())
        matching = [renderer for renderer in candidates if _fits(renderer, viewport)]
        return (matching or candidates)[0]

    def _watch(self, renderer: vtkRenderer) -> None:
        address = renderer.GetAddressAsString("")
        known = self._watched.get(address)
        if known is not None and known.Get() is not None:
            return
        self._watched[address] = vtkWeakReference()
        self._watched[address].Set(renderer)
        started = self._started
        renderer.AddObserver(vtkCommand.StartEvent, lambda caller, _event: started.Set(caller))


def _fits(renderer: vtkRenderer, viewport: tuple[int, int, int, int]) -> bool:
    """Whether a renderer's own viewport is the one in use."""
    origin = renderer.GetOrigin()
    size = renderer.GetSize()
    return (origin[0], origin[1], size[0], size[1]) == viewport
