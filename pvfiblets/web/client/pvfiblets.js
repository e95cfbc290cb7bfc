// What Vue's templates cannot do: keys, the selection tools over the picture, uploads with progress.
// Triggers are those of pvfiblets/web/app.py and the rooms beside it.
(() => {
  "use strict";

  const call = (name, ...args) => window.trame?.trigger(name, args);
  const state = () => window.trame?.state;
  const set = (name, value) => {
    state()?.set(name, value);
    state()?.flush?.(name);
  };
  const get = (name) => state()?.get(name);

  // On a narrow screen the panels lie over the picture, and begin closed (the widths are those of layout.py). On a wider
  // one the tools begin as icons, until the picture has half of the width beside them.
  const begin = () => {
    if (!state()) return setTimeout(begin, 50);
    if (window.innerWidth < 900) set("left_open", false);
    if (window.innerWidth < 1400) set("right_open", false);
    // On a phone both would lie in the same place.
    for (const [one, other] of [["left_open", "right_open"], ["right_open", "left_open"]])
      state().watch([one], (open) => { if (open && window.innerWidth < 760 && get(other)) set(other, false); });
    // A sentence that was read is not said again after a reload.
    try {
      if (sessionStorage.getItem("pvfiblets-said") === String(get("toast_number"))) set("toast_open", false);
      window.addEventListener("pagehide", () => sessionStorage.setItem("pvfiblets-said", String(get("toast_number"))));
    } catch { /* a browser that keeps nothing */ }
    recall();
    describe();
  };

  // trame gives the image of the scene no text.
  const describe = () => {
    const area = document.querySelector("#pv-view");
    if (!area) return setTimeout(describe, 50);
    const name = () => area.querySelectorAll("img:not([alt])").forEach((image) => { image.alt = "Rendered scene"; });
    new MutationObserver(name).observe(area, { childList: true, subtree: true });
    name();
  };

  // Vuetify names inputs and lists by labels that are not there: their own text names them.
  const rename = () => {
    for (const one of document.querySelectorAll("input[aria-labelledby], .v-list[aria-labelledby]")) {
      const label = one.getAttribute("aria-labelledby");
      if (document.getElementById(label)) continue;
      one.removeAttribute("aria-labelledby");
      const field = document.getElementById(label.replace(/-label$/, ""));
      if (field?.ariaLabel && !one.ariaLabel) one.ariaLabel = field.ariaLabel;
    }
  };
  new MutationObserver(rename).observe(document, { childList: true, subtree: true });

  // Light or dark is kept by the browser; a view that others see, too, is left as it is.
  const KEY = "pvfiblets-dark";
  const recall = () => {
    const page = document.querySelector(".v-application");
    if (!page) return setTimeout(recall, 50);
    try {
      const kept = localStorage.getItem(KEY);
      if (kept !== null && !get("shared")) set("dark", kept === "true");
      const keep = () => localStorage.setItem(KEY, String(page.classList.contains("v-theme--dark")));
      new MutationObserver(keep).observe(page, { attributeFilter: ["class"] });
    } catch { /* a browser that keeps nothing */ }
  };
  begin();

  // Keys -------------------------------------------------------------------------------------------

  const KEYS = {
    1: () => call("view", "axial"), 2: () => call("view", "coronal"), 3: () => call("view", "sagittal"),
    4: () => call("view", "oblique"), 0: () => call("flip"), 5: () => call("toggle_parallel"), r: () => call("reset"),
    p: () => set("tool", "pick"), b: () => set("tool", "box"), l: () => set("tool", "lasso"),
    m: () => set("tool", "measure"), o: () => call("browse", ""), s: () => set("dialog", "session"),
    c: () => document.querySelector("[data-action=screenshot]")?.click(), v: () => call("toggle_chosen"),
    t: () => set("dark", !get("dark")), "?": () => set("dialog", "help"), delete: () => call("remove_chosen"),
    "[": () => set("left_open", !get("left_open")), "]": () => set("right_open", !get("right_open")),
  };

  // Text is for the field it is typed into, arrows for the slider or list that has the focus. A list that is closed keeps
  // the focus after a choice: letters are for the page then.
  const taken = (target, key) => {
    if (target.closest?.(".v-select input[aria-expanded=false]")) return /^(arrow|enter$| $|tab$)/.test(key);
    if (target.closest?.("[role=slider]")) return /^(arrow|home$|end$|page|tab$)/.test(key);
    return Boolean(target.closest?.("input:not([type=color], [type=checkbox]), textarea, select, [contenteditable], [role=listbox]"));
  };

  window.addEventListener("keydown", (event) => {
    const target = event.target;
    if (event.key === "Enter" && target.matches?.("input.pv-num")) return target.blur();
    if (taken(target, event.key.toLowerCase())) return;
    const key = event.key.toLowerCase();
    if (event.ctrlKey || event.metaKey) {
      if (key === "z") call(event.shiftKey ? "redo" : "undo");
      else if (key === "y") call("redo");
      else return;
      event.preventDefault();
      return;
    }
    if (event.altKey || get("dialog")) return;
    if (key === "escape" && document.querySelector(".v-menu.v-overlay--active")) return; // a menu's own: it closes
    if (key === "escape") set("tool", "rotate");
    else if (KEYS[key]) KEYS[key]();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }, true);

  // Tools over the picture -------------------------------------------------------------------------

  // Places are shares of the picture's width and height from its upper left: browsers that share a view may differ.
  let drawn = null;
  let begun = null; // where the first of two clicks of a measurement was, as long as the picture stays

  const place = (over, event) => {
    const box = over.getBoundingClientRect();
    const within = (value) => Math.min(Math.max(value, 0), 1);
    return [within((event.clientX - box.left) / box.width), within((event.clientY - box.top) / box.height)];
  };

  const draw = (over, tool, points) => {
    const shown = points.map(([x, y]) => `${x * 1000},${y * 1000}`);
    const style = 'fill="rgba(255,200,0,.18)" stroke="#fc0" stroke-width="2" vector-effect="non-scaling-stroke"';
    let shape = "";
    if (tool === "box" && points.length > 1) {
      const [a, b] = [points[0], points[points.length - 1]];
      const x = Math.min(a[0], b[0]) * 1000, y = Math.min(a[1], b[1]) * 1000;
      const w = Math.abs(a[0] - b[0]) * 1000, h = Math.abs(a[1] - b[1]) * 1000;
      shape = `<rect x="${x}" y="${y}" width="${w}" height="${h}" ${style}/>`;
    } else if (tool === "lasso") {
      shape = `<polygon points="${shown.join(" ")}" ${style}/>`;
    } else if (tool === "measure") { // a line of no length is a dot
      shape = `<polyline points="${shown[0]} ${shown[shown.length - 1]}" stroke-linecap="round" ${style.replace('"2"', '"4"')}/>`;
    }
    over.innerHTML = `<svg viewBox="0 0 1000 1000" preserveAspectRatio="none">${shape}</svg>`;
  };

  document.addEventListener("pointerdown", (event) => {
    const over = event.target.closest?.("#pv-over");
    if (!over || event.button > 0) return;
    event.preventDefault();
    over.setPointerCapture(event.pointerId);
    drawn = { over, tool: over.dataset.tool, points: [place(over, event)], id: event.pointerId };
    draw(over, drawn.tool, drawn.points);
  }, true);

  document.addEventListener("pointermove", (event) => {
    const over = event.target.closest?.("#pv-over[data-tool=measure]");
    if (!drawn && over && begun) draw(over, "measure", [begun, place(over, event)]);
    if (!drawn || event.pointerId !== drawn.id) return;
    const point = place(drawn.over, event), last = drawn.points[drawn.points.length - 1];
    if (Math.hypot(point[0] - last[0], point[1] - last[1]) < 0.004) return;
    if (drawn.points.length < 500) drawn.points.push(point);
    else drawn.points[drawn.points.length - 1] = point;
    draw(drawn.over, drawn.tool, drawn.points);
  }, true);

  const finish = async (event, keep) => {
    if (!drawn || event.pointerId !== drawn.id) return;
    const { over, tool, points } = drawn;
    drawn = begun = null;
    over.innerHTML = "";
    if (!keep) return;
    const goesOn = await call("point", tool, points, event.shiftKey);
    if (!goesOn || drawn) return;
    begun = points[points.length - 1];
    draw(over, tool, [begun]);
  };
  window.addEventListener("keydown", () => { // it may change the picture
    const over = begun && document.querySelector("#pv-over");
    if (over) over.innerHTML = "";
    begun = null;
  }, true);
  document.addEventListener("pointerup", (event) => finish(event, true), true);
  document.addEventListener("pointercancel", (event) => finish(event, false), true);

  // Sliders ----------------------------------------------------------------------------------------

  // Vuetify says where a slider is only when it is let go, so its thumbs are read. One value at a time is on its way; of
  // those that come meanwhile only the newest is sent.
  let slid = null;

  const thumbs = (slider) => {
    const found = [...slider.querySelectorAll("[role=slider]")].map((one) => Number(one.getAttribute("aria-valuenow")));
    return found.length > 1 ? found : found[0];
  };

  const follow = async (one) => {
    if (one.busy || one !== slid) return;
    const value = thumbs(one.slider), text = JSON.stringify(value);
    if (text === one.text) return;
    one.text = text;
    one.busy = true;
    await call("slide", ...JSON.parse(one.slider.dataset.live), value);
    one.busy = false;
    requestAnimationFrame(() => follow(one));
  };

  const hold = (event) => {
    const slider = event.target.closest?.("[data-live]");
    if (slider && slid?.slider !== slider) slid = { slider, text: JSON.stringify(thumbs(slider)), busy: false };
    if (slid) requestAnimationFrame(() => slid && follow(slid));
  };

  // Of a pointer, the value that it is left at comes from Vuetify, after this event; of keys, it is sent from here.
  const letGo = (byKey) => {
    if (!slid) return;
    const { slider, text } = slid;
    slid = null;
    setTimeout(() => {
      const value = thumbs(slider);
      if (byKey && JSON.stringify(value) !== text) call("slide", ...JSON.parse(slider.dataset.live), value);
      call("release");
    }, 0);
  };

  document.addEventListener("pointerdown", hold, true);
  window.addEventListener("pointermove", () => slid && requestAnimationFrame(() => slid && follow(slid)), true);
  window.addEventListener("pointerup", () => letGo(false), true);
  window.addEventListener("pointercancel", () => letGo(false), true);
  document.addEventListener("keydown", (event) => /^(Arrow|Home|End|Page)/.test(event.key) && hold(event), true);
  document.addEventListener("keyup", (event) => /^(Arrow|Home|End|Page)/.test(event.key) && letGo(true), true);

  // Pictures ---------------------------------------------------------------------------------------

  document.addEventListener("click", async (event) => {
    const button = event.target.closest?.("[data-action=save-picture]");
    if (!button || button.disabled) return;
    const of = (name) => document.querySelector(`#picture-${name}`);
    button.disabled = true;
    button.classList.add("v-btn--disabled");
    try {
      const url = await call("save_picture", of("width").value, of("height").value, of("dpi").value, of("transparent").checked);
      if (url) {
        Object.assign(document.createElement("a"), { href: url, download: "picture.png" }).click();
        set("dialog", "");
      }
    } finally {
      button.disabled = false;
      button.classList.remove("v-btn--disabled");
    }
  }, true);

  // Files ------------------------------------------------------------------------------------------

  const say = (text, kind = "error") => {
    set("toast", text);
    set("toast_kind", kind);
    set("toast_open", true);
  };

  let uploading = null;

  document.addEventListener("click", (event) => {
    if (event.target.closest?.("[data-action=cancel-upload]")) uploading?.abort();
  }, true);

  const mebibytes = (bytes) => `${(bytes / 2 ** 20).toFixed(0)} MB`;

  const loadSession = async (file, limit) => {
    if (file.size > limit) return say(`${file.name} has ${mebibytes(file.size)}; session files have ${mebibytes(limit)} at most.`);
    set("dialog", "");
    const answer = await fetch("/session", { method: "POST", body: file }).catch(() => null);
    if (!answer?.ok) say(`${file.name} was not opened (${answer?.status || "connection lost"}).`);
  };

  const upload = (file, limit) => new Promise((done) => {
    if (file.size > limit) {
      say(`${file.name} has ${mebibytes(file.size)}; ${mebibytes(limit)} is the most that this server takes.`);
      return done();
    }
    const request = new XMLHttpRequest();
    uploading = request;
    const show = (share) => { set("uploading", file.name); set("uploaded", share); };
    request.upload.onprogress = (event) => show(event.lengthComputable ? (100 * event.loaded) / event.total : -1);
    request.onabort = () => say(`${file.name} was not uploaded: cancelled.`, "info");
    request.onloadend = () => {
      uploading = null;
      set("uploading", "");
      if (request.readyState !== 0 && request.status !== 200) say(`${file.name} was not uploaded (${request.status || "connection lost"}).`);
      done();
    };
    request.open("POST", `/upload?name=${encodeURIComponent(file.name)}`);
    request.setRequestHeader("Content-Type", "application/octet-stream");
    show(0);
    set("dialog", "");
    request.send(file);
  });

  document.addEventListener("change", async (event) => {
    const input = event.target;
    if (!(input instanceof HTMLInputElement) || input.type !== "file" || !input.files.length) return;
    const files = [...input.files], file = files[0];
    if (input.dataset.upload !== undefined) {
      input.value = "";
      for (const one of files) await upload(one, Number(input.dataset.limit));
    }
    else if (input.dataset.session !== undefined) await loadSession(file, Number(input.dataset.limit));
    input.value = "";
  }, true);
})();
