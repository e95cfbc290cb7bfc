"""The compute pipeline (OpenGL 4.3): decode in registers, rasterise into images with atomics.

=============  =================================================================================================
pass           task
=============  =================================================================================================
clear          empties depth and owners; only owners where lines are added to others
cull           plans the drawing: which fiblets can show, which were visible last time, which others will probably show
               by the last picture's depth, and the class of each
visible        draws the depth of the fiblets visible last time with imageAtomicMin; marks the ones that came nearest
predicted      draws the depth of fiblets that will probably show
pyramid        makes the depth so far into a pyramid
occlusion      tests the rest against it, each fiblet as a whole
refine         tests in pieces the fiblets not hidden as a whole
depth          draws the depth of the remaining fiblets
resolve_owner  draws those so marked again: where depth was kept, the least fiblet index owns the pixel and writes
               streamline, tangent and place into it
resolve_ties   writes the pixels that more than one fiblet took, by their owners
=============  =================================================================================================

Of these, predicted to refine belong to two-phase culling. Last time's fiblets and depth only decide the order: the
picture is the same whatever was seen before. There is a program for each class of fiblets
(``shaders/fiblets/compute/cull.comp``): those inside all planes of the view volume need no clipping, those drawn as
one segment no decoding. Few fiblets are all of one class: programs take longer to compile than they would spare.

Where the driver has atomics of 64 bits (GL_NV_shader_atomic_int64), the depth passes keep depth and fiblet in one word
(``shaders/fiblets/compute/nearest.glsl``). Passes make depth and owners of the words, ``split`` before the pyramid and
``owners`` at the end; then ``resolve_owner`` draws the owners alone, by the program of ``resolve_ties``, which there is
no more need of.

Each round of drawing takes its fiblets from lists that the GPU made, by indirect dispatches: the CPU issues the same
calls whatever there is to draw. A chunk is as large as buffers may be. Where it has more fiblets than one call may
draw (:mod:`pvfiblets.engine.gl.work_limits`), its arguments have several slots, a call for each. Slots
beyond the end of a list have no work groups.

The sources are in ``shaders/fiblets/compute``; what a program includes is decided by features.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import moderngl
import numpy as np
import numpy.typing as npt

from ....codec.layout import MAX_POINTS
from ...errors import EngineError
from ...gl.bindings import CLUSTER_STORAGE, CULLING, IMAGES, STORAGE
from ...gl.gl_version import version_of
from ...gl.moderngl_extras import GLExtras
from ...gl.passes import GROUP_SIZE, dispatch, has_storage, is_software
from ...gl.program_uniforms import set_uniforms
from ...gl.shaders import EXTENDED, Programs
from ...pieces import Pieces, finish
from ..data.chunks import CLUSTER, Chunk, storage_buffer
from .constants import CLASSES, GROUP_WORDS, LIST_SHARE, ROUNDS, VISIBILITY_WORDS
from .draw_request import DrawRequest
from .segment_shares import segment_shares

if TYPE_CHECKING:
    from .geometry import GeometryPipeline

__all__ = ["CLASSES", "ComputePipeline"]

ARGUMENT_BYTES = 16
RANGE_BYTES = 256  # no driver aligns ranges of storage buffers to more
SEEN, PREDICTED, REST, CANDIDATES, TIED, TESTED, LAST_LEFT, NOW_LEFT = range(ROUNDS)


FEW = 2048
"""Fiblets that are drawn by one program, without classes. A frame takes a twentieth longer by that, one of a hundred
thousand segments; the first one takes half as long, for there is less to compile."""

TUBES_BY_RASTER = True
"""Whether tubes are left to the pipeline `geometry` where software OpenGL draws: how many pixels a tube near the camera
takes is not known beforehand, and OpenGL's rasteriser has no such limit."""

SEED_OF = 1 << 23
"""Size of a set up to which a first frame begins with every eighth fiblet; larger sets begin with a smaller share. They
hide most of the other fiblets: of 7.4 million, 1.5 million are drawn instead of all."""

INT64_EXTENSIONS = "GL_NV_shader_atomic_int64", "GL_ARB_gpu_shader_int64"
"""For the least of words that hold depth and fiblet."""

