"""Regions as plain values: what browsers send, sessions hold and scripts are written from.

A *shape* is one of::

    {"kind": "plane", "normal": [x, y, z], "origin": [x, y, z]}
    {"kind": "slab", "normal": [x, y, z], "origin": [x, y, z], "thickness": mm}
    {"kind": "box", "bounds": [xmin, xmax, ymin, ymax, zmin, zmax]}
    {"kind": "sphere", "center": [x, y, z], "radius": mm}
    {"kind": "mesh", "path": "lesion.ply"}      (of a file of VTK that names no space, "space": "RAS" | "LPS")
    {"kind": "labels", "path": "atlas.nii.gz", "labels": [12, 17]}      (without labels: all that are not 0)

A *condition* on streamlines is ``{"how": how, "region": shape}`` with one of `HOWS`, or
``{"op": "and" | "or" | "not", "of": [conditions]}``. All positions are mm. The shape of a condition may have a
``"name"``: layers with one of the same name share it. ``passes`` and ``stays_in`` may have ``"sampling": "points"``:
only a streamline's points are tested.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from pvfiblets.web.values import mapping, number, numbers, shown, text, whole

if TYPE_CHECKING:
    from pvfiblets.query.selection.predicates import Predicate
    from pvfiblets.regions import Region

    Load = Callable[[Mapping[str, Any]], Any]  # from a shape of the kind `"mesh"` or `"labels"` to data

__all__ = [
    "CUTTING", "HOWS", "SAMPLED", "SHAPES", "check_condition", "check_shape", "condition_code", "make_predicate",
    "make_region", "mesh_code", "planes_of", "shape_code", "shapes_in",
]  # fmt: skip

SHAPES = ("plane", "slab", "box", "sphere", "mesh", "labels")
CUTTING = ("plane", "slab", "box", "sphere", "mesh")  # shapes that can cut

HOWS = {"passes": "pass through", "ends_in": "end in", "both_ends_in": "have both ends in", "stays_in": "stay in"}
"""Relations of streamlines to a region."""

SAMPLED = ("passes", "stays_in")  # relations for which places between points count

DEEPEST, MOST = 8, 32  # of a condition


def check_shape(value: Any, name: str = "shape", kinds: tuple[str, ...] = SHAPES) -> dict[str, Any]:
    """Return a shape with its numbers checked."""
    kind = value.get("kind") if isinstance(value, Mapping) else None
    if kind not in kinds:
        raise ValueError(f"the kind of {name} is {shown(kind)}; choose one of {', '.join(kinds)}")
    if kind == "plane":
        mapping(value, name, ("kind", "normal", "origin"))
        return {"kind": kind, "normal": _direction(value["normal"], name), "origin": _point(value["origin"], name)}
    if kind == "slab":
        mapping(value, name, ("kind", "normal", "origin", "thickness"))
        return {
            "kind": kind,
            "normal": _direction(value["normal"], name),
            "origin": _point(value["origin"], name),
            "thickness": _length(value["thickness"], f"{name}'s thickness"),
        }
    if kind == "box":
        mapping(value, name, ("kind", "bounds"))
        bounds = numbers(value["bounds"], f"{name}'s bounds", 6)
        if any(bounds[k] >= bounds[k + 1] for k in (0, 2, 4)):
            raise ValueError(f"{name}'s bounds are {bounds}; give xmin < xmax, ymin < ymax, zmin < zmax")
        return {"kind": kind, "bounds": bounds}
    if kind == "sphere":
        mapping(value, name, ("kind", "center", "radius"))
        radius = _length(value["radius"], f"{name}'s radius")
        return {"kind": kind, "center": numbers(value["center"], f"{name}'s center", 3), "radius": radius}
    if kind == "mesh":
        mapping(value, name, ("kind", "path"), ("space",))
        space = {key: part for key, part in value.items() if key == "space"}
        if space and space["space"] not in ("RAS", "LPS"):
            raise ValueError(f"space of {name} is {shown(space['space'])}; choose RAS or LPS")
        return {"kind": kind, "path": text(value["path"], f"{name}'s path", 4096), **space}
    mapping(value, name, ("kind", "path"), ("labels",))
    labels = value.get("labels")
    if labels is not None:
        given = numbers(labels, f"{name}'s labels", most=4096)
        labels = [whole(label, f"{name}'s labels", -(2**31), 2**31) for label in given]
        labels = [int(label) for label in labels]
    return {"kind": kind, "path": text(value["path"], f"{name}'s path", 4096), "labels": labels}


def check_condition(value: Any, name: str = "regions") -> dict[str, Any]:
    """Return a condition with all its shapes checked; errors as of :func:`check_shape`."""
    found = _checked(value, name, 1)
    if (count := sum(1 for _ in shapes_in(found))) > MOST:
        raise ValueError(f"{name} are {count} shapes; {MOST} at most")
    return found


def _checked(value: Any, name: str, depth: int) -> dict[str, Any]:
    if depth > DEEPEST:
        raise ValueError(f"{name} are nested more than {DEEPEST} deep; write them flatter")
    if isinstance(value, Mapping) and "op" in value:
        mapping(value, name, ("op", "of"))
        op, parts = value["op"], value["of"]
        if op not in ("and", "or", "not"):
            raise ValueError(f"op of {name} is {shown(op)}; choose one of and, or, not")
        most = 1 if op == "not" else MOST
        if not isinstance(parts, (list, tuple)) or not 1 <= len(parts) <= most:
            raise ValueError(f"{op!r} of {name} joins {shown(parts)}; give a list of 1 to {most} conditions")
        return {"op": op, "of": [_checked(part, name, depth + 1) for part in parts]}
    mapping(value, name, ("how", "region"), ("sampling",))
    if value["how"] not in tuple(HOWS):
        raise ValueError(f"how of {name} is {shown(value['how'])}; choose one of {', '.join(HOWS)}")
    region = value["region"]
    if not isinstance(region, Mapping) or "name" not in region:
        found = check_shape(region, name)
    else:
        found = check_shape({key: part for key, part in region.items() if key != "name"}, name)
        found["name"] = text(region["name"], f"{name}'s name", 40)
    return {"how": value["how"], "region": found, **_sampling(value, name)}


def _sampling(condition: Mapping[str, Any], name: str) -> dict[str, str]:
    """The sampling of a condition, if it is another than that of all others."""
    sampling = condition.get("sampling", "lines")
    if sampling not in ("lines", "points"):
        raise ValueError(f"the sampling of {name} is {shown(sampling)}; choose lines or points")
    if sampling == "lines":
        return {}
    if condition["how"] not in SAMPLED:
        raise ValueError(f"{name} say {condition['how']} with sampling=points; ends are points: leave sampling out")
    return {"sampling": sampling}


def shapes_in(condition: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    """Yield the shapes of a condition that was checked."""
    if "op" in condition:
        for part in condition["of"]:
            yield from shapes_in(part)
    else:
        yield condition["region"]


def make_region(shape: Mapping[str, Any], load: Load) -> Region:
    """Return the region of a shape that was checked."""
    from pvfiblets import regions
    from pvfiblets.plotting.filtering.region_sources import as_region

    kind = shape["kind"]
    if kind == "plane":
        return regions.Plane(shape["normal"], shape["origin"])
    if kind == "slab":
        return regions.Slab(shape["normal"], shape["origin"], shape["thickness"])
    if kind == "box":
        return regions.Box(shape["bounds"])
    if kind == "sphere":
        return regions.Sphere(shape["center"], shape["radius"])
    if kind == "mesh":
        return as_region(load(shape))
    region = as_region(load(shape))
    if shape["labels"] is None:
        return region
    values, affine = label_array(load(shape))
    return regions.Labels(values, affine, labels=shape["labels"])


def label_array(image: Any) -> tuple[Any, Any]:
    """Return an image of labels as whole numbers and the matrix that places them."""
    return image.labels, image.affine


def planes_of(shape: Mapping[str, Any], inside: bool) -> list[tuple[list[float], list[float]]] | None:
    """Return normals, which point to what stays, and origins of the planes that cut the same; None if none do."""
    kind = shape["kind"]
    if kind == "plane":
        side = 1.0 if inside else -1.0
        return [([side * part for part in shape["normal"]], shape["origin"])]
    if not inside:
        return None
    if kind == "slab":
        length = sum(part * part for part in shape["normal"]) ** 0.5
        unit = [part / length for part in shape["normal"]]
        reach = 0.5 * shape["thickness"]
        return [
            ([side * u for u in unit], [o - side * reach * u for o, u in zip(shape["origin"], unit, strict=True)])
            for side in (1.0, -1.0)
        ]
    if kind == "box":
        found = []
        for face, bound in enumerate(shape["bounds"]):
            normal, origin = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
            normal[face // 2] = 1.0 if face % 2 == 0 else -1.0
            origin[face // 2] = bound
            found.append((normal, origin))
        return found
    return None


def make_predicate(condition: Mapping[str, Any], load: Load) -> Predicate:
    """Return what a condition that was checked asks of streamlines; errors as of :func:`make_region`."""
    from pvfiblets import regions

    if "op" not in condition:
        region = make_region(condition["region"], load)
        if condition["how"] == "both_ends_in":
            return regions.ends_in(region, "both")
        if condition["how"] == "ends_in":
            return regions.ends_in(region)
        question = regions.passes if condition["how"] == "passes" else regions.stays_in
        return question(region, sampling=condition.get("sampling", "lines"))
    parts = [make_predicate(part, load) for part in condition["of"]]
    if condition["op"] == "not":
        return ~parts[0]
    found = parts[0]
    for part in parts[1:]:
        found = found & part if condition["op"] == "and" else found | part
    return found


# As Python ------------------------------------------------------------------------------------------


def shape_code(shape: Mapping[str, Any], file: Callable[[str], str]) -> str:
    """Return Python that makes the same region; ``file`` gives the Python of a path."""
    kind = shape["kind"]
    if kind == "plane":
        return f"regions.Plane({shape['normal']}, {shape['origin']})"
    if kind == "slab":
        return f"regions.Slab({shape['normal']}, {shape['origin']}, {shape['thickness']})"
    if kind == "box":
        return f"regions.Box({shape['bounds']})"
    if kind == "sphere":
        return f"regions.Sphere({shape['center']}, {shape['radius']})"
    if kind == "mesh":
        return f"as_region({mesh_code(shape['path'], file, shape.get('space'))})"
    if shape["labels"] is None:
        return f"as_region({file(shape['path'])})"
    return f"labels_of({file(shape['path'])}, {shape['labels']})"


def mesh_code(path: str, file: Callable[[str], str], space: str | None = None) -> str:
    """Return Python that reads a surface."""
    return f"read_mesh({file(path)}{'' if space is None else f', space={space!r}'})"


def condition_code(condition: Mapping[str, Any], file: Callable[[str], str]) -> str:
    """Return Python that makes the same condition; see :func:`shape_code`."""
    if "op" not in condition:
        region = shape_code(condition["region"], file)
        if condition["how"] == "both_ends_in":
            return f"regions.ends_in({region}, 'both')"
        sampling = ", sampling='points'" if "sampling" in condition else ""
        return f"regions.{condition['how']}({region}{sampling})"
    parts = [condition_code(part, file) for part in condition["of"]]
    if condition["op"] == "not":
        return f"~{parts[0]}"
    return f"({(' & ' if condition['op'] == 'and' else ' | ').join(parts)})"


# Inside ---------------------------------------------------------------------------------------------


def _point(value: Any, name: str) -> list[float]:
    return numbers(value, f"{name}'s origin", 3)


def _direction(value: Any, name: str) -> list[float]:
    found = numbers(value, f"{name}'s normal", 3)
    largest = max(map(abs, found))
    if not 1e-12 <= largest <= 1e12:
        raise ValueError(f"{name}'s normal is {found}; give a direction that is not 0")
    return found


def _length(value: Any, name: str) -> float:
    return number(value, name, 1e-9, 1e9, unit=" of mm")
