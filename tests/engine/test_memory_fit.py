"""Sets larger than memory: refused before anything is allocated, or an even share drawn; copied in slices."""

import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets import FibletSet, Streamlines, compress
from pvfiblets.codec.editing.restrict import even_share, restrict
from pvfiblets.engine import EngineError, FibletRenderer, FibletStyle, View
from pvfiblets.engine.errors import GPUMemoryError
from pvfiblets.engine.fiblets import renderer
from pvfiblets.engine.fiblets.data import memory_fit, upload
from pvfiblets.engine.fiblets.pipelines import Limits
from pvfiblets.engine.gl.moderngl_extras import INTEGERS, GLExtras
from pvfiblets.support import memory

from .pictures import SIZE, assert_same, brain_with_gaps, draw, read

WHOLE_BRAIN = {"eye": (0, -300, 40), "target": (0, -10, 20), "far": 900.0}


@pytest.fixture(scope="module")
def brain():
    return brain_with_gaps(3000, 1.0)


def bytes_of(made):
    """What a renderer holds on the GPU, but for its picture."""
    return sum(b["bytes"] for b in made.explain()["buffers"] if b["name"] not in ("gbuffer", "occlusion"))


@pytest.fixture
def allocations(gl, monkeypatch):
    """Sizes of all buffers that were asked for."""
    sizes = []
    honest = gl.buffer
    monkeypatch.setattr(gl, "buffer", lambda *a, **k: sizes.append(a or k) or honest(*a, **k))
    return sizes


def test_too_large_is_refused_before_anything_is_allocated(gl, brain, allocations, monkeypatch):
    with pytest.raises(GPUMemoryError) as caught:
        FibletRenderer(gl, brain, max_total_bytes=100_000)
    said = str(caught.value)
    assert said.startswith(f"{brain.n_fiblets} fiblets need ")
    assert "0.1 MB are available, as requested" in said
    assert "for records and codes" in said
    assert said.endswith("draw fewer streamlines, an even share of them by fit='sample', or all of them part by part "
                         "by fit='stream'")  # fmt: skip
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: 50_000_000)
    for software, whose in ((True, "of the machine's own"), (False, "by the driver's word")):
        monkeypatch.setattr(memory_fit, "is_software", lambda ctx, software=software: software)
        with pytest.raises(GPUMemoryError, match=rf"99\.5 for a picture\), 50\.0 MB are available, {whose}; "):
            FibletRenderer(gl, brain)
    assert not allocations


def test_a_set_that_just_fits_is_drawn_whole(gl, brain):
    made = FibletRenderer(gl, brain)
    needed = bytes_of(made)
    made.release()
    for more, whole in ((200_000, True), (-200_000, False)):
        made = FibletRenderer(gl, brain, fit="sample", max_total_bytes=needed + brain.n_points + more)
        assert (made.share == 1.0) == whole
        made.release()


@pytest.mark.few(1)
@pytest.mark.parametrize("kilobytes", [100, 250, 500])
def test_a_sample_is_an_even_share_and_fits(gl, brain, camera, kilobytes):
    view, limit = View(SIZE, camera(SIZE, **WHOLE_BRAIN)), 1000 * kilobytes
    made = FibletRenderer(gl, brain, fit="sample", max_total_bytes=limit)
    assert 0.0 < made.share < 1.0
    assert made.explain()["share"] == made.share
    made.render(view, FibletStyle(values="height"))
    assert 0.6 * limit < bytes_of(made) <= limit
    taken = restrict(brain, even_share(brain, made.share))
    assert len(np.flatnonzero(np.diff(taken.offsets()))) == pytest.approx(3000 * made.share)
    for style in (FibletStyle(), FibletStyle(values="height"), FibletStyle(2.0, values="arc_length")):
        picture = read(made.render(view, style))
        assert picture.drawn.sum() > 1000
        assert_same(picture, draw(gl, taken, view, style))
    assert made.value_range("height") == FibletRenderer(gl, brain).value_range("height")
    ids = set(picture.ids[picture.drawn][:, 0].tolist())
    assert ids <= set(taken.rank_to_id.tolist())
    assert max(ids) > 2500, "numbers are those of the whole set"
    made.release()


