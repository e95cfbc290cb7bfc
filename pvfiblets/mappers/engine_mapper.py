"""`EngineMapper`: what an engine draws, as geometry of an ordinary VTK actor.

VTK draws one triangle that covers the viewport (`pvfiblets.mappers.vtk_pipeline.proxy`) with its own program, in which
pieces of GLSL (`pvfiblets.mappers.effects.resolve`) read the engine's G-buffer. From inside that draw VTK fires
``UpdateShaderEvent``: the mapper, observing itself, has the engine bring the G-buffer up to date for the
camera, viewport and pass of that very moment, and hands the program its uniforms.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

import numpy as np
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_OBJECT
from vtkmodules.vtkCommonCore import vtkCommand, vtkOutputWindow
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLPolyDataMapper

from pvfiblets.engine.view import MAX_CLIP_PLANES, Style, View
from pvfiblets.mappers.colouring import Colouring
from pvfiblets.mappers.effects.depth_peeling import layers_of, with_layers
from pvfiblets.mappers.effects.line_tubes import thickened, thickness_of
from pvfiblets.mappers.effects.shader_effects import Draw, MapperEffect, prepare_effects, set_effect_uniforms, styled
from pvfiblets.mappers.effects.shading import ink_on
from pvfiblets.mappers.effects.uniforms import resolve_textures, set_uniforms
from pvfiblets.mappers.engine_options import Options
from pvfiblets.mappers.frames.active_renderer import ActiveRenderer
from pvfiblets.mappers.frames.scene import (
    Frame,
    actors_in,
    frame_of,
    in_motion,
    items_of,
    lenses,
    others_before,
    pixel_scale,
    renderers_of,
    smoothers,
    switch_view,
    to_array,
    weak,
    world_planes,
)
from pvfiblets.mappers.frames.shifted_cameras import is_shifted
from pvfiblets.mappers.frames.windows import (
    Slot,
    WindowContext,
    context_of,
    contexts_with,
    gl_viewport,
    make_current_again,
)
from pvfiblets.mappers.picking import Drawn
from pvfiblets.mappers.vtk_pipeline.actor_link import ActorLink
from pvfiblets.mappers.vtk_pipeline.connection import Connection
from pvfiblets.mappers.vtk_pipeline.proxy import proxy_polydata
from pvfiblets.mappers.vtk_pipeline.readable_lines import LineReading, readable_mapper
from pvfiblets.mappers.vtk_pipeline.vtk_overrides import override

if TYPE_CHECKING:
    from collections.abc import Sequence

    import moderngl
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    from pvfiblets.engine.effects.picture import SeenThrough
    from pvfiblets.mappers.line_data import LineData
    from pvfiblets.mappers.vtk_pipeline.vtk_input import VtkInput

_ONE_ACTOR = "give each actor a mapper of its own (mapper.ShallowCopy(other) shares the data)"

SMOOTHED_BESIDE = 3.0  # pixels beside lines that may take a share of them

AnyOptions = TypeVar("AnyOptions", bound=Options)


class EngineMapper(vtkOpenGLPolyDataMapper, Generic[AnyOptions]):
    """Mapper that draws through VTK's own lights, passes and selection what an engine puts into a G-buffer.

    ``actor.SetMapper(mapper)`` gives it to an actor, or `attach`. One mapper serves one actor, in any number of
    renderers and windows; each window has GPU memory of its own.

    An exception while drawing cannot pass through VTK. It is stored, nothing is drawn, and
    `raise_pending` raises it: call that after every render.

    GL objects are given back after the first frame in which the actor is no longer in the window, when
    the window goes, and at once by `release`.
    """

    _NAME: ClassVar[str]

    # Attributes that a shallow copy takes over beside the data.
    COPIED: ClassVar[tuple[str, ...]] = ("_options", "_factory", "_made_with", "_colouring", "_follows", "_effects")

    # Whether the engine knows where the edges run of what each pixel shows.
    _HAS_EDGES: ClassVar[bool] = False

    def __init__(
        self,
        # what to draw; it has `n_streamlines`, `n_points`, `bounds` and `promise`. None for the data connected by
        # `SetInputConnection` or `SetInputData`, which replaces the argument when it is called.
        drawn: Any,
        *,
        # where the colours come from; None leaves them to `vtkMapper`'s own settings and to the actor's property
        colouring: Colouring | None,
        options: AnyOptions,  # what can be chosen about drawing
        # takes a moderngl context, the data, and as keywords the options that differ from the defaults; returns the
        # engine's renderer
        renderer_factory: Callable[..., Any],
        **made_with: Any,
    ) -> None:
        self._factory = renderer_factory
        self._options = options
        self._made_with = made_with  # further keywords of the factory
        self._link = ActorLink(self, override)  # VTK may have loaded more exporters since
        self._connection = Connection(self)
        self.reading = LineReading(self, self._connection, self._link)
        self._active = ActiveRenderer()
        self._effects: dict[str, MapperEffect] = {}
        self._cuts_in: dict[str, Any] = {}
        self._error: BaseException | None = None
        self._follows = colouring is None
        self._colouring = Colouring("solid") if colouring is None else colouring
        self._told = ""
        self._component = -1
        self.SetScalarVisibility(self._follows)
        self._put(drawn)
        self._install()
        for event, observer in _OBSERVERS.items():
            self.AddObserver(event, observer)

    @property
    def _has_edges(self) -> bool:
        """Whether the edges of the nearest lines are known."""
        return self._HAS_EDGES and all(getattr(effect, "smooth_edges", True) for effect in self._effects.values())

    # What is drawn, and how

    def _put(self, drawn: Any, colouring: Colouring | None = None) -> None:
        """Draw something else from the next frame on; refused while the colouring is for another number."""
        wanted = self._colouring if colouring is None else colouring
        if drawn is not None:
            wanted.check_count(drawn.n_streamlines)
            if self._connection.input is not None and not self._connection.input.executing:
                self._connection.input = None
        self._drawn, self._colouring = drawn, wanted
        if colouring is not None:
            self._install()
        self._set_proxy()

    @property
    def _empty(self) -> bool:
        """Whether the data are empty, and so without bounds."""
        return not (self._drawn.n_streamlines and self._drawn.n_points)

    @property
    def _extent(self) -> Sequence[float]:
        """Bounds of the data, mm."""
        return thickened(self._drawn.bounds, self._thickness)

    def _set_proxy(self) -> None:
        """Give VTK its geometry; setting it makes VTK build the shaders anew."""
        self._layers = layers_of(self._effects.values())
        self._thickness = thickness_of(self._effects.values())
        bounds = None if self._drawn is None or self._empty else self._extent
        self._connection.show(proxy_polydata(bounds, self._layers), connect=self._drawn is not None)

    @property
    def options(self) -> AnyOptions:
        """Options of drawing; set others to change it from the next frame on."""
        return self._options

    @options.setter
    def options(self, options: AnyOptions) -> None:
        self._options = options
        self._link.modified()

    @property
    def colouring(self) -> Colouring:
        """Source of colours; set another `Colouring` to change them."""
        return self._colouring

    @colouring.setter
    def colouring(self, colouring: Colouring) -> None:
        if self._drawn is not None:
            colouring.check_count(self._drawn.n_streamlines)
        self._colouring, self._follows = colouring, False
        self._install()
        self._link.modified()

    @property
    def effects(self) -> Mapping[str, MapperEffect]:
        """Looks beside the colours, by name; see `set_effect`."""
        return dict(self._effects)

    def set_effect(self, name: str, effect: MapperEffect | None) -> None:
        """Set or, with None, take away a look beside the colours (`pvfiblets.mappers.effects.shader_effects`)."""
        if effect is None:
            self._effects.pop(name, None)
        else:
            self._effects[name] = effect
        made_for = self._layers, self._thickness
        if (layers_of(self._effects.values()), thickness_of(self._effects.values())) != made_for:
            self._set_proxy()
        self._install()
        self._link.modified()

    # The actor

    @property
    def actor(self) -> vtkActor | None:
        """The actor that has this mapper, if it still exists; None until it is attached or first drawn."""
        return self._link.actor

    def attach(self, actor: vtkActor) -> None:
        """Make this the mapper of an actor and add the shader pieces to it."""
        # `actor.SetMapper(mapper)` does the same, once VTK draws the actor. Shader replacements of others stay. The
        # representation stays at surface whatever a key or a menu sets for all actors: lines have no wireframe and no
        # edges, and all that shows is a front.
        self._link.attach(actor)

    def detach(self) -> None:
        """Take the shader pieces out of the actor; it then needs another mapper."""
        self._link.detach()

    @property
    def features(self) -> frozenset[str]:
        """Pieces of the resolve shader in use."""
        effects = frozenset().union(*(effect.features for effect in self._effects.values()))
        return with_layers(frozenset({"gbuffer", "normal"} | self._colouring.features | effects))

    @property
    def _translucent(self) -> bool:
        """Whether VTK must draw it in its translucent pass, whatever the actor's opacity is."""
        effects = self._effects.values()
        return self._colouring.translucent() or any(getattr(effect, "translucent", False) for effect in effects)

    def _install(self) -> None:
        """Bring the actor's shader pieces and its translucency up to date."""
        self._link.show(self.features, self._translucent)

    @property
    def ink(self) -> tuple[float, float, float]:
        """Black, or white where the background of the actor's first renderer is dark."""
        return ink_on(None if self.actor is None else next(renderers_of(self.actor), None))

    def _property_color(self) -> tuple[float, float, float]:
        return (1.0, 1.0, 1.0) if self.actor is None else self.actor.GetProperty().GetDiffuseColor()

    # Drawing

    def raise_pending(self) -> None:
        """Raise the exception of the last draw, if there was one, once."""
        error, self._error = self._error, None
        try:
            if error is not None:
                raise error
        finally:
            del error  # held here it would keep itself, and VTK's objects in its frames, for Python's collector

    def _update(self, program: Any) -> None:
        """Answer VTK's ``UpdateShaderEvent``: G-buffer, textures and uniforms for this draw."""
        if self.is_readable:
            return  # VTK draws real lines
        unraised, self._error = self._error, None
        try:
            self._draw(program)
        except Exception as error:  # noqa: BLE001  VTK would swallow it; see raise_pending
            program.SetUniform2i("fibletSize", (0, 0))
            if self._link.found:
                self._tell(error)
            else:
                self._error = error
        if unraised is not None and not self._link.found:
            # Nobody asked for the last one: VTK prints what an observer raises.
            raise unraised

    def _tell(self, error: BaseException) -> None:
        """Keep an error for `raise_pending`, and say it as VTK says its own."""
        self._error = error
        text = f"{self._NAME}: {error}"
        if text == self._told:
            return  # it would be the same in every frame
        self._told = text
        if self.HasObserver("ErrorEvent"):
            self.InvokeEvent("ErrorEvent", text)
        else:
            vtkOutputWindow.GetInstance().DisplayErrorText(f"ERROR: {text}\n")

    def _draw(self, program: Any) -> None:
        actor = self.actor
        if actor is None or not program.IsUniformUsed("fibletDepthMap"):
            raise RuntimeError(
                f"the actor lacks the {self._NAME}'s shader pieces: {_ONE_ACTOR}, by mapper.attach(actor) where that "
                "is not found out from SetMapper"
            )
        renderer = self._active.find(actor)
        self.reading.watch(renderer)
        self._link.check_alone(renderer)
        context = context_of(renderer.GetRenderWindow())
        viewport = gl_viewport(context.window)
        if min(viewport[2:]) < 1:  # a tile of an enlarged picture in which the renderer has no part
            program.SetUniform2i("fibletSize", (0, 0))
            return
        smoother = smoothers.get(renderer.GetAddressAsString("")) if self._has_edges else None
        frame = frame_of(renderer, actor, viewport)
        view, style = self._wanted(renderer, frame, None if smoother is None else smoother.sample)
        narrower = self._narrower(pixel_scale(renderer, viewport))
        if smoother is not None:
            smoother.widened |= smoother.sample and self._widened(style, frame)
        slot = context.slot(self)
        context.tell_lost(renderer)
        with context.foreign():
            engine = self._engine(context, slot)
            switch_view(engine, renderer, actor, view, style)
            if hasattr(engine, "patience"):
                from pvfiblets.mappers.frames.streaming import pace

                pace(engine, renderer)
            if smoother is not None and smoother.layer is not None:
                buffer = smoother.layer(self)
            else:
                outside = None
                if engine.needs_outside(view, style):
                    outside = self._outside(context, slot, renderer, viewport)
                buffer = engine.render(view, style, outside=outside)
            textures = resolve_textures(context.ctx, slot, buffer, self._colouring)
            colouring = self._colouring
            if colouring.color is None:
                colouring = colouring.with_ink(ink_on(renderer))
            draw = Draw(
                context.ctx, engine, buffer, frame, view, style, renderer, self._drawn, actor,
                colouring, dict(textures),
            )  # fmt: skip
            textures |= prepare_effects(slot, self._effects, draw)
            units = context.texture_units(len(textures))
            for unit, texture in zip(units, textures.values(), strict=True):
                texture.use(unit)
        for unit, name in zip(units, textures, strict=True):
            program.SetUniformi(name, unit)
        set_uniforms(program, frame, style, self._drawn, colouring)
        set_effect_uniforms(slot, self._effects, program, draw)
        if smoother is not None and smoother.smooths:
            slack, beside = self._drawn.promise + style.reach, style.half_width + SMOOTHED_BESIDE
            rectangle = frame.pixel_rectangle(self._drawn.bounds, slack, beside)
            smoother.note(self, buffer, narrower, rectangle)
        lens = lenses.get(renderer.GetAddressAsString(""))
        if lens is not None and actor.HasTranslucentPolygonalGeometry():
            lens[self.GetAddressAsString("")] = self._faint_light(buffer)
        if is_shifted(renderer.GetActiveCamera()) or style.exact:  # one sample of a pixel is not what users point at
            return
        address = renderer.GetAddressAsString("")
        slot.drawn.pop(address, None)  # the last one stands last
        slot.drawn[address] = Drawn(weak(renderer), viewport, view, style)

    def layers_samples(self, renderer: vtkRenderer) -> bool:  # noqa: ARG002
        """Return whether samples of all that a renderer shows can be drawn at once."""
        return False

    def _wanted(self, renderer: vtkRenderer, frame: Frame, sample: bool | None) -> tuple[View, Style]:
        """Return what the engine is to draw for a frame; `sample`, where edges are smoothed: whether it is one."""
        planes, region = self._cuts(renderer)
        view = View(
            frame.viewport[2:],
            frame.model_view_projection,
            frame.planes_in_data(planes),
            frame.region_in_data(region),
            waits=region is None or not in_motion(renderer),
        )
        style = self._whole_style(renderer, frame.viewport)
        if sample is not None:  # edges in every frame: what wants them in some only would be made anew all the time
            style = replace(style, edges=True, exact=sample)
        return view, style

    def _faint_light(self, buffer: Any) -> SeenThrough:
        """Return what depth of field is to know of a G-buffer of something translucent."""
        from pvfiblets.engine.effects.picture import SeenThrough

        return SeenThrough(buffer.depth)

    def cut_in(self, renderer: vtkRenderer, planes: Any) -> None:
        """Cut by (k, 4) planes in world mm in one of the renderers that show it, and not in the others."""
        # A point is kept where ax + by + cz + d >= 0; None for no cut.
        address = renderer.GetAddressAsString("")
        wanted = None if planes is None else np.array(planes, np.float64).reshape(-1, 4)
        if np.array_equal(wanted, self._cuts_in.get(address)):  # type: ignore[arg-type]  # None, too
            return
        if wanted is None:
            self._cuts_in.pop(address, None)
        else:
            self._cuts_in[address] = wanted
        self._link.modified()

    def _cuts(self, renderer: vtkRenderer | None = None) -> tuple[Any, Any]:
        """Return what cuts in world mm, in a renderer or in all: planes, and the region that is not planes."""
        planes = world_planes(self)
        own = None if renderer is None else self._cuts_in.get(renderer.GetAddressAsString(""))
        return planes if own is None else np.concatenate([planes, own]), None

    def _outside(
        self, context: WindowContext, slot: Slot, renderer: vtkRenderer, viewport: tuple[int, int, int, int]
    ) -> moderngl.Texture | None:
        """Return the depth of earlier objects, as keys; None if it cannot be read."""
        # What else a renderer shows is behind the slab that it is cut to (`Pane`).
        actor = None if renderer.GetAddressAsString("") in self._cuts_in else self.actor
        if not self._sums_up and actor is not None and others_before(renderer, actor):
            return slot.outside_depth(context.ctx).copy(viewport)
        return None

    def _style(self, renderer: vtkRenderer, pixel_scale: float) -> Style:
        """Return the style without values; widths are multiplied by ``pixel_scale``."""
        raise NotImplementedError

    def _narrower(self, pixel_scale: float) -> float:  # noqa: ARG002
        """Return the difference of drawn and true line widths in pixels."""
        return 0.0

    def _widened(self, style: Any, frame: Frame) -> bool:  # noqa: ARG002
        """Return whether some lines may be drawn into other pixels than those whose middles they cover."""
        return False

    def _whole_style(self, renderer: vtkRenderer, viewport: tuple[int, int, int, int]) -> Style:
        """Return the style, with the values that the colours need and what effects want."""
        style = self._style(renderer, pixel_scale(renderer, viewport))
        return styled(replace(style, values=self._colouring.point_source), self._effects.values())

    def _engine(self, context: WindowContext, slot: Slot) -> Any:
        """Return the engine's renderer of a window, made anew for other data and other options."""
        options = self._options.changed()
        if slot.versions.get("drawn") is not self._drawn or slot.versions.get("options") != options:
            slot.drop_renderer()
            slot.versions |= {"drawn": self._drawn, "options": options}
        if slot.renderer is None:
            slot.renderer = self._make(context.ctx)
        return slot.renderer

    def _make(self, ctx: moderngl.Context, **more: Any) -> Any:
        """Return a renderer of the engine, made with all options, and more."""
        return self._factory(ctx, self._drawn, **{**self._options.changed(), **self._made_with, **more})

    @property
    def _sums_up(self) -> bool:
        """Whether a pixel shows more than the nearest line."""
        return self._layers > 1 or any(getattr(effect, "translucent", False) for effect in self._effects.values())

    # VTK's pipeline

    def _begin(self) -> None:
        """Find the actor that VTK is about to draw, and apply changes since the last draw."""
        self._link.find()
        if self._connection.input is not None and not self.is_readable:
            self._connection.input.follow()
        self._link.follow_highlights()
        self._link.drop_vertex_stages()

    def _input_state(self, data: Any) -> tuple[Any, ...]:
        """Return what a picture of some data depends on beside them."""
        if not self._follows:
            return ()
        from pvfiblets.mappers.vtk_pipeline.vtk_scalars import state_of

        return self._property_color(), *state_of(self, data)

    def _made_of(self, data: Any) -> tuple[Any, Colouring]:
        """Return what to draw of the data that were connected, and its colours."""
        raise NotImplementedError

    def _user_input(self) -> VtkInput | None:
        """Return the filter with the user's data, unless VTK reads real lines."""
        return None if self.is_readable else self._connection.input

    def GetInputConnection(self, port: int, index: int) -> Any:  # noqa: N802 - VTK's name
        """Return the connection."""
        found = self._user_input()
        return super().GetInputConnection(port, index) if found is None else found.GetInputConnection(port, index)

    def GetInputAlgorithm(self, port: int = 0, index: int = 0, *_ports: Any) -> Any:  # noqa: N802 - VTK's name
        """Return the algorithm that was connected."""
        connection = self.GetInputConnection(port, index)
        return None if connection is None else connection.GetProducer()

    def GetInputDataObject(self, port: int, index: int) -> Any:  # noqa: N802 - VTK's name
        """Return the data that were connected."""
        found = self._user_input()
        return super().GetInputDataObject(port, index) if found is None else found.GetInputDataObject(port, index)

    def GetInput(self) -> Any:  # noqa: N802 - VTK's name
        """Return the data that were connected."""
        found = self._user_input()
        return super().GetInput() if found is None else found.GetInputDataObject(0, 0)

    def GetDataSetInput(self) -> Any:  # noqa: N802 - VTK's name
        """Return the lines that are shown as PolyData; while VTK reads or selects, the very data that it looks at."""
        if self.is_readable or self._connection.input is not None:
            return self.GetInputDataObject(0, 0)
        return self.reading.data(budget=None)

    def GetInputAsDataSet(self) -> Any:  # noqa: N802 - VTK's name
        """Return the same, by the older name."""
        return self.GetDataSetInput()

    def SetArrayComponent(self, component: int) -> None:  # noqa: N802 - VTK's name
        """Colour by that component of vectors; -1 leaves it to the look-up table."""
        self._component = component
        super().SetArrayComponent(component)

    def GetArrayComponent(self) -> int:  # noqa: N802 - VTK's name
        """Return the set value: VTK itself sets 0 where its data lack the array."""
        return self._component

    def ColorByArrayComponent(self, array: str | int, component: int) -> None:  # noqa: N802 - VTK's name
        """Colour by a component of an array."""
        self._component = component
        super().ColorByArrayComponent(array, component)

    def ShallowCopy(self, other: Any) -> None:  # noqa: N802 - VTK's name
        """Become like another mapper: its input, its settings of ``vtkMapper`` and, of one of these, all others."""
        # Compressed and other data are shared, not copied. Each mapper serves an actor of its own.
        super().ShallowCopy(other)
        self._component = other.GetArrayComponent()
        if not isinstance(other, type(self)):
            return
        for name in self.COPIED:
            value = getattr(other, name)
            setattr(self, name, dict(value) if isinstance(value, dict) else value)
        drawn, connected = other._drawn, other._connection.input  # noqa: SLF001  its own kind
        if connected is None:
            self._put(drawn)
        elif drawn is not None and self._connection.input is not None:
            self._connection.input.be_like(connected)
        self._install()

    def GetClassName(self) -> str:  # noqa: N802 - VTK's name
        """Return VTK's own class, or what views in browsers know mappers of this package by."""
        if "trame_vtk.modules.vtk.serializers.registry" not in sys.modules:
            return str(super().GetClassName())
        from pvfiblets.mappers.vtk_pipeline.browser_views import class_name

        return class_name(readable_mapper)

    # Real lines, for VTK's code that reads data (`pvfiblets.mappers.vtk_pipeline.readable_lines`)

    @property
    def is_readable(self) -> bool:
        """Whether VTK's data are the real lines at this moment."""
        return self._connection.is_readable

    def _readable_points(self) -> int | None:
        """Return how many points the real lines have; None where there are none, as of volumes."""
        return None

    def _selects_lines(self) -> bool:
        """Whether VTK's selection finds lines instead of the actor."""
        return False

    def _readable_data(self, budget: int, *, colours: bool, segments: bool) -> vtkPolyData:
        """Return the real lines, with no more points than that."""
        raise NotImplementedError

    def _readable_near(self, ray: Any, budget: int) -> vtkPolyData | None:  # noqa: ARG002 - of fiblets
        """Return the lines near to a picker's ray; None for all, which are few enough."""
        return None

    def _wrapped(self, data: vtkPolyData) -> vtkPolyData:
        """Return data as users of the mapper know such."""
        return data

    def _within_cuts(self, lines: LineData) -> LineData:
        """Return lines without what clipping planes and regions cut away."""
        planes, region = self._cuts()
        if region is None and not len(planes):
            return lines
        model = np.eye(4) if self.actor is None else to_array(self.actor.GetMatrix())
        region = None if region is None else region.moved(np.linalg.inv(model))
        planes = planes @ model

        def contains(points: Any) -> Any:
            inside = (points @ planes[:, :3].T + planes[:, 3] >= 0.0).all(axis=1)
            return inside if region is None else inside & region.contains(points)

        return lines.inside(contains)

    # What it drew

    @property
    def _address(self) -> str:
        """Key of the mapper in windows."""
        return self.GetAddressAsString("")

    @property
    def pipeline_in_use(self) -> str | None:
        """Name of the pipeline that drew the last picture; None before the first."""
        return next((getattr(renderer, "pipeline", None) for renderer in self._renderers()), None)

    @property
    def share(self) -> float | None:
        """Least share of the streamlines that a window draws: 1.0 but for ``fit='sample'``; None before the first."""
        return min((getattr(renderer, "share", 1.0) for renderer in self._renderers()), default=None)

    def _renderers(self) -> list[Any]:
        """Return the engine's renderers of all windows."""
        slots = [context.slots[self._address] for context in contexts_with(self)]
        return [slot.renderer for slot in slots if slot.renderer is not None]

    def explain(self) -> dict[str, Any]:
        """Return the ``features`` and ``textures`` (name, bytes) of the resolve, and the engine's work per window."""
        windows, textures = [], []
        for context in contexts_with(self):
            slot = context.slots[self._address]
            if slot.renderer is not None and context.alive:
                context.window.MakeCurrent()
                with context.foreign():
                    windows.append(slot.renderer.explain())
                    for share, thinned in slot.thinned.items():
                        size = 0 if thinned is None else sum(one["bytes"] for one in thinned.explain()["buffers"])
                        windows[-1]["buffers"].append({"name": f"{share:.3g} of the streamlines", "bytes": size})
                    for _, kept in slot.effects.values():
                        if hasattr(kept, "explain"):
                            costs = kept.explain()
                            windows[-1]["passes"] += costs["passes"]
                            windows[-1]["features"] = sorted({*windows[-1]["features"], *costs.get("features", ())})
                            textures += costs["buffers"]
            textures += [
                {"name": name, "bytes": texture.width * texture.height * texture.components}
                for name, texture in slot.textures.items()
            ]
        return {"features": sorted(self.features), "textures": textures, "windows": windows}

    # Memory

    def release(self, window: vtkRenderWindow | None = None) -> None:
        """Delete the GL objects of one window, or of all; twice is harmless."""
        # Call it before a window is closed, to have the memory back at once.
        address = None if window is None else window.GetAddressAsString("")
        for context in contexts_with(self):
            if address in (None, context.address):
                context.release(self)


