"""What a picture's passes tell each other about fiblets (``fiblets/compute/visibility_bits.glsl``), read back."""

import re

import numpy as np

from pvfiblets.engine.fiblets.pipelines import CONSTANTS
from pvfiblets.engine.gl.shaders import assemble


def kind(name):
    """Number of a kind of bits by its name in ``visibility_bits.glsl``."""
    return int(re.search(rf"\b{name} = (\d+)u", assemble("fiblets/compute/plan.comp", (), CONSTANTS))[1])


def visibility_words(renderer):
    """(kinds, words) of all chunks."""
    pipeline = renderer._pipeline
    return np.concatenate([pipeline.read_marks(chunk) for chunk in range(len(renderer._chunks))], axis=1)


def bits(words, n_fiblets):
    """(n_fiblets,) bool of one word for each 32."""
    return np.unpackbits(np.ascontiguousarray(words).view(np.uint8), bitorder="little")[:n_fiblets].astype(bool)


def planned(renderer, *, seen=True, unseen=True):
    """(n_fiblets,) bool: drawn in the last picture, those seen in the one before and those not seen in it."""
    words = visibility_words(renderer)
    low, high = words[kind("ROUND_LOW")], words[kind("ROUND_HIGH")]
    found = (low & ~high if seen else low & 0) | (high if unseen else high & 0)
    return bits(found, renderer._fiblets.n_fiblets)


def owning(renderer):
    """(n_fiblets,) bool: may own a pixel of the last picture."""
    return bits(visibility_words(renderer)[kind("SEEN")], renderer._fiblets.n_fiblets)
