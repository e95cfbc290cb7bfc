"""A made-up fifth drawable, which fills the picture with one owner: all else it has from `Drawable`."""

from dataclasses import dataclass

import numpy as np
import pytest

from pvfiblets.engine import EngineError, FibletStyle, View
from pvfiblets.engine.drawable import Drawable
from pvfiblets.engine.gbuffer import GBuffer
from pvfiblets.engine.view import Style

VIEW = View((8, 6), np.eye(4))


@dataclass(frozen=True)
class GlyphStyle(Style):
    owner: int = 3


class Block:
    """What it keeps on the GPU."""

    def __init__(self, ctx, size):
        self.buffers = {"glyphs": ctx.buffer(reserve=size)}
        self.released = 0

    def release(self):
        self.released += 1
        self.buffers.clear()


class GlyphRenderer(Drawable[GlyphStyle]):
    STYLE = GlyphStyle
    pipeline = "discs"

    def __init__(self, ctx, size=64, fails=False):
        super().__init__(ctx, {})
        self.draws, self.blocks = 0, []
        with self._making():
            for _ in range(2):
                self.blocks.append(self._keep(Block(ctx, size)))
            if fails:
                raise EngineError("no room")

    def _draw(self, view, style, outside):
        self.draws += 1
        target = self._fitting("gbuffer", view.size, lambda: GBuffer(self._ctx, view.size))
        with self._passes.timed("discs"):
            target.owner.write(np.full(view.size, style.owner, "u4").tobytes())
        return target

    def _facts(self, *, counts):
        return {"glyphs_total": 7, "counted": counts}


@pytest.fixture
def glyphs(gl):
    made = GlyphRenderer(gl)
    yield made
    made.release()


def test_it_draws_when_the_view_or_the_style_changed_and_takes_no_other_style(glyphs):
    first = glyphs.render(VIEW)
    assert glyphs.render(View((8, 6), np.eye(4)), GlyphStyle()) is first
    assert (glyphs.draws, first.generation) == (1, 1)
    assert (np.frombuffer(first.owner.read(), "u4") == 3).all()
    assert glyphs.render(VIEW, GlyphStyle(owner=5)) is first
    assert (glyphs.draws, first.generation) == (2, 2)
    assert (np.frombuffer(first.owner.read(), "u4") == 5).all()
    other = glyphs.render(View((4, 6), np.eye(4)), GlyphStyle(owner=5))
    assert other is not first
    assert (other.size, glyphs.draws, other.generation) == ((4, 6), 3, 3)
    with pytest.raises(TypeError, match="style is a FibletStyle; GlyphRenderer needs a GlyphStyle"):
        glyphs.render(VIEW, FibletStyle())


def test_a_picture_for_one_call_serves_that_call_only(glyphs, gl):
    outside = gl.texture(VIEW.size, 1, dtype="u4")
    for draws in (1, 2):
        glyphs.render(VIEW, outside=outside)
        assert glyphs.draws == draws
    glyphs.render(VIEW)
    glyphs.render(VIEW)
    assert glyphs.draws == 3
    outside.release()


def test_it_says_what_it_is_made_of(glyphs):
    glyphs.render(VIEW)
    said = glyphs.explain(counts=False)
    assert [step["name"] for step in said["passes"]] == ["discs"]
    assert {part["name"]: part["bytes"] for part in said["buffers"]} == {"glyphs": 2 * 64, "gbuffer": 8 * 6 * 24}
    assert (said["features"], said["glyphs_total"], said["counted"]) == ([], 7, False)
    assert not glyphs.needs_outside(VIEW, GlyphStyle())
    assert glyphs.share == 1.0


def test_nothing_is_left_of_one_that_is_released_or_was_never_made(gl, monkeypatch):
    made = GlyphRenderer(gl)
    made.render(VIEW)
    made.release()
    made.release()
    assert [block.released for block in made.blocks] == [1, 1]
    assert made.explain()["buffers"] == []
    with pytest.raises(EngineError, match="released"):
        made.render(VIEW)
    kept = []
    monkeypatch.setattr(GlyphRenderer, "_keep", lambda self, part: kept.append(part) or Drawable._keep(self, part))
    with pytest.raises(EngineError, match="no room"):
        GlyphRenderer(gl, fails=True)
    assert [block.released for block in kept] == [1, 1]