def shows_engine(renderer: vtkRenderer) -> bool:
    """Return True if a renderer has an actor that an engine draws."""
    actors = [actor for prop in items_of(renderer.GetViewProps()) for actor in actors_in(prop)]
    return any(isinstance(actor.GetMapper(), EngineMapper) for actor in actors)


class CutMapper(EngineMapper[AnyOptions]):
    """Mapper of what a region can cut."""

    _region: Any = None

    @property
    def region(self) -> Any:
        """`pvfiblets.regions.Region` in world mm that clips the drawing; None for none."""
        return self._region

    @region.setter
    def region(self, region: Any) -> None:
        self._region = region
        self._link.modified()

    def _cuts(self, renderer: vtkRenderer | None = None) -> tuple[Any, Any]:
        """Return planes, VTK's own and what of the region is planes as far as there is room, and the rest of it."""
        planes, region = super()._cuts(renderer)
        if self._region is None:
            return planes, region
        from pvfiblets.engine.regions.clip_planes import planes_of

        more, region = planes_of(self._region, max(MAX_CLIP_PLANES - len(planes), 0))
        return np.concatenate([planes, more]), region


class FilteredMapper(CutMapper[AnyOptions]):
    """Mapper of lines of which some can be left out."""

    COPIED = (*CutMapper.COPIED, "_filtering")

    _filtering: Any = None

    @property
    def filtering(self) -> Any:
        """What the engine's ``filtering`` says of the visible lines; None for all."""
        return self._filtering

    @filtering.setter
    def filtering(self, wanted: Any) -> None:
        self._filtering = wanted
        self._link.modified()

    def _engine(self, context: WindowContext, slot: Slot) -> Any:
        before = slot.renderer
        engine = super()._engine(context, slot)
        if engine is not before:
            slot.versions.pop("filtering", None)
        if slot.versions.get("filtering") is not self._filtering:
            engine.filtering = slot.versions["filtering"] = self._filtering
        return engine


# Functions, since bound methods would keep the mapper alive for ever.


@calldata_type(VTK_OBJECT)
def _update_shader(mapper: EngineMapper[Any], _event: str, program: Any) -> None:
    mapper._update(program)  # noqa: SLF001


def _begin(mapper: EngineMapper[Any], _event: str) -> None:
    make_current_again(mapper)
    mapper._begin()  # noqa: SLF001


def _connections_changed(mapper: EngineMapper[Any], _event: str) -> None:
    mapper._connection.changed()  # noqa: SLF001


_OBSERVERS = {
    vtkCommand.UpdateShaderEvent: _update_shader,
    vtkCommand.StartEvent: _begin,
    vtkCommand.ModifiedEvent: _connections_changed,
}
