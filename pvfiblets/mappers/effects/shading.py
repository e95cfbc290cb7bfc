"""Shading as effects of a mapper: light of illuminated lines, ambient occlusion, depth cueing, halos, ink, outlines.

Each is a value that ``FibletMapper.set_effect`` takes; none leaves a trace in a mapper that has not been given it.
Lengths are mm of the world. All work with perspective and parallel cameras, and in pictures that are supersampled.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from pvfiblets.mappers.effects.line_tubes import normals_to_view
from pvfiblets.mappers.effects.shader_effects import Draw, ShaderEffect
from pvfiblets.mappers.effects.spacing import line_spacing_of
from pvfiblets.mappers.frames.scene import pixel_scale

if TYPE_CHECKING:
    import moderngl
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from pvfiblets.engine.effects import AmbientOcclusionPass, HaloPass, OutlinePass, Projection

Colour = tuple[float, float, float]

LUMINANCE = (0.2126, 0.7152, 0.0722)  # shares of red, green and blue (Rec. 709).

HALO_WIDTH, LEAST_HALO, MOST_HALO = 0.5, 1.25, 5.0
"""Default width of a halo: by the distance between lines; at least and at most so many pixels of the window."""
HALO_DEPTH = 8.0
"""Default depth of a halo, by its width: what crosses is set apart, and bundles and sheets stay together."""
OCCLUSION_RADIUS, LEAST_OCCLUSION, MOST_OCCLUSION = 16.0, 8.0, 0.05
"""Default radius of occlusion: by the distance between lines; at least so many pixels, at most this share of the data's
diagonal."""

MAX_OUTLINE = 16.0  # pixels of the window; an outline's cost grows with the square of its width


class Illuminated(ShaderEffect):
    """Every light finds the normal of a line that reflects most of it (Zöckler 1996, Mallo 2005), see `resolve`."""

    features = frozenset({"illuminated"})

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set what the lights of the scene add up to."""
        lights = draw.renderer.GetLights()
        strengths = [
            light.GetIntensity() * max(light.GetDiffuseColor())
            for light in (lights.GetItemAsObject(i) for i in range(lights.GetNumberOfItems()))
            if light.GetSwitch()
        ]
        program.SetUniformf("fibletLightSum", max(1.0, sum(strengths)))


