"""Pictures are added up in float32, and their mean is drawn back."""

import numpy as np
import pytest

from pvfiblets.engine.effects.antialias_accumulation import Accumulation
from pvfiblets.engine.effects.picture_passes import Attachment

SIZE = (23, 17)
PART = (3, 2, 15, 11)


def pictures(n, seed=0):
    return np.random.default_rng(seed).integers(0, 256, (n, SIZE[1], SIZE[0], 4)).astype(np.uint8)


def part(picture):
    x, y, width, height = PART
    return picture[y : y + height, x : x + width]


@pytest.mark.parametrize("n", [1, 2, 16])
def test_the_mean_is_exact_and_only_in_its_part(gl, n):
    data = pictures(n)
    texture = gl.texture(SIZE, 4, dtype="f1")
    colour = Attachment(texture.glo, 0)
    sums = Accumulation(gl)
    for picture in data:
        texture.write(picture.tobytes())
        sums.add(colour, PART)
    assert sums.samples == n
    sums.show(colour, PART)
    found = np.frombuffer(texture.read(), np.uint8).reshape(*SIZE[::-1], 4)
    wanted = np.mean([part(picture) for picture in data], axis=0)
    assert np.abs(part(found) - wanted).max() <= 0.502
    rest = np.ones(SIZE[::-1], bool)
    part(rest)[:] = False
    assert np.array_equal(found[rest], data[-1][rest])
    assert sums.nbytes == PART[2] * PART[3] * 16
    sums.release()
    texture.release()


def test_another_picture_of_the_same_name_is_drawn_into(gl):
    """A framebuffer is kept from picture to picture; what it drew into may be gone, and its name be another's."""
    sums = Accumulation(gl)
    for value in (40, 200):
        texture = gl.texture(SIZE, 4, bytes([value]) * (4 * SIZE[0] * SIZE[1]), dtype="f1")
        colour = Attachment(texture.glo, 0)
        sums.restart()
        sums.add(colour, PART)
        texture.write(bytes(4 * SIZE[0] * SIZE[1]))
        sums.show(colour, PART)
        found = np.frombuffer(texture.read(), np.uint8).reshape(*SIZE[::-1], 4)
        assert (part(found) == value).all()
        texture.release()
    sums.release()


def test_a_float_picture_and_another_beginning(gl):
    texture = gl.texture(SIZE, 4, dtype="f4")
    colour = Attachment(texture.glo, 0, floats=True)
    sums = Accumulation(gl)
    data = np.random.default_rng(1).normal(size=(4, *SIZE[::-1], 4)).astype("f4")
    for picture in data[:2]:
        texture.write(picture.tobytes())
        sums.add(colour, (0, 0, *SIZE))
    sums.restart()
    for picture in data[2:]:
        texture.write(picture.tobytes())
        sums.add(colour, (0, 0, *SIZE))
    sums.show(colour, (0, 0, *SIZE))
    found = np.frombuffer(texture.read(), "f4").reshape(data[0].shape)
    np.testing.assert_allclose(found, data[2:].mean(axis=0), rtol=1e-6, atol=1e-6)
    sums.release()
    texture.release()


def test_samples_of_a_pixel_are_added_as_vtk_resolves_them(gl):
    """By light: of colours to the power of 2.2."""
    texture = gl.texture(SIZE, 4, samples=4, dtype="f1")
    framebuffer = gl.framebuffer([texture])
    framebuffer.clear(0.25, 0.5, 0.75, 1.0)
    sums = Accumulation(gl)
    sums.add(Attachment(texture.glo, 4), PART)
    framebuffer.clear(1.0, 0.0, 0.25, 0.0)
    sums.add(Attachment(texture.glo, 4), PART)
    plain = gl.texture(SIZE, 4, dtype="f1")
    sums.show(Attachment(plain.glo, 0), PART)
    found = part(np.frombuffer(plain.read(), np.uint8).reshape(*SIZE[::-1], 4))
    assert np.abs(found - 255.0 * np.array([0.625, 0.25, 0.5, 0.5])).max() <= 1.0
    for thing in (framebuffer, texture, plain):
        thing.release()
    sums.release()


def test_a_picture_can_be_kept_meanwhile(gl):
    data = pictures(2)
    texture = gl.texture(SIZE, 4, data[0].tobytes(), dtype="f1")
    colour = Attachment(texture.glo, 0)
    sums = Accumulation(gl)
    assert not sums.kept
    sums.keep(colour, PART)
    assert sums.kept
    texture.write(data[1].tobytes())
    sums.add(colour, PART)
    sums.show_kept(colour, PART)
    found = np.frombuffer(texture.read(), np.uint8).reshape(*SIZE[::-1], 4)
    assert np.array_equal(part(found), part(data[0]))
    sums.show(colour, PART)
    found = np.frombuffer(texture.read(), np.uint8).reshape(*SIZE[::-1], 4)
    assert np.array_equal(part(found), part(data[1]))
    sums.forget_kept()
    assert not sums.kept
    sums.release()
    sums.release()
    texture.release()
