// Strokes over slices: see pvfiblets/web/panels/tabs/painting_tab.py. Places are shares of the picture from its upper left; one list
// of them at a time is on its way, and those that the pointer passes meanwhile come with the next.
(() => {
  "use strict";

  const call = (name, ...args) => window.trame?.trigger(name, args);
  const set = (name, value) => {
    window.trame?.state?.set(name, value);
    window.trame?.state?.flush?.(name);
  };
  const WHOLE = /outline|sphere/;
  let stroke = null;

  const place = (over, event) => {
    const box = over.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  };

  const send = async (one) => {
    if (one.busy) return;
    one.busy = true;
    while (one.places.length) {
      const places = one.places.splice(0, 500), begins = one.begins;
      one.begins = false;
      await call("paint", one.tool, places, begins);
    }
    one.busy = false;
    if (one.left) call("paint_end");
  };

  // What is drawn of a stroke that is sent whole when it is done: an outline, or a ball about where it began.
  const sketch = ({ over, tool, places }) => {
    const box = over.getBoundingClientRect();
    const at = places.map(([x, y]) => [x * box.width, y * box.height]);
    const look = `fill="${over.dataset.color}33" stroke="${over.dataset.color}" stroke-width="1.5"`;
    const [a, b] = [at[0], at[at.length - 1]];
    const shape = tool === "outline" ? `<polygon points="${at.join(" ")}" ${look}/>`
      : `<circle cx="${a[0]}" cy="${a[1]}" r="${Math.hypot(b[0] - a[0], b[1] - a[1])}" ${look}/>`;
    let svg = over.querySelector("svg");
    if (!svg) over.append(svg = document.createElementNS("http://www.w3.org/2000/svg", "svg"));
    svg.innerHTML = shape;
  };

  // A circle as wide as the brush, where it would paint.
  const ring = (over, event) => {
    const [x, y] = place(over, event), box = over.getBoundingClientRect();
    const view = JSON.parse(over.dataset.boxes || "[]").find(
      (one) => one.mm > 0 && x >= one.x && x < one.x + one.w && y >= one.y && y < one.y + one.h,
    );
    let circle = over.querySelector(".pv-brush");
    if (!view) return circle?.remove();
    if (!circle) {
      circle = document.createElement("div");
      circle.className = "pv-brush";
      over.append(circle);
    }
    const radius = /fill|outline|grow/.test(over.dataset.tool) ? 3 : Math.max(2, (Number(over.dataset.radius) / view.mm) * box.height);
    Object.assign(circle.style, {
      left: `${x * box.width - radius}px`, top: `${y * box.height - radius}px`, width: `${2 * radius}px`,
      height: `${2 * radius}px`, borderColor: over.dataset.color || "#fff",
    });
  };

  document.addEventListener("pointerdown", (event) => {
    const over = event.target.closest?.("#pv-paint");
    if (!over || event.button > 0) return;
    event.preventDefault();
    over.setPointerCapture(event.pointerId);
    stroke = { over, tool: over.dataset.tool, places: [place(over, event)], id: event.pointerId, begins: true };
    if (!WHOLE.test(stroke.tool)) send(stroke);
  }, true);

  document.addEventListener("pointermove", (event) => {
    const over = event.target.closest?.("#pv-paint");
    if (over) ring(over, event);
    if (!stroke || event.pointerId !== stroke.id || /fill|grow/.test(stroke.tool)) return;
    const here = place(stroke.over, event);
    if (stroke.tool === "sphere") stroke.places[1] = here;
    else if (stroke.places.length < 500 || !WHOLE.test(stroke.tool)) stroke.places.push(here);
    if (WHOLE.test(stroke.tool)) sketch(stroke);
    else send(stroke);
  }, true);

  const letGo = (event) => {
    if (!stroke || event.pointerId !== stroke.id) return;
    stroke.left = true;
    stroke.over.querySelector("svg")?.remove();
    const whole = WHOLE.test(stroke.tool), enough = stroke.tool === "sphere" || stroke.places.length > 2;
    if (whole && event.type === "pointerup" && enough) send(stroke);
    else if (!whole && !stroke.busy) call("paint_end");
    stroke = null;
  };
  document.addEventListener("pointerup", letGo, true);
  document.addEventListener("pointercancel", letGo, true);

  const KEYS = { n: "brush", e: "erase", f: "fill", u: "outline", j: "sphere", w: "grow" };
  window.addEventListener("keydown", (event) => {
    const tool = KEYS[event.key.toLowerCase()], state = window.trame?.state;
    if (!tool || event.ctrlKey || event.metaKey || event.altKey || state?.get("dialog")) return;
    if (event.target.closest?.("input:not([type=color], [type=checkbox]), textarea, select, [contenteditable], [role=listbox]")) return;
    if (!state?.get("slicing")?.shown || !state.get("painting")?.regions.length) return;
    set("tool", tool);
    event.preventDefault();
  }, true);
})();
