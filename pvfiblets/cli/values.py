"""Values of command line arguments."""

from __future__ import annotations

import argparse


def antialias(text: str) -> str | int:
    """Parse how edges are smoothed."""
    from pvfiblets.antialias import check_antialias

    try:
        return check_antialias("it", int(text) if text.isdecimal() else text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def positive(text: str) -> float:
    """Parse a finite number above zero."""
    value = _number(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return value


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no number") from None


def angle(text: str) -> float | None:
    """Parse degrees above zero and up to 90, or ``none``."""
    if text == "none":
        return None
    value = _number(text)
    if not 0.0 < value <= 90.0:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and up to 90 degrees, or none")
    return value


def count(text: str) -> int:
    """Parse a whole number above zero."""
    try:
        value = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number") from None
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above zero")
    return value


def size(text: str) -> tuple[int, int]:
    """Parse ``WIDTHxHEIGHT`` in pixels."""
    width, by, height = text.lower().partition("x")
    if not (by and width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT, such as 1200x900")
    pixels = int(width), int(height)
    if not all(1 <= side <= 16384 for side in pixels):
        raise argparse.ArgumentTypeError(f"{text}: each side must be from 1 to 16384 pixels")
    return pixels
