"""What a picture's passes tell each other about fiblets (``fiblets/compute/visibility_bits.glsl``), read back."""

import re

import numpy as np

from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gl.shaders import assemble

CLASSES = 4


def column(name):
    """Number of a word of ``visibility_bits.glsl`` by its name there."""
    return int(re.search(rf"\b{name} = (\d+)u", assemble("fiblets/compute/clear.comp", (), CONSTANTS))[1])


def visibility_words(renderer):
    """(n, words) of each 32 fiblets."""
    buffer = renderer._pipeline.buffers["visibility_bits"]
    words = CONSTANTS["visibility_words"]
    count = -(-renderer._fiblets.n_fiblets // 32)
    return np.frombuffer(buffer.read(4 * words * count), "<u4").reshape(count, words)


def bits(words, n_fiblets):
    """(n_fiblets,) bool of one word for each 32."""
    return np.unpackbits(np.ascontiguousarray(words).view(np.uint8), bitorder="little")[:n_fiblets].astype(bool)


def planned(renderer, *, seen=True, unseen=True):
    """(n_fiblets,) bool: drawn in the last picture, those seen in the one before and those not seen in it."""
    words = visibility_words(renderer)
    columns = [*(range(CLASSES) if seen else ()), *(range(CLASSES, column("CANDIDATES")) if unseen else ())]
    return bits(np.bitwise_or.reduce(words[:, columns], axis=1), renderer._fiblets.n_fiblets)


def owning(renderer):
    """(n_fiblets,) bool: may own a pixel of the last picture."""
    return bits(visibility_words(renderer)[:, column("SEEN")], renderer._fiblets.n_fiblets)
