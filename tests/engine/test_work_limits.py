"""No call asks so much of a card that its system takes it for hung, and no picture shows where calls end."""

from types import SimpleNamespace

import numpy as np
import pytest

from pvfiblets.engine import View
from pvfiblets.engine.fiblets.data.chunks import plan_chunks
from pvfiblets.engine.fiblets.pipelines.limits import Limits
from pvfiblets.engine.gl.moderngl_extras import GLExtras
from pvfiblets.engine.gl.work_limits import DISCRETE, INTEGRATED, SOFTWARE, WorkLimits
from pvfiblets.engine.volumes import VolumeRenderer, VolumeStyle
from pvfiblets.volumes.raycast_options import RaycastOptions
from pvfiblets.volumes.volume import RaycastVolume

from .imagined import imagined
from .pictures import SIZE, assert_same, read

CARDS = {
    "NVIDIA Corporation | NVIDIA H200/PCIe/SSE2": DISCRETE,
    "NVIDIA Corporation | NVIDIA GeForce GTX 1650/PCIe/SSE2": DISCRETE,
    "nouveau | NV167": INTEGRATED,  # slow as one: its clock stays low
    "AMD | AMD Radeon RX 6800 XT (radeonsi, navi21, LLVM 15.0.7, DRM 3.49)": DISCRETE,
    "ATI Technologies Inc. | AMD Radeon Pro 5500M OpenGL Engine": DISCRETE,
    "AMD | AMD Radeon Graphics (radeonsi, renoir, LLVM 15.0.6, DRM 3.49)": INTEGRATED,
    "ATI Technologies Inc. | AMD Radeon(TM) Vega 8 Graphics": INTEGRATED,
    "Intel | Mesa Intel(R) UHD Graphics 620 (KBL GT2)": INTEGRATED,
    "Intel | Intel(R) Iris(R) Xe Graphics": INTEGRATED,
    "Intel | Mesa Intel(R) Arc(tm) A770 Graphics (DG2)": DISCRETE,
    "Apple | Apple M2": INTEGRATED,
    "Broadcom | V3D 4.2": INTEGRATED,
    "Mesa | llvmpipe (LLVM 15.0.6, 256 bits)": SOFTWARE,
    "Mesa | zink Vulkan 1.3(llvmpipe (LLVM 22.1.1, 256 bits) (MESA_LLVMPIPE))": SOFTWARE,
}


@pytest.mark.parametrize("name", CARDS)
def test_cards_are_known_by_their_names(name):
    vendor, renderer = name.split(" | ")
    assert WorkLimits.from_context(SimpleNamespace(info={"GL_VENDOR": vendor, "GL_RENDERER": renderer})) is CARDS[name]


@pytest.mark.parametrize("samples", [1.0, 700.0, 1e9])
def test_bands_cover_a_picture_and_are_small_enough(samples):
    limits = WorkLimits(1, 1_000_000)
    covered = np.zeros((480, 640), int)
    for x, y, width, height in limits.bands((640, 480), samples):
        covered[y : y + height, x : x + width] += 1
        assert height == 1 or width * height * samples <= limits.samples
    assert (covered == 1).all()
    assert SOFTWARE.bands((640, 480), samples) == [(0, 0, 640, 480)]


@pytest.mark.parametrize("pipeline", ["compute", "tessellation", "geometry"])
def test_chunks_are_no_larger_than_a_call_may_be(gl, monkeypatch, pipeline):
    for card in (INTEGRATED, DISCRETE):
        monkeypatch.setattr(WorkLimits, "from_context", classmethod(lambda cls, ctx, card=card: card))
        limits = Limits.from_context(gl, GLExtras(gl), pipeline, 2**31 - 4, None)
        plans = plan_chunks(imagined(40_000_000, 58, 60), limits.buffer_bytes, limits.fiblets)
        sizes = [plan.fiblets[1] - plan.fiblets[0] for plan in plans]
        assert sum(sizes) == 40_000_000
        if pipeline == "compute":  # its calls draw parts of chunks, which are as large as buffers may be
            assert max(plan.nbytes for plan in plans[:-1]) > 0.99 * limits.buffer_bytes
            assert limits.call == card.listed
            continue
        assert max(sizes) <= card.fiblets
        assert len(sizes) == -(-40_000_000 // min(card.fiblets, max(sizes)))


@pytest.mark.parametrize("sparse", [1, 4])
def test_rays_of_many_samples_are_cast_band_by_band(gl, monkeypatch, camera, sparse):
    axes = np.linspace(-1, 1, 24)
    ball = 1.5 - np.sqrt(axes[:, None, None] ** 2 + axes[:, None] ** 2 + axes**2)
    volume = RaycastVolume(ball.astype("f4"), np.diag([4.0, 4.0, 4.0, 1.0]))
    style = VolumeStyle(casting=RaycastOptions("isosurface", values=(0.8,), sparse=sparse))
    view = View(SIZE, camera(SIZE, target=(46, 46, 46)))
    pictures, calls = [], []
    for samples in (1 << 62, 100_000):
        limits = WorkLimits(1, samples)
        monkeypatch.setattr(WorkLimits, "from_context", classmethod(lambda cls, ctx, limits=limits: limits))
        renderer = VolumeRenderer(gl, volume)
        honest = WorkLimits.bands
        monkeypatch.setattr(
            WorkLimits, "bands", lambda self, *a, honest=honest: calls.append(honest(self, *a)) or calls[-1]
        )
        pictures.append(read(renderer.render(view, style)))
        monkeypatch.setattr(WorkLimits, "bands", honest)
        renderer.release()
    assert max(map(len, calls)) > 5
    assert pictures[0].drawn.sum() > 500
    assert_same(*pictures)
