"""The study of smooth edges: the errors of pictures with few samples a pixel, and their cost."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...record import FRAME, Axes, Figure, Record
from ...study import LATE, Options, Study, Unavailable
from ...timing import timing
from ...window import Window
from ..codec.data_sets import files_of
from ..codec.pixels import lines_of

if TYPE_CHECKING:
    import pyvista as pv

SIZE, QUICK_SIZE, FILE_SIZE = (800, 600), (320, 240), (1000, 800)
SCREEN = (1920, 1080)
SEGMENTS, QUICK_SEGMENTS = (1_100_000, 6_000_000), (60_000,)  # of synthetic brains
STEP, QUICK_STEP = 0.1, 0.5  # mm, of their points
BUNDLE, QUICK_BUNDLE = 300, 60  # streamlines of it
TUBES, QUICK_TUBES = 60, 15
REFERENCE, QUICK_REFERENCE = 16, 8  # samples along a pixel's side
WHOLE = 1.0 + 1e-6  # pixels: lines of one exactly are drawn by OpenGL's rule for thin lines
TURN = 1.14  # degrees from frame to frame: Schertzer et al. 2022, section 4.5
SHIMMER, TURNS = 0.1, 5  # degrees of a small turn, and how many
OURS, VTK = "pvfiblets", "VTK"

Pixels = npt.NDArray[np.float64]


def _nothing(_plotter: Any) -> None:
    """Leave edges as VTK draws them."""


@dataclass(frozen=True)
class Variant:
    """A method of smoothing edges."""

    # As of :class:`.Record`
    method: str
    setting: str
    antialias: str | int = "off"  # Of `plotter.picture`
    vtk: Callable[[Any], object] = _nothing  # Called with a plotter: what VTK does about edges
    singly: bool = False  # Whether one sample is drawn after the other where all could be drawn at once


def variants(quick: bool) -> list[Variant]:
    """Return all of them, the most important first."""

    def multi(samples: int) -> Callable[[Any], object]:
        return lambda plotter: plotter.enable_anti_aliasing("msaa", multi_samples=samples)

    def fxaa(plotter: pv.BasePlotter) -> None:
        plotter.renderer.SetUseFXAA(True)  # PyVista has SSAA instead where it is not sure that this works

    found = [Variant(OURS, "refined", "refined"), Variant(OURS, "off"), Variant(OURS, "coverage", "coverage")]
    found.append(Variant(OURS, "refined, singly", "refined", singly=True))
    found += [Variant(OURS, f"refined, {n}", n) for n in ((4,) if quick else (2, 4, 8))]
    found += [Variant(VTK, f"MSAA {n}", vtk=multi(n)) for n in ((8,) if quick else (8, 4))]
    return [*found, Variant(VTK, "SSAA", vtk=lambda plotter: plotter.enable_anti_aliasing("ssaa")),
            Variant(VTK, "FXAA", vtk=fxaa)]  # fmt: skip


@dataclass(frozen=True)
class Subject:
    """A scene; ``fill`` puts it into a plotter, and points the camera. ``size`` is its own, where it has one."""

    name: str
    fill: Callable[[Any], object]
    only_vtk: bool = False
    size: tuple[int, int] | None = None


def subjects(options: Options) -> list[Subject]:
    """Return the scenes, whole brains first."""
    import pyvista as pv

    from pvfiblets.report.studies.codec.coded import compress
    from pvfiblets.synthetic import brain_streamlines, streamline_count

    quick = options.quick
    few = brain_streamlines(QUICK_BUNDLE if quick else BUNDLE, step=QUICK_STEP, seed=options.seed)
    thick = few[np.arange(QUICK_TUBES if quick else TUBES)]

    def look(plotter: pv.BasePlotter, zoom: float) -> None:
        plotter.view_vector((1.0, 0.8, 0.5), (0.0, 0.0, 1.0))
        plotter.camera.zoom(zoom)

    def whole(segments: int) -> Subject:
        step = QUICK_STEP if quick else STEP

        def fill(plotter: pv.BasePlotter) -> None:
            streamlines = brain_streamlines(streamline_count(segments, step), step=step, seed=options.seed)
            plotter.add_fiblets(compress(streamlines), show_scalar_bar=False)
            look(plotter, 1.4)

        return Subject(f"brain of {segments:,} segments", fill, size=QUICK_SIZE if quick else SCREEN)

    def bundle(plotter: pv.BasePlotter) -> None:
        plotter.add_fiblets(few, color="orange", lighting=False, line_width=2, show_scalar_bar=False)
        look(plotter, 3.0)

    def tubes(plotter: pv.BasePlotter) -> None:
        plotter.add_spline_tubes(thick, radius=0.6, color="orange", show_scalar_bar=False)
        look(plotter, 2.0)

    def halos(plotter: pv.BasePlotter) -> None:
        plotter.add_halo_lines(few)
        look(plotter, 2.0)

    def surface(plotter: pv.BasePlotter) -> None:
        bundle(plotter)
        middle = 0.5 * (few.points.min(axis=0) + few.points.max(axis=0))
        plotter.add_mesh(pv.Sphere(radius=20.0, center=middle, theta_resolution=12, phi_resolution=8), color="white")

    def lines(plotter: pv.BasePlotter) -> None:
        poly = lines_of(pv, few.points, np.asarray(few.offsets))
        plotter.add_mesh(poly, color="orange", line_width=2, lighting=False)
        look(plotter, 3.0)

    def file(path: Path) -> Subject:
        def fill(plotter: pv.BasePlotter) -> None:
            plotter.add_fiblets(path, show_scalar_bar=False)
            look(plotter, 1.4)

        return Subject(path.stem.replace("_", " "), fill, size=QUICK_SIZE if quick else FILE_SIZE)

    files = files_of(options.files)[0] if options.files else []
    return [*map(whole, QUICK_SEGMENTS if quick else SEGMENTS), Subject("bundle", bundle), Subject("tubes", tubes),
            Subject("halos", halos), Subject("bundle and surface", surface),
            Subject("lines drawn by VTK", lines, only_vtk=True), *map(file, files)]  # fmt: skip


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every scene and variant."""
    try:
        import pyvista  # noqa: F401
    except ImportError as error:
        raise Unavailable(f"{error.name} is not installed") from error
    for subject in subjects(options):
        if not options.allows(subject.name):
            continue
        yield from _measured(subject, options)

