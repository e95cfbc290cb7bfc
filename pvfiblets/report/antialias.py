"""The study of smooth edges: what pictures are off by with few samples a pixel, and what they cost."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .drawing import LATE, clock_of, timing
from .record import FRAME, Axes, Figure, LeftOut, Record
from .study import Options, Unavailable

__all__ = [
    "OURS", "STUDY", "AntialiasStudy", "PictureWindow", "Subject", "Variant", "differences", "subjects", "variants",
]  # fmt: skip

SIZE, QUICK_SIZE = (800, 600), (320, 240)
SEGMENTS, QUICK_SEGMENTS = 1_000_000, 60_000  # of a synthetic brain
STEP, LENGTH = 0.5, 94.0  # mm, of its points and of its streamlines on average
BUNDLE, QUICK_BUNDLE = 300, 60  # streamlines of it
TUBES, QUICK_TUBES = 60, 15
REFERENCE, QUICK_REFERENCE = 16, 8  # samples along a pixel's side
TURN = 1.14  # degrees from frame to frame: Schertzer et al. 2022, section 4.5
OURS, VTK = "pvfiblets", "VTK"

Pixels = npt.NDArray[np.float64]


def _nothing(_plotter: Any) -> None:
    """Leave edges as VTK draws them."""


@dataclass(frozen=True)
class Variant:
    """How edges are smoothed.

    Attributes
    ----------
    method, setting : str
        As of :class:`.Record`.
    antialias : str or int
        Of ``plotter.picture``.
    vtk : callable, optional
        Called with a plotter: what VTK does about edges.
    """

    method: str
    setting: str
    antialias: str | int = "off"
    vtk: Callable[[Any], object] = _nothing


def variants(quick: bool) -> list[Variant]:
    """Return all of them, the most important first."""

    def multi(samples: int) -> Callable[[Any], object]:
        return lambda plotter: plotter.enable_anti_aliasing("msaa", multi_samples=samples)

    def fxaa(plotter: Any) -> None:
        plotter.renderer.SetUseFXAA(True)  # PyVista has SSAA instead where it is not sure that this works

    found = [Variant(OURS, "refined", "refined"), Variant(OURS, "off"), Variant(OURS, "coverage", "coverage")]
    found += [Variant(OURS, f"refined, {n}", n) for n in ((4,) if quick else (2, 4, 8))]
    found += [Variant(VTK, f"MSAA {n}", vtk=multi(n)) for n in ((8,) if quick else (8, 4))]
    return [*found, Variant(VTK, "SSAA", vtk=lambda plotter: plotter.enable_anti_aliasing("ssaa")),
            Variant(VTK, "FXAA", vtk=fxaa)]  # fmt: skip


@dataclass(frozen=True)
class Subject:
    """A scene; ``fill`` puts it into a plotter, and points the camera."""

    name: str
    fill: Callable[[Any], object]
    only_vtk: bool = False


def subjects(options: Options) -> list[Subject]:
    """Return the scenes: lines, tubes, lines with a surface, and lines that VTK draws itself."""
    import pyvista as pv

    from pvfiblets.codec.compress import compress
    from pvfiblets.synthetic import brain_streamlines

    quick = options.quick
    n = max(round((QUICK_SEGMENTS if quick else SEGMENTS) * STEP / LENGTH), 1)
    brain = brain_streamlines(n, step=STEP, seed=options.seed)
    compressed = compress(brain)
    few = brain[np.arange(min(QUICK_BUNDLE if quick else BUNDLE, n))]
    thick = brain[np.arange(min(QUICK_TUBES if quick else TUBES, n))]

    def look(plotter: Any, zoom: float) -> None:
        plotter.view_vector((1.0, 0.8, 0.5), (0.0, 0.0, 1.0))
        plotter.camera.zoom(zoom)

    def whole(plotter: Any) -> None:
        plotter.add_fiblets(compressed, show_scalar_bar=False)
        look(plotter, 1.4)

    def bundle(plotter: Any) -> None:
        plotter.add_fiblets(few, line_width=2, show_scalar_bar=False)
        look(plotter, 3.0)

    def tubes(plotter: Any) -> None:
        plotter.add_spline_tubes(thick, radius=0.6, color="orange", show_scalar_bar=False)
        look(plotter, 2.0)

    def surface(plotter: Any) -> None:
        bundle(plotter)
        middle = 0.5 * (few.points.min(axis=0) + few.points.max(axis=0))
        plotter.add_mesh(pv.Sphere(radius=20.0, center=middle, theta_resolution=12, phi_resolution=8), color="white")

    def lines(plotter: Any) -> None:
        starts, ends = few.offsets[:-1], few.offsets[1:]
        cells = [np.concatenate([[b - a], np.arange(a, b)]) for a, b in zip(starts, ends, strict=True)]
        poly = pv.PolyData(np.asarray(few.points, np.float64), lines=np.concatenate(cells))
        plotter.add_mesh(poly, color="orange", line_width=2, lighting=False)
        look(plotter, 3.0)

    return [Subject("whole brain", whole), Subject("bundle", bundle), Subject("tubes", tubes),
            Subject("bundle and surface", surface), Subject("lines drawn by VTK", lines, only_vtk=True)]  # fmt: skip


class AntialiasStudy:
    """Pictures of few samples a pixel, beside the mean of very many."""

    name = "antialias"
    title = "Smooth edges"
    approximates = (
        "The mean of what each pixel shows, by one sample, by what lines cover of it, or by the mean of some pictures."
    )
    axes = (
        Axes("rest", "times/at rest", "errors/at rest", "ms until the picture is finished", "rms error, levels of 255"),
        Axes("moving", "times/moving", "errors/moving", "ms per frame", "rms error, levels of 255"),
    )
    notes = (
        "PyVista windows, all of VTK's work included; the camera turns by 1.14° between frames. *moving*: a frame as "
        "it is shown while the camera turns; *at rest*: the finished picture, and the time from the change to it. Both "
        "are the same but for *refined*, which then draws one picture after the other, 16 unless a number says "
        "otherwise, with the camera moved by parts of a pixel. *samples*: pictures that the finished one is the mean "
        "of.",
        "Errors are root mean squares over the pixels that show anything, beside the mean of 256 pictures (64 in quick "
        "runs) whose camera is moved on a regular grid in the pixel: a box filter one pixel wide. It is made for each "
        "scene without any smoothing; *p99* and *max* are of the finished picture.",
        "*MSAA*, *SSAA* and *FXAA* are VTK's own. MSAA smooths the meshes in a scene, no lines or tubes of this "
        "program, and averages light, not colours: its error is partly that. SSAA has a wider filter. *lines drawn by "
        "VTK*: the bundle by ``add_mesh``; *refined* is asked for there, since nothing of this program is in the "
        "scene. OpenGL draws other pixels of such lines under MSAA: its reference there is the mean of pictures under "
        "MSAA of 8.",
    )

    def run(self, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
        """Yield a record for every scene and variant."""
        try:
            import pyvista  # noqa: F401
        except ImportError as error:
            raise Unavailable(f"{error.name} is not installed") from error
        for subject in subjects(options):
            if not options.budget.allows():
                left_out.append(LeftOut(subject.name, LATE))
                continue
            yield from _measured(subject, options, left_out)


def differences(picture: Pixels, reference: Pixels) -> dict[str, float]:
    """Return errors of a picture: of all channels of pixels in which either shows something.

    Parameters
    ----------
    picture, reference : numpy.ndarray
        (rows, columns, 3), 0 to 255, black where nothing is.

    Returns
    -------
    dict
        ``rms``, ``p99`` (99th percentile) and ``max`` of the differences.
    """
    there = (picture > 0.0).any(axis=2) | (reference > 0.0).any(axis=2)
    apart = np.abs(picture - reference)[there]
    if not apart.size:
        return {"rms": 0.0, "p99": 0.0, "max": 0.0}
    return {"rms": float(np.sqrt((apart**2).mean())), "p99": float(np.quantile(apart, 0.99)), "max": float(apart.max())}


class PictureWindow:
    """A PyVista window with a scene."""

    def __init__(self, subject: Subject, size: tuple[int, int]) -> None:
        if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
            os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        import pyvista as pv

        from pvfiblets.mappers.windows import borrowed_context

        self.plotter: Any = pv.Plotter(off_screen=True, window_size=list(size))
        self.plotter.set_background("black")
        subject.fill(self.plotter)
        self.take(Variant(OURS, "off"))
        self._camera = self.plotter.camera_position
        self.plotter.show(auto_close=False)
        with borrowed_context(self.plotter.render_window) as ctx:
            self.driver = f"{ctx.info['GL_RENDERER']}, {ctx.info['GL_VERSION']}"
            self.clock, self.clock_name = clock_of(ctx)

    def take(self, variant: Variant) -> None:
        """Smooth edges in another way from the next frame on."""
        self.plotter.disable_anti_aliasing()
        self.plotter.renderer.SetUseFXAA(False)
        self.plotter.picture.antialias = variant.antialias
        variant.vtk(self.plotter)

    def look_back(self) -> None:
        """Draw a frame of the camera that the window began with."""
        self.plotter.camera_position = self._camera
        self.plotter.render()
        self._finish()

    def _finish(self) -> None:
        self.plotter.render_window.WaitForCompletion()
        self.plotter.render_window.GetPixelData(0, 0, 0, 0, 0, 0)

    def frame(self) -> float:
        """Turn the camera, draw, and return the seconds that it took."""
        self.plotter.camera.azimuth += TURN
        begun = self.clock()
        self.plotter.render()
        self._finish()
        return self.clock() - begun

    def samples(self) -> float:
        """Draw what is left of the picture, and return the seconds that it took."""
        begun = self.clock()
        while self.plotter.picture.refine():
            pass
        self._finish()
        return self.clock() - begun

    def pixels(self) -> Pixels:
        """Return what is seen: the picture as it is drawn, finished or not."""
        interactor = self.plotter.iren.interactor
        interactor.EnableRenderOff()  # or it would be finished first
        try:
            from vtkmodules.util.numpy_support import vtk_to_numpy
            from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

            grab = vtkWindowToImageFilter()
            grab.SetInput(self.plotter.render_window)
            grab.ShouldRerenderOff()
            grab.Update()
            image = grab.GetOutput()
        finally:
            interactor.EnableRenderOn()
        width, height, _ = image.GetDimensions()
        flat = vtk_to_numpy(image.GetPointData().GetScalars())
        return flat.reshape(height, width, -1)[..., :3].astype(np.float64)

    def reference(self, side: int, go_on: Callable[[], bool]) -> Pixels | None:
        """Return the mean of pictures whose camera is moved on a grid in the pixel; None where time runs out."""
        from pvfiblets.mappers.shifted_cameras import shifted

        window, total = self.plotter.render_window, np.zeros(())
        places = (np.arange(side) + 0.5) / side - 0.5
        for x in places:
            for y in places:
                if not go_on():
                    return None
                with shifted(self.plotter.camera, window.GetSize(), (float(x), float(y))):
                    window.Render()
                    total = total + self.pixels()
        return total / side**2


def _measured(subject: Subject, options: Options, left_out: list[LeftOut]) -> Iterator[Record]:
    quick, begun, late = options.quick, time.perf_counter(), []
    size, side = (QUICK_SIZE, QUICK_REFERENCE) if quick else (SIZE, REFERENCE)
    window = PictureWindow(subject, size)
    try:
        options.driver = window.driver
        window.look_back()
        references = {False: window.reference(side, options.budget.allows)}
        for variant in variants(quick):
            if subject.only_vtk and variant.antialias == "coverage":
                continue
            other = subject.only_vtk and variant.setting.startswith("MSAA")  # of which the first has 8 samples
            window.take(variant)
            if other not in references:
                window.look_back()
                references[other] = window.reference(side, options.budget.allows)
            reference = references[other]
            if reference is None or not options.budget.allows():
                late.append(variant.setting)
                continue
            yield _record(subject, variant, window, reference, options)
    finally:
        window.plotter.close()
    if late:
        left_out.append(LeftOut(f"{subject.name}: {', '.join(late)}", LATE))
    options.log(f"antialias: {subject.name}: {time.perf_counter() - begun:.0f} s")


def _record(subject: Subject, variant: Variant, window: PictureWindow, reference: Pixels, options: Options) -> Record:
    window.look_back()
    moving = window.pixels()
    window.samples()
    still, n = window.pixels(), window.plotter.picture.samples
    frames, whole = [], []
    for _ in range(options.repeats):
        frames.append(window.frame())
        whole.append(frames[-1] + (window.samples() if n > 1 else 0.0))
    found = {"at rest": differences(still, reference), "moving": differences(moving, reference)}
    errors = {name: Figure(figures["rms"], "levels") for name, figures in found.items()}
    errors |= {name: Figure(found["at rest"][name], "levels") for name in ("p99", "max")}
    times = {"moving": frames, "at rest": whole}
    height, width = reference.shape[:2]
    return Record(
        data=f"{subject.name}, {width} x {height}",
        group=subject.name.replace(" ", "-"),
        approximation="the mean of what a pixel shows",
        method=variant.method,
        setting=variant.setting,
        errors=errors,
        costs={"samples": Figure(float(n), "pictures")},
        times={name: timing(seconds, 1.0, FRAME, window.clock_name) for name, seconds in times.items()},
        ours=variant.method == OURS,
        default=variant.antialias == "refined",
        machine=options.machine,
    )


STUDY = AntialiasStudy()
