"""What each scene has more than its plain one or, after a minus, less."""

from dataclasses import replace

from .what import What

# Of how far apart lines lie: some of them are decoded.
MEASURING = "codec.arrays.decode_arrays, codec.decompress, codec.arrays.frame_arrays, codec.small_sets, halos.spacing"

# The hardware's rasteriser in place of compute shaders.
HARDWARE = """
    -fiblets/compute/clear.comp, -fiblets/compute/cull.comp,
    -fiblets/compute/depth.comp, -fiblets/compute/resolve_owner.comp, -fiblets/compute/plan.comp,
    -fiblets/compute/resolve_ties.comp, fiblets/hardware_raster/resolve.frag, fiblets/hardware_raster/resolve.vert,
    fiblets/hardware_raster/survivors.vert
"""
HARDWARE_PASSES = "-cull, -depth, -resolve_owner, -resolve_ties, -visible, draw, resolve"

TUBES = What(
    ran=f"{HARDWARE}, fiblets/geometry/capsules.geom, fiblets/hardware_raster/capsule.frag",
    features="-ONE_CLASS, CROSS_LINE, TEXTURE_DATA, TUBES, WIDE_LINES",
    resolve="-line_light, tube_normal",
    passes=HARDWARE_PASSES,
    buffers="depth of tubes, tubes",
    modules="engine.fiblets.pipelines.geometry",
)