def differences(picture: Pixels, reference: Pixels) -> dict[str, float]:
    """Return errors of a picture: of all channels of pixels in which either shows something."""
    there = (picture > 0.0).any(axis=2) | (reference > 0.0).any(axis=2)
    apart = np.abs(picture - reference)[there]
    if not apart.size:
        return {"rms": 0.0, "mean": 0.0, "p99": 0.0, "max": 0.0}
    return {
        "rms": float(np.sqrt((apart**2).mean())),
        "mean": float(apart.mean()),
        "p99": float(np.quantile(apart, 0.99)),
        "max": float(apart.max()),
    }


class PictureWindow(Window):
    """A window with a scene."""

    def __init__(self, subject: Subject, size: tuple[int, int]) -> None:
        super().__init__(size)
        subject.fill(self.plotter)
        self.take(Variant(OURS, "off"))
        self._camera = self.plotter.camera_position
        self.show()

    def take(self, variant: Variant) -> None:
        """Smooth edges in another way from the next frame on."""
        self.plotter.disable_anti_aliasing()
        self.plotter.renderer.SetUseFXAA(False)
        self.plotter.picture.antialias = variant.antialias
        self.plotter.picture.antialias_seconds = 1e6 if variant.singly else None  # with a limit, they come one by one
        variant.vtk(self.plotter)

    def look_back(self) -> None:
        """Draw a frame of the camera that the window began with."""
        self.plotter.camera_position = self._camera
        self.render()

    def frame(self) -> float:
        """Turn the camera, draw, and return the seconds that it took."""
        self.plotter.camera.azimuth += TURN
        begun = self.clock()
        self.render()
        return self.clock() - begun

    def shimmer(self, turns: int) -> float:
        """Turn the camera a little, some times, and return by how many levels pixels that show something change."""
        frames = []
        for _ in range(turns + 1):
            self.plotter.camera.azimuth += SHIMMER
            self.render()
            frames.append(self.pixels())
        return float(np.mean([differences(after, before)["mean"] for before, after in itertools.pairwise(frames)]))

    def samples(self) -> float:
        """Draw the remaining samples of the picture, and return the seconds taken."""
        begun = self.clock()
        while self.plotter.picture.refine():
            pass
        self.wait()
        return self.clock() - begun

    def pixels(self) -> Pixels:
        """Return the picture on the screen, finished or not."""
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
        from pvfiblets.mappers.frames.shifted_cameras import shifted

        window, total = self.plotter.render_window, np.zeros(())
        thin = [actor for actor in self.plotter.fiblets if actor.line_width == 1.0]
        smooth = [actor for actor in self.plotter.halo_lines if actor.smooth]
        for actor in thin:
            actor.line_width = WHOLE
        for actor in smooth:
            actor.smooth = False
        places = (np.arange(side) + 0.5) / side - 0.5
        try:
            for x in places:
                for y in places:
                    if not go_on():
                        return None
                    with shifted(self.plotter.camera, window.GetSize(), (float(x), float(y))):
                        window.Render()
                        total = total + self.pixels()
        finally:
            for actor in thin:
                actor.line_width = 1.0
            for actor in smooth:
                actor.smooth = True
        return total / side**2