@dataclass(frozen=True)
class Ink(ShaderEffect):
    """One colour for all lines whatever they are coloured by, without light."""

    # RGB between 0 and 1. None: black on a light background, white on a dark one.
    color: Colour | None = (0.0, 0.0, 0.0)
    features = frozenset({"ink"})

    def __post_init__(self) -> None:
        if self.color is not None:
            object.__setattr__(self, "color", _colour(self.color, "color of ink"))

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the colour."""
        color = self.color
        if color is None:
            color = ink_on(draw.renderer)
        program.SetUniform3f("fibletInk", color)


@dataclass(frozen=True)
class AmbientOcclusion(ShaderEffect):
    """Lines and surfaces are darker where others stand over them."""

    # mm: farther geometry does not count. By default 16 times the distance between lines, but at least 8 pixels, and at
    # most a 20th of the diagonal of the data's bounds.
    radius: float | None = None
    samples: int = 16  # pixels looked at around each, 1 to 256
    strength: float = 1.0  # 0 to 1
    features = frozenset({"ambient_occlusion"})

    def __post_init__(self) -> None:
        if self.radius is not None:
            object.__setattr__(self, "radius", positive(self.radius, "radius of ambient occlusion", "mm"))
        from pvfiblets.engine.effects.ambient_occlusion import MAX_SAMPLES

        if int(self.samples) != self.samples or not 1 <= self.samples <= MAX_SAMPLES:
            raise ValueError(
                f"samples of ambient occlusion is {self.samples!r}; give a whole number from 1 to {MAX_SAMPLES}"
            )
        object.__setattr__(self, "samples", int(self.samples))
        object.__setattr__(self, "strength", share(self.strength, "strength of ambient occlusion"))

    def make(self, ctx: moderngl.Context) -> AmbientOcclusionPass:
        """Make the passes."""
        from pvfiblets.engine.effects import AmbientOcclusionPass

        return AmbientOcclusionPass(ctx)

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:
        """Run them."""
        radius = self.reach(draw)
        directions = draw.frame.directions_to_view
        surface = draw.buffer.relief == "normal"
        texture = kept.draw(
            draw.buffer,
            _lens_of(draw),
            directions,
            radius=radius,
            samples=self.samples,
            strength=self.strength,
            normals_to_view=normals_to_view(directions) if surface else None,
        )
        return {"fibletOcclusionMap": texture}

    def reach(self, draw: Draw) -> float:
        """Return the radius in mm."""
        if self.radius is not None:
            return self.radius
        most, spacing = MOST_OCCLUSION * extent(draw), _spacing_in(draw)
        if spacing is None:
            return most
        return min(max(OCCLUSION_RADIUS * spacing, LEAST_OCCLUSION * _pixel_in(draw)), most)


@dataclass(frozen=True)
class DepthCue(ShaderEffect):
    """Lines fade towards one colour with their distance from the viewer's plane."""

    strength: float = 0.7  # share of that colour at the far end, 0 to 1
    color: Colour | None = None  # RGB between 0 and 1; by default the renderer's background
    # distances in mm at which fading begins and ends. By default the distances of the nearest and the farthest corner
    # of the data's bounds, as the camera sees them.
    range: tuple[float, float] | None = None
    features = frozenset({"depth_cue"})

    def __post_init__(self) -> None:
        object.__setattr__(self, "strength", share(self.strength, "strength of depth cueing"))
        if self.color is not None:
            object.__setattr__(self, "color", _colour(self.color, "color of depth cueing"))
        if self.range is not None:
            ends = tuple(float(end) for end in self.range)
            if len(ends) != 2 or not all(map(math.isfinite, ends)) or ends[0] >= ends[1]:
                raise ValueError(f"range of depth cueing is {self.range!r}; give two rising distances in mm, or None")
            object.__setattr__(self, "range", ends)

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set colours and distances."""
        near, far = distances(draw) if self.range is None else self.range
        lower, upper = background(draw.renderer) if self.color is None else (self.color, self.color)
        program.SetUniform3f("fibletCueLower", lower)
        program.SetUniform3f("fibletCueUpper", upper)
        program.SetUniform3f("fibletCue", (near, 1.0 / max(far - near, 1e-30), self.strength))


@dataclass(frozen=True)
class Halos(ShaderEffect):
    """Depth-dependent halos: a line cuts a gap into the lines behind it, the wider the farther they are behind.

    Everts et al. 2009. A halo covers pixels without a line, too: it hides its background, and has a depth in the scene.
    Lines that a colour's alpha hides have their halos all the same; a mask of streamlines takes both away.
    """

    # mm from a line's edge to its halo's, at most 24 pixels of the window. By default half the distance between lines
    # (`pvfiblets.mappers.effects.spacing`), but from 1.25 to 5 pixels of the window in the middle of the data.
    width: float | None = None
    # mm from the line back to the halo's edge: lines side by side whose depths differ by less leave each other alone.
    # By default 8 times the width.
    depth: float | None = None
    color: Colour | None = (1.0, 1.0, 1.0)  # RGB between 0 and 1; by default the renderer's background
    features = frozenset({"halo"})

    def __post_init__(self) -> None:
        if self.width is not None:
            object.__setattr__(self, "width", positive(self.width, "width of halos", "mm"))
        if self.depth is not None:
            object.__setattr__(self, "depth", positive(self.depth, "depth of halos", "mm"))
        if self.color is not None:
            object.__setattr__(self, "color", _colour(self.color, "color of halos"))

    def make(self, ctx: moderngl.Context) -> HaloPass:
        """Make the passes."""
        from pvfiblets.engine.effects import HaloPass

        return HaloPass(ctx)

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:
        """Run them."""
        width, depth = self.sizes(draw)
        nearest = distances(draw)[0]
        lens, scale = _lens_of(draw), _pixel_scale(draw)
        texture = kept.draw(draw.buffer, lens, width=width, depth=depth, nearest=nearest, pixel_scale=scale)
        return {"fibletHaloMap": texture}

    def sizes(self, draw: Draw) -> tuple[float, float]:
        """Return width and depth in mm."""
        width = self.width
        if width is None:
            pixel, spacing = _pixel_in(draw), _spacing_in(draw)
            width = min(max(HALO_WIDTH * (spacing or 0.0), LEAST_HALO * pixel), MOST_HALO * pixel)
        return width, HALO_DEPTH * width if self.depth is None else self.depth

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the colour, and widen the rectangle in which anything can be."""
        lower, upper = background(draw.renderer) if self.color is None else (self.color, self.color)
        program.SetUniform3f("fibletHaloLower", lower)
        program.SetUniform3f("fibletHaloUpper", upper)
        _widen(program, draw)


@dataclass(frozen=True, eq=False)
class Silhouette(ShaderEffect):
    """An outline around the pixels that show chosen streamlines."""

    selected: npt.NDArray[np.bool_]  # `(n_streamlines,)` bool
    color: Colour = (1.0, 1.0, 1.0)  # RGB between 0 and 1
    width: float = 2.0  # pixels of the window, 1 to 16
    features = frozenset({"silhouette"})

    def __post_init__(self) -> None:
        selected = np.array(self.selected)
        if selected.dtype != np.bool_ or selected.ndim != 1:
            raise ValueError(
                f"selected of a silhouette is {selected.dtype} of shape {selected.shape}; "
                "expected bool (n_streamlines,)"
            )
        selected.flags.writeable = False
        object.__setattr__(self, "selected", selected)
        object.__setattr__(self, "color", _colour(self.color, "color of a silhouette"))
        if not 1.0 <= float(self.width) <= MAX_OUTLINE:
            raise ValueError(f"width of a silhouette is {self.width!r}; give pixels from 1 to {MAX_OUTLINE:g}")
        object.__setattr__(self, "width", float(self.width))

    def make(self, ctx: moderngl.Context) -> OutlinePass:
        """Make the passes."""
        from pvfiblets.engine.effects import OutlinePass

        return OutlinePass(ctx)

    def prepare(self, kept: Any, draw: Draw) -> Mapping[str, Any]:
        """Run them."""
        if len(self.selected) != draw.fiblets.n_streamlines:
            raise ValueError(
                f"a silhouette has {len(self.selected)} values for {draw.fiblets.n_streamlines} streamlines; "
                "give one per streamline, empty ones included"
            )
        return {"fibletOutlineMap": kept.draw(draw.buffer, self.selected, width=self.width * _pixel_scale(draw))}

    def set_uniforms(self, kept: Any, program: Any, draw: Draw) -> None:  # noqa: ARG002 - as of all effects
        """Set the colour, and widen the rectangle in which anything can be."""
        program.SetUniform3f("fibletOutlineColour", self.color)
        _widen(program, draw)