CHANGED = {
    "one colour": What(resolve="-colour_orientation, colour_solid"),
    "colours: per streamline": What(
        resolve="-colour_orientation, -line_light, legend_colours, colour_streamline_rgba", buffers="colour_list"
    ),
    "colours: stored": What(
        features="VALUES_STORED",
        resolve="-colour_orientation, -line_light, legend_colours, colour_point_scalar, point_value",
        buffers="colour_table, values",
    ),
    "colours: arc length": What(
        features="VALUES_ARC_LENGTH",
        resolve="-colour_orientation, -line_light, legend_colours, colour_point_scalar, point_value",
        buffers="colour_table, starts",
        modules="codec.arrays.decode_arrays, codec.decompress, codec.arrays.frame_arrays, codec.small_sets",
    ),
    "colours: curvature": What(
        features="VALUES_STORED",
        resolve="-colour_orientation, -line_light, legend_colours, colour_point_scalar, point_value",
        buffers="colour_table, values",
        packages="numba",
        modules="""
            codec.arrays.decode_arrays, codec.decompress, codec.arrays.frame_arrays, codec.jit, codec.small_sets,
            query.measures.measure_kernels
        """,
    ),
    "colours: volume": What(
        features="VALUES_VOLUME",
        resolve="-colour_orientation, -line_light, legend_colours, colour_point_scalar, point_value",
        buffers="colour_table, volume",
    ),
    "colours: logarithm": What(
        resolve="-colour_orientation, -line_light, legend_colours, colour_streamline_rgba", buffers="colour_list"
    ),
    "wide lines": What(features="WIDE_LINES"),
    "wide lines, shaded": What(features="CROSS_LINE, WIDE_LINES", resolve="-line_light, tube_shading"),
    "ends": What(features="LINE_ENDS, WIDE_LINES"),
    "tubes": TUBES,
    "tubes, shaded": replace(
        TUBES,
        resolve="-line_light, tube_normal, tube_shading",
        buffers="depth of tubes, fibletAcrossMap (blank), tubes",
    ),
    "opacity": What(
        ran="screen/triangle.vert, fiblets/compute/gather.comp, fiblets/gather/slice_keys.frag",
        features="GATHER_SLICES, PAINTED, COLOUR_ORIENTATION, PAINT_LIGHT",
        resolve="layers_covered, layers_geometry, slices, slices_colour, sums",
        passes="gather",
        buffers="fibletSumFloats (none), gathered",
        modules="""
            engine.fiblets.gather.gatherer, engine.fiblets.gather.gathering, engine.fiblets.gather.paint,
            mappers.effects.gathering, mappers.frames.scene_state, mappers.effects.slices
        """,
    ),
    "opacity, the nearest": What(),
    "density": What(
        ran="screen/triangle.vert, fiblets/compute/gather.comp, fiblets/gather/greatest.frag",
        features="GATHER_WORDS, PAINTED, COLOUR_ORIENTATION",
        resolve="-line_light, density, legend_colours, sums",
        passes="gather",
        buffers="fibletSumFloats (none), gathered",
        modules="""
            engine.fiblets.gather.gatherer, engine.fiblets.gather.gathering, engine.fiblets.gather.paint,
            mappers.effects.density, mappers.effects.gathering, mappers.frames.scene_state
        """,
    ),
    "density, by a map": What(
        ran="screen/triangle.vert, fiblets/compute/gather.comp, fiblets/gather/greatest.frag",
        features="GATHER_WORDS",
        resolve="-line_light, -colour_orientation, colour_point_scalar, density_value, legend_colours, sums",
        passes="gather",
        buffers="fibletSumFloats (none), colour_table, gathered",
        modules="""
            engine.fiblets.gather.gatherer, engine.fiblets.gather.gathering, engine.fiblets.gather.paint,
            mappers.effects.density, mappers.effects.gathering, mappers.frames.scene_state
        """,
    ),
    "layers": What(
        ran="screen/triangle.vert, fiblets/layers/copy.frag",
        features="PEEL",
        resolve="layers, layers_covered, layers_geometry",
        buffers="across (no layer), layers, normal (no layer)",
    ),
    "illuminated": What(resolve="-line_light, illuminated"),
    "ambient occlusion": What(
        ran="screen/triangle.vert, effects/ssao.frag, effects/ssao_blur.frag",
        resolve="ambient_occlusion",
        passes="ssao (effect), ssao_blur (effect)",
        buffers="occlusion (effect), rough occlusion (effect)",
        modules=f"{MEASURING}, engine.effects.ambient_occlusion",
    ),
    "depth cue": What(resolve="depth_cue"),
    "halos": What(
        ran="screen/triangle.vert, effects/linear_depth.frag, effects/halo.frag, effects/tile_min_distance.frag",
        resolve="halo",
        passes="halo (effect), linear_depth (effect), tile_min_distance (effect)",
        buffers="distances (effect), halos (effect), tiles (effect)",
        modules=f"{MEASURING}, engine.effects.halos",
    ),
    "ink": What(
        ran="screen/triangle.vert, effects/linear_depth.frag, effects/halo.frag, effects/tile_min_distance.frag",
        resolve="-line_light, halo, ink",
        passes="halo (effect), linear_depth (effect), tile_min_distance (effect)",
        buffers="distances (effect), halos (effect), tiles (effect)",
        modules=f"{MEASURING}, engine.effects.halos",
    ),
    "clip: plane": What(features="CLIP_PLANES", buffers="clip_planes", modules="engine.regions.clip_planes, regions"),
    "clip: planes of VTK": What(features="CLIP_PLANES", buffers="clip_planes"),
    "clip: box": What(features="CLIP_PLANES", buffers="clip_planes", modules="engine.regions.clip_planes, regions"),
    "clip: plane and ball": What(
        ran="screen/triangle.vert, regions/combine.frag",
        features="CLIP_PLANES, CLIP_REGION",
        buffers="clip_planes, region, region shapes",
        modules="engine.regions.ray_intervals, engine.regions.uniform_block, regions",
    ),
    "clip: outside a box": What(
        ran="screen/triangle.vert, regions/combine.frag",
        features="CLIP_REGION",
        buffers="region, region shapes",
        modules="engine.regions.ray_intervals, engine.regions.uniform_block, regions",
    ),
    "clip: mesh": What(
        ran="screen/triangle.vert, regions/combine.frag, regions/inspect.frag, regions/peel.frag, regions/surface.vert",
        features="CLIP_REGION, PEEL, REGION_FIELDS",
        buffers="region, region shapes",
        packages="numba",
        modules="""
            engine.regions.ray_intervals, engine.regions.uniform_block, query.regions.fields,
            query.regions.surface_kernels, query.regions.surfaces, regions
        """,
    ),
    "criterion: per streamline": What(
        features="STREAMLINE_MASK",
        buffers="filter",
        packages="numba",
        modules="codec.arrays.decode_arrays, query.measures.measure_kernels",
    ),
    "criterion: per point": What(
        features="POINT_MASK", buffers="filter", packages="numba", modules="query.selection.bit_kernels"
    ),
    "include": What(
        features="STREAMLINE_MASK",
        buffers="filter, query",
        packages="numba",
        modules="engine.fiblets.region_query, query.selection.passing, regions",
    ),
    "selection": What(resolve="highlight", buffers="fibletChosenMap"),
    "selection as tubes": What(
        ran="screen/near.vert, tubes/attributes.frag, tubes/rectangles.vert, tubes/tube.frag",
        features="TUBE_ILLINOIS, TUBES",
        resolve="highlight",
        buffers="fibletChosenMap",
        modules="""
            codec.arrays.decode_arrays, engine.tubes.renderer, mappers.tubes, plotting.fiblets.selection_overlay,
            tubes.build
        """,
    ),
    "selection outlined": What(
        ran="screen/triangle.vert, effects/selection_mask.frag, effects/outline.frag",
        resolve="highlight, silhouette",
        passes="selection_mask (effect), outline (effect)",
        buffers="chosen pixels (effect), chosen streamlines (effect), fibletChosenMap, outline (effect)",
        modules="engine.effects.halos, engine.effects.outline",
    ),
    "picking": What(),
    "detail": What(features="LEVEL_OF_DETAIL"),
    "culling: none": What(),
    "culling: two-phase": What(
        ran="""
            fiblets/compute/occlude.comp, fiblets/compute/refine.comp, culling/pyramid_reduce.frag,
            screen/triangle.vert
        """,
        features="CULL_PYRAMID",
        passes="predicted, last picture, occlusion, pyramid, refine",
        buffers="occlusion",
        modules="engine.culling.pyramid",
    ),
    "culling: two-phase, clusters": What(
        ran="""
            fiblets/compute/choose_predicted.comp, fiblets/compute/choose_rest.comp, fiblets/compute/clusters.comp,
            fiblets/compute/refine.comp, culling/pyramid_reduce.frag, screen/triangle.vert
        """,
        features="CLUSTERS",
        passes="predicted, last picture, occlusion, pyramid, refine",
        buffers="clusters, occlusion",
        modules="engine.culling.pyramid, engine.fiblets.data.clusters",
    ),
    "culling: coverage": What(
        ran="""
            fiblets/compute/occlude.comp, culling/coverage_dilate.frag, culling/coverage_grid.frag,
            culling/coverage_grid.vert, culling/pyramid_reduce.frag, screen/triangle.vert
        """,
        features="CULL_COVERAGE",
        passes="last picture, occlusion",
        buffers="occlusion",
        modules="engine.culling.coverage",
    ),
    "pipeline: geometry": What(
        ran=f"{HARDWARE}, fiblets/geometry/lines.geom, fiblets/hardware_raster/line.frag",
        features="-ONE_CLASS, TEXTURE_DATA",
        passes=HARDWARE_PASSES,
        buffers="-visibility_bits, depth",
        modules="engine.fiblets.pipelines.geometry",
    ),
    "pipeline: tessellation": What(
        ran=f"""
            {HARDWARE}, fiblets/hardware_raster/line.frag, fiblets/tessellation/decode.tesc,
            fiblets/tessellation/lines.tese
        """,
        features="-ONE_CLASS, TEXTURE_DATA",
        passes=HARDWARE_PASSES,
        buffers="-visibility_bits, depth",
        modules="engine.fiblets.pipelines.tessellation",
    ),
    "picture: depth of field": What(
        ran="""
            effects/picture/blur.frag, effects/picture/copy.frag, effects/picture/gather.frag,
            effects/picture/reach.frag, effects/picture/tiles.frag, screen/triangle.vert
        """,
        features="PICTURE_DEPTH, PICTURE_SAMPLES",
        buffers="picture",
        modules="plotting.picture_component",
    ),
    "picture: refined": What(
        ran="""
            effects/picture/copy.frag, effects/picture/antialias_coverage.frag, effects/picture/line_tiles.frag,
            effects/picture/line_tiles.vert, effects/picture/mean.frag, effects/picture/visible_edges.frag,
            screen/triangle.vert
        """,
        features="EDGES, PICTURE_ALIKE, PICTURE_SAMPLES, WIDE_LINES",
        buffers="coverage, refinement",
        modules="engine.effects.antialias_coverage, mappers.picture.antialias_coverage, plotting.picture_component",
    ),
    "picture: refined, moving": What(
        ran="""
            effects/picture/antialias_coverage.frag, effects/picture/line_tiles.frag, effects/picture/line_tiles.vert,
            effects/picture/visible_edges.frag, screen/triangle.vert
        """,
        features="EDGES, PICTURE_ALIKE, PICTURE_SAMPLES",
        buffers="coverage",
        modules="engine.effects.antialias_coverage, mappers.picture.antialias_coverage, plotting.picture_component",
    ),
    "picture: tone": What(
        ran="screen/triangle.vert, effects/picture/copy.frag, effects/picture/tone.frag",
        features="PICTURE_SAMPLES, TONE_ACES",
        buffers="picture",
        modules="plotting.picture_component",
    ),
    "spline tubes: values": What(
        features="TUBE_VALUES",
        resolve="-colour_solid, colour_point_scalar, point_value",
        buffers="colour_table, values",
    ),
    "spline tubes: colours": What(
        features="TUBE_COLOURS", resolve="-colour_solid, colour_point_rgba", buffers="colours"
    ),
    "spline tubes: solver": What(features="-TUBE_ILLINOIS, TUBE_NEWTON"),
    "spline tubes: planes": What(features="CLIP_PLANES, TUBE_CHAIN", buffers="clip_planes"),
    "spline tubes: region": What(
        ran="screen/triangle.vert, regions/combine.frag",
        features="CLIP_REGION, TUBE_CHAIN",
        buffers="region",
        modules="engine.regions.ray_intervals, regions",
    ),
    "spline tubes: some": What(),
    "halo lines: region": What(
        ran="screen/triangle.vert, regions/combine.frag",
        features="CLIP_REGION",
        buffers="region",
        modules="engine.regions.ray_intervals, regions",
    ),
    "halo lines: some": What(),
    "halo lines: tapered": What(features="HALO_TAPER"),
    "halo lines: cue": What(features="HALO_CUE"),
    "halo lines: bent": What(features="HALO_BENT"),
    "halo lines: filter": What(features="HALO_FILTER", buffers="filters"),
    "halo lines: values": What(
        features="HALO_VALUES",
        resolve="-colour_solid, colour_point_scalar, point_value",
        buffers="colour_table, values",
    ),
    "halo lines: colours": What(features="HALO_COLOURS", resolve="-colour_solid, colour_point_rgba", buffers="colours"),
    "halo points": What(
        ran="-halos/strips.vert, halos/discs.vert",
        features="HALO_POINTS",
        passes="-strips, discs",
        buffers="-masks, -offsets",
    ),
    "halo points: some": What(
        ran="-halos/strips.vert, halos/discs.vert",
        features="HALO_POINTS, HALO_SOME",
        passes="-strips, discs",
        buffers="-offsets",
    ),
    "volume: local mip": What(features="VOLUME_LOCAL"),
    "volume: surface": What(
        features="VOLUME_SURFACE",
        resolve="-colour_point_scalar, -point_value, colour_solid, tube_normal",
        buffers="-colour_table",
    ),
    "volume: closed surface": What(
        features="VOLUME_CLOSED, VOLUME_SURFACE",
        resolve="-colour_point_scalar, -point_value, colour_solid, tube_normal",
        buffers="-colour_table",
    ),
    "volume: gentle light": What(
        features="-VOLUME_CELLS, VOLUME_COMPOSITE, VOLUME_PREINTEGRATED",
        resolve="-colour_point_scalar, -point_value, colour_point_rgba, own_light",
        buffers="-colour_table, colours, segments",
        packages="numba",
        modules="volumes.preintegration, volumes.steepness_kernels",
    ),
    "volume: light": What(
        features="-VOLUME_CELLS, VOLUME_FINER, VOLUME_COMPOSITE, VOLUME_PREINTEGRATED",
        resolve="-colour_point_scalar, -point_value, colour_point_rgba, own_light",
        buffers="-colour_table, colours, segments, allowed_bends",
        packages="numba",
        modules="volumes.preintegration, volumes.steepness_kernels",
    ),
    "volume: dense light": What(
        features="-VOLUME_CELLS, VOLUME_EXACT, VOLUME_FINER, VOLUME_COMPOSITE, VOLUME_PREINTEGRATED",
        resolve="-colour_point_scalar, -point_value, colour_point_rgba, own_light",
        buffers="-colour_table, colours, segments, allowed_bends, media",
        packages="numba",
        modules="volumes.preintegration, volumes.steepness_kernels",
    ),
    "volume: shaded light": What(
        features="-VOLUME_CELLS, VOLUME_SHADED, VOLUME_EXACT, VOLUME_FINER, VOLUME_COMPOSITE, VOLUME_PREINTEGRATED",
        resolve="-colour_point_scalar, -point_value, colour_point_rgba, own_light",
        buffers="-colour_table, colours, segments, allowed_bends, media",
        packages="numba",
        modules="volumes.preintegration, volumes.steepness_kernels, engine.volumes.shading",
    ),
    "volume: translucent surfaces": What(
        features="VOLUME_LAYERS, VOLUME_SHADED, VOLUME_SURFACE",
        resolve="-colour_point_scalar, -point_value, colour_point_rgba, own_light",
        buffers="-colour_table",
        modules="engine.volumes.shading",
    ),
    "volume: minimum": What(features="VOLUME_MINIMUM"),
    "volume: average": What(features="-VOLUME_CELLS, VOLUME_AVERAGE"),
    "volume: nearest": What(features="-VOLUME_CELLS, VOLUME_NEAREST"),
    "volume: tricubic": What(features="-VOLUME_CELLS, VOLUME_TRICUBIC"),
    "volume: jitter": What(features="-VOLUME_CELLS, VOLUME_JITTER"),
    "volume: no octree": What(features="VOLUME_WHOLE", buffers="-nodes"),
    "volume: sparse": What(ran="volumes/fill.frag", passes="-rays, between, other rays, sparse rays", buffers="sparse"),
    "volume: cut by planes": What(modules="engine.regions.clip_planes, regions"),
    "volume: cut": What(
        ran="regions/combine.frag",
        features="CLIP_REGION",
        buffers="region",
        modules="engine.regions.ray_intervals, regions",
    ),
    "volume: ray occlusion": What(
        ran="volumes/ray_occlusion.frag, volumes/ray_occlusion_mean.frag",
        features="VOLUME_SURFACE",
        resolve="-colour_point_scalar, -point_value, colour_solid, ray_occlusion, tube_normal",
        passes="mean ray occlusion (effect), ray occlusion (effect)",
        buffers="-colour_table, mean ray occlusion (effect), ray occlusion (effect)",
        modules="engine.volumes.ray_occlusion, mappers.effects.ray_occlusion",
    ),
}
