"""The mesh pipelines (GL_NV_mesh_shader or GL_EXT_mesh_shader): a task stage culls, a mesh stage decodes.

Paper: Schertzer et al. 2022, sections 3.3, 3.4 and 4.5, figure 2. The sources are in ``shaders/fiblets/mesh``.

===============  ==============================================================================================
pipeline         how a fiblet is decoded
===============  ==============================================================================================
``mesh``         by 32 invocations together, a prefix product in shared memory (section 3.3.2)
``mesh-serial``  by one (section 3.3.1), to compare with
===============  ==============================================================================================

What stands before and after is the same: a task work group tests :data:`TASK_FIBLETS` fiblets and tells the mesh stage
which of them are left; fragments are those of the other raster pipelines. Data come from the storage buffers that the
compute pipeline reads, so that nothing else is uploaded.

Of sets with clusters a compute stage tests these first (``shaders/fiblets/mesh/open.comp``), and marks the fiblets of
the ones that may show. The task stage reads these marks in the order of coding, which decides between equal depths.

The stages have a form for each extension. GL_EXT_mesh_shader's is taken where the driver has and compiles it, else
NVIDIA's. Both promise 65,535 task work groups a call: 16.7 million fiblets. More are drawn by several calls.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from typing import Any

import moderngl

from ...errors import EngineError
from ...gl.bindings import CLUSTER_STORAGE, CULLING, OPEN_STORAGE
from ...gl.capabilities import MESH, MESH_EXT
from ...gl.moderngl_extras import GLExtras
from ...gl.passes import GROUP_SIZE, dispatch, work_groups
from ...gl.program_uniforms import set_uniforms
from ...gl.shaders import Programs
from ..data.chunks import CLUSTER, Chunk, padded, reserve_buffer
from .constants import TASK_FIBLETS, THREADS
from .draw_request import DrawRequest
from .hardware_raster import Memory, RasterPipeline

logger = logging.getLogger("pvfiblets.engine")

PROMISED_TASKS = 65535
_BALLOT = 0x8  # of GL_SUBGROUP_SUPPORTED_FEATURES_KHR
_TASK_STAGE = 0x80  # of GL_SUBGROUP_SUPPORTED_STAGES_KHR


class MeshPipeline(RasterPipeline):
    """Draws chunks through task and mesh stages; if ``serial``, one invocation decodes a fiblet."""

    def __init__(
        self, ctx: moderngl.Context, gl: GLExtras, programs: Programs, n_fiblets: int, *, serial: bool = False
    ) -> None:
        super().__init__(ctx, gl, programs, n_fiblets)
        self.name = "mesh-serial" if serial else "mesh"
        self._max_tasks = PROMISED_TASKS
        self._open: dict[int, moderngl.Buffer] = {}  # by a chunk's first fiblet
        self._ballots = ("SUBGROUPS",) if self._has_ballots() else ()
        self._take_form("MESH_EXT" if MESH_EXT in ctx.extensions else "")

    def _take_form(self, form: str) -> None:
        self.features = ("PER_PRIMITIVE", *([form] if form else ()), *self._ballots)

    def _program(self, request: DrawRequest, features: Sequence[str]) -> moderngl.Program:
        try:
            return super()._program(request, features)
        except EngineError as error:
            if "MESH_EXT" not in self.features or MESH not in self._ctx.extensions:
                raise
            logger.info("%s was refused, trying %s: %s", MESH_EXT, MESH, str(error).partition("\n")[0])
            self._take_form("")
            return super()._program(request, features)

    def _has_ballots(self) -> bool:
        """Whether a ballot tells the answers of a whole work group."""
        if "GL_KHR_shader_subgroup" not in self._ctx.extensions:
            return False
        size, stages, features = (
            self._gl.get_integer(f"GL_SUBGROUP_{name}_KHR")
            for name in ("SIZE", "SUPPORTED_STAGES", "SUPPORTED_FEATURES")
        )
        return size == THREADS and bool(stages & _TASK_STAGE) and bool(features & _BALLOT)

    def _stages(self, request: DrawRequest) -> Mapping[str, str]:
        return {
            "task": "fiblets/mesh/fiblets.task",
            "mesh": "fiblets/mesh/serial.mesh" if self.name == "mesh-serial" else "fiblets/mesh/together.mesh",
            "fragment": "fiblets/hardware_raster/capsule.frag" if request.wide else "fiblets/hardware_raster/line.frag",
        }

    def _bind_data(self, chunk: Chunk) -> None:
        chunk.bind_storage()

    def _features(self, request: DrawRequest) -> list[str]:
        return [*super()._features(request), *(["OPEN_FIBLETS"] if request.clustered else [])]

    def _round(self, request: DrawRequest, features: Sequence[str]) -> None:
        if request.clustered:
            self._mark_open(request, second="SECOND_ROUND" in features)
        super()._round(request, features)

    def _mark_open(self, request: DrawRequest, *, second: bool) -> None:
        """Mark the fiblets of clusters that the last picture, or the first round, does not hide."""
        assert request.occlusion is not None
        if not second:
            for chunk in request.chunks:
                first, last = chunk.plan.fiblets
                if first not in self._open:
                    size = padded(8 * -(-(last - first) // 32))
                    self._open[first] = reserve_buffer(self._ctx, size, "marks of open fiblets")
                self._gl.clear_words(self._open[first])
            if not request.occlusion.predicts:
                return
        program = self._programs.compute("fiblets/mesh/open.comp", request.cluster_features)
        request.kept.bind(program)
        request.occlusion.bind(program)
        set_uniforms(program, marked_round=int(second), **({} if second else {"pyramid": CULLING["last"]}))
        for chunk in request.chunks:
            chunk.bind_block()
            chunk.buffers["clusters"].bind_to_storage_buffer(CLUSTER_STORAGE["clusters"])
            self._bind_open(chunk)
            dispatch(program, -(-chunk.n_fiblets // (CLUSTER * GROUP_SIZE)), work_groups(self._ctx))
        self._ctx.memory_barrier(moderngl.SHADER_STORAGE_BARRIER_BIT)

    def _bind_open(self, chunk: Chunk) -> None:
        self._open[chunk.plan.fiblets[0]].bind_to_storage_buffer(OPEN_STORAGE["open_fiblets"])

    @property
    def buffers(self) -> dict[str, Memory]:
        """The raster pipelines' buffers, and the marks of open fiblets, if there are clusters."""
        held = sum(buffer.size for buffer in self._open.values())
        return {**super().buffers, **({"open fiblets": Memory(held)} if held else {})}

    def release(self) -> None:
        """Give everything on the GPU back; twice is harmless."""
        super().release()
        for buffer in self._open.values():
            buffer.release()
        self._open.clear()

    def _array(self, program: Any) -> moderngl.VertexArray | None:  # noqa: ARG002 - it has its own
        return None

    def _draw(
        self,
        array: moderngl.VertexArray | None,  # noqa: ARG002
        program: Any,
        chunk: Chunk,
        request: DrawRequest,
    ) -> None:
        if request.clustered:
            self._bind_open(chunk)
        groups = -(-chunk.n_fiblets // TASK_FIBLETS)
        for first in range(0, groups, self._max_tasks):
            program["first_group"] = first
            program.draw_mesh_tasks(min(self._max_tasks, groups - first))