def test_samples_are_nested(gl, brain):
    shares = []
    for limit in (100_000, 250_000, 500_000):
        made = FibletRenderer(gl, brain, fit="sample", max_total_bytes=limit)
        shares.append(set(made._fiblets.rank_to_id.tolist()))
        made.release()
    assert shares[0] < shares[1] < shares[2]


def test_free_memory_counts_the_picture_and_where_it_is_shared_the_copy(gl, brain, monkeypatch):
    """With software OpenGL the GPU's buffers and the sample itself lie in the same memory."""
    free = memory_fit.PICTURE_BYTES + 600_000
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: free)
    monkeypatch.setattr(memory_fit, "free_host_memory", lambda: free)
    shares = []
    for software in (True, False):
        monkeypatch.setattr(memory_fit, "is_software", lambda ctx, software=software: software)
        with pytest.raises(GPUMemoryError, match=f"{free / 1e6:.1f} MB are available, "):
            FibletRenderer(gl, brain)
        monkeypatch.setattr(memory_fit, "RESERVE", 0.0)
        made = FibletRenderer(gl, brain, fit="sample")
        shares.append(made.share)
        made.release()
    assert 0.4 < shares[0] / shares[1] < 0.75


def test_little_memory_of_the_machine_limits_a_sample_too(gl, brain, monkeypatch):
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: None)
    monkeypatch.setattr(memory_fit, "free_host_memory", lambda: brain.nbytes // 4)
    made = FibletRenderer(gl, brain, fit="sample")
    assert made.share == 1.0, "the set is there already"
    made.release()
    made = FibletRenderer(gl, brain, fit="sample", max_total_bytes=600_000)
    assert made.share < 0.25
    made.release()


def test_where_no_streamline_fits_that_is_said(gl, brain, allocations):
    with pytest.raises(GPUMemoryError, match="not one streamline fits: .* 0.0 MB are available"):
        FibletRenderer(gl, brain, fit="sample", max_total_bytes=100)
    assert not allocations


def test_an_empty_set_takes_no_memory_but_for_the_picture(gl, camera, monkeypatch):
    empty = compress(Streamlines(np.empty((0, 3)), [0, 0]))
    made = FibletRenderer(gl, empty, fit="sample")
    assert made.share == 1.0
    assert not read(made.render(View(SIZE, camera(SIZE)))).drawn.any()
    assert made.explain()["fiblets"] == {"total": 0, "in_frustum": 0, "drawn": 0, "visible": 0}
    made.release()
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: 1000)
    with pytest.raises(GPUMemoryError, match="not one streamline fits"):
        FibletRenderer(gl, empty, fit="sample")


@pytest.mark.parametrize("place", [0, 1000])
def test_streamlines_of_very_different_lengths(gl, place):
    """One of them is a fifth of the set, and, where it comes first, in every share."""
    long = np.cumsum(np.full((15_000, 3), 0.1), axis=0)
    short = [long[:30] + i / 10 for i in range(2000)]
    whole = compress(Streamlines.from_list([*short[:place], long, *short[place:]]))
    shares = []
    for limit in (60_000, 80_000, 120_000):
        made = FibletRenderer(gl, whole, fit="sample", max_total_bytes=limit)
        assert bytes_of(made) <= limit
        shares.append(made.share)
        made.release()
    assert 0.0 < shares[0] < shares[1] < shares[2] < 1.0


