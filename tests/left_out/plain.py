"""What the plain scenes are made of, as a whole."""

from .what import What

PLAIN = {
    "plain": What(
        ran="""
            fiblets/compute/clear.comp, fiblets/compute/cull.comp,
            fiblets/compute/depth.comp, fiblets/compute/resolve_owner.comp, fiblets/compute/plan.comp,
            fiblets/compute/resolve_ties.comp
        """,
        features="CLIPPING, CLIPPING_DEPTH, DIRECTION, ONE_CLASS",
        resolve="colour_orientation, gbuffer, line_light, normal",
        passes="clear, cull, depth, resolve_owner, resolve_ties, visible",
        buffers="anchors, bounds, chunk, codes, coding, decoding, frame, gbuffer, visibility_bits, pages, rotations",
        modules="codec.files.fiblets_file, engine.fiblets.renderer, plotting.fiblets.actor, plotting.fiblets.component",
    ),
    "spline tubes": What(
        ran="screen/near.vert, tubes/attributes.frag, tubes/rectangles.vert, tubes/tube.frag",
        features="TUBE_ILLINOIS, TUBES",
        resolve="colour_solid, gbuffer, normal, tube_normal",
        passes="attributes, clear, tubes",
        buffers="frame, gbuffer, indices, nodes, segments, splines, tubes",
        modules="engine.tubes.renderer, plotting.tubes.actor, plotting.tubes.component",
    ),
    "halo lines": What(
        ran="halos/attributes.frag, halos/halo.frag, halos/strips.vert, screen/near.vert",
        resolve="colour_solid, gbuffer, normal, strip",
        passes="attributes, clear, strips",
        buffers="frame, gbuffer, halos, indices, masks, offsets, places",
        modules="engine.halos.renderer, plotting.halos.actors, plotting.halos.component",
    ),
    "volume: mip": What(
        ran="volumes/cast.frag, screen/triangle.vert",
        features="VOLUME_CELLS",
        resolve="colour_point_scalar, point_value, gbuffer, normal",
        passes="rays",
        buffers="colour_table, gbuffer, nodes, rays, voxels",
        modules="engine.volumes.renderer, plotting.volumes.actor, plotting.volumes.component, volumes.sources",
    ),
}
