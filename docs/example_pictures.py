"""Makes the pictures of the docs that examples draw: ``python docs/example_pictures.py [PICTURE…]``."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parent / "examples"
DATA = Path(os.environ.get("PVFIBLETS_DATA", HERE.parents[1] / "shared" / "data"))
ARGUMENTS = {"23_tracts_in_their_anatomy": [DATA / "nv_MNI152_2009_template.nii.gz"]}  # after the folder
WIDTH = 1600  # pixels at most: a page is half as wide, on a sharp screen
QUALITY = 88

# Picture of the docs: examples and their names for it, side by side where there are several.
PICTURES: dict[str, tuple[tuple[str, str], ...]] = {
    "brain": (("01_first_picture", "first_picture"), ("03_colours", "colours")),
    "pictures/cut": (("09_cut", "cut"),),
    "pictures/filter": (("10_filter", "filter"),),
    "pictures/selection": (("11_select", "selection"),),
    "pictures/shading": (("12_shading", "shading"),),
    "pictures/more_colours": (("13_more_colours", "more_colours"),),
    "pictures/vessels": (("14_vessels", "vessels"),),
    "pictures/selected_tracts": (("15_selected_tracts", "selected_tracts"),),
    "pictures/furball": (("16_furball", "furball"),),
    "pictures/halo_fibres": (("17_halos_of_fibres", "halos_of_fibres"),),
    "pictures/halo_filtered": (("17_halos_of_fibres", "halos_filtered"),),
    "pictures/halo_air": (("18_halos_of_air", "halos_of_air"),),
    "pictures/halo_stereo": (("18_halos_of_air", "halos_of_air_stereo"),),
    "pictures/halo_scan": (("19_halos_of_a_scan", "halos_of_a_scan"),),
    "pictures/halo_knots": (("20_halos_of_knots", "halos_of_knots"),),
    "pictures/halo_displacement": (("20_halos_of_knots", "displacement_functions"),),
    "pictures/depth_of_field": (("21_depth_of_field", "depth_of_field"),),
    "pictures/volume_angiogram": (("22_angiogram", "angiogram"),),
    "pictures/volume_tracts": (("23_tracts_in_their_anatomy", "tracts_in_their_anatomy"),),
    "pictures/volume_inside": (("24_inside_a_volume", "inside_a_volume"),),
    "pictures/density": (("25_density", "density"),),
    "pictures/workspace": (("26_linked_slices", "slices"),),
    "pictures/bundles": (("27_bundles_and_matrix", "bundles"),),
    "pictures/bundles_numbers": (("27_bundles_and_matrix", "bundles_numbers"),),
    "pictures/connectome": (("29_connectome", "connectome"),),
}


def main() -> None:
    """Run the named examples, and write their pictures."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0] + ".")
    parser.add_argument("picture", nargs="*", metavar="PICTURE", help=", ".join(PICTURES))
    parser.add_argument("--output", type=Path, default=HERE, help="folder")
    options = parser.parse_args()
    if unknown := sorted(set(options.picture) - set(PICTURES)):
        parser.error(f"there is no picture {', '.join(unknown)}; choose among {', '.join(PICTURES)}")
    wanted = {name: PICTURES[name] for name in options.picture or PICTURES}
    environment = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"} | os.environ
    with tempfile.TemporaryDirectory() as home:
        for example in sorted({example for parts in wanted.values() for example, _ in parts}):
            folder = Path(home) / example
            folder.mkdir()
            command = [sys.executable, EXAMPLES / f"{example}.py", folder, *ARGUMENTS.get(example, [])]
            subprocess.run(command, check=True, env=environment)
        for name, parts in wanted.items():
            picture = beside([Image.open(Path(home) / example / f"{drawn}.png") for example, drawn in parts])
            picture.thumbnail((WIDTH, picture.height))
            target = options.output / f"{name}.jpg"
            target.parent.mkdir(parents=True, exist_ok=True)
            picture.save(target, quality=QUALITY, optimize=True)
            print(target)


def beside(pictures: list[Image.Image]) -> Image.Image:
    """Return pictures side by side, as high as the lowest."""
    height = min(picture.height for picture in pictures)
    fitted = [picture.convert("RGB").resize((picture.width * height // picture.height, height)) for picture in pictures]
    whole = Image.new("RGB", (sum(picture.width for picture in fitted), height))
    left = 0
    for picture in fitted:
        whole.paste(picture, (left, 0))
        left += picture.width
    return whole


if __name__ == "__main__":
    main()
