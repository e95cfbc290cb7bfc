"""What each scene is made of: the plain ones whole, the others by what they have more or, after a minus, less.

Whoever adds a module, a pass or a buffer says here which scenes ask for it.
"""

from __future__ import annotations

from dataclasses import dataclass

KINDS = ("ran", "features", "resolve", "passes", "buffers", "packages", "modules")


@dataclass(frozen=True)
class What:
    """Names, with commas between.

    Attributes
    ----------
    ran : str
        Shader files of the programs that ran.
    features : str
        Switches of these programs that were on.
    resolve : str
        Pieces in VTK's own shader.
    passes, buffers : str
        As ``explain()`` tells them.
    packages : str
        Of others, that were imported.
    modules : str
        Of this package, that were imported.
    """

    ran: str = ""
    features: str = ""
    resolve: str = ""
    passes: str = ""
    buffers: str = ""
    packages: str = ""
    modules: str = ""

    def names(self, kind: str) -> set[str]:
        """Return the names of one kind."""
        return {" ".join(name.split()) for name in getattr(self, kind).split(",") if name.strip()}


def expected(name: str, kind: str) -> set[str]:
    """Return what a scene has of one kind."""
    if name in PLAIN:
        return PLAIN[name].names(kind)
    changed = CHANGED[name].names(kind)
    less = {part[1:] for part in changed if part.startswith("-")}
    base = PLAIN[plain_of(name)].names(kind)
    assert less <= base, f"{name} cannot lack {sorted(less - base)}"
    return (base - less) | {part for part in changed if not part.startswith("-")}


def plain_of(name: str) -> str:
    """Return the plain scene that a scene is a change of."""
    starts = {"spline tubes": "spline tubes", "halo": "halo lines", "volume": "volume: mip"}
    if name == "halos":
        return "plain"
    return next((plain for start, plain in starts.items() if name.startswith(start)), "plain")


COMPANIONS = {
    "__mp_main__", "_cffi_backend", "cffi", "cython_runtime", "llvmlite", "numpy", "pycparser", "vtkmodules", "yaml",
}  # fmt: skip
"""What comes with numba, NumPy and VTK, which not every machine has all of."""

