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

Drawing calls are limited to GL_MAX_DRAW_MESH_TASKS_COUNT_NV work groups, of which 65,535 are promised, as many as
GL_EXT_mesh_shader promises along an axis: 16.7 million fiblets. More are drawn by several calls.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import moderngl

from ...gl.capabilities import MESH, MESH_EXT
from ...gl.moderngl_extras import GLExtras
from ...gl.shaders import Programs
from ..data.chunks import Chunk
from .constants import TASK_FIBLETS, THREADS
from .draw_request import DrawRequest
from .hardware_raster import RasterPipeline

__all__ = ["MeshPipeline"]

PROMISED_TASKS = 65535
_BALLOT = 0x8  # of GL_SUBGROUP_SUPPORTED_FEATURES_KHR
_TASK_STAGE = 0x80  # of GL_SUBGROUP_SUPPORTED_STAGES_KHR


class MeshPipeline(RasterPipeline):
    """Draws chunks through task and mesh stages.

    Parameters
    ----------
    ctx : moderngl.Context
        With GL_NV_mesh_shader, which is taken where both are, or GL_EXT_mesh_shader.
    gl : GLExtras
    programs : Programs
    n_fiblets : int
        In all chunks.
    serial : bool
        Whether one invocation decodes a fiblet.
    max_tasks : int, optional
        Task work groups of a call, where that is less than the driver's limit.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GLExtras,
        programs: Programs,
        n_fiblets: int,
        *,
        serial: bool = False,
        max_tasks: int | None = None,
    ) -> None:
        super().__init__(ctx, gl, programs, n_fiblets)
        self.name = "mesh-serial" if serial else "mesh"
        self._max_tasks = self._most_tasks(max_tasks)
        self.features = (
            "PER_PRIMITIVE",
            *(("MESH_EXT",) if self._by_ext() else ()),
            *(("SUBGROUPS",) if self._has_ballots() else ()),
        )

    def _by_ext(self) -> bool:
        return MESH_EXT in self._ctx.extensions and MESH not in self._ctx.extensions

    def _most_tasks(self, wanted: int | None) -> int:
        most = PROMISED_TASKS if self._by_ext() else self._gl.get_integer("GL_MAX_DRAW_MESH_TASKS_COUNT_NV")
        return min(most, wanted or most)

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

    def _prepare(self, program: Any) -> None:
        """Do nothing: bindings stand in the sources."""

    def _array(self, program: Any) -> moderngl.VertexArray | None:
        return None if self._by_ext() else super()._array(program)

    def _draw(
        self,
        array: moderngl.VertexArray | None,  # noqa: ARG002
        program: Any,
        chunk: Chunk,
        request: DrawRequest,  # noqa: ARG002
    ) -> None:
        chunk.bind_storage()
        groups = -(-chunk.n_fiblets // TASK_FIBLETS)
        for first in range(0, groups, self._max_tasks):
            program["first_group"] = first
            program.draw_mesh_tasks(0, min(self._max_tasks, groups - first))
