"""Surfaces and slices of images of a plotter, as a page has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from pvfiblets.mappers.frames.scene import to_array, world_planes
from pvfiblets.mappers.line_data import COLOURS
from pvfiblets.page.scene import PageScene, encoded

if TYPE_CHECKING:
    from pvfiblets.mappers.tubes import TubeMapper

_FLAT = 0  # VTK_FLAT


def reflects_of(prop: Any) -> tuple[tuple[float, float, float, float], tuple[float, float, float]]:
    """Return what a property reflects: ambient, diffuse, specular and its power; and the colour of highlights."""
    red, green, blue = prop.GetSpecularColor()
    reflects = prop.GetAmbient(), prop.GetDiffuse(), prop.GetSpecular(), max(prop.GetSpecularPower(), 1e-3)
    return reflects, (red, green, blue)


def add_surface(scene: PageScene, name: str, actor: Any, mapper: Any, *, smooth: bool = False) -> bool:
    """Show the triangles of an actor in the colours that its mapper gives them; say whether it has any."""
    mapper.Update()
    found = pv.wrap(mapper.GetInputDataObject(0, 0))
    prop = actor.GetProperty()
    if not isinstance(found, pv.DataSet) or not found.n_cells or prop.GetRepresentation() != 2:
        return False
    surface = found.copy(deep=False)
    shade, values = _colours_of(mapper, surface), _values_of(mapper, surface)
    if values is not None:
        surface.point_data["_values"] = values
    elif shade is not None:
        (surface.point_data if len(shade) == surface.n_points else surface.cell_data)["_page"] = shade
    if not isinstance(surface, pv.PolyData):
        surface = surface.extract_surface(algorithm=None)
    outlined, surface = surface, surface.triangulate()
    triangles = surface.regular_faces if surface.n_cells and surface.is_all_triangles else np.zeros((0, 3), int)
    if not len(triangles):
        return False
    by_cell = "_page" in surface.cell_data
    edges = _edges(prop, outlined, triangles) if prop.GetEdgeVisibility() else None
    # Triangles get corners of their own where they have colours or edges of their own.
    corners = triangles.ravel() if by_cell or edges is not None else slice(None)
    points, colours = np.asarray(surface.points, np.float32)[corners], None
    smooth = smooth or prop.GetInterpolation() != _FLAT
    normals = surface.point_data.get("Normals") if smooth else None
    if by_cell:
        colours = np.repeat(np.asarray(surface.cell_data["_page"])[: len(triangles)], 3, axis=0)
    elif "_page" in surface.point_data:
        colours = np.asarray(surface.point_data["_page"])[corners]
    if not isinstance(corners, slice):
        triangles = np.arange(len(points)).reshape(-1, 3)
    matrix = to_array(actor.GetMatrix())
    reflects, sheen = reflects_of(prop)
    red, green, blue = prop.GetColor()
    bounds = tuple(float(v) for v in actor.GetBounds())
    layer: dict[str, Any] = {
        "kind": "surface",
        "name": "surface" if "Addr=" in name else name,
        "visible": True,
        "places": scene.add_blob(points),
        "triangles": scene.add_blob(triangles.astype(np.uint32)),
        "colour": (red, green, blue),
        "opacity": prop.GetOpacity(),
        "lighting": bool(prop.GetLighting()),
        "reflects": reflects,
        "sheen": sheen,
        "bounds": bounds,
    }
    if edges is not None:
        layer["edges"] = edges | {"sides": scene.add_blob(np.repeat(edges["sides"], 3))}
    culled = {"front": prop.GetFrontfaceCulling(), "back": prop.GetBackfaceCulling()}
    if any(culled.values()):
        layer["culled"] = [side for side, on in culled.items() if on]
    if normals is not None:
        layer["normals"] = scene.add_blob(np.asarray(normals, np.float32)[corners])
    if "_values" in surface.point_data:
        table = mapper.GetLookupTable()
        layer["values"] = scene.add_blob(np.asarray(surface.point_data["_values"], np.float32)[corners])
        layer |= {"table": encoded(_table(table)), "clim": tuple(table.GetTableRange()), "log": table.GetScale() == 1}
        _add_bar(scene, mapper)
    elif colours is not None:
        layer["colours"] = scene.add_blob(np.ascontiguousarray(colours, np.uint8))
        _add_bar(scene, mapper)
    if not np.array_equal(matrix, np.eye(4)):
        layer["matrix"] = matrix.T.ravel().tolist()
    planes = world_planes(mapper)
    if len(planes):
        layer["planes"] = planes.tolist()
    scene.add_layer(layer, bounds)
    return True


def add_tubes(scene: PageScene, name: str, actor: Any, mapper: TubeMapper) -> None:
    """Show the surfaces around spline tubes, if they are not all filtered out or cut away."""
    found = pv.wrap(mapper.reading.data(colours=True))
    if not found.n_cells:
        return
    surface = found.copy(deep=False)
    # VTK names those of tubes otherwise, and drops them where balls are added.
    normals = surface.point_data.active_normals
    surface.point_data["Normals"] = surface.point_normals if normals is None else normals
    shown = pv.DataSetMapper(surface)
    shown.scalar_visibility = COLOURS in surface.point_data  # else radii would be colours
    add_surface(scene, name, actor, shown, smooth=True)


def _edges(prop: Any, surface: pv.PolyData, triangles: np.ndarray) -> dict[str, Any]:
    """Return how edges look, and of each triangle a bit for each side that has one, opposite the same corner."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    sides = np.full(len(triangles), 7, np.uint8)
    if not surface.is_all_triangles and not surface.n_strips:  # edges within a polygon are not drawn

        def keys(a: np.ndarray, b: np.ndarray) -> np.ndarray:
            return np.minimum(a, b).astype(np.int64) * surface.n_points + np.maximum(a, b)

        offsets, at = (np.asarray(vtk_to_numpy(array), np.int64) for array in (
            surface.GetPolys().GetOffsetsArray(), surface.GetPolys().GetConnectivityArray()
        ))  # fmt: skip
        some = np.diff(offsets) > 0
        after = np.arange(1, len(at) + 1)
        after[offsets[1:][some] - 1] = offsets[:-1][some]
        a, b, c = triangles.T
        has = np.isin(np.stack([keys(b, c), keys(c, a), keys(a, b)], axis=1), keys(at, at[after]))
        sides = (has @ np.array([1, 2, 4])).astype(np.uint8)
    width = prop.GetLineWidth() if prop.GetUseLineWidthForEdgeThickness() else prop.GetEdgeWidth()
    return {"sides": sides, "colour": (*prop.GetEdgeColor(), prop.GetEdgeOpacity()), "width": width}


