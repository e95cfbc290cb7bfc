"""`FibletMapper`: fiblets as geometry of an ordinary VTK actor.

VTK draws one triangle that covers the viewport (`pvfiblets.mappers.proxy`) with its own program, in which
pieces of GLSL (`pvfiblets.mappers.resolve`) read the engine's G-buffer. From inside that draw VTK fires
``UpdateShaderEvent``: the mapper, observing itself, has the engine bring the G-buffer up to date for the
camera, viewport and pass of that very moment, and hands the program its uniforms.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, cast

from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_OBJECT
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLPolyDataMapper

from pvfiblets.engine.view import Style, View
from pvfiblets.mappers import resolve
from pvfiblets.mappers.active import ActiveRenderer
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.engines import EngineOptions, engine_renderer
from pvfiblets.mappers.extras import Draw, Extra, prepare_extras, set_extra_uniforms, styled
from pvfiblets.mappers.layers import layers_of, with_layers
from pvfiblets.mappers.picking import Drawn
from pvfiblets.mappers.proxy import proxy_polydata
from pvfiblets.mappers.questions import Questions
from pvfiblets.mappers.scene import frame_of, others_before, world_planes
from pvfiblets.mappers.tubes import thickened, thickness_of
from pvfiblets.mappers.uniforms import resolve_textures, set_uniforms
from pvfiblets.mappers.windows import Slot, WindowContext, context_of, contexts_with, gl_viewport, weak

VTK_SURFACE = 2


class FibletMapper(Questions, vtkOpenGLPolyDataMapper):
    """Mapper that draws a `FibletSet` through VTK's own lights, passes and selection.

    Give it to an actor with `attach`, which also adds the shader pieces to the actor: ``SetMapper``
    alone is not enough. One mapper serves one actor, in any number of renderers of one window; another
    window needs another mapper and actor, as with all of VTK's.

    Parameters
    ----------
    fiblets : FibletSet
        What to draw.
    colouring : Colouring, optional
        By orientation when left out.
    line_width : float, default 1.0
        Pixels of the window, at least 1.
    options : EngineOptions, optional
        Pipeline and culling; the defaults suit every machine.
    renderer_factory : callable, optional
        Takes a moderngl context, the fiblets, and as keywords those options that are not the defaults; returns a
        renderer as of `pvfiblets.engine`.
    progress : bool, default False
        Show a progress bar while copying to the GPU.

    Notes
    -----
    An exception while drawing cannot pass through VTK. It is stored, nothing is drawn, and
    `raise_pending` raises it: call that after every render.

    GL objects are given back after the first frame in which the actor is no longer in the window, when
    the window goes, and at once by `release`.
    """

    def __init__(
        self,
        fiblets: Any,
        *,
        colouring: Colouring | None = None,
        line_width: float = 1.0,
        options: EngineOptions | None = None,
        renderer_factory: Callable[..., Any] = engine_renderer,
        progress: bool = False,
    ) -> None:
        self._factory = renderer_factory
        self._options = EngineOptions() if options is None else options
        self._progress = {"progress": True} if progress else {}
        self._actor = weak(None)
        self._property = weak(None)
        self._observer = 0
        self._active = ActiveRenderer()
        self._installed: tuple[resolve.Replacement, ...] = ()
        self._extras: dict[str, Extra] = {}
        self._filtering: Any = None
        self._region: Any = None
        self._error: BaseException | None = None
        self._last_drawn: str | None = None
        self._colouring = Colouring() if colouring is None else colouring
        self.line_width = line_width
        self.SetScalarVisibility(False)
        self.set_fiblets(fiblets)
        self.AddObserver("UpdateShaderEvent", _update_shader)

    # What is drawn, and how

    @property
    def fiblets(self) -> Any:
        """The `FibletSet` that is drawn."""
        return self._fiblets

    def set_fiblets(self, fiblets: Any) -> None:
        """Draw other fiblets from the next frame on.

        Raises
        ------
        ValueError
            The colouring has values for another number of streamlines.
        """
        self._colouring.check_count(fiblets.n_streamlines)
        self._fiblets = fiblets
        self._set_proxy()

    def _set_proxy(self) -> None:
        """Give VTK its geometry; setting it makes VTK build the shaders anew."""
        drawn = self._fiblets.n_streamlines and self._fiblets.n_points
        self._layers = layers_of(self._extras.values())
        self._thickness = thickness_of(self._extras.values())
        bounds = thickened(self._fiblets.bounds, self._thickness) if drawn else None
        self.SetInputData(proxy_polydata(bounds, self._layers))

    @property
    def line_width(self) -> float:
        """Width of the lines in pixels of the window."""
        return self._line_width

    @line_width.setter
    def line_width(self, pixels: float) -> None:
        self._line_width = Style(line_width=float(pixels)).line_width
        self._actor_modified()

    @property
    def options(self) -> EngineOptions:
        """Pipeline and culling; set another `EngineOptions` to change them from the next frame on."""
        return self._options

    @options.setter
    def options(self, options: EngineOptions) -> None:
        self._options = options
        self._actor_modified()

    @property
    def colouring(self) -> Colouring:
        """Where the colours come from; set another `Colouring` to change them."""
        return self._colouring

    @colouring.setter
    def colouring(self, colouring: Colouring) -> None:
        colouring.check_count(self._fiblets.n_streamlines)
        self._colouring = colouring
        self._install()
        self._actor_modified()

    @property
    def filtering(self) -> Any:
        """`pvfiblets.engine.filtering.Filter` of what is there to be drawn; None for everything."""
        return self._filtering

    @filtering.setter
    def filtering(self, wanted: Any) -> None:
        self._filtering = wanted
        self._actor_modified()

    @property
    def region(self) -> Any:
        """`pvfiblets.regions.Region` in world mm outside of which fiblets are cut away; None for none."""
        return self._region

    @region.setter
    def region(self, region: Any) -> None:
        self._region = region
        self._actor_modified()

    @property
    def extras(self) -> Mapping[str, Extra]:
        """Looks beside the colours, by name; see `set_extra`."""
        return dict(self._extras)

    def set_extra(self, name: str, extra: Extra | None) -> None:
        """Set or, with None, take away one of the looks beside the colours (`pvfiblets.mappers.extras`)."""
        if extra is None:
            self._extras.pop(name, None)
        else:
            self._extras[name] = extra
        made_for = self._layers, self._thickness
        if (layers_of(self._extras.values()), thickness_of(self._extras.values())) != made_for:
            self._set_proxy()
        self._install()
        self._actor_modified()

    # The actor

    @property
    def actor(self) -> vtkActor | None:
        """The actor that this mapper was attached to, if it still exists."""
        return cast("vtkActor | None", self._actor.Get())

    def attach(self, actor: vtkActor) -> None:
        """Make this the mapper of an actor and add the shader pieces to it.

        Parameters
        ----------
        actor : vtkActor
            Shader replacements of others stay. Its representation stays at surface whatever a key or a
            menu sets for all actors: lines have no wireframe and no edges.
        """
        self.detach()
        self._actor = weak(actor)
        actor.SetMapper(self)
        _keep_surface(actor.GetProperty(), "")
        self._property = weak(actor.GetProperty())
        self._observer = actor.GetProperty().AddObserver("ModifiedEvent", _keep_surface)
        self._install()

    def detach(self) -> None:
        """Take the shader pieces out of the actor; it then needs another mapper."""
        actor = self.actor
        if actor is not None:
            resolve.uninstall(actor.GetShaderProperty(), self._installed)
        if self._property.Get() is not None:
            self._property.Get().RemoveObserver(self._observer)
        self._property = weak(None)
        self._installed = ()
        self._actor = weak(None)

    def _actor_modified(self) -> None:
        """Tell those who render on demand; the mapper's own time would make VTK build its shaders anew."""
        if self.actor is not None:
            self.actor.Modified()

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve shader in use."""
        extras = frozenset().union(*(extra.features for extra in self._extras.values()))
        return with_layers(frozenset({"gbuffer", "normal"} | self._colouring.features | extras))

    def _install(self) -> None:
        """Bring the actor's shader pieces and its translucency up to date."""
        actor = self.actor
        if actor is None:
            return
        wanted = resolve.assemble(self.features)
        if wanted != self._installed:
            resolve.uninstall(actor.GetShaderProperty(), self._installed)
            resolve.install(actor.GetShaderProperty(), wanted)
            self._installed = wanted
        translucent = self._colouring.translucent()
        if translucent != actor.GetForceTranslucent():
            actor.SetForceTranslucent(translucent)

    # Drawing

    def raise_pending(self) -> None:
        """Raise the exception of the last draw, if there was one, once."""
        error, self._error = self._error, None
        if error is not None:
            raise error

    def _update(self, program: Any) -> None:
        """Answer VTK's ``UpdateShaderEvent``: G-buffer, textures and uniforms for this draw."""
        unraised, self._error = self._error, None
        try:
            self._draw(program)
        except Exception as error:  # noqa: BLE001  VTK would swallow it; see raise_pending
            program.SetUniform2i("fibletSize", (0, 0))
            self._error = error
        if unraised is not None:
            # Nobody asked for the last one: VTK prints what an observer raises.
            raise unraised

    def _draw(self, program: Any) -> None:
        actor = self.actor
        if actor is None or not program.IsUniformUsed("fibletDepthMap"):
            raise RuntimeError(
                "the actor lacks the fiblets' shader pieces; use mapper.attach(actor), "
                "not actor.SetMapper(mapper), and do not replace its shader property"
            )
        renderer = self._active.find(actor)
        context = context_of(renderer.GetRenderWindow())
        if any(other is not context and other.shows(self) for other in contexts_with(self)):
            raise RuntimeError(
                "VTK can show an actor in one window only; for the second window make another "
                "FibletMapper of the same fiblets, with an actor of its own"
            )
        viewport = gl_viewport(context.window)
        frame = frame_of(renderer, actor, viewport)
        planes = frame.planes_in_data(world_planes(self))
        view = View(viewport[2:], frame.model_view_projection, planes, frame.region_in_data(self._region))
        style = self._style(renderer, viewport)
        slot = context.slot(self)
        with context.foreign():
            engine = self._engine(context, slot)
            outside = None
            if self._layers == 1 and engine.needs_outside(view, style) and others_before(renderer, actor):
                outside = slot.outside_depth(context.ctx).copy(viewport)
            buffer = engine.render(view, style, outside=outside)
            draw = Draw(context.ctx, engine, buffer, frame, view, style, renderer, self._fiblets, actor)
            textures = resolve_textures(context.ctx, slot, buffer, self._colouring)
            textures |= prepare_extras(slot, self._extras, draw)
            units = context.texture_units(len(textures))
            for unit, texture in zip(units, textures.values(), strict=True):
                texture.use(unit)
        for unit, name in zip(units, textures, strict=True):
            program.SetUniformi(name, unit)
        set_uniforms(program, frame, style, self._fiblets, self._colouring)
        set_extra_uniforms(slot, self._extras, program, draw)
        self._last_drawn = renderer.GetAddressAsString("")
        slot.drawn.pop(self._last_drawn, None)
        slot.drawn[self._last_drawn] = Drawn(weak(renderer), viewport, view, style)

    def _style(self, renderer: vtkRenderer, viewport: tuple[int, int, int, int]) -> Style:
        """Return the style in pixels of the framebuffer, which supersampling makes larger than the window."""
        enlarged = viewport[2] / max(1, renderer.GetSize()[0])
        width = self._line_width * max(1.0, enlarged)
        style = Style(line_width=width, values=self._colouring.point_source)
        return styled(style, self._extras.values())

    def _engine(self, context: WindowContext, slot: Slot) -> Any:
        """Return the engine's renderer of a window, made anew for other fiblets and other options."""
        if slot.versions.get("fiblets") is not self._fiblets or slot.versions.get("options") != self._options:
            slot.drop_renderer()
            slot.versions |= {"fiblets": self._fiblets, "options": self._options}
        if slot.renderer is None:
            slot.renderer = self._factory(context.ctx, self._fiblets, **self._options.changed(), **self._progress)
            slot.versions.pop("filtering", None)
        if slot.versions.get("filtering") is not self._filtering:
            slot.renderer.filtering = slot.versions["filtering"] = self._filtering
        return slot.renderer

    # Memory

    def release(self, window: Any = None) -> None:
        """Delete the GL objects of one window, or of all; twice is harmless.

        Parameters
        ----------
        window : vtkRenderWindow, optional
            All windows when left out. Call it before a window is closed, to have the memory back at once.
        """
        address = None if window is None else window.GetAddressAsString("")
        for context in contexts_with(self):
            if address in (None, context.address):
                context.release(self)


@calldata_type(VTK_OBJECT)
def _update_shader(mapper: FibletMapper, _event: str, program: Any) -> None:
    mapper._update(program)  # noqa: SLF001  a bound method would keep the mapper alive for ever


def _keep_surface(actor_property: Any, _event: str) -> None:
    """Undo wireframe, points and edges, in which VTK would not fill the covering triangle."""
    if actor_property.GetRepresentation() != VTK_SURFACE:
        actor_property.SetRepresentationToSurface()
    if actor_property.GetEdgeVisibility():
        actor_property.SetEdgeVisibility(False)
