"""Binding points do not overlap, and OpenGL agrees with what Python says of them."""

import re

import pytest

from pvfiblets.engine.fiblets.pipelines import CONSTANTS as OF_FIBLETS
from pvfiblets.engine.gl.bindings import BLOCKS, CONSTANTS, BindingError, Scope, together
from pvfiblets.engine.gl.shaders import assemble


def test_two_names_for_one_number_are_an_error():
    with pytest.raises(BindingError, match=r"10 is both 'a' of one and 'b' of one; choose a free number"):
        Scope("one", {"a": 10, "b": 10})


def test_programs_that_meet_may_not_share_a_number():
    one, other = Scope("one", {"a": 10}), Scope("other", {"b": 11})
    together(one, other)
    with pytest.raises(BindingError, match=r"10 is both 'a' of one and 'c' of third"):
        together(one, other, Scope("third", {"c": 10}))


@pytest.mark.parametrize("number", [8, 48])
def test_numbers_out_of_range_are_an_error(number):
    with pytest.raises(BindingError, match=rf"'a' is bound to {number}; numbers are 9 to 47"):
        Scope("one", {"a": number})


def test_sources_take_their_numbers_from_here():
    source = assemble("fiblets/compute/resolve_owner.comp", ["DIRECTION"], OF_FIBLETS)
    assert f"layout(std430, binding = {CONSTANTS['storage_visibility_bits']}) buffer VisibilityBits" in source
    assert re.search(rf"layout\(r32ui, binding = {CONSTANTS['image_owner']}\)[^;]*owner_image", source)


def test_a_linked_program_has_its_blocks_where_they_are_bound(gl):
    source = assemble("fiblets/compute/depth.comp", ["DIRECTION"], OF_FIBLETS)
    program = gl.compute_shader(source)
    for name in ("Frame", "Coding", "Chunk", "Rotations"):
        assert program[name].binding == BLOCKS[name]