def test_more_fiblets_than_can_be_marked(gl, brain, monkeypatch):
    honest = Limits.from_context
    few = brain.n_fiblets // 3
    monkeypatch.setattr(renderer.Limits, "from_context", lambda *a: replace(honest(*a), marks=few))
    with pytest.raises(EngineError, match=f"fiblets are more than the {few} whose marks fit into this OpenGL's larg"):
        FibletRenderer(gl, brain)
    made = FibletRenderer(gl, brain, fit="sample")
    assert 0.9 * few < made._fiblets.n_fiblets <= few
    made.release()


@pytest.mark.parametrize("failures", [1, 3])
def test_a_driver_may_run_out_of_memory_only_while_uploading(gl, brain, monkeypatch, failures):
    """Memory that cannot be asked for beforehand: the share is halved until the driver takes it."""
    left = [failures]
    honest = upload.upload_chunk

    def reluctant(*arguments):
        if left[0]:
            left[0] -= 1
            raise GPUMemoryError("no GPU memory for 12 bytes of codes")
        return honest(*arguments)

    monkeypatch.setattr(upload, "upload_chunk", reluctant)
    monkeypatch.setattr(memory_fit, "free_memory", lambda ctx, gl: None)
    made = FibletRenderer(gl, brain, fit="sample")
    assert made.share == pytest.approx(0.5**failures, rel=0.15)
    assert len(made._chunks) == 1
    made.release()
    left[0] = 1
    with pytest.raises(GPUMemoryError, match="no GPU memory for 12 bytes"):
        FibletRenderer(gl, brain)


@pytest.mark.parametrize("bad", ["half", "", 3])
def test_other_words_for_fit_are_refused(gl, brain, bad):
    with pytest.raises(ValueError, match="fit is .*; expected one of None, 'sample'"):
        FibletRenderer(gl, brain, fit=bad)


# ------------------------------------------------------------------------------------------------- what is asked


class Card:
    """A driver of a card that tells how much of its memory is free, in kilobytes."""

    def __init__(self, extension):
        self.extensions = {extension}
        self.info = {"GL_RENDERER": "A card"}

    def get_integer(self, name):
        assert name in {
            "GL_NVX_gpu_memory_info": ["GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX"],
            "GL_ATI_meminfo": ["GL_VBO_FREE_MEMORY_ATI"],
        }.get(next(iter(self.extensions)), [])
        return 8_000_000


def test_cards_are_asked_by_the_extensions_that_they_have():
    for extension, free in (("GL_NVX_gpu_memory_info", 8_192_000_000), ("GL_ATI_meminfo", 8_192_000_000), ("", None)):
        card = Card(extension)
        assert memory_fit.free_memory(card, card) == free


def test_what_this_opengl_lacks_is_not_asked(gl):
    functions = GLExtras(gl)
    for name in ("GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX", "GL_VBO_FREE_MEMORY_ATI"):
        if INTEGERS[name][1] in gl.extensions:
            assert functions.get_integer(name) > 0
        else:
            with pytest.raises(EngineError, match="which this OpenGL"):
                functions.get_integer(name)
    assert memory_fit.free_memory(gl, functions) is None or memory_fit.free_memory(gl, functions) > 0


def test_memory_of_the_machine_and_of_its_group(tmp_path, monkeypatch):
    monkeypatch.setattr(memory, "_MEMORY", tmp_path / "meminfo")
    monkeypatch.setattr(memory, "_GROUP", tmp_path)
    assert memory.free_host_memory() is None
    (tmp_path / "meminfo").write_text("MemTotal:  2000 kB\nMemFree:  1 kB\nMemAvailable:    1000 kB\n")
    assert memory.free_host_memory() == 1_024_000
    (tmp_path / "memory.max").write_text("max\n")
    assert memory.free_host_memory() == 1_024_000
    (tmp_path / "memory.max").write_text("900000\n")
    assert memory.free_host_memory() == 1_024_000, "an unfinished answer is no answer"
    (tmp_path / "memory.current").write_text("600000\n")
    (tmp_path / "memory.stat").write_text("anon 1\nfile 50000\nfile_mapped 7\n")
    assert memory.free_host_memory() == 350_000


