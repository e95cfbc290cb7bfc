"""Pages in notebooks: what a cell keeps, and camera and choice that a page shares with the kernel."""

import json
import re
import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import pyvista as pv

import pvfiblets
from pvfiblets.plotting.notebook_view import Picked, page_view, show
from tests.page.pages import until

pytestmark = pytest.mark.more

ROOT = Path(__file__).resolve().parents[2]
SIZE = (200, 160)


@pytest.fixture
def plotter():
    lines = [np.stack([np.linspace(-40.0, 40.0, 161), np.full(161, y), np.zeros(161)], axis=1) for y in (0.0, 20.0)]
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("white")
    plotter.add_mesh(pv.Sphere(radius=0.5, center=(0.0, -20.0, 0.0)), name="ball")
    plotter.add_fiblets(pvfiblets.compress(pvfiblets.Streamlines.from_list(lines)), line_width=4.0, name="lines")
    plotter.camera_position = [(0.0, 0.0, 200.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    yield plotter
    plotter.close()


def test_backend_of_the_project_is_the_one_that_shows():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    (name, value) = next(iter(project["entry-points"]["pyvista.jupyter_backends"].items()))
    assert (name, EntryPoint(name, value, "").load()) == ("fiblets", show)


def test_cell_keeps_the_page_and_a_picture_for_who_runs_no_page(plotter):
    view = show(plotter)
    block = ET.fromstring(view._repr_html_())
    picture, frame = block.find("img"), block.find("iframe")
    assert frame.attrib["srcdoc"].startswith("<!DOCTYPE html>")
    assert (frame.attrib["sandbox"], frame.attrib["height"]) == ("allow-scripts allow-downloads", str(SIZE[1]))
    assert picture.attrib["src"].startswith("data:image/png;base64,")
    with pytest.raises(ValueError, match="height is 3; give a whole number of pixels from 50"):
        show(plotter, height=3)
    with pytest.raises(TypeError, match="no_such"):
        show(plotter, no_such=1)


def test_plotter_without_fiblets_is_the_picture_that_pyvista_shows():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.add_mesh(pv.Sphere())
    image = show(plotter)
    assert image.size == SIZE
    plotter.close()


def test_camera_of_plotter_and_page_are_one(plotter):
    pytest.importorskip("anywidget")
    view = page_view(plotter)
    other = page_view(plotter)
    assert view.state.camera["position"] == [0.0, 0.0, 200.0]
    plotter.camera.position = (0.0, 100.0, 0.0)
    assert view.state.camera["position"] == other.state.camera["position"] == [0.0, 100.0, 0.0]
    view.state.set_state({"camera": {**view.state.camera, "position": [50.0, 0.0, 0.0], "parallel": True}})  # the page
    assert plotter.camera.position == (50.0, 0.0, 0.0)
    assert plotter.camera.parallel_projection
    assert other.state.camera["position"] == [50.0, 0.0, 0.0]
    with pytest.raises(Exception, match="give position, focal_point and up of three numbers"):
        view.state.camera = {"position": [1.0, 2.0]}
    before = plotter.camera.GetClassName(), plotter.camera.HasObserver("ModifiedEvent")
    assert before[1]
    del view, other


def test_picked_streamline_is_told_both_ways(plotter):
    pytest.importorskip("anywidget")
    view, told = page_view(plotter), []
    view.state.observe(lambda change: told.append(view.picked), "picked")
    assert view.picked is None
    view.state.set_state({"picked": {"layer": 1, "streamline": 1, "place": [0.0, 20.0, 0.0]}})
    assert told == [Picked("lines", 1, (0.0, 20.0, 0.0))]
    view.picked = Picked("lines", 0)
    assert view.state.picked == {"layer": 1, "streamline": 0}
    view.picked = None
    assert view.picked is None
    with pytest.raises(ValueError, match=r"the name 'ball of wool'; the page shows \['ball', 'lines'\]"):
        view.picked = Picked("ball of wool", 0)


def test_without_anywidget_the_page_is_there_alone(plotter, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    view = page_view(plotter)
    assert view.state is None
    assert view.picked is None
    with pytest.raises(RuntimeError, match=r"pip install pvfiblets\[notebook\]"):
        view.picked = Picked("lines", 0)


HOST = """<!DOCTYPE html><body data-state="host">
%s
<script type="module">
const bridge = (await import("data:text/javascript;base64," + btoa(%s))).default;
const heard = {}, values = %s;
window.kernel = { values, saved: 0 };
const model = {
  get: (name) => values[name],
  set: (name, value) => { values[name] = value; (heard[`change:${name}`] ?? []).forEach((one) => one()); },
  on: (name, call) => (heard[name] ??= []).push(call),
  save_changes: () => ++kernel.saved,
};
kernel.set = model.set;
kernel.stop = bridge.initialize({ model });
</script>"""


def test_frame_and_model_of_a_notebook_talk(plotter, visit, tmp_path):
    """The real frame and the model's real script, in a page that stands for the notebook."""
    pytest.importorskip("anywidget")
    view = page_view(plotter, height=SIZE[1])
    script = (ROOT / "pvfiblets" / "plotting" / "notebook_state.js").read_text()
    values = {"name": view._name, "camera": view.state.camera, "picked": None}
    path = tmp_path / "notebook.html"
    path.write_text(HOST % (view._repr_html_(), json.dumps(script), json.dumps(values)))
    page = visit(path, size=(SIZE[0] + 16, SIZE[1] + 40)).page
    frame = page.frames[1]
    frame.wait_for_selector("body[data-state=drawn]")
    frame.evaluate("pvfiblets.settled()")
    assert page.evaluate("kernel.saved") == 0  # what both know is not told
    canvas = frame.locator("#view")
    box = canvas.bounding_box()
    canvas.click(position={"x": box["width"] / 2, "y": box["height"] / 2})
    until(page, "kernel.values.picked")
    picked = page.evaluate("kernel.values.picked")
    view.state.set_state({"picked": picked})
    assert (view.picked.name, view.picked.streamline) == ("lines", 0)
    np.testing.assert_allclose(view.picked.place, (0.0, 0.0, 0.0), atol=0.6)
    canvas.press("ArrowRight")
    until(page, "kernel.values.camera.position[0] !== 0")
    view.state.set_state({"camera": page.evaluate("kernel.values.camera")})
    assert np.linalg.norm(plotter.camera.position) == pytest.approx(200.0)
    assert plotter.camera.position[0] != 0.0
    saved = page.evaluate("kernel.saved")
    plotter.view_xy()
    page.evaluate("(camera) => kernel.set('camera', camera)", view.state.camera)
    view.picked = Picked("lines", 1)
    page.evaluate("(picked) => kernel.set('picked', picked)", view.state.picked)
    until(frame, "document.getElementById('status').textContent.startsWith('Streamline 1 of lines')")
    frame.evaluate("pvfiblets.settled()")
    np.testing.assert_allclose(frame.evaluate("pvfiblets.camera.state.position"), plotter.camera.position)
    assert page.evaluate("kernel.saved") == saved  # nothing comes back
    page.evaluate("kernel.stop()")


CELLS = (
    """
import pyvista as pv
from pvfiblets.plotting.notebook_view import Picked, show
if "fiblets" not in [one.name for one in pv.registered_jupyter_backends()]:
    pv.register_jupyter_backend("fiblets", show)  # the installed metadata are older than the project's
plotter = pv.Plotter(notebook=True, window_size=(300, 200))
actor = plotter.add_fiblets("lines.fiblets", color="red", line_width=3, lighting=False, name="lines")
view = plotter.show(jupyter_backend="fiblets", return_viewer=True)
view
""",
    'view.picked = Picked("lines", 1)\nplotter.camera.azimuth = 90\nprint(view.state.camera["position"])',
)


def test_executed_notebook_keeps_the_page_and_has_the_state(visit, tmp_path):
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    nbconvert = pytest.importorskip("nbconvert")
    lines = [np.cumsum(np.full((n, 3), 0.5), axis=0) for n in (40, 200)]
    pvfiblets.compress(pvfiblets.Streamlines.from_list(lines)).save(tmp_path / "lines.fiblets")
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS])
    nbclient.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in book.cells for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error"]
    kept = next(output.data["text/html"] for output in outputs if "data" in output)
    name = re.search(r'name="(pvfiblets-[0-9a-f]{32})"', kept)[1]
    states = book.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"].values()
    (state,) = [one["state"] for one in states if one["state"].get("name") == name]
    assert state["picked"] == {"layer": 0, "streamline": 1}
    assert str(state["camera"]["position"]) in "".join(output.get("text", "") for output in outputs)
    text, _ = nbconvert.HTMLExporter(exclude_input=True).from_notebook_node(book)
    page = tmp_path / "saved.html"
    page.write_text(re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL))  # none of the exporter's own is needed
    shown = visit(page).page
    frame = shown.wait_for_selector(f"iframe[name='{name}']").content_frame()
    frame.wait_for_selector("body[data-state=drawn]")
