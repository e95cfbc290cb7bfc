"""What each scene has more than its plain one or, after a minus, less."""

from __future__ import annotations

from .what import What

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
        features="CLIP_PLANES",
        buffers="clip_planes",
        modules="codec.query.shapes, engine.cut_planes, regions",
    ),
    "clip: planes of VTK": What(
        features="CLIP_PLANES",
        buffers="clip_planes",
    ),
    "clip: box": What(
        features="CLIP_PLANES",
        buffers="clip_planes",
        modules="codec.query.shapes, engine.cut_planes, regions",
    ),
    "clip: plane and ball": What(
        ran="regions/combine.frag",
        features="CLIP_PLANES, CLIP_REGION",
        buffers="clip_planes, region, region shapes",
        modules="""
            codec.query.shapes, engine.cut_planes, engine.cutting, engine.layer_stack, engine.rays, engine.regions,
            engine.surface_layers, regions
        """,
    ),
    "clip: outside a box": What(
        ran="regions/combine.frag",
        features="CLIP_REGION",
        buffers="region, region shapes",
        modules="""
            codec.query.shapes, engine.cut_planes, engine.cutting, engine.layer_stack, engine.rays, engine.regions,
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
            codec.query.surface_kernels, codec.query.surfaces, engine.cut_planes, engine.cutting,
            engine.layer_stack, engine.rays, engine.regions, engine.surface_layers, regions
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
    "volume: gentle light": What(
        features="RAYCAST_LIGHT, RAYCAST_PREINTEGRATED",
        resolve="-colour_point_value, colour_point",
        buffers="-fibletTable, colours, segments",
        packages="numba",
        modules="codec.jit, raycast.preintegration",
    ),
    "volume: light": What(
        features="RAYCAST_FINER, RAYCAST_LIGHT, RAYCAST_PREINTEGRATED",
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
    "volume: no octree": What(
        features="RAYCAST_WHOLE",
        buffers="-nodes",
    ),
    "volume: sparse": What(
        ran="raycast/fill.frag",
        passes="-rays, between, other rays, sparse rays",
        buffers="sparse",
    ),
    "volume: cut by planes": What(
        modules="codec.query.shapes, engine.cut_planes, regions",
    ),
    "volume: cut": What(
        ran="regions/combine.frag",
        features="CLIP_REGION",
        buffers="region",
        modules="""
            codec.query.shapes, engine.cut_planes, engine.cutting, engine.frame, engine.layer_stack, engine.rays,
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