PLAIN = {
    "plain": What(
        ran="""
            compute/arguments.comp, compute/clear.comp, compute/cull.comp, compute/depth.comp,
            compute/occlude.comp, compute/own.comp, compute/plan.comp, compute/refine.comp, compute/settle.comp,
            culling/reduce.frag, screen/triangle.vert
        """,
        features="CLIPPING, CLIPPING_DEPTH, CULL_PYRAMID, DIRECTION, LEVEL_OF_DETAIL, ONE_SEGMENT",
        resolve="colour_orientation, gbuffer, normal",
        passes="clear, cull, depth, guessed, last picture, occlusion, own, pyramid, refine, seen, settle",
        buffers="""
            anchors, bounds, chunk, codes, coding, decoding, frame, gbuffer, marks, occlusion, pages, rotations
        """,
        modules="""
            codec, codec.archive, codec.capsules, codec.check, codec.decompress, codec.fibletset, codec.layout,
            codec.parameters, codec.places, codec.quantised, codec.query, codec.query.bits, codec.query.measures,
            codec.query.placement, codec.query.predicates, codec.query.region, codec.restrict, codec.storage,
            codec.tables, engine, engine.capabilities, engine.census, engine.chunks, engine.clipping,
            engine.culling, engine.culling.occlusion, engine.culling.pyramid, engine.data_textures, engine.errors,
            engine.filtering, engine.fit, engine.frame, engine.gbuffer, engine.kept, engine.layers, engine.loader,
            engine.measures, engine.opengl, engine.passes, engine.pipelines, engine.pipelines.compute,
            engine.pipelines.constants, engine.pipelines.job, engine.pipelines.limits, engine.renderer,
            engine.reporting, engine.shaders, engine.shared, engine.tubes, engine.upload, engine.values,
            engine.view, engine.volumes, errors, formats, formats.mapped, formats.registry, later, mappers,
            mappers.active, mappers.base, mappers.colouring, mappers.engines, mappers.extras, mappers.highlight,
            mappers.layers, mappers.mapper, mappers.outside, mappers.picking, mappers.proxy, mappers.questions,
            mappers.resolve, mappers.scene, mappers.shading, mappers.tubes, mappers.uniforms, mappers.windows,
            plotting, plotting.actor, plotting.choices, plotting.clipping, plotting.coloured, plotting.colours,
            plotting.component, plotting.cutting, plotting.engines, plotting.filtering, plotting.halo_component,
            plotting.halo_defaults, plotting.halo_point_component, plotting.keeping, plotting.mapper,
            plotting.overlay, plotting.picked, plotting.picking, plotting.pointing, plotting.printing,
            plotting.profiles, plotting.raycast_component, plotting.report, plotting.scalars, plotting.selecting,
            plotting.shading, plotting.slabs, plotting.sources, plotting.spline_component, plotting.transparency,
            plotting.volumes, plotting.widgets, pvfiblets, ragged, streamlines
        """,
    ),
    "spline tubes": What(
        ran="screen/near.vert, splines/attributes.frag, splines/rectangles.vert, splines/tube.frag",
        features="SPLINE_ILLINOIS, TUBES",
        resolve="colour_solid, gbuffer, normal, tube_normal",
        passes="attributes, clear, tubes",
        buffers="frame, gbuffer, indices, nodes, segments, splines, tubes",
        modules="""
            codec, codec.layout, codec.quantised, codec.query, codec.query.measures, codec.query.placement,
            codec.query.predicates, codec.query.region, engine, engine.capabilities, engine.clipping,
            engine.culling, engine.culling.listing, engine.culling.occlusion, engine.culling.pyramid,
            engine.depth_texture, engine.errors, engine.frame, engine.gbuffer, engine.hit_target, engine.lattice,
            engine.layers, engine.loader, engine.opengl, engine.passes, engine.pulling, engine.shaders,
            engine.splines, engine.splines.blocks, engine.splines.choices, engine.splines.inside,
            engine.splines.nodes, engine.splines.renderer, engine.splines.silhouettes, engine.tubes, engine.view,
            engine.volumes, errors, later, mappers, mappers.active, mappers.base, mappers.colouring,
            mappers.engines, mappers.extras, mappers.layers, mappers.outside, mappers.picking, mappers.proxy,
            mappers.questions, mappers.resolve, mappers.scene, mappers.shading, mappers.splines, mappers.tubes,
            mappers.uniforms, mappers.windows, plotting, plotting.choices, plotting.coloured, plotting.colours,
            plotting.component, plotting.cutting, plotting.halo_component, plotting.halo_defaults,
            plotting.halo_point_component, plotting.keeping, plotting.mapper, plotting.overlay, plotting.picked,
            plotting.picking, plotting.pointing, plotting.printing, plotting.raycast_component, plotting.report,
            plotting.scalars, plotting.shading, plotting.slabs, plotting.spline_actor, plotting.spline_component,
            plotting.spline_scalars, plotting.widgets, pvfiblets, ragged, splines, splines.build, splines.curves,
            splines.sources, splines.tangents, splines.tubes, streamlines
        """,
    ),
    "halo lines": What(
        ran="halos/attributes.frag, halos/halo.frag, halos/strips.vert, screen/near.vert",
        resolve="colour_solid, gbuffer, normal, strip",
        passes="attributes, clear, strips",
        buffers="frame, gbuffer, halos, indices, masks, offsets, places",
        modules="""
            codec, codec.layout, codec.quantised, codec.query, codec.query.measures, codec.query.placement,
            codec.query.predicates, codec.query.region, engine, engine.capabilities, engine.clipping,
            engine.culling, engine.culling.listing, engine.culling.occlusion, engine.culling.pyramid,
            engine.depth_texture, engine.errors, engine.frame, engine.gbuffer, engine.halos, engine.halos.blocks,
            engine.halos.renderer, engine.halos.style, engine.halos.vertices, engine.hit_target, engine.lattice,
            engine.layers, engine.loader, engine.opengl, engine.passes, engine.pulling, engine.shaders,
            engine.view, engine.volumes, errors, halos, halos.build, halos.displacement, halos.grid, halos.look,
            halos.neighbours, halos.spacing, halos.things, later, mappers, mappers.active, mappers.base,
            mappers.colouring, mappers.engines, mappers.extras, mappers.halos, mappers.layers, mappers.outside,
            mappers.picking, mappers.proxy, mappers.questions, mappers.resolve, mappers.scene, mappers.shading,
            mappers.tubes, mappers.uniforms, mappers.windows, plotting, plotting.choices, plotting.coloured,
            plotting.colours, plotting.component, plotting.cutting, plotting.halo_actor, plotting.halo_component,
            plotting.halo_defaults, plotting.halo_kinds, plotting.halo_look, plotting.halo_point_component,
            plotting.halo_scalars, plotting.keeping, plotting.mapper, plotting.overlay, plotting.picked,
            plotting.picking, plotting.pointing, plotting.printing, plotting.raycast_component, plotting.report,
            plotting.scalars, plotting.slabs, plotting.spline_component, plotting.widgets, pvfiblets, ragged,
            splines, splines.sources, splines.tubes, streamlines
        """,
    ),
    "volume: mip": What(
        ran="raycast/cast.frag, screen/triangle.vert",
        resolve="colour_point_value, gbuffer, normal",
        passes="rays",
        buffers="fibletTable, gbuffer, nodes, rays, voxels",
        modules="""
            codec, codec.layout, codec.quantised, codec.query, codec.query.measures, codec.query.placement,
            codec.query.predicates, codec.query.region, engine, engine.capabilities, engine.errors,
            engine.gbuffer, engine.layers, engine.loader, engine.opengl, engine.passes, engine.raycast,
            engine.raycast.blocks, engine.raycast.cuts, engine.raycast.nodes, engine.raycast.pictures,
            engine.raycast.renderer, engine.raycast.style, engine.raycast.tables, engine.raycast.textures,
            engine.shaders, engine.view, engine.volumes, errors, later, mappers, mappers.active, mappers.base,
            mappers.colouring, mappers.engines, mappers.extras, mappers.layers, mappers.outside, mappers.picking,
            mappers.proxy, mappers.questions, mappers.ray_occlusion, mappers.raycast, mappers.resolve,
            mappers.scene, mappers.shading, mappers.tubes, mappers.uniforms, mappers.windows, plotting,
            plotting.choices, plotting.clipping, plotting.coloured, plotting.colours, plotting.component,
            plotting.cutting, plotting.halo_component, plotting.halo_defaults, plotting.halo_point_component,
            plotting.keeping, plotting.mapper, plotting.overlay, plotting.picked, plotting.picking,
            plotting.pointing, plotting.printing, plotting.raycast_actor, plotting.raycast_component,
            plotting.raycast_opacity, plotting.raycast_settings, plotting.raycast_shading, plotting.report,
            plotting.scalars, plotting.shading, plotting.slabs, plotting.spline_component, plotting.widgets,
            pvfiblets, raycast, raycast.casting, raycast.coarser, raycast.octree, raycast.smoothing,
            raycast.sources, raycast.steepness, raycast.transfer, raycast.volume
        """,
    ),
}