def _colours_of(mapper: Any, data: Any) -> np.ndarray | None:
    """Return RGBA of points or of cells, as the mapper's table has it; None where the property's colour counts."""
    if not mapper.GetScalarVisibility():
        return None
    # Of values at points VTK interpolates the values or the colours; from vertex to vertex both are the same.
    before = mapper.GetInterpolateScalarsBeforeMapping()
    mapper.SetInterpolateScalarsBeforeMapping(False)
    try:
        from vtkmodules.vtkCommonCore import mutable

        mapped = mapper.MapScalars(data, 1.0, mutable(0))
    finally:
        mapper.SetInterpolateScalarsBeforeMapping(before)
    if mapped is None:
        return None
    colours = pv.convert_array(mapped)
    colours = np.asarray(colours).reshape(mapped.GetNumberOfTuples(), mapped.GetNumberOfComponents())
    if len(colours) not in (data.n_points, data.n_cells) or colours.shape[1] < 3:
        return None
    full = np.full((len(colours), 4), 255, np.uint8)
    full[:, : colours.shape[1]] = colours
    return full


def _values_of(mapper: Any, data: Any) -> np.ndarray | None:
    """Return values of points where VTK interpolates values, not colours; None elsewhere."""
    name, table = mapper.GetArrayName(), mapper.GetLookupTable()
    if not (mapper.GetScalarVisibility() and mapper.GetInterpolateScalarsBeforeMapping() and name in data.point_data):
        return None
    values = np.asarray(data.point_data[name])
    direct = mapper.GetColorMode() == 2 or (mapper.GetColorMode() == 0 and values.dtype == np.uint8)
    return values if values.ndim == 1 and not direct and hasattr(table, "GetTable") else None


def _table(table: Any) -> np.ndarray:
    """Return the entries of a table, then its colours for values below, above, and NaN."""
    entries = np.asarray(pv.convert_array(table.GetTable())).reshape(-1, 4)
    below = _bytes(table.GetBelowRangeColor()) if table.GetUseBelowRangeColor() else entries[0]
    above = _bytes(table.GetAboveRangeColor()) if table.GetUseAboveRangeColor() else entries[-1]
    return np.concatenate([entries, [below, above, _bytes(table.GetNanColor())]]).astype(np.uint8)


def _bytes(colour: Any) -> np.ndarray:
    return np.rint(np.asarray(colour) * 255.0).astype(np.uint8)


def _add_bar(scene: PageScene, mapper: Any) -> None:
    table, name = mapper.GetLookupTable(), mapper.GetArrayName()
    if table is None or not hasattr(table, "GetTable") or not name or mapper.GetColorMode() == 2:
        return
    values = np.asarray(pv.convert_array(table.GetTable()))
    low, high = table.GetTableRange()
    if values.ndim == 2 and values.shape[1] == 4 and high > low:
        scene.bars.append({"title": name, "table": encoded(values), "clim": (low, high), "log": table.GetScale() == 1})


def add_image(scene: PageScene, name: str, actor: Any) -> None:
    """Show a slice of an image, which is a textured rectangle."""
    matrix = to_array(actor.GetMatrix())
    corners = np.asarray(pv.wrap(actor.GetMapper().GetInput()).points, float) @ matrix[:3, :3].T + matrix[:3, 3]
    bounds = tuple(float(v) for v in actor.GetBounds())
    pixels = scene.once(("slice", actor, str(actor.shows)), actor.pixels.tobytes)
    height, width = actor.pixels.shape[:2]
    layer = {
        "kind": "image",
        "name": "slice" if "Addr=" in name else name,
        "visible": True,
        "corner": corners[0].tolist(),
        "across": (corners[1] - corners[0]).tolist(),
        "up": (corners[-1] - corners[0]).tolist(),
        "size": (width, height),
        "pixels": scene.add_blob(pixels),
        "smooth": bool(actor.GetTexture().GetInterpolate()),
        "clear": bool(actor.GetForceTranslucent()),
        "opacity": actor.GetProperty().GetOpacity(),
        "bounds": bounds,
    }
    scene.add_layer(layer, bounds)
