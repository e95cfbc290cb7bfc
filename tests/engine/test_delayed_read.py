"""Numbers that come back later: the right ones, in time, without waiting, and none are left behind."""

import moderngl
import numpy as np
import pytest

from pvfiblets.engine import FibletRenderer, FibletStyle, View
from pvfiblets.engine.gl.delayed_read import AT_ONCE, DelayedRead
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from tests.gl_calls import possible, recording

from .pictures import SIZE


@pytest.fixture
def target(gl):
    """A function: fills a picture of 5 x 3 pixels of two numbers, of which one tells its number."""
    texture = gl.texture((5, 3), 2, dtype="f4")
    framebuffer = gl.framebuffer([texture])

    def filled(number):
        texture.write(np.stack(np.broadcast_arrays(number, np.arange(15).reshape(3, 5)), -1).astype("f4").tobytes())
        return framebuffer

    yield filled
    framebuffer.release()
    texture.release()


def test_numbers_come_with_their_tags(gl, target):
    reads = DelayedRead(gl, GLExtras(gl))
    assert reads.arrived() is None
    for number in (3, 4):
        assert reads.start(target(number), (1, 0, 4, 2), 2, f"the {number}th")
    gl.finish()
    tag, numbers = reads.arrived()
    assert tag == "the 4th"  # of several the newest
    assert numbers.shape == (2, 4, 2)
    assert (numbers[..., 0] == 4).all()
    assert (numbers[..., 1] == np.arange(15).reshape(3, 5)[:2, 1:]).all()
    assert reads.arrived() is None
    reads.release()
    reads.release()
    assert reads.nbytes == 0


def test_no_more_are_on_their_way_than_a_few(gl, target, monkeypatch):
    extras = GLExtras(gl)
    reads = DelayedRead(gl, extras)
    monkeypatch.setattr(GLExtras, "passed", lambda self, fence: False)  # a GPU that is far behind
    begun = [reads.start(target(number), (0, 0, 5, 3), 2, number) for number in range(6)]
    assert begun == [True] * AT_ONCE + [False] * (6 - AT_ONCE)
    assert reads.arrived() is None
    monkeypatch.undo()
    gl.finish()
    tag, numbers = reads.arrived()
    assert tag == AT_ONCE - 1
    assert (numbers[..., 0] == tag).all()
    size = reads.nbytes
    for number in range(10):
        assert reads.start(target(number), (0, 0, 5, 3), 2, number)
        gl.finish()
        assert reads.arrived()[0] == number
    assert reads.nbytes == size == AT_ONCE * 15 * 2 * 4


@pytest.mark.skipif(not possible(), reason="calls are recorded on x86-64 and Linux only")
def test_what_waits_is_noticed(gl):
    """The recorder of calls: of the ways to read, those that wait, and not the one that does not."""

    with recording() as calls:
        moderngl.init_context()
        ctx = moderngl.get_context()
        ctx.clear_errors()
        buffer, reads = ctx.buffer(reserve=120), DelayedRead(ctx, GLExtras(ctx))
        texture = ctx.texture((5, 3), 2, dtype="f4")
        other = ctx.framebuffer([texture])
        query = ctx.query(time=True)
        calls.forget()
        reads.start(other, (0, 0, 5, 3), 2)
        while reads.arrived() is None:
            pass
        assert calls.waits == []
        assert calls.counts["glReadPixels"] == 1
        for wait, name in (
            (lambda: other.read(components=2, dtype="f4"), "glReadPixels"),
            (texture.read, "glGetTexImage"),
            (buffer.read, "glMapBufferRange"),
            (ctx.finish, "glFinish"),
            (lambda: (other.read_into(buffer, components=2, dtype="f4"), buffer.read()), "glMapBufferRange"),
        ):
            calls.forget()
            wait()
            assert [name] == calls.waits
        with query:
            buffer.write(bytes(120))
        calls.forget()
        assert query.elapsed >= 0
        assert calls.waits == ["glGetQueryObjectuiv of a result"]
        reads.release()
        for thing in (other, texture, buffer):
            thing.release()


def test_the_most_lines_of_a_pixel_may_come_later(gl, fabricate, random_lines, camera):
    renderer = FibletRenderer(gl, fabricate(random_lines(80, seed=3), kind=2))
    near, far = (View(SIZE, camera(SIZE, height=height)) for height in (120.0, 1200.0))

    def most(view, **how):
        renderer.gather(view, FibletStyle(1.0))
        return renderer.most_lines(**how)

    exact = [most(near), most(far)]
    assert exact[0] < exact[1]
    assert most(near, wait=False) == exact[1]  # of the picture before
    gl.finish()
    assert most(near, wait=False) == exact[0]
    assert most(far, wait=False) == exact[0]
    assert most(far) == exact[1]  # at once
    renderer.release()
