"""The record and the direction table hold what their documents say."""

import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvfiblets.codec import direction_codebook, layout
from pvfiblets.codec.kernels import nearest

from . import reference


def test_fields_tile_their_words_without_overlap():
    for array, words in (("anchors", 2), ("decoding", 3)):
        used = [0] * words
        for f in layout.FIELDS.values():
            if f.array == array:
                bits = f.mask << f.shift
                assert used[f.word] & bits == 0, f.name
                used[f.word] |= bits
        assert used == [0xFFFFFFFF] * words


def test_field_widths_hold_the_largest_page():
    largest_codes = layout.WIDE_HEADER + (layout.MAX_POINTS - 1) * 4
    assert (layout.PAGE - 1) * largest_codes <= layout.FIELDS["code"].mask
    assert (layout.PAGE - 1) * layout.MAX_POINTS <= layout.FIELDS["point"].mask
    assert layout.PAGE - 1 <= layout.FIELDS["rank"].mask


@given(st.data())
def test_pack_and_unpack_are_inverse(data):
    for array in ("anchors", "decoding"):
        fields = [f for f in layout.FIELDS.values() if f.array == array]
        values = {f.name: data.draw(st.integers(0, f.mask)) for f in fields}
        words = layout.pack(array, **values)
        assert {name: int(layout.unpack(name, words)[0]) for name in values} == values


def test_pack_refuses_what_does_not_fit():
    good = {f.name: 0 for f in layout.FIELDS.values() if f.array == "anchors"}
    with pytest.raises(ValueError, match=r"rank holds 0\.\.16383, got 16384"):
        layout.pack("anchors", **(good | {"rank": 16384}))
    with pytest.raises(ValueError, match="needs exactly the fields"):
        layout.pack("anchors", rank=1)


@given(st.lists(st.tuples(*[st.integers(-511, 511)] * 3), max_size=5))
def test_end_vectors_pack_and_unpack(vectors):
    words = layout.pack_ends(np.array(vectors, int).reshape(-1, 3))
    assert words.dtype == np.uint32
    assert (words >> 30 == 0).all()
    assert [tuple(v) for v in layout.unpack_ends(words).tolist()] == vectors


def test_end_vectors_stand_where_they_are_said_to():
    assert layout.pack_ends(np.array([[1, 2, 3], [-1, 0, 0], [0, 0, -511]])).tolist() == [3147777, 1023, 537919488]
    with pytest.raises(ValueError, match=r"holds -511\.\.511, got 0\.\.512"):
        layout.pack_ends(np.array([[512, 0, 0]]))


def test_codes_are_smallest_rotations_within_their_cap():
    directions = direction_codebook.directions()
    q = direction_codebook.quaternions().astype(np.float64)
    assert np.abs(np.linalg.norm(q, axis=-1) - 1).max() < 1e-7
    assert np.all(q[..., 1] == 0), "the smallest rotation from X to another direction has no part about X"
    for cap, degrees in enumerate(direction_codebook.CAP_DEGREES):
        turn = np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(directions[cap] - [1, 0, 0], axis=1) / 2, 0, 1)))
        assert turn[0] == 0
        assert turn.max() <= degrees * (1 + 1e-6)
        assert turn.max() >= 0.95 * degrees
        assert len(np.unique(directions[cap], axis=0)) == direction_codebook.CODES


def test_tables_are_the_same_everywhere():
    """Files hold codes, not directions: a table that changed would silently bend every file."""
    assert zlib.crc32(direction_codebook.packed().astype("<u4").tobytes()) == 983017696
    assert zlib.crc32(direction_codebook.packed_scales().astype("<f4").tobytes()) == 3030463841
    assert zlib.crc32(direction_codebook.quaternions().astype("<f4").tobytes()) == 3427054955


