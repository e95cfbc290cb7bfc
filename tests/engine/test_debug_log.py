"""What watches OpenGL's own messages notices a wrong call, and forgets it once it was told."""

from pvfiblets.engine.gl.moderngl_extras import GLExtras
from tests.debug_log import DebugLog


def test_a_wrong_call_is_noticed_once(gl):
    said = DebugLog(gl)
    assert not said.take()
    GLExtras(gl).function("glBindFramebuffer")(0x1234, 0)  # no target
    assert gl.error == "GL_INVALID_ENUM"
    (complaint,) = said.take()
    assert complaint.startswith("error: ")
    assert "glBindFramebuffer" in complaint
    assert not said.take()
