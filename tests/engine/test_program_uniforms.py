"""Uniforms are set where they change, and only there."""

import moderngl
import numpy as np
import pytest

from pvfiblets.engine.gl.program_uniforms import set_uniforms
from tests.gl_calls import possible, recording

SOURCE = """
#version 430
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Out { int told[3]; };
uniform int number;
uniform ivec2 pair;
void main() { told[0] = number; told[1] = pair.x; told[2] = pair.y; }
"""


@pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
def test_what_a_program_was_told_already_costs_no_call(gl):
    with recording() as calls:
        moderngl.init_context()
        ctx = moderngl.get_context()
        program, buffer = ctx.compute_shader(SOURCE), ctx.buffer(reserve=12)
        buffer.bind_to_storage_buffer(0)
        for number, pair, changed in ((3, (4, 5), 2), (3, (4, 5), 0), (3, (4, 6), 1), (0, (4, 6), 1)):
            calls.forget()
            set_uniforms(program, number=number, pair=pair, gone=7)
            assert sum(count for name, count in calls.counts.items() if "Uniform" in name) == changed
            program.run(1)
            ctx.finish()
            assert np.frombuffer(buffer.read(), np.int32).tolist() == [number, *pair]
        buffer.release()
        program.release()
