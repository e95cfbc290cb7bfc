"""Pictures as bytes of a file's format, for their way to a browser."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray


def encode(pixels: NDArray[np.uint8], codec: str, quality: int) -> bytes:
    """Return a picture's bytes."""
    from PIL import Image

    file = BytesIO()
    settings: dict[str, Any] = {"quality": quality}
    if codec == "png":
        settings = {"compress_level": 1}
    elif codec == "jpeg" and quality >= 90:
        settings["subsampling"] = 0  # thin coloured lines lose their colour by it
    elif codec == "webp":
        settings["method"] = 1
    Image.fromarray(pixels).save(file, codec, **settings)
    return file.getvalue()
