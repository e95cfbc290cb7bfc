"""Which actor has a mapper that ``vtkActor.SetMapper`` gave to it, which VTK does not report.

Mappers do not know their actors, and windows are in no list. But all rendering starts in Python, from an object:
a window, its interactor, a renderer, or a filter that takes pictures of a window. From these, among all objects
that Python's garbage collector knows, windows lead to renderers and these to actors. That takes a hundredth of a second
or so, once for each mapper.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from typing import Any

from vtkmodules.vtkCommonCore import vtkObjectBase
from vtkmodules.vtkRenderingCore import vtkActor, vtkProp, vtkRenderer, vtkRenderWindow

from pvfiblets.mappers.frames.scene import actors_in, items_of, renderers_of

# Methods of objects with a window or a renderer: vtkRenderWindowInteractor, vtkWindowToImageFilter and others.
_LEADS = ("GetRenderWindow", "GetInput", "GetRenderer")


def actor_of(mapper: Any) -> vtkActor | None:
    """Return an actor whose mapper this is, one in the window that is being drawn before all others; None for none."""
    found: vtkActor | None = None
    for actor in _actors():
        if actor.GetMapper() is not mapper:
            continue
        if any(_is_drawn(renderer) for renderer in renderers_of(actor)):
            return actor
        found = actor if found is None else found
    return found


def _is_drawn(renderer: vtkRenderer) -> bool:
    window = renderer.GetRenderWindow()
    return window is not None and bool(window.IsCurrent())


def _actors() -> Iterator[vtkActor]:
    """Yield the actors that Python or a renderer that it leads to has; some more than once."""
    seen: set[str] = set()
    # By type(): isinstance reads the object's __class__, which may raise, as for a dead weakref.proxy.
    for held in [held for held in gc.get_objects() if issubclass(type(held), vtkObjectBase)]:
        if isinstance(held, vtkProp):
            yield from actors_in(held)
        for renderer in _renderers(held):
            if renderer.GetAddressAsString("") not in seen:
                seen.add(renderer.GetAddressAsString(""))
                for prop in items_of(renderer.GetViewProps()):
                    yield from actors_in(prop)


def _renderers(held: Any) -> Iterator[vtkRenderer]:
    """Yield the renderers to which an object leads."""
    leads = [held, *(getattr(held, lead)() for lead in _LEADS if _takes_nothing(held, lead))]
    for lead in leads:
        if isinstance(lead, vtkRenderer):
            yield lead
        elif isinstance(lead, vtkRenderWindow):
            yield from items_of(lead.GetRenderers())


def _takes_nothing(held: Any, lead: str) -> bool:
    # Of filters, whose GetInput would be one of data, and slow.
    return hasattr(held, lead) and (lead != "GetInput" or held.IsA("vtkWindowToImageFilter"))
