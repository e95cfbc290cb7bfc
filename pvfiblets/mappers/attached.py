"""`Attached`: the actor that a mapper draws for, and the shader pieces that this actor needs.

VTK keeps the pieces with the actor, not with the mapper, and tells a mapper nothing of the actors that have it. So a
mapper that an actor was given by ``SetMapper`` alone looks for it when VTK first begins to draw
(`pvfiblets.mappers.actor_search`). From then on the actor's own ``ModifiedEvent`` says whether it still has the mapper,
the property and the shader property.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any, cast

from vtkmodules.vtkRenderingCore import vtkActor

from pvfiblets.mappers import resolve
from pvfiblets.mappers.depth_peeling import with_layers
from pvfiblets.mappers.scene import actors_in, items_of
from pvfiblets.mappers.vtk_overrides import override
from pvfiblets.mappers.windows import weak

VTK_SURFACE = 2

_UNUSED = {
    "backface_prop": ("GetBackfaceProperty", "what is drawn has no backs; prop says how it looks from all sides"),
    "texture": ("GetTexture", "what is drawn has no texture coordinates; give colours as scalars"),
}
"""By PyVista's name: how VTK calls it, and what to say of it."""


class Attached:
    """The part of `pvfiblets.mappers.engine_mapper.EngineMapper` that knows its actor."""

    _colouring: Any
    _effects: Mapping[str, Any]

    def _init_actor(self) -> None:
        self._actor = weak(None)
        self._property = weak(None)
        self._shader_property = weak(None)
        self._tags = (0, 0)
        self._installed: tuple[resolve.Replacement, ...] = ()
        self._found = False
        self._alone = ("", 0)
        self._unused: frozenset[str] = frozenset()
        self._shaders_seen = 0

    @property
    def actor(self) -> vtkActor | None:
        """The actor that has this mapper, if it still exists; None until it is attached or first drawn."""
        return cast("vtkActor | None", self._actor.Get())

    def attach(self, actor: vtkActor) -> None:
        """Make this the mapper of an actor and add the shader pieces to it.

        ``actor.SetMapper(mapper)`` does the same, once VTK draws the actor.

        Parameters
        ----------
        actor : vtkActor
            Shader replacements of others stay. Its representation stays at surface whatever a key or a
            menu sets for all actors: lines have no wireframe and no edges, and all that shows is a front.
        """
        self.detach()
        override()  # of modules of VTK's that have been loaded since
        self._found = False
        self._actor = weak(actor)
        actor.SetMapper(cast("Any", self))
        self._tags = actor.AddObserver("ModifiedEvent", _follow_actor(self)), 0
        self._watch_property(actor)
        self._install()

    def detach(self) -> None:
        """Take the shader pieces out of the actor; it then needs another mapper."""
        actor, shaders = self.actor, self._shader_property.Get()
        if actor is not None:
            actor.RemoveObserver(self._tags[0])
        if shaders is not None:
            resolve.uninstall(shaders, self._installed)
        if self._property.Get() is not None:
            self._property.Get().RemoveObserver(self._tags[1])
        self._init_actor()

    def _find_actor(self) -> None:
        """Look for the actor that VTK draws, where it is not known: it was given the mapper by ``SetMapper``."""
        if self.actor is not None:
            return
        from pvfiblets.mappers.actor_search import actor_of

        found = actor_of(self)
        if found is not None:
            self.attach(found)
            self._found = True

    def _actor_changed(self) -> None:
        """Follow an actor that has another mapper, property or shader property by now."""
        actor = self.actor
        if actor is None:
            return
        if actor.GetMapper() is not self:
            self.detach()
            return
        if actor.GetProperty() is not self._property.Get():
            self._watch_property(actor)
        if actor.GetShaderProperty() is not self._shader_property.Get():
            self._install()
        self._tell_unused(actor)

    def _tell_unused(self, actor: vtkActor) -> None:
        """Say once of what an actor was given that the covering triangle has no use for it."""
        given = frozenset(name for name, (get, _) in _UNUSED.items() if getattr(actor, get)() is not None)
        new, self._unused = given - self._unused, given
        for name in sorted(new):
            warnings.warn(f"actor.{name} changes nothing here: {_UNUSED[name][1]}", UserWarning, stacklevel=2)

    def _check_alone(self, renderer: Any) -> None:
        """Raise where actors share the mapper, as copies of an actor do: nobody says which of them is drawn."""
        props = renderer.GetViewProps()
        seen = renderer.GetAddressAsString(""), props.GetMTime()
        if seen == self._alone:
            return
        actors = [actor for prop in items_of(props) for actor in actors_in(prop)]
        count = sum(actor.GetMapper() is self for actor in actors if actor.GetVisibility())
        if count > 1:
            raise RuntimeError(
                f"{count} actors have this mapper, which serves one; give each actor a mapper of its own "
                "(mapper.ShallowCopy(other) shares the data)"
            )
        self._alone = seen

    def _drop_vertex_stages(self) -> None:
        """Take out what others do to vertices, as PyVista's camera distortion does: here these are a rectangle's."""
        shaders: Any = self._shader_property.Get()
        if shaders is None or shaders.GetMTime() == self._shaders_seen:
            return
        own = {(edit.original, edit.first, edit.text) for edit in self._installed if edit.stage == "vertex"}
        there = set(resolve.vertex_replacements(shaders))
        found = there - own
        for name, first, _ in found:
            shaders.ClearVertexShaderReplacement(name, first)
        if found or own - there:  # a tag has one of each
            resolve.install(shaders, self._installed)
        self._shaders_seen = shaders.GetMTime()
        if found:
            warnings.warn(
                "a replacement of the vertex shader changes nothing here, neither camera distortion nor maximum "
                "intensity projection: what is drawn is computed pixel by pixel, and stays undistorted",
                UserWarning,
                stacklevel=2,
            )

    def _watch_property(self, actor: vtkActor) -> None:
        if self._property.Get() is not None:
            self._property.Get().RemoveObserver(self._tags[1])
        _keep_surface(actor.GetProperty(), "")
        self._property = weak(actor.GetProperty())
        self._tags = self._tags[0], actor.GetProperty().AddObserver("ModifiedEvent", _keep_surface)

    def _actor_modified(self) -> None:
        """Tell those who render on demand; the mapper's own time would make VTK build its shaders anew."""
        if self.actor is not None:
            self.actor.Modified()

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve shader in use."""
        effects = frozenset().union(*(effect.features for effect in self._effects.values()))
        return with_layers(frozenset({"gbuffer", "normal"} | self._colouring.features | effects))

    def _install(self) -> None:
        """Bring the actor's shader pieces and its translucency up to date."""
        actor = self.actor
        if actor is None:
            return
        shaders, before = actor.GetShaderProperty(), self._shader_property.Get()
        wanted = resolve.assemble(self.features)
        if wanted != self._installed or shaders is not before:
            if before is not None:
                resolve.uninstall(before, self._installed)
            self._shader_property, self._installed = weak(shaders), wanted
            resolve.install(shaders, wanted)
        translucent = self._translucent
        if translucent != actor.GetForceTranslucent():
            actor.SetForceTranslucent(translucent)

    @property
    def _translucent(self) -> bool:
        """Whether VTK must draw it in its translucent pass, whatever the actor's opacity is."""
        effects = self._effects.values()
        return self._colouring.translucent() or any(getattr(effect, "translucent", False) for effect in effects)


def _follow_actor(mapper: Any) -> Callable[[Any, str], None]:
    """Return an observer of an actor that does not keep the mapper alive."""
    follower = weak(mapper)

    def changed(_actor: Any, _event: str) -> None:
        found: Any = follower.Get()
        if found is not None:
            found._actor_changed()  # noqa: SLF001  this module's own

    return changed


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
            f"prop.{' and prop.'.join(undone)} changes nothing here: what is drawn has no facets",
            UserWarning,
            stacklevel=2,
        )