def _measured(subject: Subject, options: Options) -> Iterator[Record]:
    quick, begun, late = options.quick, time.perf_counter(), []
    size, side = (QUICK_SIZE, QUICK_REFERENCE) if quick else (SIZE, REFERENCE)
    window = PictureWindow(subject, subject.size or size)
    try:
        options.driver = window.driver
        window.look_back()
        references = {False: window.reference(side, options.budget.allows)}
        for variant in variants(quick):
            if subject.only_vtk and variant.antialias == "coverage":
                continue
            other = subject.only_vtk and variant.setting.startswith("MSAA")  # its first setting has 8 samples
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
        window.release()
    if late:
        options.leave_out(f"{subject.name}: {', '.join(late)}", LATE)
    options.log(f"antialias: {subject.name}: {time.perf_counter() - begun:.0f} s")


def _record(subject: Subject, variant: Variant, window: PictureWindow, reference: Pixels, options: Options) -> Record:
    window.look_back()
    moving = window.pixels()
    window.samples()
    still, n = window.pixels(), window.plotter.picture.samples
    window.look_back()
    shimmer = window.shimmer(TURNS)
    frames, whole = [], []
    for _ in range(options.repeats):
        frames.append(window.frame())
        whole.append(frames[-1] + (window.samples() if n > 1 else 0.0))
    found = {"at rest": differences(still, reference), "moving": differences(moving, reference)}
    errors = {name: Figure(figures["rms"], "levels") for name, figures in found.items()}
    errors["shimmer"] = Figure(shimmer, "levels")
    errors |= {name: Figure(found["at rest"][name], "levels") for name in ("p99", "max")}
    times = {"moving": frames, "at rest": whole}
    height, width = reference.shape[:2]
    return Record(
        data=f"{subject.name}, {width} x {height}",
        group=subject.name.replace(",", "").replace(" ", "-"),
        approximation="the mean of what a pixel shows",
        method=variant.method,
        setting=variant.setting,
        errors=errors,
        costs={"samples": Figure(float(n), "pictures")},
        times={name: timing(seconds, 1.0, FRAME, window.clock_name) for name, seconds in times.items()},
        ours=variant.method == OURS,
        default=variant.antialias == "refined",
    )


STUDY = Study(
    name="antialias",
    title="Smooth edges",
    approximates=(
        "The mean of what each pixel shows, by one sample, by what lines cover of it, or by the mean of some pictures."
    ),
    axes=(
        Axes("rest", "times/at rest", "errors/at rest", "ms until the image is finished", "rms error, levels of 255"),
        Axes("moving", "times/moving", "errors/moving", "ms per frame", "rms error, levels of 255"),
    ),
    notes=(
        "PyVista windows, all of VTK's work included; the camera turns by 1.14° between frames. *moving*: a frame "
        "during the turn; *at rest*: the finished picture, and the time from the change to it. Both "
        "are the same but for *refined*, which then draws the samples of a screenshot, 16 unless a number is set, "
        "each with the camera moved by parts of a pixel: for a single set of lines at once, *singly* one "
        "after the other, as in all other scenes. *samples*: the number of pictures averaged into the finished one. "
        "*shimmer*: the mean difference of the colours of two frames while the camera turns by 0.1° between them, "
        "over the pixels that show anything in either.",
        "Errors are root mean squares over the pixels that show anything, beside the mean of 256 pictures (64 in quick "
        "runs) whose camera is moved on a regular grid in the pixel: a box filter one pixel wide. It is made for each "
        "scene without any smoothing, of lines of their full width (OpenGL's own lines of one pixel are thinner where "
        "they are slanted), of halos that do not blend with lines; *p99* and *max* are of the finished picture.",
        "*MSAA*, *SSAA* and *FXAA* are VTK's own. MSAA smooths the meshes in a scene, no lines or tubes of this "
        "program, and averages light, not colours: its error is partly that. SSAA has a wider filter. *lines drawn by "
        "VTK*: the lines of *bundle* by ``add_mesh``; there, *refined* is set, since nothing of this program is "
        "in the scene. OpenGL draws other pixels of such lines under MSAA: its reference there is the mean of pictures "
        "under MSAA of 8.",
    ),
    run=run,
)