CHANGED = {
    "one colour": What(
        resolve="-colour_orientation, colour_solid",
    ),
    "colours: per streamline": What(
        resolve="-colour_orientation, colour_streamline",
        buffers="fibletStreamlineColours",
    ),
    "colours: stored": What(
        features="VALUES_STORED",
        resolve="-colour_orientation, colour_point_value",
        buffers="fibletTable, values",
    ),
    "colours: arc length": What(
        features="VALUES_ARC_LENGTH",
        resolve="-colour_orientation, colour_point_value",
        buffers="fibletTable, starts",
        packages="numba",
        modules="codec.capsule_kernels, codec.decode_kernels, codec.jit, codec.kernels, codec.nearest",
    ),
    "colours: curvature": What(
        features="VALUES_CURVATURE",
        resolve="-colour_orientation, colour_point_value",
        buffers="fibletTable, starts",
        packages="numba",
        modules="codec.capsule_kernels, codec.decode_kernels, codec.jit, codec.kernels, codec.nearest",
    ),
    "colours: volume": What(
        features="VALUES_VOLUME",
        resolve="-colour_orientation, colour_point_value",
        buffers="fibletTable, volume",
    ),
    "colours: logarithm": What(
        resolve="-colour_orientation, colour_streamline",
        buffers="fibletStreamlineColours",
    ),
    "wide lines": What(
        features="WIDE_LINES",
    ),
    "wide lines, shaded": What(
        features="ACROSS, WIDE_LINES",
        resolve="tube_shading",
    ),
    "tubes": What(
        ran="""
            -compute/arguments.comp, -compute/clear.comp, -compute/cull.comp, -compute/depth.comp,
            -compute/occlude.comp, -compute/own.comp, -compute/plan.comp, -compute/refine.comp,
            -compute/settle.comp, geometry/capsules.geom, raster/between.frag, raster/capsule.frag,
            raster/seen.frag, raster/seen.vert, raster/survivors.vert
        """,
        features="-CLIPPING_DEPTH, -ONE_SEGMENT, ACROSS, SECOND_ROUND, TEXTURE_DATA, TUBES, WIDE_LINES",
        resolve="tube_normal",
        passes="-cull, -depth, -guessed, -occlusion, -own, -refine, -settle, draw, marks",
        buffers="depth of tubes, marks of tubes, tubes",
        modules="""
            engine.depth_texture, engine.pipelines.geometry, engine.pipelines.raster, engine.pipelines.textured
        """,
    ),
    "tubes, shaded": What(
        ran="""
            -compute/arguments.comp, -compute/clear.comp, -compute/cull.comp, -compute/depth.comp,
            -compute/occlude.comp, -compute/own.comp, -compute/plan.comp, -compute/refine.comp,
            -compute/settle.comp, geometry/capsules.geom, raster/between.frag, raster/capsule.frag,
            raster/seen.frag, raster/seen.vert, raster/survivors.vert
        """,
        features="-CLIPPING_DEPTH, -ONE_SEGMENT, ACROSS, SECOND_ROUND, TEXTURE_DATA, TUBES, WIDE_LINES",
        resolve="tube_normal, tube_shading",
        passes="-cull, -depth, -guessed, -occlusion, -own, -refine, -settle, draw, marks",
        buffers="depth of tubes, fibletAcrossMap (blank), marks of tubes, tubes",
        modules="""
            engine.depth_texture, engine.pipelines.geometry, engine.pipelines.raster, engine.pipelines.textured
        """,
    ),
    "opacity": What(),
    "layers": What(
        ran="layers/copy.frag",
        features="PEEL",
        resolve="layers, layers_covered",
        buffers="across (no layer), layers, normal (no layer)",
    ),
    "illuminated": What(
        resolve="illuminated",
    ),
    "ambient occlusion": What(
        ran="effects/occlusion.frag, effects/smooth.frag",
        resolve="ambient_occlusion",
        passes="occlusion (effect), smooth (effect)",
        buffers="occlusion (effect), rough occlusion (effect)",
        modules="""
            engine.effects, engine.effects.ambient_occlusion, engine.effects.lens, engine.effects.screen
        """,
    ),
    "depth cue": What(
        resolve="depth_cue",
    ),
    "halos": What(
        ran="effects/distance.frag, effects/halo.frag, effects/nearest.frag",
        resolve="halo",
        passes="distance (effect), halo (effect), nearest (effect)",
        buffers="distances (effect), halos (effect), tiles (effect)",
        modules="engine.effects, engine.effects.halos, engine.effects.lens, engine.effects.screen",
    ),
    "ink": What(
        ran="effects/distance.frag, effects/halo.frag, effects/nearest.frag",
        resolve="halo, ink",
        passes="distance (effect), halo (effect), nearest (effect)",
        buffers="distances (effect), halos (effect), tiles (effect)",
        modules="""
            engine.effects, engine.effects.halos, engine.effects.lens, engine.effects.screen
        """,
    ),
    "clip: plane": What(
        ran="regions/combine.frag",
        features="CLIP_REGION",
        buffers="region, region shapes",
        modules="""
            codec.query.shapes, engine.cutting, engine.layer_stack, engine.rays, engine.regions,
            engine.surface_layers, regions
        """,
    ),
    "clip: planes of VTK": What(
        features="CLIP_PLANES",
        buffers="clip_planes",
    ),
    "clip: box": What(
        ran="regions/combine.frag",
        features="CLIP_REGION",
        buffers="region, region shapes",
        modules="""
            codec.query.shapes, engine.cutting, engine.layer_stack, engine.rays, engine.regions,
            engine.surface_layers, regions
        """,
    ),
    "clip: mesh": What(
        ran="regions/combine.frag, regions/inspect.frag, regions/peel.frag, regions/surface.vert",
        features="CLIP_REGION, PEEL, REGION_FIELDS",
        buffers="region, region shapes",
        packages="numba",
        modules="""
            codec.jit, codec.query.field_kernels, codec.query.fields, codec.query.shapes,
            codec.query.surface_kernels, codec.query.surfaces, engine.cutting, engine.layer_stack, engine.rays,
            engine.regions, engine.surface_layers, regions
        """,
    ),
    "criterion: per streamline": What(
        features="STREAMLINE_MASK",
        buffers="filter",
        packages="numba",
        modules="""
            codec.capsule_kernels, codec.decode_kernels, codec.jit, codec.kernels, codec.nearest,
            codec.query.measure_kernels
        """,
    ),
    "criterion: per point": What(
        features="POINT_MASK",
        buffers="filter",
        packages="numba",
        modules="codec.jit, codec.query.bit_kernels",
    ),
    "include": What(
        features="STREAMLINE_MASK",
        buffers="filter, query",
        packages="numba",
        modules="""
            codec.capsule_kernels, codec.jit, codec.query.classify, codec.query.endpoints, codec.query.passing,
            codec.query.passing_kernels, codec.query.shape_kernels, codec.query.shapes, engine.querying,
            engine.regions, regions
        """,
    ),
    "selection": What(
        resolve="highlight",
        buffers="fibletChosenMap",
    ),
    "selection as tubes": What(
        ran="screen/near.vert, splines/attributes.frag, splines/rectangles.vert, splines/tube.frag",
        features="SPLINE_ILLINOIS, TUBES",
        resolve="highlight",
        buffers="fibletChosenMap",
        packages="numba",
        modules="""
            codec.capsule_kernels, codec.decode_kernels, codec.jit, codec.kernels, codec.nearest,
            engine.culling.listing, engine.depth_texture, engine.hit_target, engine.lattice, engine.pulling,
            engine.splines, engine.splines.blocks, engine.splines.choices, engine.splines.inside,
            engine.splines.nodes, engine.splines.renderer, engine.splines.silhouettes, mappers.splines,
            plotting.standout, splines, splines.build, splines.curves, splines.sources, splines.tangents,
            splines.tubes
        """,
    ),
    "selection outlined": What(
        ran="effects/chosen.frag, effects/outline.frag",
        resolve="highlight, silhouette",
        passes="chosen (effect), outline (effect)",
        buffers="chosen pixels (effect), chosen streamlines (effect), fibletChosenMap, outline (effect)",
        modules="""
            engine.effects, engine.effects.halos, engine.effects.lens, engine.effects.outline,
            engine.effects.screen
        """,
    ),
    "picking": What(),
    "culling: none": What(
        ran="-compute/occlude.comp, -compute/refine.comp, -culling/reduce.frag, -screen/triangle.vert",
        features="-CULL_PYRAMID",
        passes="-guessed, -last picture, -occlusion, -pyramid, -refine",
        buffers="-occlusion",
        modules="-engine.culling.pyramid",
    ),
    "culling: coverage": What(
        ran="""
            -compute/refine.comp, culling/coverage_dilate.frag, culling/coverage_grid.frag,
            culling/coverage_grid.vert
        """,
        features="-CULL_PYRAMID, CULL_COVERAGE",
        passes="-guessed, -pyramid, -refine",
        modules="engine.culling.coverage",
    ),
    "pipeline: geometry": What(
        ran="""
            -compute/arguments.comp, -compute/clear.comp, -compute/cull.comp, -compute/depth.comp,
            -compute/occlude.comp, -compute/own.comp, -compute/plan.comp, -compute/refine.comp,
            -compute/settle.comp, geometry/lines.geom, raster/between.frag, raster/line.frag, raster/seen.frag,
            raster/seen.vert, raster/survivors.vert
        """,
        features="-CLIPPING_DEPTH, -ONE_SEGMENT, SECOND_ROUND, TEXTURE_DATA",
        passes="-cull, -depth, -guessed, -occlusion, -own, -refine, -settle, draw, marks",
        buffers="depth",
        modules="""
            engine.depth_texture, engine.pipelines.geometry, engine.pipelines.raster, engine.pipelines.textured
        """,
    ),
    "pipeline: tessellation": What(
        ran="""
            -compute/arguments.comp, -compute/clear.comp, -compute/cull.comp, -compute/depth.comp,
            -compute/occlude.comp, -compute/own.comp, -compute/plan.comp, -compute/refine.comp,
            -compute/settle.comp, raster/between.frag, raster/line.frag, raster/seen.frag, raster/seen.vert,
            raster/survivors.vert, tessellation/decode.tesc, tessellation/lines.tese
        """,
        features="-CLIPPING_DEPTH, -ONE_SEGMENT, SECOND_ROUND, TEXTURE_DATA",
        passes="-cull, -depth, -guessed, -occlusion, -own, -refine, -settle, draw, marks",
        buffers="depth",
        modules="""
            engine.depth_texture, engine.pipelines.raster, engine.pipelines.tessellation,
            engine.pipelines.textured
        """,
    ),
    "picture: depth of field": What(
        ran="""
            effects/picture/blur.frag, effects/picture/copy.frag, effects/picture/gather.frag,
            effects/picture/reach.frag, effects/picture/tiles.frag
        """,
        features="PICTURE_DEPTH, PICTURE_SAMPLES",
        buffers="picture",
        modules="""
            engine.effects, engine.effects.depth_of_field, engine.effects.lens, engine.effects.picture,
            engine.effects.screen, engine.effects.tone, mappers.focusing, mappers.overlays, mappers.picture,
            mappers.tiles, plotting.picture_component
        """,
    ),
    "picture: tone": What(
        ran="effects/picture/copy.frag, effects/picture/tone.frag",
        features="PICTURE_SAMPLES, TONE_ACES",
        buffers="picture",
        modules="""
            engine.effects, engine.effects.depth_of_field, engine.effects.lens, engine.effects.picture,
            engine.effects.screen, engine.effects.tone, mappers.focusing, mappers.overlays, mappers.picture,
            mappers.tiles, plotting.picture_component
        """,
    ),
    "spline tubes: values": What(
        features="SPLINE_VALUES",
        resolve="-colour_solid, colour_point_value",
        buffers="fibletTable, values",
    ),
    "spline tubes: colours": What(
        features="SPLINE_COLOURS",
        resolve="-colour_solid, colour_point",
        buffers="colours",
    ),
    "spline tubes: solver": What(
        features="-SPLINE_ILLINOIS, SPLINE_NEWTON",
    ),
    "spline tubes: planes": What(
        features="CLIP_PLANES, SPLINE_CHAIN",
        buffers="clip_planes",
    ),
    "halo lines: tapered": What(
        features="HALO_TAPER",
    ),
    "halo lines: cue": What(
        features="HALO_CUE",
    ),
    "halo lines: bent": What(
        features="HALO_BENT",
    ),
    "halo lines: filter": What(
        features="HALO_FILTER",
        buffers="filters",
    ),
    "halo lines: values": What(
        features="HALO_VALUES",
        resolve="-colour_solid, colour_point_value",
        buffers="fibletTable, values",
    ),
    "halo lines: colours": What(
        features="HALO_COLOURS",
        resolve="-colour_solid, colour_point",
        buffers="colours",
    ),
    "halo points": What(
        ran="-halos/strips.vert, halos/discs.vert",
        features="HALO_POINTS",
        passes="-strips, discs",
        buffers="-masks, -offsets",
    ),
    "volume: local mip": What(
        features="RAYCAST_LOCAL",
    ),
    "volume: surface": What(
        features="RAYCAST_SURFACE",
        resolve="tube_normal",
    ),
    "volume: light": What(
        features="RAYCAST_LIGHT, RAYCAST_PREINTEGRATED",
        resolve="-colour_point_value, colour_point",
        buffers="-fibletTable, colours, segments",
        packages="numba",
        modules="codec.jit, raycast.preintegration",
    ),
    "volume: nearest": What(
        features="RAYCAST_NEAREST",
    ),
    "volume: tricubic": What(
        features="RAYCAST_TRICUBIC",
    ),
    "volume: jitter": What(
        features="RAYCAST_JITTER",
    ),
    "volume: no octree": What(),
    "volume: sparse": What(
        ran="raycast/fill.frag",
        passes="-rays, between, other rays, sparse rays",
        buffers="sparse",
    ),
    "volume: cut": What(
        ran="regions/combine.frag",
        features="CLIP_REGION",
        buffers="region",
        modules="""
            codec.query.shapes, engine.cutting, engine.frame, engine.layer_stack, engine.rays,
            engine.surface_layers, regions
        """,
    ),
    "volume: ray occlusion": What(
        ran="raycast/occlusion.frag, raycast/occlusion_mean.frag",
        features="RAYCAST_SURFACE",
        resolve="ray_occlusion, tube_normal",
        passes="mean ray occlusion (effect), ray occlusion (effect)",
        buffers="mean ray occlusion (effect), ray occlusion (effect)",
        modules="engine.effects, engine.effects.screen, engine.raycast.occlusion",
    ),
}
