"""Tone mapping, brightness, contrast, gamma: what ``shaders/effects/picture/tone.glsl`` does to a picture's colours."""

from __future__ import annotations

from dataclasses import dataclass

from pvfiblets.support.real_numbers import is_number

OPERATORS = ("none", "reinhard", "exponential", "aces", "hable")
"""Operators of tone mapping; the formulas are in the shader."""

_WHITE = {"hable": 11.2}  # default white point; the other operators take the brightest colour drawn

_BRIGHTEST = 1e4


@dataclass(frozen=True)
class Tone:
    """Changes of red, green and blue, the same for all pixels: exposure, operator, contrast, gamma, in this order."""

    operator: str = "none"  # one of `OPERATORS`
    exposure: float = 1.0  # factor of the drawn colours; above 0
    # what the exposed picture's white becomes white from, for `'reinhard'` and `'hable'`: above 0. The exposure (so
    # that white stays white), and 11.2, by default.
    white: float | None = None
    brightness: float = 0.0  # added, -1 to 1
    contrast: float = 1.0  # factor of the distance from middle grey; 0 or more
    gamma: float = 1.0  # colours are raised to `1 / gamma`; above 0

    def __post_init__(self) -> None:
        if self.operator not in OPERATORS:
            raise ValueError(f"operator is {self.operator!r}; choose one of {OPERATORS}")
        if self.white is not None and self.operator not in ("reinhard", "hable"):
            raise ValueError(f"white is {self.white!r}, but operator {self.operator!r} has none; leave it None")
        for name in ("exposure", "white", "gamma"):
            value = getattr(self, name)
            if value is not None and not (is_number(value) and value > 0.0):
                raise ValueError(f"{name} is {value!r}; give a number above 0")
        if not (is_number(self.contrast) and self.contrast >= 0.0):
            raise ValueError(f"contrast is {self.contrast!r}; give a number of 0 or more, 1 for none")
        if not (is_number(self.brightness) and -1.0 <= self.brightness <= 1.0):
            raise ValueError(f"brightness is {self.brightness!r}; give a number from -1 to 1, 0 for none")

    @property
    def changes(self) -> bool:
        """Whether there is anything to be done."""
        plain = self.exposure, self.brightness, self.contrast, self.gamma
        return self.operator != "none" or plain != (1.0, 0.0, 1.0, 1.0)

    @property
    def features(self) -> tuple[str, ...]:
        """Features of a shader with this tone."""
        return () if self.operator == "none" else (f"TONE_{self.operator.upper()}",)

    def uniforms(self) -> dict[str, float]:
        """Return what ``shaders/effects/picture/tone.glsl`` asks for."""
        white = _WHITE.get(self.operator, self.exposure) if self.white is None else self.white
        names = ("exposure", "brightness", "contrast", "gamma")
        given = {name: float(getattr(self, name)) for name in names}
        # Beyond, float32 knows infinity only, and infinity over infinity is black.
        return given | {"exposure": min(self.exposure, 1e30), "white": min(white, _BRIGHTEST), "brightest": _BRIGHTEST}
