"""The one file of a card's check, to be attached to a report of a bug: findings, the driver's facts, pictures."""

from __future__ import annotations

import json
import struct
import time
import zipfile
import zlib
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from pvfiblets.support.whole_files import replacing

from ...machine import about
from .check import CardCheck
from .findings import table, totals


def summary(check: CardCheck) -> str:
    """Return the readable summary: the driver, the table, and the verdict."""
    opengl = check.opengl
    lines = [f"{name:<10}{opengl[name]}" for name in ("renderer", "driver") if name in opengl]
    if opengl.get("software"):
        lines[0] += " (on the CPU: no graphics card was tried)"
    lines += ["", table(check.findings), ""]
    bad = [one for one in check.findings if one.bad]
    if bad:
        which = "; ".join(f"{one.part}: {one.feature}" for one in bad[:5]) + ("; ..." if len(bad) > 5 else "")
        lines.append(f"{len(bad)} of {len(check.findings)} things differ or fail: {which}.")
    lines.append(f"{totals(check.findings)}{'' if bad else '; nothing differs or fails'}.")
    return "\n".join(lines)


def write(check: CardCheck, path: str | PathLike[str]) -> None:
    """Write a ZIP archive of ``check.txt``, ``check.json`` and, of what differs, pictures as PNG."""
    facts: dict[str, Any] = about(0, False, str(check.opengl.get("driver", "")))
    told = {"machine": facts, "opengl": check.opengl, "findings": [one.as_dict() for one in check.findings]}
    now = time.localtime()[:6]
    with replacing(path) as file, zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo("check.txt", now), summary(check) + "\n", zipfile.ZIP_DEFLATED)
        archive.writestr(zipfile.ZipInfo("check.json", now), json.dumps(told, indent=1) + "\n", zipfile.ZIP_DEFLATED)
        for files in check.pictures.values():
            for picture in files:
                archive.writestr(zipfile.ZipInfo(f"{picture.stem}.png", now), png(np.load(picture)))


def png(picture: npt.NDArray[Any]) -> bytes:
    """Return a picture as a PNG file, without a library: a bare machine has none."""
    if picture.ndim == 2:
        picture = np.repeat(picture[..., None], 3, axis=2) * np.uint8(255)
    height, width, _ = picture.shape
    rows = np.ascontiguousarray(picture[::-1], np.uint8).reshape(height, -1)
    raw = np.concatenate([np.zeros((height, 1), np.uint8), rows], axis=1).tobytes()  # 0: rows are as they are

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b"")