CARD_FORMS: Sequence[str] = ("STORED_ROTATIONS", "PER_FIBLET", "COVER_APART")
SOFTWARE_FORMS: Sequence[str] = ()
"""Features of all programs on graphics cards, and of software OpenGL, which they slow down."""

READ_LISTS = True
"""Whether software OpenGL compiles programs of classes when they first have fiblets."""


@dataclass(frozen=True)
class MarkRange:
    """Where what the passes note of a chunk's fiblets lies in its buffer: ``visibility_bits.glsl`` has the same."""

    begin: int  # bytes
    end: int
    words: int  # of a kind of bits
    room: int  # fiblets of a list
    lengths: int
    slots: int  # calls that draw a class of a round

    @classmethod
    def at(cls, begin: int, n_fiblets: int, slot_groups: int) -> MarkRange:
        """Return the layout of a range that starts at byte `begin` of the buffer."""
        words = -(-n_fiblets // 32)
        slots = max(-(-words // (GROUP_WORDS * slot_groups)), 1)
        room = -(-n_fiblets // LIST_SHARE)
        lengths = begin + 4 * (VISIBILITY_WORDS * words + CLASSES * room)
        end = lengths + ROUNDS * CLASSES * (4 + slots * ARGUMENT_BYTES)
        return cls(begin, end + -end % RANGE_BYTES, words, room, lengths, slots)

    def length_at(self, number: int, part: int = 0) -> int:
        """Byte of the length of a class's list in a round."""
        return self.lengths + 4 * (number * CLASSES + part)

    def arguments_at(self, number: int, part: int) -> int:
        """Byte of a class's arguments in a round."""
        first = self.lengths + 4 * ROUNDS * CLASSES
        return first + (number * CLASSES + part) * self.slots * ARGUMENT_BYTES


class ComputePipeline:
    """Draws chunks into a G-buffer."""

    name = "compute"

    def __init__(
        self,
        ctx: moderngl.Context,
        programs: Programs,
        sizes: Sequence[int],  # Fiblets of each chunk
        max_groups: int,  # Work groups per axis of a dispatch
        most: int,  # Fiblets that one call may draw
        # Fiblets of a set whose pictures these shall equal in every bit, as this is a part of it: which programs draw
        # goes by their number, and rounding differs from program to program
        alike: int | None = None,
    ) -> None:
        self._ctx = ctx
        self._programs = programs
        self._max_groups = max_groups
        self._gl = GLExtras(ctx)
        self._software = is_software(ctx)
        self._int64 = ("INT64_ATOMICS",) if _has_int64_atomics(ctx) else ()
        self._forms = SOFTWARE_FORMS if self._software else CARD_FORMS
        if not has_storage(ctx, "rotations"):
            self._forms = [form for form in self._forms if form != "STORED_ROTATIONS"]
        self._shares = [(0, MAX_POINTS)]
        self._raster: GeometryPipeline | None = None
        self.planned = False  # Whether the visibility bits are the last picture's
        self._n_fiblets = sum(sizes)
        self._one_class = (self._n_fiblets if alike is None else alike) <= FEW
        self._seed_words = -(-self._n_fiblets // SEED_OF)
        self._slot_groups = max(min(most // (32 * GROUP_WORDS), max_groups), 1)
        self._marks: list[MarkRange] = []
        end = 0
        for size in sizes:
            self._marks.append(MarkRange.at(end, size, self._slot_groups))
            end = self._marks[-1].end
        self._own: dict[str, moderngl.Buffer] = {}
        self._own["visibility_bits"] = storage_buffer(ctx, np.zeros(end // 4, np.uint32), "visibility_bits")

    def list_lengths(self) -> npt.NDArray[np.uint32]:
        """Return how long the lists of the last picture were, by chunk, round and class; it waits for the GPU."""
        self._ctx.memory_barrier(moderngl.BUFFER_UPDATE_BARRIER_BIT)
        held, size = self._own["visibility_bits"], 4 * ROUNDS * CLASSES
        words = b"".join(held.read(size, offset=of.lengths) for of in self._marks)
        return np.frombuffer(words, np.uint32).reshape(-1, ROUNDS, CLASSES)

    def list_room(self, chunk: int) -> int:
        """Return how many fiblets fit into a chunk's list; longer rounds go through the bits."""
        return self._marks[chunk].room

    def read_marks(self, chunk: int) -> npt.NDArray[np.uint32]:
        """Return a chunk's bits, by kind and 32 fiblets (``visibility_bits.glsl``); it waits for the GPU."""
        of, kinds = self._marks[chunk], VISIBILITY_WORDS
        self._ctx.memory_barrier(moderngl.BUFFER_UPDATE_BARRIER_BIT)
        words = self._own["visibility_bits"].read(4 * kinds * of.words, offset=of.begin)
        return np.frombuffer(words, np.uint32).reshape(kinds, -1)

    @property
    def buffers(self) -> dict[str, Any]:
        """``visibility_bits`` (``visibility_bits.glsl``); ``nearest``: a word a pixel, with 64-bit atomics.

        And what the pipeline that draws tubes has, if it does.
        """
        others = {} if self._raster is None else self._raster.buffers
        return {**self._own, **{f"{name} of tubes": held for name, held in others.items()}}

    def draw(self, request: DrawRequest) -> None:
        """Draw all chunks; the uniform blocks are bound already."""
        finish(self.steps(request))

    def steps(self, request: DrawRequest, pieces: Pieces | None = None) -> Generator[None, None, None]:
        """Draw the same, and yield after each piece; in one without `pieces`. Pixels are the same in any case."""
        if self._software and request.tubes and TUBES_BY_RASTER:
            self._draw_by_raster(request)
            self.planned = False
            return
        self._drop_raster()
        seed = self._seed_words if not self.planned and request.occlusion is not None else 0
        self.planned = True
        if self._software:
            self._shares = segment_shares(request.line_width, request.segment)
        self._bind(request)
        target, occlusion, passes = request.target, request.occlusion, request.passes
        with passes.timed("clear"):
            clear = self._program("clear", self._int64)
            set_uniforms(clear, adds=int(request.adds))
            dispatch(clear, target.size[1], self._max_groups)
        with passes.timed("cull"):
            features = self._planning(request)
            clustered = request.clustered
            predicting = occlusion is not None and occlusion.predicts and not clustered
            if clustered:
                features.append("CLUSTERS")
            elif predicting and occlusion is not None:
                features.append(occlusion.feature)
            yield from self._run("cull", features, request, pieces, looks=predicting, seed_words=seed)
            self._barrier()
        if occlusion is not None and not occlusion.halfway:
            with passes.timed("occlusion"):
                yield from self._test("occlude", request, pieces)
        with passes.timed("visible"):
            yield from self._round("depth", SEEN, request, pieces)
        if occlusion is not None and occlusion.halfway:
            if occlusion.predicts:
                with passes.timed("predicted"):
                    if clustered:
                        yield from self._choose("choose_predicted", LAST_LEFT, request, pieces)
                    yield from self._round("depth", PREDICTED, request, pieces)
            self._split(request, marking=False)
            with passes.timed("pyramid"):
                occlusion.build(target)
                self._bind(request)  # it takes image units
            with passes.timed("occlusion"):
                if clustered:
                    yield from self._choose("choose_rest", NOW_LEFT, request, pieces)
                else:
                    yield from self._test("occlude", request, pieces)
            with passes.timed("refine"):
                yield from self._refine(request, pieces)
        with passes.timed("depth"):
            yield from self._round("depth", REST, request, pieces)
        self._split(request, marking=True)
        with passes.timed("resolve_owner"):
            yield from self._round("resolve_ties" if self._int64 else "resolve_owner", CANDIDATES, request, pieces)
        if not self._int64:
            with passes.timed("resolve_ties"):
                yield from self._round("resolve_ties", TIED, request, pieces)
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def _bind(self, request: DrawRequest) -> None:
        """Bind what all programs of a picture write to."""
        target = request.target
        for name, index in IMAGES.items():
            if (texture := getattr(target, name)) is not None:
                texture.bind_to_image(index, read=True, write=True)
        if self._int64:
            self._bind_nearest(8 * target.size[0] * target.size[1])

    def gathers_words(self, request: DrawRequest) -> bool:
        """Return whether sums for such a request are words, not floats."""
        return not (self._software and request.tubes and TUBES_BY_RASTER)

    def gather(self, request: DrawRequest) -> None:
        """Add up what all lines show; the uniform blocks are bound already."""
        assert request.gather is not None
        if not self.gathers_words(request):
            self._by_raster().gather(request)
            return
        self._drop_raster()
        if self._software:
            self._shares = segment_shares(request.line_width, request.segment)
        request.gather.bind_images()
        with request.passes.timed("gather"):
            if request.gather.own is None:
                request.gather.target.clear(self._gl)
            features = self._planning(request)
            finish(self._run("cull", features, request, seed_words=0))
            self._barrier()
            finish(self._round("gather", REST, request))
        self._ctx.memory_barrier(moderngl.ALL_BARRIER_BITS)

    def _draw_by_raster(self, request: DrawRequest) -> None:
        """Draw by the pipeline `geometry`, which reads the same buffers."""
        self._by_raster().draw(request)

    def _by_raster(self) -> GeometryPipeline:
        from .geometry import GeometryPipeline

        if self._raster is None:
            self._raster = GeometryPipeline(self._ctx, self._gl, self._programs, self._n_fiblets)
        return self._raster

    def _bind_nearest(self, size: int) -> None:
        held = self._own.get("nearest")
        if held is None or held.size != size:
            if held is not None:
                self._own.pop("nearest").release()
            try:
                held = self._own["nearest"] = self._ctx.buffer(reserve=size)
            except moderngl.Error as error:
                raise EngineError(f"no GPU memory for {size} bytes of depths and owners") from error
        held.bind_to_storage_buffer(STORAGE["nearest"])

    def _split(self, request: DrawRequest, *, marking: bool) -> None:
        """Make depth and owners of the words, if there are any; mark owners as seen, and to be drawn."""
        if not self._int64:
            return
        with request.passes.timed("owners" if marking else "split"):
            split = self._program("split", ())
            set_uniforms(split, marking=0)
            dispatch(split, request.target.size[1], self._max_groups)
            for index, chunk in enumerate(request.chunks if marking else ()):
                chunk.bind_block()
                self.bind_marks(index)
                set_uniforms(split, marking=1)
                dispatch(split, request.target.size[1], self._max_groups)
            self._barrier()

    def _planning(self, request: DrawRequest) -> list[str]:
        """Features of the program that plans a picture."""
        one = ("ONE_CLASS",) if self._one_class else ()
        return [*request.decoding, *request.detail, *request.planes, *request.tubes, *request.culling, *one]

    def _program(self, stage: str, features: Sequence[str]) -> moderngl.ComputeShader:
        return self._programs.compute(f"fiblets/compute/{stage}.comp", [*features, *self._forms])

    def _barrier(self) -> None:
        self._ctx.memory_barrier(
            moderngl.SHADER_STORAGE_BARRIER_BIT
            | moderngl.SHADER_IMAGE_ACCESS_BARRIER_BIT
            | moderngl.COMMAND_BARRIER_BIT
            | moderngl.TEXTURE_FETCH_BARRIER_BIT
            | moderngl.FRAMEBUFFER_BARRIER_BIT
        )

    def _plan(self, number: int, chunks: Sequence[Chunk], refined: bool = False) -> None:
        """List what a round has to draw, and write the arguments of the calls that do."""
        plan = self._program("plan", ())
        set_uniforms(plan, drawing=number, refined=int(refined), slot_groups=self._slot_groups)
        for index, chunk in enumerate(chunks):
            chunk.bind_block()
            self.bind_marks(index)
            set_uniforms(plan, slots=self._marks[index].slots)
            dispatch(plan, -(-chunk.n_fiblets // (32 * GROUP_SIZE)), self._max_groups)
        self._barrier()

    def _round(
        self, stage: str, number: int, request: DrawRequest, pieces: Pieces | None = None
    ) -> Generator[None, None, None]:
        """Draw one round's fiblets, class by class."""
        refined = number == REST and request.occlusion is not None and request.occlusion.halfway
        self._plan(number, request.chunks, refined)
        parts = [(self._program(stage, features), part) for part, features in self._classes_of(stage, number, request)]
        shares = self._shares if request.line_width > 0.0 else self._shares[:1]
        for share in shares:
            yield from self._run_listed(stage, parts, number, request, pieces, share=share)
            if len(shares) > 1:  # of two segments with the same depth the later one writes the pixel
                self._barrier()
        self._barrier()

    def _classes_of(self, stage: str, number: int, request: DrawRequest) -> list[tuple[int, list[str]]]:
        """Return the classes whose programs run in a round that is planned, with their features.

        Software OpenGL has finished the plan when the call returns, and takes 0.3 s to compile a program's first
        run: before a class gets a program, its fiblets are counted. Cards would have to be waited for.
        """
        looks = (request.occlusion.feature,) if request.occlusion is not None and self._tests_segments(request) else ()
        classes = [(part, [*features, *self._int64, *looks]) for part, features in request.classes(one=self._one_class)]
        name = f"fiblets/compute/{stage}.comp"
        made = all(self._programs.has_compute(name, [*each, *self._forms]) for _, each in classes)
        if made or not (READ_LISTS and self._software and self._marks):
            return classes
        self._ctx.memory_barrier(moderngl.BUFFER_UPDATE_BARRIER_BIT)
        held = self._own["visibility_bits"]
        lengths = [held.read(4 * CLASSES, offset=of.length_at(number)) for of in self._marks]
        longest = np.frombuffer(b"".join(lengths), np.uint32).reshape(-1, CLASSES).max(axis=0)
        return [one for one in classes if one[0] == 0 or longest[one[0]] > 0]

    @staticmethod
    def _tests_segments(request: DrawRequest) -> bool:
        """Whether drawing programs of samples leave out segments that a pyramid hides, not only fiblets."""
        return bool(request.samples) and request.occlusion is not None and request.occlusion.halfway

    def _run_listed(
        self,
        stage: str,
        parts: Sequence[tuple[moderngl.ComputeShader, int]],
        number: int,
        request: DrawRequest,
        pieces: Pieces | None,
        **uniforms: object,
    ) -> Generator[None, None, None]:
        """Run a program for each class of fiblets, chunk by chunk, with each chunk bound once."""
        listed = self._own["visibility_bits"]

        def tell(program: moderngl.ComputeShader) -> None:
            request.kept.bind(program)
            if request.peel is not None:
                request.peel.bind(program)
            if request.gather is not None:
                request.gather.bind(program)
            segments = self._tests_segments(request) and number in (SEEN, REST, CANDIDATES, TIED)
            if request.occlusion is not None and (number in (TESTED, LAST_LEFT, NOW_LEFT) or segments):
                request.occlusion.bind(program)
            if segments:
                set_uniforms(program, tests_segments=int(number != SEEN))  # before them there is no pyramid
            set_uniforms(program, drawing=number, **uniforms)

        for program, _ in parts:
            tell(program)
        for index, marks in enumerate(self._marks):
            self._bind_chunk(index, request)
            self._bind_clusters(number, request.chunks[index])
            for program, part in parts:
                set_uniforms(program, part=part)  # which some have in common
                at = marks.arguments_at(number, part)
                if pieces is None:
                    for slot in range(marks.slots):
                        set_uniforms(program, first_group=slot * self._slot_groups)
                        program.run_indirect(listed, at + slot * ARGUMENT_BYTES)
                    continue
                words = np.frombuffer(listed.read(marks.slots * ARGUMENT_BYTES, offset=at), np.uint32)
                for _ in self._in_pieces(stage, program, int(words[::4].sum()), request, pieces):
                    yield
                    tell(program)
                    set_uniforms(program, part=part)
                    self._bind_chunk(index, request)
                    self._bind_clusters(number, request.chunks[index])

    def _test(self, stage: str, request: DrawRequest, pieces: Pieces | None) -> Generator[None, None, None]:
        """Run a pass over all fiblets that looks at the occlusion's texture."""
        yield from self._run(stage, self._looking(request), request, pieces, looks=True)
        self._barrier()

    def _looking(self, request: DrawRequest) -> Sequence[str]:
        assert request.occlusion is not None
        return [*request.decoding, *request.detail, *request.tubes, request.occlusion.feature]

    def _refine(self, request: DrawRequest, pieces: Pieces | None) -> Generator[None, None, None]:
        """Test the survivors of the occlusion pass more closely; hidden ones leave the list."""
        program = self._program("refine", self._looking(request))
        self._plan(TESTED, request.chunks)
        parts = [(program, part) for part, _ in request.classes(one=self._one_class)]
        yield from self._run_listed("refine", parts, TESTED, request, pieces)
        self._barrier()

    @staticmethod
    def _bind_clusters(number: int, chunk: Chunk) -> None:
        if number in (LAST_LEFT, NOW_LEFT):
            chunk.buffers["clusters"].bind_to_storage_buffer(CLUSTER_STORAGE["clusters"])

    def _choose(
        self, stage: str, number: int, request: DrawRequest, pieces: Pieces | None
    ) -> Generator[None, None, None]:
        """Put the fiblets of clusters that a pyramid does not hide into a round, as a stage wants them."""
        assert request.occlusion is not None
        clusters = self._program("clusters", request.cluster_features)
        request.kept.bind(clusters)
        request.occlusion.bind(clusters)
        if number == LAST_LEFT:
            set_uniforms(clusters, pyramid=CULLING["last"])
        set_uniforms(clusters, drawing=number, slot_groups=self._slot_groups)
        for index, chunk in enumerate(request.chunks):
            chunk.bind_block()
            self.bind_marks(index)
            self._bind_clusters(number, chunk)
            set_uniforms(clusters, slots=self._marks[index].slots)
            dispatch(clusters, -(-chunk.n_fiblets // (CLUSTER * GROUP_SIZE)), self._max_groups)
        self._barrier()
        program = self._program(stage, [*self._planning(request), request.occlusion.feature])
        yield from self._run_listed(stage, [(program, 0)], number, request, pieces)
        self._barrier()

    def _run(
        self,
        stage: str,
        features: Sequence[str],
        request: DrawRequest,
        pieces: Pieces | None = None,
        *,
        looks: bool = False,
        **uniforms: object,
    ) -> Generator[None, None, None]:
        """Run a pass over all fiblets (``by_word.glsl``), which may look at the occlusion's texture."""
        program = self._program(stage, features)
        apart = "PER_FIBLET" in self._forms and "CLUSTERS" not in features
        words = GROUP_WORDS if apart else GROUP_SIZE  # of a work group

        def tell() -> None:
            request.kept.bind(program)
            if looks and request.occlusion is not None:
                request.occlusion.bind(program)
            set_uniforms(program, **uniforms)

        tell()
        for index, chunk in enumerate(request.chunks):
            self._bind_chunk(index, request)
            set_uniforms(program, slots=self._marks[index].slots)
            groups = -(-chunk.n_fiblets // (32 * words))
            if pieces is None:
                dispatch(program, groups, self._max_groups)
                continue
            for _ in self._in_pieces(stage, program, groups, request, pieces):
                yield
                tell()
                self._bind_chunk(index, request)

    def _bind_chunk(self, index: int, request: DrawRequest) -> None:
        request.chunks[index].bind_storage()
        self.bind_marks(index)
        request.kept.bind_chunk(index)

    def bind_marks(self, chunk: int) -> None:
        """Bind what the passes note of a chunk's fiblets (``visibility_bits.glsl``)."""
        of = self._marks[chunk]
        held = self._own["visibility_bits"]
        held.bind_to_storage_buffer(STORAGE["visibility_bits"], of.begin, of.end - of.begin)

    def _in_pieces(
        self, stage: str, program: moderngl.ComputeShader, groups: int, request: DrawRequest, pieces: Pieces
    ) -> Iterator[None]:
        """Run work groups of a program, some at a time; after a pause, bind the program's and the chunk's data again.

        Which groups run together is of no consequence: no pass depends on the order of fiblets.
        """
        first = 0
        while first < groups:
            count = min(pieces.groups(stage, groups - first), self._max_groups)
            set_uniforms(program, first_group=first)
            with pieces.measured(stage, count):
                program.run(count)
            first += count
            set_uniforms(program, first_group=0)
            if pieces.due:
                yield from pieces.pause()
                self._bind(request)

    def release(self) -> None:
        """Give the pipeline's own buffers back; twice is harmless."""
        for buffer in self._own.values():
            buffer.release()
        self._own.clear()
        self._drop_raster()

    def _drop_raster(self) -> None:
        if self._raster is not None:
            self._raster.release()
            self._raster = None


def _has_int64_atomics(ctx: moderngl.Context) -> bool:
    """Whether shaders take the least of 64-bit words in a storage buffer, and there is a binding left for it."""
    if version_of(ctx) < EXTENDED or not set(INT64_EXTENSIONS) <= set(ctx.extensions):
        return False
    return has_storage(ctx, "nearest")
