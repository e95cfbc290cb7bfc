// Strokes over slices: see pvfiblets/web/painting_tab.py. Places are shares of the picture from its upper left; one list
// of them at a time is on its way, and those that the pointer passes meanwhile come with the next.
(() => {
  "use strict";

  const call = (name, ...args) => window.trame?.trigger(name, args);
  const set = (name, value) => {
    window.trame?.state?.set(name, value);
    window.trame?.state?.flush?.(name);
  };
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

  // A circle as wide as the brush, where it would paint.
  const ring = (over, event) => {
    const [x, y] = place(over, event), box = over.getBoundingClientRect();
    const view = JSON.parse(over.dataset.boxes || "[]").find(
      (one) => one.mm > 0 && x >= one.x && x < one.x + one.w && y >= one.y && y < one.y + one.h,
    );
    let circle = over.firstElementChild;
    if (!view) return circle?.remove();
    if (!circle) {
      circle = document.createElement("div");
      circle.className = "pv-brush";
      over.append(circle);
    }
    const radius = over.dataset.tool === "fill" ? 3 : Math.max(2, (Number(over.dataset.radius) / view.mm) * box.height);
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
    send(stroke);
  }, true);

  document.addEventListener("pointermove", (event) => {
    const over = event.target.closest?.("#pv-paint");
    if (over) ring(over, event);
    if (!stroke || event.pointerId !== stroke.id || stroke.tool === "fill") return;
    stroke.places.push(place(stroke.over, event));
    send(stroke);
  }, true);

  const letGo = (event) => {
    if (!stroke || event.pointerId !== stroke.id) return;
    stroke.left = true;
    if (!stroke.busy) call("paint_end");
    stroke = null;
  };
  document.addEventListener("pointerup", letGo, true);
  document.addEventListener("pointercancel", letGo, true);

  const KEYS = { n: "brush", e: "erase", f: "fill" };
  window.addEventListener("keydown", (event) => {
    const tool = KEYS[event.key.toLowerCase()], state = window.trame?.state;
    if (!tool || event.ctrlKey || event.metaKey || event.altKey || state?.get("dialog")) return;
    if (event.target.closest?.("input:not([type=color]), textarea, select, [contenteditable], [role=listbox]")) return;
    if (!state?.get("slicing")?.shown || !state.get("painting")?.regions.length) return;
    set("tool", tool);
    event.preventDefault();
  }, true);
})();