def _lens_of(draw: Draw) -> Projection:
    """Return what effects must know of a draw's camera."""
    from pvfiblets.engine.effects import Projection

    return Projection(draw.view.size, draw.frame.projection)


def extent(draw: Draw) -> float:
    """Return the diagonal of the data's bounds in mm of the world; 1 where there is none."""
    bounds = np.asarray(draw.fiblets.bounds, np.float64)
    diagonal = float(np.linalg.norm(draw.frame.model[:3, :3] @ (bounds[1::2] - bounds[::2])))
    return diagonal if math.isfinite(diagonal) and diagonal > 0.0 else 1.0


def _spacing_in(draw: Draw) -> float | None:
    """Return the distance between lines in mm of the world; None where it is not known."""
    spacing = line_spacing_of(draw.fiblets)
    if spacing is None:
        return None
    bounds = np.asarray(draw.fiblets.bounds, np.float64)
    return spacing * extent(draw) / (float(np.linalg.norm(bounds[1::2] - bounds[::2])) or 1.0)


def _pixel_in(draw: Draw) -> float:
    """Return the mm of a pixel of the window in the middle of the data."""
    return _pixel_scale(draw) / _lens_of(draw).pixels_per_mm(sum(distances(draw)) / 2.0)


def distances(draw: Draw) -> tuple[float, float]:
    """Return the distances in mm of the nearest and the farthest corner of the bounds; not behind the viewer."""
    bounds = np.asarray(draw.fiblets.bounds, np.float64)
    slack = (draw.fiblets.promise + draw.style.thickness) * np.array([-1.0, 1.0])
    ends = [bounds[axis : axis + 2] + slack for axis in (0, 2, 4)]
    corners = np.array([[x, y, z, 1.0] for x in ends[0] for y in ends[1] for z in ends[2]])
    away = -(corners @ draw.frame.model_view[2])
    return max(0.0, float(away.min())), max(0.0, float(away.max()))


def background(renderer: vtkRenderer) -> tuple[Colour, Colour]:
    """Return the colours of a renderer's background at its lower and its upper edge."""
    lower = renderer.GetBackground()
    return lower, renderer.GetBackground2() if renderer.GetGradientBackground() else lower


def is_light(renderer: vtkRenderer) -> bool:
    """Return True if a renderer's background is light."""
    return float(np.mean(background(renderer), axis=0) @ LUMINANCE) > 0.5


def ink_on(renderer: vtkRenderer | None) -> Colour:
    """Return black on a light background, white on a dark one; black without a renderer."""
    return (0.0, 0.0, 0.0) if renderer is None or is_light(renderer) else (1.0, 1.0, 1.0)


def _widen(program: Any, draw: Draw) -> None:
    """Extend the resolve to pixels as far from the lines as any halo or outline reaches."""
    from pvfiblets.engine.effects.halos import WIDEST

    margin = draw.style.half_width + 2.0 + max(WIDEST, MAX_OUTLINE) * _pixel_scale(draw)
    slack = draw.fiblets.promise + draw.style.reach
    rectangle = draw.frame.rectangle(draw.fiblets.bounds, slack, margin)
    program.SetUniform4f("fibletRectangle", rectangle)


def _pixel_scale(draw: Draw) -> float:
    """Return pixels of the framebuffer for a pixel in which users give a width."""
    return pixel_scale(draw.renderer, draw.frame.viewport)


def _colour(value: Any, name: str) -> Colour:
    channels = tuple(float(channel) for channel in value)
    if len(channels) != 3 or not all(0.0 <= channel <= 1.0 for channel in channels):
        raise ValueError(f"{name} is {value!r}; expected 3 numbers between 0 and 1")
    return channels


def positive(value: Any, name: str, unit: str) -> float:
    """Return a finite number above 0."""
    number = float(value)
    if not (math.isfinite(number) and number > 0.0):
        raise ValueError(f"{name} is {value!r}; give {unit}, a finite number above 0")
    return number


def share(value: Any, name: str) -> float:
    """Return a number from 0 to 1."""
    number = float(value)
    if not 0.0 <= number <= 1.0:
        raise ValueError(f"{name} is {value!r}; give a number from 0 to 1")
    return number
