#!/usr/bin/env bash
# nibabel 5.4.2: items of a lazily loaded tractogram come without its affine, and so does what is saved of it.
#
# `nibabel.streamlines.load(path, lazy_load=True)` keeps the affine of a .trk beside its generator. `tractogram.streamlines`
# applies it; `for item in tractogram` (and `.data`) yields the points as they are in the file. Writers iterate the items: a
# lazily loaded .trk that is saved as .tck, or as .trk under another header, lands elsewhere, without a warning. In the eager
# tractogram both ways give the same points.
#
# Seen: with voxels of 2 mm and the origin at (-90, -126, -72), a point at RAS (0, 0, 0) is (91, 127, 73), half a voxel more, as
# an item, and the .tck that is saved has it there.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check nibabel==5.4.2 numpy==2.3.5
cd "$work"
"$work/venv/bin/python" - <<'CODE'
import numpy as np
import nibabel as nib
from nibabel.streamlines import Tractogram, TrkFile, load, save

print("nibabel", nib.__version__)
affine = np.diag([2.0, 2.0, 2.0, 1.0])
affine[:3, 3] = -90, -126, -72
line = np.array([[0, 0, 0], [1, 0, 0], [2, 1, 0]], np.float32)
header = {"voxel_to_rasmm": affine, "voxel_sizes": (2, 2, 2), "dimensions": (91, 109, 91), "voxel_order": "RAS"}
save(TrkFile(Tractogram([line], affine_to_rasmm=np.eye(4)), header), "in.trk")

eager, lazy = load("in.trk"), load("in.trk", lazy_load=True)
by_item = next(iter(lazy.tractogram)).streamline[0]
by_streamlines = next(iter(lazy.tractogram.streamlines))[0]
save(lazy.tractogram, "lazy.tck")
save(eager.tractogram, "eager.tck")
from_lazy, from_eager = load("lazy.tck").streamlines[0][0], load("eager.tck").streamlines[0][0]
print("first point: eager", eager.streamlines[0][0], "lazy .streamlines", by_streamlines, "lazy item", by_item)
print("saved as .tck: from the eager tractogram", from_eager, "from the lazy one", from_lazy)
assert np.allclose(eager.streamlines[0][0], 0) and np.allclose(by_streamlines, 0) and np.allclose(from_eager, 0)
assert np.allclose(next(iter(eager.tractogram)).streamline[0], 0)
assert np.allclose(by_item, (91, 127, 73)) and np.allclose(from_lazy, (91, 127, 73))
CODE
