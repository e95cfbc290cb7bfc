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
WIDTH = 1600  # pixels at most: a page is half as wide, on a sharp screen
QUALITY = 88

# Picture of the docs: the example, and what it calls it.
PICTURES = {
    "brain": ("03_colours", "colours"),
    "pictures/cut": ("09_cut", "cut"),
    "pictures/filter": ("10_filter", "filter"),
    "pictures/selection": ("11_select", "selection"),
    "pictures/shading": ("12_shading", "shading"),
    "pictures/more_colours": ("13_more_colours", "more_colours"),
    "pictures/vessels": ("14_vessels", "vessels"),
    "pictures/selected_tracts": ("15_selected_tracts", "selected_tracts"),
    "pictures/furball": ("16_furball", "furball"),
    "pictures/halo_fibres": ("17_halos_of_fibres", "halos_of_fibres"),
    "pictures/halo_filtered": ("17_halos_of_fibres", "halos_filtered"),
    "pictures/halo_air": ("18_halos_of_air", "halos_of_air"),
    "pictures/halo_stereo": ("18_halos_of_air", "halos_of_air_stereo"),
    "pictures/halo_scan": ("19_halos_of_a_scan", "halos_of_a_scan"),
    "pictures/halo_knots": ("20_halos_of_knots", "halos_of_knots"),
    "pictures/halo_displacement": ("20_halos_of_knots", "displacement_functions"),
    "pictures/depth_of_field": ("21_depth_of_field", "depth_of_field"),
    "pictures/volume_angiogram": ("22_angiogram", "angiogram"),
    "pictures/volume_tracts": ("23_tracts_in_their_anatomy", "tracts_in_their_anatomy"),
    "pictures/volume_inside": ("24_inside_a_volume", "inside_a_volume"),
    "pictures/density": ("25_density", "density"),
}


def main() -> None:
    """Run the examples that are asked for, and write their pictures."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0] + ".")
    parser.add_argument("picture", nargs="*", choices=[[], *PICTURES], metavar="PICTURE", help=", ".join(PICTURES))
    parser.add_argument("--output", type=Path, default=HERE, help="folder")
    options = parser.parse_args()
    wanted = {name: PICTURES[name] for name in options.picture or PICTURES}
    environment = {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"} | os.environ
    for example in sorted({example for example, _ in wanted.values()}):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, EXAMPLES / f"{example}.py", folder], check=True, env=environment)
            for name, (of, drawn) in wanted.items():
                if of == example:
                    picture = Image.open(Path(folder) / f"{drawn}.png").convert("RGB")
                    picture.thumbnail((WIDTH, picture.height))
                    target = options.output / f"{name}.jpg"
                    target.parent.mkdir(parents=True, exist_ok=True)
                    picture.save(target, quality=QUALITY, optimize=True)
                    print(target)


if __name__ == "__main__":
    main()