# ---------------------------------------------------------------------------------------------------- upload


def tiled(pages):
    """A set of that many full pages, all alike: records count from their page, so that copies of one are good."""
    rng = np.random.default_rng(4)
    directions = rng.normal(size=(16384, 1, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    points = rng.uniform(-50, 50, (16384, 1, 3)) + 0.5 * np.arange(60)[None, :, None] * directions
    one = compress(Streamlines(points.reshape(-1, 3), np.arange(16385) * 60))
    assert len(one.pages) == 2
    arrays = {
        name: np.concatenate([getattr(one, name)] * pages) for name in ("anchors", "decoding", "reach", "codes", "ends")
    }
    return replace(one, n_streamlines=16384 * pages, pages=np.arange(pages + 1)[:, None] * one.pages[1], **arrays)


PEAK = """
import re, sys
from pathlib import Path
import moderngl, numpy as np
from pvfiblets import FibletSet, Streamlines, compress
from pvfiblets.engine import FibletRenderer, View

def resident(what):
    return 1024 * int(re.search(what + r":\\s+(\\d+)", Path("/proc/self/status").read_text())[1])

ctx = moderngl.create_standalone_context(require=430, backend="egl")
def made(fiblets):
    return FibletRenderer(ctx, fiblets, pipeline=sys.argv[2], fit="sample", max_total_bytes=int(sys.argv[3]))
made(compress(Streamlines.from_list([np.eye(3)]))).release()  # what is loaded once
fiblets = FibletSet.open(sys.argv[1])
Path("/proc/self/clear_refs").write_text("5")  # the peak counts from here
before = resident("VmRSS")
renderer = made(fiblets)
held = sum(b["bytes"] for b in renderer.explain()["buffers"])
print(resident("VmHWM") - before, resident("VmRSS") - before, held, renderer.share)
"""


@pytest.mark.more
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="peaks of memory are read from /proc")
@pytest.mark.parametrize("pipeline", ["compute", "geometry"])
def test_a_mapped_file_is_not_in_memory_beside_its_copy(gl, tmp_path, pipeline):
    """Software OpenGL: GPU memory is memory. Beside it a few slices, and of a sample the sample."""
    fiblets = tiled(80)
    assert fiblets.nbytes > 100e6
    fiblets.save(tmp_path / "large.fiblets")
    for limit, share in ((10**9, 1.0), (70_000_000, 0.55)):
        command = [sys.executable, "-c", PEAK, str(tmp_path / "large.fiblets"), pipeline, str(limit)]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr
        peak, after, held, drawn = map(float, run.stdout.split())
        assert drawn == pytest.approx(share, abs=0.15)
        copy = 0.0 if drawn == 1.0 else drawn * fiblets.nbytes
        assert held > 50e6
        assert peak < held + copy + 40e6
        assert after < held + 0.3 * copy + 40e6


def test_a_mapped_file_draws_the_same_picture(gl, brain, camera, tmp_path):
    brain.save(tmp_path / "brain.fiblets")
    view = View(SIZE, camera(SIZE, **WHOLE_BRAIN))
    for style in (FibletStyle(), FibletStyle(values="height")):
        assert_same(draw(gl, FibletSet.open(tmp_path / "brain.fiblets"), view, style), draw(gl, brain, view, style))


def test_progress_counts_every_byte(gl, brain, monkeypatch):
    shown = []

    class Bar:
        def __init__(self, total, **_):
            self.total = total

        def __enter__(self):
            return SimpleNamespace(update=shown.append)

        def __exit__(self, *_):
            assert 0.99 * self.total < sum(shown) <= self.total

    monkeypatch.setattr("tqdm.tqdm", Bar)
    FibletRenderer(gl, brain, progress=True).release()
    assert len(shown) > 5
