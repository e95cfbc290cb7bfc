"""Cameras, made-up lines and made-by-hand fiblets for the engine's tests."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from pvfiblets.report.studies.stability import render_checks

_spec = importlib.util.spec_from_file_location("fabricate", Path(__file__).with_name("fabricate.py"))
_module = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(_module)


@pytest.fixture(scope="session", autouse=True)
def classes():
    """Few as the fiblets of tests are, the compute pipeline draws them by a program for each class."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pvfiblets.engine.fiblets.pipelines.compute.FEW", 0)
        yield


@pytest.fixture(scope="session")
def fabricate():
    """Return the encoder of ``fabricate.py``."""
    return _module.fabricate


@pytest.fixture(scope="session")
def random_lines():
    """Return a maker of wandering lines with steps of about 1 mm in a box of 100 mm; some have one or two points."""

    def make(n, *, seed=0, longest=200, spread=50.0, wander=0.15):
        rng = np.random.default_rng(seed)
        lines = []
        for i in range(n):
            count = 1 + i % 2 if i < 6 else int(rng.integers(3, longest))
            d = rng.normal(0, 1, 3) + np.cumsum(rng.normal(0, wander, (count, 3)), axis=0)
            d /= np.linalg.norm(d, axis=1)[:, None]
            lines.append(rng.uniform(-spread, spread, 3) + np.cumsum(d, axis=0))
        return lines

    return make


@pytest.fixture(scope="session")
def camera():
    """Return a maker of model-view-projection matrices, perspective or parallel: that of the study of extreme cases."""
    return render_checks.camera
