"""Messages for unsupported arguments of ``add_mesh`` and ``add_volume``: the reason, and the replacement."""

from __future__ import annotations

import pyvista as pv

_FACETS = "lines, tubes, halos and volumes have no facets"
_POINTS = "lines, tubes, halos and volumes are no points"

_WORDS = {
    "backface_params": f"{_FACETS}, and so no backs",
    "component": "give one column as scalars (array[:, 0]); a name maps vectors by their magnitude",
    "copy_mesh": "the data are copied in any case; actor.update(data) updates them",
    "edge_color": _FACETS,
    "edge_opacity": _FACETS,
    "emissive": _POINTS,
    "feature_angle": _FACETS,
    "force_opaque": "give opacity=1",
    "interpolate_before_map": "values of points are interpolated before they are mapped, always",
    "multi_colors": "all is one actor; add parts one by one, or colour by an array of categories",
    "nan_opacity": "give nan_color with an alpha: nan_color=(0.5, 0.5, 0.5, 0.0)",
    "pbr": "set actor.prop.interpolation = 'pbr'",
    "point_shape": _POINTS,
    "point_size": _POINTS,
    "preference": "points have no cells whose arrays could be meant",
    "remove_existing_actor": "name='...' replaces the actor of that name",
    "render_points_as_spheres": _POINTS,
    "show_edges": _FACETS,
    "show_vertices": f"{_FACETS}, and no vertices",
    "silhouette": "set actor.halos = True, which outlines lines",
    "smooth_shading": "lines and tubes are smooth as they are",
    "split_sharp_edges": _FACETS,
    "static": "nothing is uploaded again unless it changes",
    "stitle": "give scalar_bar_args={'title': '...'}",
    "style": _FACETS,
    "texture": "lines and tubes have no texture coordinates; give colours of points as scalars with rgb=True",
    "use_transparency": "give 1 - values as opacity, or 'linear_r' for 'linear'",
}
"""By argument: what to say after "takes no ...". Those of lines, tubes and halos; volumes differ in `_OF_VOLUMES`."""

_RAYS = "rays through values have neither lines nor points"
_OF_VOLUMES = {
    "above_color": "opacity=[..., 0] or thresholds hide values above others",
    "below_color": "opacity=[0, ...] or thresholds hide values below others",
    "component": "give one component as an array: image[..., 0]",
    "copy_mesh": "its voxels are copied to the GPU in any case; actor.update() reads the image anew",
    "emissive": _RAYS,
    "force_opaque": "give mode='isosurface', whose surfaces are opaque",
    "interpolate_before_map": "values between voxels are interpolated before they are mapped; filter says how",
    "line_width": _RAYS,
    "multi_colors": "it is of a MultiBlock, with a map of colours for each block",
    "nan_color": "missing voxels count as the least value",
    "nan_opacity": "missing voxels count as the least value",
    "point_shape": _RAYS,
    "point_size": _RAYS,
    "render_lines_as_tubes": _RAYS,
    "render_points_as_spheres": _RAYS,
    "rgb": "voxels of four numbers of type uint8 are RGBA by themselves",
    "silhouette": "light and surfaces have no outline of their own; depth_cue=True sets them off",
    "smooth_shading": "surfaces are shaded by the gradient of the values, which is smooth",
    "style": "mode says how rays are cast",
    "texture": "rays through values have no texture coordinates; cmap and opacity colour them",
}  # fmt: skip
_OURS = {"colormap": "cmap", "rng": "clim", "scalar": "scalars"}
_OF_TUBES = {
    "categories": "words are categories by themselves; give numbers as words, or n_colors=...",
    "line_width": "radius is theirs, in mm, and min_width the pixels that they take at least",
    "render_lines_as_tubes": "tubes are round as they are",
}
_OF_HALOS = {
    "categories": _OF_TUBES["categories"],
    "render_lines_as_tubes": "strips of lines face the camera; add_spline_tubes draws round ones",
    "line_width": "points have a point_size and a halo_size, in mm",
    "silhouette": "halos are outlines: set halo_color and strip_width",
}
_OF_IMAGES = {"colormap": "give cmap", "rng": "give clim"}
_OF_GRAPHS = {**_OF_IMAGES, "line_width": "radius is that of the strongest edge, in mm"}
_SPECIAL = {
    "add_raycast_volume": _OF_VOLUMES, "add_spline_tubes": _OF_TUBES, "add_halo_lines": _OF_HALOS,
    "add_halo_points": _OF_HALOS, "add_slices": _OF_IMAGES, "add_connectome": _OF_GRAPHS,
}  # fmt: skip
_NO_ACTORS = ("add_slices", "add_connectome")  # they return several actors' owner, to which words of one do not apply


def why_not(add: str, name: str) -> str | None:
    """Return the message for an argument that a method of plotters does not take; None for unknown names."""
    why = _SPECIAL.get(add, {}).get(name)
    if add in _NO_ACTORS:
        return None if why is None else f"{add}() takes no {name}: {why}"
    why = why or _WORDS.get(name)
    if name in _OURS:
        why = f"give {_OURS[name]}"
    if why is None and isinstance(getattr(pv.Property, name, None), property):
        why = f"set it on the actor it returns (actor.prop.{name} = ...)"
    return None if why is None else f"{add}() takes no {name}: {why}"
