"""What the plain scenes are made of, as a whole."""

from __future__ import annotations

from .what import What

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
