"""The study of features: what each adds to a scene that has none of the others, in bytes and milliseconds."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from pvfiblets.engine.errors import EngineError

from ...drawing import drawing_context
from ...record import Axes, Figure, Record
from ...study import Options, Study
from ...timing import Comparison, turns_of
from .scenes import PLAIN, Drawn, Subject
from .subjects import brain_subject, halo_subject, tube_subject, volume_subject
from .window import in_window

if TYPE_CHECKING:
    import moderngl

    from pvfiblets.codec.fibletset import FibletSet
    from pvfiblets.streamlines import Streamlines

    from ...record import Timing

SEGMENTS, QUICK_SEGMENTS = 2_000_000, 150_000  # of a synthetic brain
STEP = 0.5  # mm
TUBES, QUICK_TUBES = 400, 60  # streamlines that are drawn as spline tubes, and with halos
VOXELS, QUICK_VOXELS = 96, 40  # along a side of a synthetic volume
SIZE, QUICK_SIZE = (1024, 768), (480, 360)
FRAMES, QUICK_FRAMES = 3, 2


def run(options: Options) -> Iterator[Record]:
    """Yield a record for every subject and feature."""
    with drawing_context(options) as ctx:
        for make in subjects(options):
            subject = make()
            yield from _measured(ctx, subject, options)
    try:
        yield from in_window(partial(brain, options), QUICK_SIZE if options.quick else SIZE, options)
    except ImportError as error:
        options.leave_out("streamlines in a window", f"{error.name} is not installed")

def _measured(ctx: moderngl.Context, subject: Subject, options: Options) -> Iterator[Record]:
    size, frames = (QUICK_SIZE, QUICK_FRAMES) if options.quick else (SIZE, FRAMES)
    path = subject.path(frames + 1, size)
    compared, shown = Comparison(subject.name, options, turns_of(ctx), frames), []
    with ExitStack() as stack:
        for feature in subject.features:
            label = f"{feature.group} {feature.name}".strip()
            if not compared.allows(label):
                continue
            try:
                drawn = Drawn(ctx, subject, feature, path)
            except EngineError as error:
                compared.refuse(label, error)
                continue
            stack.callback(drawn.release)
            shown.append(drawn)
            record = Record(
                data=f"{subject.name}, {size[0]} x {size[1]}",
                group=subject.name.replace(" ", "-"),
                approximation="nothing",
                method=feature.group,
                setting=feature.name,
                errors={},
                ours=True,
                default=feature.group == PLAIN,
            )
            compared.add(record, draw=drawn)
        plain: tuple[int, Timing] | None = None
        for record, drawn in zip(compared.finish(), shown, strict=True):
            plain = plain or (drawn.nbytes, record.times["draw"])
            record.costs = _costs(drawn.nbytes, plain[0], record.times["draw"], plain[1])
            yield record


def _costs(nbytes: int, plain_nbytes: int, timing: Timing, plain: Timing) -> dict[str, Figure]:
    return {
        "memory": Figure(nbytes / 1e6, "MB"),
        "more memory": Figure((nbytes - plain_nbytes) / 1e6, "MB"),
        "more time": Figure(1e3 * (timing.each - plain.each), "ms per frame"),
    }


def brain(options: Options) -> FibletSet:
    """Make fiblets of a synthetic brain, with a per-point array ``'height'``."""
    from pvfiblets.report.studies.codec.coded import compress
    from pvfiblets.synthetic import brain_streamlines, streamline_count

    segments = QUICK_SEGMENTS if options.quick else SEGMENTS
    made = brain_streamlines(streamline_count(segments, STEP), step=STEP, seed=options.seed)
    made.per_point = {"height": made.points[:, 2].copy()}
    return compress(made, per_point=("height",))


def subjects(options: Options) -> list[Callable[[], Subject]]:
    """Return what makes each subject, so that one at a time is in memory."""

    def streamlines() -> Streamlines:
        from pvfiblets.synthetic import brain_streamlines

        return brain_streamlines(QUICK_TUBES if options.quick else TUBES, step=1.0, seed=options.seed)

    def tubes() -> Subject:
        from pvfiblets.tubes import as_spline_tubes

        made = streamlines()
        radius = 0.5 + 0.3 * np.sin(np.arange(made.n_points) / 5.0)
        return tube_subject(as_spline_tubes(made, radius=radius, scalars=radius))

    def halos() -> Subject:
        from pvfiblets.halos.build import as_halo_lines

        made = streamlines()
        lines, _ = as_halo_lines(made, filter_by=made.points[:, 2].copy())
        return halo_subject(lines)

    def volume() -> Subject:
        from pvfiblets.volumes import RaycastVolume

        n = QUICK_VOXELS if options.quick else VOXELS
        x, y, z = np.meshgrid(*[np.linspace(-1.0, 1.0, n)] * 3, indexing="ij")
        waves = np.cos(9.0 * x) * np.cos(7.0 * y) * np.cos(8.0 * z)
        values = np.clip(1.2 - np.sqrt(x * x + y * y + z * z) + 0.2 * waves, 0.0, None).astype(np.float32)
        return volume_subject(RaycastVolume(values))

    return [lambda: brain_subject(brain(options)), tubes, halos, volume]


STUDY = Study(
    name="features",
    title="What features cost",
    approximates=(
        "No approximation: what each feature adds to a plain scene, in bytes on the GPU and in milliseconds a frame. A "
        "feature that is off is not there: no code, no buffer, no pass."
    ),
    axes=(Axes("cost", "times/draw", "costs/memory", "ms per frame", "memory on the GPU, MB", alternatives=False),),
    notes=(
        "Plain streamlines are thin, coloured by direction, culled in two phases; plain spline tubes and lines with "
        "halos have one colour, the latter straight halos of one width; the plain volume shows greatest values. "
        "Each feature alone is added to that. *memory*: all buffers and textures on the GPU, those of the picture "
        "included; *more memory*, *more time*: beside the plain scene; negative numbers are a gain, as of features "
        "that leave less to draw. The camera turns 1.14° a frame, and the frames of all features take turns.",
        "Pictures are of the engine without VTK, each waited for. Where OpenGL is software, times are the processor "
        "time of all its threads; on a graphics card they are elapsed. Measurements and compilation that happen once, "
        "when a feature is set, are not included.",
        "Effects on a whole *picture* receive the scene's depths and synthetic colours of one sample a pixel in place "
        "of VTK's picture; that input is not counted, the memory of the effects is.",
        "*in a window*: the same streamlines in a PyVista window, all of VTK's work included, with colours, depth "
        "cueing and illuminated lines, which VTK's shader writes. Frames with and without a feature take turns. "
        "*change*: the feature is set anew and drawn at once, which is what dragging costs.",
    ),
    run=run,
)
