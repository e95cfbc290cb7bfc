"""What splits of a slot into lattice fiblets cost, and how far they go; kernels and NumPy alike choose the cheapest.

A lattice of edge ``h`` errs by at most ``h sqrt(3) / 2`` whatever the steps, and adding integers does not drift.
"""

from .layout import WORDS

RECORD_BYTES = 4 * sum(WORDS.values()) + 2  # words, and the radius of the capsule
LATTICE_LIMIT = 2.0**30  # lattice coordinates stay clear of int32's end, on the GPU too
MAX_HALVINGS = 15
TURNED_TOO_FAR = 2**16  # bytes: any split that turns fewer segments too far is better
TREE_DEPTH = 6  # halving 60 points six times leaves single points
