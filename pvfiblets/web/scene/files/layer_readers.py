"""Reading the data of layers: tubes, surfaces, volumes and images of slices, with their descriptions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from pvfiblets import formats
from pvfiblets.formats.registry import UnknownFormatError
from pvfiblets.web.scene.files.file_kinds import MESHES, VOLUMES, VTK_SUFFIXES, read_vtk

if TYPE_CHECKING:
    from pvfiblets.engine.fiblets.data.sampled_volume import VolumeSource

LARGEST_AS_TUBES = 5_000_000  # points


def read_tubes(place: Path) -> tuple[Any, dict[str, Any]]:
    """Return the spline tubes of a file, and its facts; ValueError if it has too many points for them."""
    from pvfiblets.plotting.tubes.sources import as_tubes

    if place.suffix.lower() not in VTK_SUFFIXES:
        points = formats.info(place).get("points")
        if points is not None and points > LARGEST_AS_TUBES:
            raise ValueError(
                f"{place.name} has {points:,} points, more than the {LARGEST_AS_TUBES:,} that spline tubes are made of "
                "here; open it as a tractogram, and give that a tube radius"
            )
    tubes, _, _ = as_tubes(place)
    return tubes, {"tubes": tubes.n_tubes, "segments": tubes.n_segments}


def read_fixels(place: Path) -> tuple[Any, dict[str, Any]] | None:
    """Return the image of a file of a fixel directory of MRtrix's, and its facts; None of any other."""
    from pvfiblets.slices.fixels import sibling_files
    from pvfiblets.web.scene.slices.label_images import facts_of, read_image

    image = read_image(place) if sibling_files(place) else None
    return None if image is None or image.fixels is None else (image, facts_of(image))


def read_several(place: Path) -> tuple[Any, dict[str, Any]] | None:
    """Return a file's image and its facts if its voxels hold several numbers each, which slices can show."""
    from pvfiblets.web.scene.slices.label_images import facts_of, read_image

    if not place.name.lower().endswith(VOLUMES):
        return None
    image = read_image(place)
    return None if image.n_volumes == 1 else (image, facts_of(image))


def read_mesh(place: Path) -> Any:
    """Return the surface in a file; ValueError or UnknownFormatError if there is none."""
    import pyvista as pv

    if not place.name.lower().endswith(MESHES):  # VTK has readers of its own for volumes, which follow other names
        raise UnknownFormatError(f"{place.name}: surfaces are in files of {', '.join(MESHES)}; convert it")
    data = read_vtk(place)
    if isinstance(data, pv.MultiBlock):
        data = data.combine().extract_surface() if data.n_blocks else pv.PolyData()
    if not isinstance(data, pv.PolyData) and hasattr(data, "extract_surface"):
        data = data.extract_surface()
    if not isinstance(data, pv.PolyData) or not data.n_points:
        raise ValueError(f"{place.name}: there is no surface in it")
    return data


def read_colours(place: Path) -> VolumeSource | None:
    """Return a volume to be sampled along lines, from the same numbers as a script's ``scalars=path`` gives."""
    from pvfiblets.images.sources import as_image
    from pvfiblets.plotting.fiblets.sources import as_volume

    return as_volume(as_image(read_vtk(place) if place.name.lower().endswith(VTK_SUFFIXES) else place))


def volume_facts(volume: Any) -> dict[str, Any]:
    """Return the description of a volume, in JSON types or similar."""
    return {
        "voxels": list(volume.shape),
        "spacing_mm": volume.spacing,
        "affine": volume.affine,
        "values": list(volume.value_range),
        "dtype": str(volume.values.dtype),
        "missing": volume.n_missing,
    }
