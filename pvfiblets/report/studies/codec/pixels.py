"""The study of pixels: what compressed lines show beside the raw ones (figure 8 of the fiblets paper)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...record import Axes, Figure, Record
from ...study import Options, Study, Unavailable
from ...window import Window
from .baselines.directions import PaperFiblets, QFib
from .data_sets import DataSet, file_sets
from .errors import median_step

if TYPE_CHECKING:
    import pyvista as pv

    from pvfiblets.codec.fibletset import FibletSet

SIZE, QUICK_SIZE = (960, 720), (240, 180)
STREAMLINES, QUICK_STREAMLINES = 300, 40  # a few, as in the paper: in a dense set, pixels show the nearest of many
STEP = 0.1  # mm
FINE = 1e-3  # steps; so small an error leaves only the effect of rasterising
VIEWS = {"far": 1.0, "close": 8.0}  # zoom

Pixels = npt.NDArray[np.bool_]


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every set, view and method."""
    try:
        import pyvista as pv
    except ImportError as error:
        raise Unavailable(f"{error.name} is not installed") from error
    for data in _sets(options):
        if not options.allows(data.name):
            continue
        yield from _measured(pv, data, options)

def _sets(options: Options) -> Iterator[DataSet]:
    from pvfiblets.synthetic.trackers import tracked_streamlines

    count = QUICK_STREAMLINES if options.quick else STREAMLINES
    for algorithm in ("iFOD1", "SD_STREAM"):
        made = tracked_streamlines(algorithm, count, STEP, options.seed)
        yield DataSet(f"{algorithm}-like, {STEP:g} mm", algorithm, made)
    for data in file_sets(options, options.points):
        some = data.streamlines[: min(count, len(data.streamlines))]
        if some.n_points > len(some):
            yield DataSet(data.name, "files", some)


def _measured(pv: Any, data: DataSet, options: Options) -> Iterator[Record]:
    from pvfiblets.report.studies.codec.coded import compress

    points, offsets = data.streamlines.points, np.asarray(data.streamlines.offsets, np.int64)
    step = median_step(points, offsets)
    kept, fine = compress(data.streamlines), compress(data.streamlines, max_error=FINE * step)
    paper, qfib = PaperFiblets()(points, offsets), QFib(8)(points, offsets)
    size = QUICK_SIZE if options.quick else SIZE
    raw = _Scene(size, lambda plotter: _by_vtk(pv, plotter, points, offsets))
    methods: list[tuple[str, str, Any, float]] = [
        ("fiblets", "drawn", lambda plotter: _drawn(plotter, kept), kept.nbytes),
        ("fiblets", "by VTK", lambda plotter: _by_vtk(pv, plotter, kept.decompress().points, offsets), kept.nbytes),
        ("fiblets", "kept to a thousandth of a step, drawn", lambda plotter: _drawn(plotter, fine), fine.nbytes),
        ("paper's fiblets", "by VTK", lambda plotter: _by_vtk(pv, plotter, paper.points(), offsets), paper.nbytes),
        ("QFib", "8 bits, by VTK", lambda plotter: _by_vtk(pv, plotter, qfib.points(), offsets), qfib.nbytes),
    ]
    try:
        wanted = {view: raw.pixels(zoom) for view, zoom in VIEWS.items()}
        for method, setting, add, nbytes in methods:
            scene = _Scene(size, add, raw.plotter.camera_position)
            try:
                for view, zoom in VIEWS.items():
                    shown = scene.pixels(zoom)
                    either = max(int((shown | wanted[view]).sum()), 1)
                    errors = {
                        "other": (shown ^ wanted[view]).sum(),
                        "beyond a pixel": beyond(shown, wanted[view]).sum() + beyond(wanted[view], shown).sum(),
                    }
                    yield Record(
                        data=f"{data.name}, {view}",
                        group=f"{data.group}-{view}",
                        approximation="pixels of raw lines",
                        method=method,
                        setting=setting,
                        errors={name: Figure(100.0 * float(n) / either, "%") for name, n in errors.items()},
                        costs={"size": Figure(nbytes / len(points), "bytes/point")},
                        ours=method == "fiblets",
                        default=setting == "drawn",
                    )
            finally:
                scene.release()
        options.driver = options.driver or raw.driver
    finally:
        raw.release()
    options.log(f"pixels: {data.name}")


def lines_of(pv: Any, points: npt.ArrayLike, offsets: npt.NDArray[np.int64]) -> Any:
    """Return poly-lines through points, for VTK to draw."""
    counts = np.diff(offsets)
    cells = np.insert(np.arange(offsets[-1]), offsets[:-1], counts)
    return pv.PolyData(np.asarray(points, np.float32), lines=cells)


def beyond(shown: Pixels, other: Pixels) -> Pixels:
    """Pixels of a picture that have none of another at their place or next to it."""
    padded = np.pad(other, 1)
    height, width = other.shape
    near = np.zeros_like(other)
    for i in range(3):
        for j in range(3):
            near |= padded[i : i + height, j : j + width]
    return shown & ~near


def _by_vtk(pv: Any, plotter: pv.BasePlotter, points: npt.ArrayLike, offsets: npt.NDArray[np.int64]) -> None:
    plotter.add_mesh(lines_of(pv, points, offsets), color="white", lighting=False, line_width=1, name="lines")


def _drawn(plotter: pv.BasePlotter, fiblets: FibletSet) -> None:
    plotter.add_fiblets(fiblets, color="white", lighting=False, show_scalar_bar=False, name="lines")


class _Scene(Window):
    """A window that shows lines in white on black."""

    def __init__(self, size: tuple[int, int], add: Callable[[Any], None], camera: Any = None) -> None:
        super().__init__(size)
        add(self.plotter)
        if camera is None:
            self.plotter.view_vector((1.0, 0.8, 0.5), (0.0, 0.0, 1.0))
        else:
            self.plotter.camera_position = camera
            self.plotter.renderer.ResetCameraClippingRange()
        self._angle = self.plotter.camera.view_angle
        self.show()

    def pixels(self, zoom: float) -> Pixels:
        """Return which pixels show a line, ``(height, width)``."""
        self.plotter.camera.view_angle = self._angle / zoom
        self.plotter.render()
        image: npt.NDArray[np.uint8] = np.asarray(self.plotter.screenshot(None))
        return np.asarray(image[..., :3].max(axis=2) > 0)


STUDY = Study(
    name="pixels",
    title="Pixels of compressed lines",
    approximates="The pixels that VTK's lines through the raw points take.",
    axes=(Axes("other", "costs/size", "errors/other", "bytes per point", "other pixels, % of those drawn"),),
    across=("errors/other", "errors/beyond a pixel"),
    notes=(
        "Figure 8 of Schertzer et al. 2022: a few streamlines, one pixel wide, without light, far (all in view) and "
        "close (8 times nearer). *other*: pixels covered in only one of the two pictures, as a share of those covered "
        "in either; *beyond a pixel*: differing pixels whose neighbours in the other picture, corners included, are "
        "empty.",
        "*by VTK*: decoded points through VTK's own lines, as the raw ones are: the effect of compression alone. "
        "*fiblets, drawn*: by this program, which snaps ends of segments to pixels; *kept to a thousandth of a step*: "
        "the same with a negligible error, which leaves the difference between the two ways of rasterising.",
    ),
    run=run,
)
