// Drawing in this browser: the scene that pvfiblets/web/browser_drawing.py sends, by the script of pages, over the
// server's pictures. The server is told what there is to draw with, and where the camera is; all else it says itself.
(() => {
  "use strict";

  const PACE = 100; // ms between two words on a camera that moves
  const REST = 150; // ms without a move after which it rests
  const LOSSES = 3; // of graphics, after which this page leaves drawing to the server
  const PATIENT = 250; // ms that a change of the scene may take without a word

  const call = (name, ...args) => window.trame?.trigger(name, args);
  const get = (name) => window.trame?.state?.get(name);
  const me = Math.random().toString(36).slice(2);
  const watched = new WeakSet();
  let renderer = null, canvas = null, script = null, wanted = null, busy = false, broken = "", losses = 0;
  let data = new Map();
  let told = "", last = "", saidAt = 0, timer = 0, resting = true;
  let taken = true, patience = 0; // whether the newest scene is drawn; timer of the progress note
  let turn = 0; // of the last camera from elsewhere: the server leaves out moves that were made before it

  // What there is to draw with --------------------------------------------------------------------

  const report = () => {
    const asked = get("there")?.asked;
    if (!asked || asked === "here") return;
    if (broken) return call("there_ready", false, "", broken);
    const gl = document.createElement("canvas").getContext("webgl2", { failIfMajorPerformanceCaveat: asked === "auto" });
    if (!gl) return call("there_ready", false, "");
    const more = gl.getExtension("WEBGL_debug_renderer_info");
    const card = String(gl.getParameter(more ? more.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
    gl.getExtension("WEBGL_lose_context")?.loseContext();
    call("there_ready", true, card);
  };

  // While a scene comes and is drawn for the first time, the page says so.
  const progress = (begins) => {
    clearTimeout(patience);
    const note = document.querySelector("#pv-there-progress");
    if (begins) patience = setTimeout(() => { if (note) note.hidden = false; }, PATIENT);
    else if (note) note.hidden = true;
  };

  const fail = (error) => {
    broken = `this browser could not draw: ${error instanceof Error ? error.message : error}`;
    hide();
    call("there_ready", false, "", broken);
  };

  // The scene -------------------------------------------------------------------------------------

  const fetched = async (file) => {
    try {
      return await read(file);
    } catch (error) {
      data.delete(file);
      throw error;
    }
  };

  const read = async (file) => {
    const answer = await fetch(file, { cache: "no-store" });
    if (!answer.ok) throw new Error(`its data could not be fetched (${answer.status})`);
    return new Uint8Array(await answer.arrayBuffer());
  };

  const loaded = () => (script ??= new Promise((done, failed) => {
    const made = document.createElement("script");
    Object.assign(made, { src: "/there/page.js", onload: done, onerror: () => failed(new Error("its script could not be fetched")) });
    document.head.append(made);
  }));

  // The parts of a set, read once.
  const archives = new WeakMap();
  const opened = (scene, all) => new Map(scene.layers.filter((layer) => layer.kind === "fiblets").map(({ data: at }) => {
    if (!archives.has(all[at])) archives.set(all[at], window.pvfibletsPage.readArchive(all[at]));
    return [at, archives.get(all[at])];
  }));

  const make = (scene, all) => {
    canvas = document.querySelector("#pv-there");
    renderer = new window.pvfibletsPage.Renderer(canvas, { ...scene, camera: get("there_camera").camera }, all, opened(scene, all));
    renderer.failed = renderer.lacking = fail;
    renderer.presented = () => {
      show();
      if (taken) progress(false);
      window.pvfibletsDistances(renderer);
      follow();
    };
    window.pvfibletsPage.attachMouse(renderer, (x, y) => {
      settle();
      if (!get("slicing")?.shown) return;
      const box = canvas.getBoundingClientRect(), whole = document.querySelector("#pv-view").getBoundingClientRect();
      call("go_to_slice", (box.left + x - whole.left) / whole.width, (box.top + y - whole.top) / whole.height);
    });
    new ResizeObserver(() => renderer?.canvas.isConnected && renderer.change()).observe(canvas);
    canvas.addEventListener("webglcontextlost", () => {
      losses += 1;
      hide();
      call("there_ready", false, "", "this browser lost its graphics");
    });
    canvas.addEventListener("webglcontextrestored", () => {
      if (losses < LOSSES) report();
    });
    window.pvfibletsThere = renderer;
    take(get("there_camera"));
  };

  const apply = async ({ scene }) => {
    taken = false;
    progress(true);
    const files = scene.data.map((one) => one.file);
    for (const file of files) if (!data.has(file)) data.set(file, fetched(file));
    await loaded();
    while (!document.querySelector("#pv-there")) await new Promise((done) => setTimeout(done, 50));
    const all = await Promise.all(files.map((file) => data.get(file)));
    if (wanted) return;
    data = new Map(files.map((file) => [file, data.get(file)]));
    if (!renderer || !canvas.isConnected) make(scene, all);
    else renderer.update(scene, all, opened(scene, all));
    const over = document.querySelector("#pv-there-bars");
    over.replaceChildren(...scene.bars.map(bar));
    taken = true;
  };

  const change = async (there) => {
    wanted = there;
    if (busy) return;
    busy = true;
    while (wanted) {
      const now = wanted;
      wanted = null;
      try {
        if (now.on) await apply(now);
        else hide();
      } catch (error) {
        if (!wanted) fail(error); // else it was of a scene that there is no more
      }
    }
    busy = false;
  };

  const show = () => {
    if (get("there")?.on) canvas.style.visibility = "visible";
  };

  // What was drawn here stays until the server's picture is there.
  const hide = () => {
    progress(false);
    const view = document.querySelector("#pv-view"), old = canvas;
    if (!old || old.style.visibility === "hidden") return;
    const gone = () => {
      if (get("there")?.on && !broken) return;
      old.style.visibility = "hidden";
      for (const over of document.querySelectorAll("#pv-there-bars, #pv-there-distances")) over.replaceChildren();
    };
    view?.addEventListener("load", gone, { capture: true, once: true });
    setTimeout(gone, 2000);
  };

  // Colour bars -----------------------------------------------------------------------------------

  const part = (name, text) => {
    const made = document.createElement(name);
    if (text !== undefined) made.textContent = text;
    return made;
  };

  const bar = ({ title, table, clim, log, names, colours }) => {
    const made = part("figure"), row = part("div"), strip = part("canvas"), list = part("ol");
    const bytes = names ? colours.flatMap((one) => [...one, 255]) : [...atob(table)].map((letter) => letter.charCodeAt(0));
    const n = bytes.length / 4;
    made.className = "pv-there-bar";
    Object.assign(strip, { width: 1, height: n });
    const context = strip.getContext("2d"), pixels = context.createImageData(1, n);
    for (let k = 0; k < n; ++k) pixels.data.set(bytes.slice(4 * k, 4 * k + 4), 4 * (n - 1 - k));
    context.putImageData(pixels, 0, 0);
    const value = (share) => (log && clim[0] > 0 ? clim[0] * (clim[1] / clim[0]) ** share : clim[0] + share * (clim[1] - clim[0]));
    const texts = names ?? [0, 0.25, 0.5, 0.75, 1].map((share) => String(Number(value(share).toPrecision(3))));
    list.append(...[...texts].reverse().map((text) => part("li", text)));
    if (names) list.className = "pv-named";
    row.append(strip, list);
    made.append(part("figcaption", title), row);
    return made;
  };

  // The camera ------------------------------------------------------------------------------------

  const now = () => JSON.stringify(renderer.camera.state);

  const tell = () => {
    const at = now();
    saidAt = performance.now();
    if (at === told && resting) return;
    told = at;
    call("there_camera", JSON.parse(at), me, resting, turn);
  };

  const follow = () => {
    const at = now();
    if (at === last) return;
    last = at;
    resting = false;
    clearTimeout(timer);
    timer = setTimeout(settle, REST);
    if (performance.now() - saidAt > PACE) tell();
  };

  const settle = () => {
    clearTimeout(timer);
    if (resting || !renderer) return;
    resting = true;
    told = "";
    tell();
  };

  // What is done next is done as seen from here.
  for (const kind of ["pointerdown", "keydown", "click"]) window.addEventListener(kind, settle, true);

  const take = (moved) => {
    if (!renderer || !moved?.camera) return;
    turn = moved.turn;
    if (moved.from === me) return;
    Object.assign(renderer.camera.state, structuredClone(moved.camera));
    last = told = now();
    resting = true;
    renderer.change();
  };

  // ------------------------------------------------------------------------------------------------

  const attach = () => {
    const state = window.trame?.state;
    if (state?.get("there") === undefined) return setTimeout(attach, 50);
    if (!watched.has(state)) {
      watched.add(state);
      state.watch(["there_camera"], take);
      state.watch(["there"], change);
    } else change(state.get("there")); // a connection that was lost: the page is another one
    report();
  };
  attach();
  window.trame?.addConnectListener?.(() => setTimeout(attach, 0));
})();