def test_rotations_are_what_their_packed_words_say():
    """Unpacked in float64 from the description, against the float32 that everything decodes with."""
    q, words = direction_codebook.quaternions().astype(np.float64), direction_codebook.packed().astype(np.int64)
    scale = direction_codebook.packed_scales().astype(np.float64)[:, None]
    y, z = (((v & 0xFFFF) ^ 0x8000) - 0x8000 for v in (words, words >> 16))
    assert max(np.abs(y).max(), np.abs(z).max()) <= 32767
    np.testing.assert_allclose(q[..., 2], y * scale, rtol=6e-8)
    np.testing.assert_allclose(q[..., 3], z * scale, rtol=6e-8)
    np.testing.assert_allclose(q[..., 0], np.sqrt(1 - (y * scale) ** 2 - (z * scale) ** 2), atol=1e-6)
    assert (q[:, 0] == [1, 0, 0, 0]).all(), "code 0 is exactly straight on"


def test_packed_rotations_are_close_to_the_codes_directions():
    """Rounding moves a direction by less than a five-thousandth of its cap angle."""
    x = 1 - direction_codebook.cap_ratios()[:, None] * (direction_codebook.disc() ** 2).sum(1)
    lateral = np.sqrt(np.maximum(1 - x * x, 0))
    spin = direction_codebook.disc() / np.maximum(np.linalg.norm(direction_codebook.disc(), axis=1), 1e-300)[:, None]
    wanted = np.concatenate([x[..., None], lateral[..., None] * spin], axis=-1)
    moved = np.linalg.norm(direction_codebook.directions() - wanted, axis=-1).max(axis=1)
    assert (moved < np.radians(direction_codebook.CAP_DEGREES) / 5000).all()


def test_small_caps_keep_their_digits():
    closed = 2 * np.sin(np.radians(direction_codebook.CAP_DEGREES[0]) / 2) ** 2
    assert direction_codebook.cap_ratios()[0] == pytest.approx(closed, rel=1e-6)


@pytest.mark.few(7)
@pytest.mark.parametrize("cap", range(layout.CAPS))
def test_candidates_always_hold_the_nearest_code(cap):
    rng = np.random.default_rng(cap)
    rows, directions = nearest.candidates(cap), direction_codebook.directions()[cap]
    ratio = direction_codebook.cap_ratios()[cap]
    uv = rng.uniform(-nearest.EXTENT, nearest.EXTENT, (20_000, 2))
    rho2 = (uv**2).sum(1)
    keep = ratio * rho2 < 2
    uv, x = uv[keep], 1 - ratio * rho2[keep]
    v = np.concatenate([x[:, None], uv * np.sqrt(ratio * (1 + x))[:, None]], axis=1)
    best = np.argmax(v @ directions.T, axis=1)
    cell = ((uv + nearest.EXTENT) * (nearest.CELLS / (2 * nearest.EXTENT))).astype(int)
    cell = cell[:, 1] * nearest.CELLS + cell[:, 0]
    for c, code in zip(cell, best, strict=True):
        assert code in rows.codes[rows.start[c] : rows.start[c + 1]]


@given(st.tuples(*[st.floats(-1, 1, allow_subnormal=False)] * 3).filter(lambda d: np.linalg.norm(d) > 1e-3))
def test_first_direction_is_kept_to_four_thousandths_of_a_degree(d):
    direction = np.array(d) / np.linalg.norm(d)
    decoded, frame = reference.first_frame(reference.pack_direction(direction))
    assert np.linalg.norm(decoded - direction) < np.radians(0.004)
    assert np.linalg.norm(frame) == pytest.approx(1, abs=1e-12)
    assert reference.rotate_x(frame) == pytest.approx(decoded, abs=1e-12)


def test_first_frame_has_no_bad_direction():
    for d in ([1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [-1, 1e-9, -1e-9], [-1e-12, 1, 0]):
        decoded, frame = reference.first_frame(reference.pack_direction(np.array(d, float)))
        assert np.isfinite(frame).all()
        assert decoded == pytest.approx(np.array(d) / np.linalg.norm(d), abs=1e-4)
        assert reference.rotate_x(frame) == pytest.approx(decoded, abs=1e-12)
