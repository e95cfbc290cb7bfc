"""`ActorLink`: the actor that a mapper draws for, and the shader pieces that this actor needs.

VTK keeps the pieces with the actor, not with the mapper, and tells a mapper nothing of the actors that have it. So a
mapper that an actor was given by ``SetMapper`` alone looks for it when VTK first begins to draw
(`pvfiblets.mappers.vtk_pipeline.actor_search`). From then on the actor's own ``ModifiedEvent`` says whether it still
has the mapper, the property and the shader property.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from vtkmodules.vtkRenderingCore import vtkActor, vtkMapper

from pvfiblets.mappers.effects import resolve
from pvfiblets.mappers.frames.observers import observe
from pvfiblets.mappers.frames.scene import actors_in, items_of, weak

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkRenderer

VTK_SURFACE = 2

_UNUSED = {
    "backface_prop": ("GetBackfaceProperty", "there are no back faces; prop applies to all sides"),
    "texture": ("GetTexture", "there are no texture coordinates; give colours as scalars"),
}
"""VTK's method, and the warning, by PyVista's name."""


class ActorLink:
    """The actor of a mapper, and the shader pieces in it; keeps neither alive."""

    found = False  # whether the actor was given the mapper by `SetMapper`, not by `attach`
    installed: tuple[resolve.Replacement, ...] = ()

    def __init__(self, mapper: vtkMapper, before_attach: Callable[[], None]) -> None:
        self._mapper = weak(mapper)
        self._before_attach = before_attach
        self._features: frozenset[str] = frozenset()
        self._translucent = False
        self._forget()

    def _forget(self) -> None:
        self._actor = weak(None)
        self._property = weak(None)
        self._shader_property = weak(None)
        self._ignore_actor: Callable[[], None] = lambda: None
        self._ignore_property: Callable[[], None] = lambda: None
        self.installed = ()
        self.found = False
        self._alone = ("", 0)
        self._unused: frozenset[str] = frozenset()
        self._shaders_seen = 0

    @property
    def actor(self) -> vtkActor | None:
        """The actor, if it still exists; None until the mapper is attached or first drawn."""
        return cast("vtkActor | None", self._actor.Get())

    def attach(self, actor: vtkActor) -> None:
        """Make the mapper that of an actor, and add the shader pieces to it."""
        self.detach()
        self._before_attach()
        self._actor = weak(actor)
        actor.SetMapper(cast("Any", self._mapper.Get()))
        self._ignore_actor = observe(actor, ("ModifiedEvent",), self._actor_changed)
        self._watch_property(actor)
        self.install()

    def detach(self) -> None:
        """Take the shader pieces out of the actor; it then needs another mapper."""
        self._ignore_actor()
        shaders = self._shader_property.Get()
        if shaders is not None:
            resolve.uninstall(shaders, self.installed)
        self._ignore_property()
        self._forget()

    def find(self) -> None:
        """Look for the actor that VTK draws, where it is not known: it was given the mapper by ``SetMapper``."""
        if self.actor is not None:
            return
        from pvfiblets.mappers.vtk_pipeline.actor_search import actor_of

        found = actor_of(self._mapper.Get())
        if found is not None:
            self.attach(found)
            self.found = True

    def _actor_changed(self, actor: vtkActor, _event: str) -> None:
        """Follow an actor that has another mapper, property or shader property by now."""
        if self._mapper.Get() is None:
            return
        if actor.GetMapper() is not self._mapper.Get():
            self.detach()
            return
        if actor.GetProperty() is not self._property.Get():
            self._watch_property(actor)
        if actor.GetShaderProperty() is not self._shader_property.Get():
            self.install()
        self._tell_unused(actor)

    def _tell_unused(self, actor: vtkActor) -> None:
        """Warn once of an actor's settings that the covering triangle cannot use."""
        given = frozenset(name for name, (get, _) in _UNUSED.items() if getattr(actor, get)() is not None)
        new, self._unused = given - self._unused, given
        for name in sorted(new):
            warnings.warn(f"actor.{name} changes nothing here: {_UNUSED[name][1]}", UserWarning, stacklevel=2)

    def check_alone(self, renderer: vtkRenderer) -> None:
        """Raise if actors share the mapper, as copies of an actor do: VTK does not say which one it draws."""
        props = renderer.GetViewProps()
        seen = renderer.GetAddressAsString(""), props.GetMTime()
        if seen == self._alone:
            return
        actors = [actor for prop in items_of(props) for actor in actors_in(prop)]
        count = sum(actor.GetMapper() is self._mapper.Get() for actor in actors if actor.GetVisibility())
        if count > 1:
            raise RuntimeError(
                f"{count} actors have this mapper, which serves one; give each actor a mapper of its own "
                "(mapper.ShallowCopy(other) shares the data)"
            )
        self._alone = seen

    def drop_vertex_stages(self) -> None:
        """Take out what others do to vertices, as PyVista's camera distortion does: here these are a rectangle's."""
        shaders: Any = self._shader_property.Get()
        if shaders is None or shaders.GetMTime() == self._shaders_seen:
            return
        own = {(edit.original, edit.first, edit.text) for edit in self.installed if edit.stage == "vertex"}
        there = set(resolve.vertex_replacements(shaders))
        found = there - own
        for name, first, _ in found:
            shaders.ClearVertexShaderReplacement(name, first)
        if found or own - there:  # a tag has one of each
            resolve.install(shaders, self.installed)
        self._shaders_seen = shaders.GetMTime()
        if found:
            warnings.warn(
                "a replacement of the vertex shader changes nothing here, neither camera distortion nor maximum "
                "intensity projection: the image is computed pixel by pixel and stays undistorted",
                UserWarning,
                stacklevel=2,
            )

    def _watch_property(self, actor: vtkActor) -> None:
        self._ignore_property()
        _keep_surface(actor.GetProperty(), "")
        self._property = weak(actor.GetProperty())
        self._ignore_property = observe(actor.GetProperty(), ("ModifiedEvent",), _keep_surface)

    def modified(self) -> None:
        """Notify observers that render on demand; the mapper's own time would make VTK rebuild its shaders."""
        if self.actor is not None:
            self.actor.Modified()

    def show(self, features: frozenset[str], translucent: bool) -> None:
        """Set the actor's shader pieces, and whether VTK draws it in its translucent pass, whatever its opacity is."""
        self._features, self._translucent = features, translucent
        self.install()

    def install(self) -> None:
        """Give the actor its shader pieces, unless it has them."""
        actor = self.actor
        if actor is None:
            return
        shaders, before = actor.GetShaderProperty(), self._shader_property.Get()
        wanted = resolve.assemble(self._features) + (resolve.NO_HIGHLIGHTS if self._is_dull else ())
        if wanted != self.installed or shaders is not before:
            if before is not None:
                resolve.uninstall(before, self.installed)
            self._shader_property, self.installed = weak(shaders), wanted
            resolve.install(shaders, wanted)
        if self._translucent != actor.GetForceTranslucent():
            actor.SetForceTranslucent(self._translucent)

    @property
    def _is_dull(self) -> bool:
        return bool(cast("vtkActor", self.actor).GetProperty().GetSpecular() == 0.0)

    def follow_highlights(self) -> None:
        """Compute highlights from now on if the actor has come to have any, and not if it has none."""
        if self.installed and self._is_dull != (self.installed[-1:] == resolve.NO_HIGHLIGHTS):
            self.install()

    def take_out(self) -> None:
        """Take the shader pieces out of the actor, so that VTK draws the mapper's data in its own way."""
        shaders = self._shader_property.Get()
        if shaders is not None:
            resolve.uninstall(shaders, self.installed)
        self.installed = ()


def _keep_surface(actor_property: Any, event: str) -> None:
    """Undo wireframe, points, edges and culling of front faces, in which VTK would not fill the covering triangle."""
    undone = []
    if actor_property.GetRepresentation() != VTK_SURFACE:
        actor_property.SetRepresentationToSurface()
        undone.append("style")
    if actor_property.GetEdgeVisibility():
        actor_property.SetEdgeVisibility(False)
        undone.append("show_edges")
    if actor_property.GetFrontfaceCulling():
        actor_property.SetFrontfaceCulling(False)
        undone.append("culling")
    if undone and event:  # not what a theme or a property brings with it
        warnings.warn(
            f"prop.{' and prop.'.join(undone)} changes nothing here: lines, tubes, halos and volumes have no facets",
            UserWarning,
            stacklevel=2,
        )
