"""Pages that draw by themselves beside NiiVue and PyVista's own: bytes, time to the first and the last picture, frames.

    python benchmarks/page.py --points 1e5 1e6 --output page.json

NiiVue (npm ``@niivue/niivue``) is fetched and bundled into a temporary folder; node and npm are needed. PyVista's page
is that of ``export_html`` (vtk.js; ``pip install trame-pyvista``), with the same lines and a colour for each point, and
is left out above ``--most-vtk`` points. All pages come from the same server of files on this machine, are opened in the
same Chromium one after the other, and are turned. A frame is counted when its pixels can be read. ``--gpu`` lets
Chromium use the graphics card; without, its software OpenGL draws.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import tempfile
import threading
import time
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pvfiblets
from pvfiblets.page.scene import PageScene, fiblet_layer
from pvfiblets.page.writing import write_page
from pvfiblets.synthetic import brain_streamlines

SIZE = (800, 600)
FRAMES = 8
FLAGS = ("--no-sandbox", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--no-first-run", "--ignore-gpu-blocklist")  # fmt: skip
SOFTWARE = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NIIVUE = """
import { Niivue } from '@niivue/niivue';
const canvas = document.getElementById('view');
const nv = new Niivue({ backColor: [1, 1, 1, 1], show3Dcrosshair: false });
window.ready = (async () => {
  await nv.attachToCanvas(canvas);
  nv.setSliceType(nv.sliceTypeRender);
  await nv.loadMeshes([{ url: FILE }]);
  nv.drawScene();
  const pixel = new Uint8Array(4);
  nv.gl.readPixels(1, 1, 1, 1, nv.gl.RGBA, nv.gl.UNSIGNED_BYTE, pixel);
  document.body.dataset.state = 'drawn';
})();
window.turn = (frames) => {
  const pixel = new Uint8Array(4), begun = performance.now();
  for (let i = 0; i < frames; ++i) {
    nv.setRenderAzimuthElevation(10 * i, 15);
    nv.drawScene();
    nv.gl.readPixels(1, 1, 1, 1, nv.gl.RGBA, nv.gl.UNSIGNED_BYTE, pixel);
  }
  return (performance.now() - begun) / frames;
};
"""
# Keeps what a page draws with, and counts what it draws.
WATCH = """(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
        const gl = get.call(this, kind, ...more);
        if (!gl || !/webgl/.test(kind) || gl.watched || !gl.drawArrays) return gl;
        gl.watched = true;
        for (const name of ['drawArrays', 'drawElements']) {
            const draw = gl[name].bind(gl);
            gl[name] = (...all) => {
                window.draws = (window.draws ?? 0) + 1;
                window.drawnBy = gl;
                return draw(...all);
            };
        }
        return gl;
    };
    window.read = () => {
        const gl = window.drawnBy;
        gl.readPixels(1, 1, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    };
})()"""
VTK_FIRST = """async () => {
    while (!window.draws) await new Promise(requestAnimationFrame);
    window.read();
}"""
# A drag by a pointer: vtk.js draws once for each move.
VTK = {
    "turned": """async (frames) => {
        const canvas = window.drawnBy.canvas.isConnected ? window.drawnBy.canvas : document.querySelector('canvas');
        const tell = (kind, x, buttons) => canvas.dispatchEvent(new PointerEvent(kind, {
            clientX: x, clientY: 300, pointerId: 1, button: kind === 'pointermove' ? -1 : 0, buttons, bubbles: true,
            cancelable: true, isPrimary: true, pointerType: 'mouse',
        }));
        tell('pointerdown', 300, 1);
        const begun = performance.now();
        for (let i = 0; i < frames; ++i) {
            const before = window.draws, gone = performance.now();
            tell('pointermove', 310 + 10 * i, 1);
            while (window.draws === before) {
                if (performance.now() - gone > 60000) throw new Error('the page does not turn');
                await new Promise(requestAnimationFrame);
            }
            window.read();
        }
        const took = (performance.now() - begun) / frames;
        tell('pointerup', 310 + 10 * frames, 0);
        return took;
    }""",
}
OURS = {
    "whole": """async (frames) => {
        const begun = performance.now();
        for (let i = 0; i < frames; ++i) {
            pvfiblets.camera.rotate(0.05, 0);
            pvfiblets.change();
            await pvfiblets.settled();
            pvfiblets.pixels();
        }
        return (performance.now() - begun) / frames;
    }""",
    "moving": """async (frames) => {
        const begun = performance.now(), before = pvfiblets.frames;
        while (pvfiblets.frames < before + frames) {
            pvfiblets.camera.rotate(0.01, 0);
            pvfiblets.change(true);
            await new Promise(requestAnimationFrame);
        }
        pvfiblets.pixels();
        return (performance.now() - begun) / frames;
    }""",
}


def serve(folder: Path) -> ThreadingHTTPServer:
    """Serve the files of a folder."""

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_: Any) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server


def bundle_niivue(folder: Path) -> str:
    """Bundle NiiVue's page and return its version."""
    (folder / "package.json").write_text('{"private": true}')
    install = ["npm", "install", "--no-audit", "--no-fund", "@niivue/niivue", "esbuild"]
    subprocess.run(install, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    (folder / "entry.js").write_text(NIIVUE.replace("FILE", "new URLSearchParams(location.search).get('file')"))
    build = ["npx", "esbuild", "entry.js", "--bundle", "--minify", "--format=esm", "--outfile=niivue.js"]
    subprocess.run(build, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return json.loads((folder / "node_modules/@niivue/niivue/package.json").read_text())["version"]


def export_vtk(lines: pvfiblets.Streamlines, path: Path) -> None:
    """Write PyVista's own page of lines that are coloured by their directions."""
    import numpy as np
    import pyvista as pv

    points, starts = np.asarray(lines.points, np.float32), np.asarray(lines.offsets)
    sizes = np.diff(starts)
    cells = np.insert(np.arange(len(points)), starts[:-1], sizes)
    steps = np.gradient(points, axis=0)
    length = np.maximum(np.linalg.norm(steps, axis=1, keepdims=True), 1e-9)
    mesh = pv.PolyData(points, lines=cells)
    mesh["colours"] = (255.0 * np.abs(steps / length)).astype(np.uint8)
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("white")
    plotter.add_mesh(mesh, scalars="colours", rgb=True, lighting=False, line_width=1)
    plotter.trame.export_html(path)
    plotter.close()


def opened(browser: Any, url: str, turns: dict[str, str]) -> dict[str, float]:
    """Return how long a page takes to its first picture and to its last, and for frames; seconds and milliseconds."""
    context = browser.new_context(viewport={"width": SIZE[0], "height": SIZE[1]})
    page = context.new_page()
    page.set_default_timeout(600_000)
    if turns is VTK:
        page.add_init_script(WATCH)
    begun = time.perf_counter()
    page.goto(url)
    if turns is VTK:
        page.evaluate(VTK_FIRST)
    else:
        page.wait_for_selector("body[data-state=drawn]", state="attached")
    found = {"first_s": time.perf_counter() - begun}
    if "whole" in turns:
        page.evaluate("pvfiblets.settled()")
    found["finished_s"] = time.perf_counter() - begun
    for name, code in turns.items():
        found[f"{name}_ms"] = page.evaluate(code, FRAMES)
    context.close()
    return {key: round(value, 3) for key, value in found.items()}


def tried(browser: Any, url: str, turns: dict[str, str]) -> dict[str, Any]:
    """Return what :func:`opened` finds, or why another program's page did not open: some take no large sets."""
    from playwright.sync_api import Error

    try:
        return dict(opened(browser, url, turns))
    except Error as error:
        return {"failed": error.message.splitlines()[0]}


def measure(points: float, browser: Any, folder: Path, base: str, most_vtk: float) -> list[dict[str, Any]]:
    """Return a row for each program."""
    lines = brain_streamlines(max(1, round(points / 188)), seed=4)
    fiblets = pvfiblets.compress(lines)
    n = fiblets.n_points
    scene = PageScene("Benchmark")
    fiblet_layer(scene, fiblets)
    written = write_page(scene, folder / "ours.html")
    pvfiblets.write(folder / "lines.trk", lines)
    html = "<!DOCTYPE html><body><canvas id='view' width='800' height='600'></canvas>"
    (folder / "niivue.html").write_text(f"{html}<script type='module' src='niivue.js'></script>")
    data = (folder / "lines.trk").stat().st_size
    rows = [
        {"program": "pvfiblets", "bytes": sum(p.stat().st_size for p in written), "data_bytes": len(scene.blobs[0])},
        {"program": "niivue", "bytes": data + (folder / "niivue.js").stat().st_size, "data_bytes": data},
    ]
    rows[0] |= opened(browser, f"{base}/ours.html", OURS)
    print(n, rows[0], flush=True)  # others may take minutes
    rows[1] |= tried(browser, f"{base}/niivue.html?file=lines.trk", {"turned": "(frames) => turn(frames)"})
    if n <= most_vtk:
        export_vtk(lines, folder / "vtk.html")
        size = (folder / "vtk.html").stat().st_size
        rows.append({"program": "pyvista", "bytes": size, "data_bytes": size})
        rows[-1] |= tried(browser, f"{base}/vtk.html", VTK)
    for row in rows:
        row |= {"points": n, "data_bytes_per_point": round(row["data_bytes"] / n, 3)}
        print(row, flush=True)
    return rows


def main() -> None:
    """Measure, and write what was found."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--points", type=float, nargs="+", default=[1e5, 1e6, 1e7])
    parser.add_argument("--most-vtk", type=float, default=2e6, help="points up to which PyVista's page is measured")
    parser.add_argument("--gpu", action="store_true", help="let Chromium use the graphics card")
    parser.add_argument("--output", metavar="JSON")
    options = parser.parse_args()
    from playwright.sync_api import sync_playwright

    path = next(found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name)))
    with tempfile.TemporaryDirectory() as name, sync_playwright() as driver:
        folder = Path(name)
        version = bundle_niivue(folder)
        server = serve(folder)
        flags = [*FLAGS, *(() if options.gpu else SOFTWARE)]
        browser = driver.chromium.launch(executable_path=path, args=flags)
        base = f"http://127.0.0.1:{server.server_address[1]}"
        rows = [row for points in options.points for row in measure(points, browser, folder, base, options.most_vtk)]
        said = {"chromium": browser.version, "niivue": version, "software_opengl": not options.gpu, "rows": rows}
        browser.close()
        server.shutdown()
    if options.output:
        Path(options.output).write_text(json.dumps(said, indent=1) + "\n")


if __name__ == "__main__":
    main()
