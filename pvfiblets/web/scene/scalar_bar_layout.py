"""Layout of colour bars: side by side in the lower half of the picture, with their sizes and letters.

Nothing of what belongs to the page is covered: the tools at the left, the letters at the middles of the edges, the line
at the bottom. Where there is less room, long titles are shortened first, then letters are smaller, and then bars are
left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

Measure = Callable[[str, int], float]
"""Function from a text and the size of its letters to its width, in pixels of the window."""

FONTS = (13, 11, 9)  # sizes of letters, from the one that is taken where there is room; 72 points are an inch
SMALLEST_NAMES = 7
BAR = 15.0  # width of the colours; all of these are pixels at 72 to an inch
GAP = 12.0  # between what belongs to two bars
LEFT, RIGHT, BOTTOM = 48.0, 8.0, 34.0  # free margins: the tools, the edge, and the line at the bottom
MIDDLE = 14.0  # half the height that the letters at the sides take
HIGHEST = 0.3  # of the height of the picture
SHORTEST = 28.0  # of the colours
NARROWEST = 46.0  # of a title that was shortened
MOST_LABELS = 5
LEADER = 16.0  # from the colours to the names beside them
DOTS = "..."
_LOOSE = " ([{,;:-"  # not at the end of a title that was shortened


@dataclass(frozen=True)
class Wanted:
    """A bar that is to be shown."""

    title: str
    labels: tuple[str, ...]  # all numbers that it may show, or its names
    named: bool = False  # whether they are names; then it shows all of them


@dataclass(frozen=True)
class Place:
    """Position and size of a bar."""

    title: str  # as it is shown: it may be shortened
    left: float  # of the frame that VTK lays the bar out in, in pixels from the lower left corner
    bottom: float
    width: float
    height: float
    ratio: float  # the share of that width that the colours take
    font: int  # size of the title's letters
    label_font: int  # size of the letters of numbers or names
    labels: int  # how many numbers
    gap: int  # pixels between colours and title, in addition to VTK's


def arrange(wanted: Sequence[Wanted], size: tuple[int, int], scale: float, measure: Measure) -> list[Place | None]:
    """Return a place for each bar, the first at the right; ``None`` without room."""
    kept = list(range(len(wanted)))
    while kept:
        for font in FONTS:
            columns = _columns([wanted[k] for k in kept], size, scale, font, measure)
            if columns is not None:
                break
        else:
            kept.pop()  # the last one; the others may fit then, and if not, one more goes
            continue
        found: list[Place | None] = [None] * len(wanted)
        right = size[0] - RIGHT * scale
        for k, column in zip(kept, columns, strict=True):
            found[k] = column.place(right)
            right -= column.width + GAP * scale
        return found
    return [None] * len(wanted)


@dataclass(frozen=True)
class _Column:
    """Space of one bar: its colours begin ``before`` pixels from the left."""

    width: float
    before: float
    frame: float
    shown: Place

    def place(self, right: float) -> Place:
        shown = self.shown
        return Place(
            shown.title, right - self.width + self.before, shown.bottom, self.frame, shown.height, shown.ratio,
            shown.font, shown.label_font, shown.labels, shown.gap,
        )  # fmt: skip


def _columns(
    wanted: Sequence[Wanted], size: tuple[int, int], scale: float, font: int, measure: Measure
) -> list[_Column] | None:
    """Return what bars take with letters of a size, titles shortened as far as they must be; ``None`` if too much."""
    room = size[0] - (LEFT + RIGHT) * scale - GAP * scale * (len(wanted) - 1)
    natural = [measure(one.title, font) for one in wanted]
    # From no limit to the narrowest titles: the widest limit at which all fit.
    limits = sorted({width for width in natural if width > NARROWEST * scale} | {NARROWEST * scale}, reverse=True)
    limits += [limits[0] + share * (limits[-1] - limits[0]) for share in (k / 16 for k in range(1, 16))]
    for limit in sorted(limits, reverse=True):
        columns = [_column(one, size, scale, font, limit, measure) for one in wanted]
        if any(column is None for column in columns):
            return None
        found = [column for column in columns if column is not None]
        if sum(column.width for column in found) <= room:
            return found
    return None


def _column(
    one: Wanted, size: tuple[int, int], scale: float, font: int, limit: float, measure: Measure
) -> _Column | None:
    letters = font * scale  # pixels
    title = _shortened(one.title, limit, font, measure)
    across = measure(title, font)
    bottom = BOTTOM * scale
    top = size[1] / 2.0 - MIDDLE * scale - letters  # VTK's titles stand out of the frame by three quarters of a letter
    height = min(HIGHEST * size[1], top - bottom)
    gap = round(0.5 * letters + 2.5)
    long = height - 1.1 * letters - gap - 4.0  # of the colours
    if long < SHORTEST * scale:
        return None
    if one.named:
        # Names stand apart by their height, and out of the colours if those are shorter.
        line = long / (1.25 * scale * max(len(one.labels), 1))  # the size of letters at which lines fill it
        label_font = min(font, int(line)) if line >= SMALLEST_NAMES else 0
        if not label_font:
            return None
        names = max((measure(name, label_font) for name in one.labels), default=0.0)
        half = max(across, BAR * scale) / 2.0  # VTK centres the title over the colours
        after = max(half, BAR * scale / 2.0 + LEADER * scale + names)
        shown = Place(title, 0.0, bottom, 0.0, height, 1.0, font, label_font, 0, gap)
        return _Column(half + after, half - BAR * scale / 2.0, BAR * scale, shown)
    frame = BAR * scale + 4.0 + max((measure(label, font) for label in one.labels), default=0.0)
    labels = int(min(MOST_LABELS, max(2, 1 + long // (1.6 * letters))))
    width = max(frame, across)
    shown = Place(title, 0.0, bottom, 0.0, height, BAR * scale / frame, font, font, labels, gap)
    return _Column(width, (width - frame) / 2.0, frame, shown)


def _shortened(text: str, limit: float, font: int, measure: Measure) -> str:
    """Return a text shortened to a width."""
    if measure(text, font) <= limit:
        return text
    kept = len(text)
    while kept > 2 and measure(text[:kept].rstrip(_LOOSE) + DOTS, font) > limit:
        kept -= 1
    return text[:kept].rstrip(_LOOSE) + DOTS
