"""What the tests of the web room share: a folder of small files, and a scene that has it as its root."""

import asyncio
import inspect

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.streamlines import Streamlines


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    """Run tests that are coroutines; only a hang reaches the bound."""
    if not inspect.iscoroutinefunction(pyfuncitem.obj):
        return None
    arguments = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    asyncio.run(asyncio.wait_for(pyfuncitem.obj(**arguments), 250))
    return True


def sixty_lines():
    """Return 60 straight lines along x, 10 to 69 mm long, on a grid of 10 by 6 in y and z, 4 mm apart.

    ``fa`` rises from 0 to 1 along each; ``weight`` is the line's number; the first 30 are the group ``near``.
    """
    lines, fa = [], []
    for i in range(60):
        x = np.linspace(0.0, 10.0 + i, 2 * (10 + i) + 1)
        lines.append(np.stack([x, np.full_like(x, 4.0 * (i % 10)), np.full_like(x, 4.0 * (i // 10))], axis=1))
        fa.append(x / x[-1])
    return Streamlines.from_list(
        lines,
        per_point={"fa": np.concatenate(fa)},
        per_streamline={"weight": np.arange(60.0)},
        groups={"near": np.arange(30), "far": np.arange(30, 60)},
    )


@pytest.fixture(scope="session")
def lines():
    return sixty_lines()


@pytest.fixture(scope="session")
def _files(tmp_path_factory, lines):
    import nibabel

    folder = tmp_path_factory.mktemp("served")
    pvfiblets.write(folder / "lines.trk", lines)
    pvfiblets.compress(lines, per_point=["fa"]).save(folder / "lines.fiblets")
    pv.Sphere(radius=8.0, center=(20.0, 18.0, 10.0)).save(folder / "ball.ply")
    pv.Plane().save(folder / "open.ply")
    curve = pv.Spline([(0, -10, 0), (20, -14, 5), (40, -10, 0)], 30)
    curve["radius"] = np.linspace(1.0, 3.0, 30)
    curve.save(folder / "vessel.vtp")
    x = np.linspace(-1.0, 1.0, 16)
    ball = 1.0 - np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2)
    affine = np.diag([4.0, 4.0, 4.0, 1.0])
    nibabel.save(nibabel.Nifti1Image(ball.astype(np.float32), affine), folder / "head.nii.gz")
    labels = np.zeros((16, 16, 16), np.int16)
    labels[:4], labels[4:8] = 3, 5
    affine[0, 3] = 0.3  # so that no line ends where two labels meet
    nibabel.save(nibabel.Nifti1Image(labels, affine), folder / "atlas.nii.gz")
    return folder


@pytest.fixture
def folder(_files, tmp_path):
    """Return a folder of its own with links to the files, so that a test may write there."""
    import shutil

    home = tmp_path / "root"
    home.mkdir()
    for file in _files.iterdir():
        shutil.copy(file, home / file.name)
    return home


@pytest.fixture
def plotter():
    """Return an off-screen plotter on black, without anti-aliasing, so that colours are pure."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 160))
    plotter.set_background("black")
    plotter.disable_anti_aliasing()
    yield plotter
    plotter.close()


@pytest.fixture
def scene(plotter, folder):
    """Return an empty scene whose root is the folder."""
    from pvfiblets.web.scene.scene import Scene

    scene = Scene(plotter, folder)
    yield scene
    scene.close()


def look_down(scene, at, per_pixel):
    """Look along z from above at a place, with so many mm a pixel, and draw."""
    x, y, z = at
    scene.cameras.set_camera(
        {"position": [x, y, z + 300], "focal_point": [x, y, z], "up": [0, 1, 0], "view_angle": 30.0,
         "parallel": True, "parallel_scale": per_pixel * scene.plotter.window_size[1] / 2}
    )  # fmt: skip
    scene.cameras.screenshot()


@pytest.fixture
def flat(scene):
    """Return the scene with the sixty lines seen along z from above, 0.5 mm a pixel, without light or a bar."""
    layer = scene.open("lines.trk")
    scene.set(layer.id, "scalars", None)
    scene.set(layer.id, "lighting", False)
    look_down(scene, (30, 18, 0), 0.5)
    return scene


@pytest.fixture
def ball(scene):
    """Return the scene with a ball of 8 mm around (20, 18, 10), from above at a quarter of a millimetre a pixel."""
    scene.open("ball.ply")
    look_down(scene, (20, 18, 10), 0.25)
    return scene


# Pages in a browser: see browsing.py


@pytest.fixture(scope="module")
def browser():
    """Return Chromium, or skip where there is none."""
    from tests.web.browsing import launched

    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def served(tmp_path_factory, _files):
    """Return a function that starts a server of the small files; the same arguments give the same server."""
    import shutil

    from tests.web.browsing import Served

    started = {}

    def serve(*arguments):
        if arguments not in started:
            root = tmp_path_factory.mktemp("site") / "root"
            shutil.copytree(_files, root)
            paths = [root / name if (root / name).is_file() else name for name in arguments]
            started[arguments] = Served(*paths, root=root)
        return started[arguments]

    yield serve
    for server in started.values():
        server.stop()


@pytest.fixture(scope="module")
def _pages(browser, served):
    pages = {}
    yield pages
    for found in pages.values():
        found.close()


@pytest.fixture
def revisit(_pages, browser, served):
    """Return a function that opens a page that tests of a module share; each finds it as the first one did."""
    from tests.web.browsing import Visit

    def open_page(*arguments, **options):
        asked = arguments, tuple(sorted(options.items()))
        if asked in _pages:
            return _pages[asked].begin_again()
        found = _pages[asked] = Visit(browser, served(*arguments), **options)
        return found.open().remember()

    yield open_page
    for found in _pages.values():
        errors, found.errors[:] = list(found.errors), []
        assert not errors


@pytest.fixture
def visit(browser, served):
    """Return a function that opens a page of a server; errors on its console fail the test."""
    from tests.web.browsing import Visit

    visits = []

    def open_page(*arguments, opened=True, **options):
        found = Visit(browser, served(*arguments), **options)
        visits.append(found)
        return found.open() if opened else found

    yield open_page
    errors = []
    for found in visits:
        errors += found.errors
        found.close()
    assert not errors
