// Keys of slices: see pvfiblets/web/panels/tabs/slices_tab.py. Where the pointer is says which pane is meant.
(() => {
  "use strict";

  const call = (name, ...args) => window.trame?.trigger(name, args);
  const get = (name) => window.trame?.state?.get(name);
  let at = [0.1, 0.1];

  // Where the pointer is, as shares of the picture from its upper left.
  const place = (event) => {
    const box = document.querySelector("#pv-view")?.getBoundingClientRect();
    return box ? [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height] : at;
  };
  const within = (share) => share >= 0 && share <= 1;

  for (const kind of ["pointermove", "pointerdown"]) document.addEventListener(kind, (event) => {
    const here = place(event);
    if (here.every(within) && event.target.closest?.("#pv-view") && !event.target.closest("#paint-tools, .pv-tools")) {
      at = here;
    }
  }, true);

  const STEPS = {
    ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0],
    PageUp: [0, 0, 1], PageDown: [0, 0, -1],
  };
  const taken = (target) => Boolean(target.closest?.(
    "input, textarea, select, [contenteditable], [role=listbox], [role=slider], [role=tab], .v-overlay",
  ));

  // One step at a time is on its way; those that come meanwhile are added up, each for the pane that it was meant for.
  const waiting = [];
  let busy = false;
  const pane = ([x, y]) => (get("slicing")?.boxes ?? []).findIndex(
    (box) => x >= box.x && x <= box.x + box.w && y >= box.y && y <= box.y + box.h,
  );
  const step = async (steps) => {
    const last = waiting[waiting.length - 1];
    if (last && last.pane === pane(at)) {
      last.steps = last.steps.map((sum, k) => Math.max(-100, Math.min(100, sum + steps[k])));
    } else waiting.push({ at, pane: pane(at), steps });
    if (busy) return;
    busy = true;
    try {
      while (waiting.length) {
        const now = waiting.shift();
        await call("step_slice", ...now.at, ...now.steps);
      }
    } finally { // a connection that is lost refuses: what is pressed after it counts again
      waiting.length = 0;
      busy = false;
    }
  };

  // The field appears with its tab, some frames later.
  const typePosition = (frames) => requestAnimationFrame(() => {
    const field = document.querySelector("[data-place=position] input");
    if (field) field.select();
    else if (frames) typePosition(frames - 1);
  });

  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || get("dialog") || taken(event.target)) return;
    const slicing = get("slicing");
    if (event.key.toLowerCase() === "x") {
      call("set_layout", slicing?.layout === "beside" ? "3d" : "beside");
    } else if (event.key.toLowerCase() === "g" && slicing?.shown) {
      window.trame.state.update({ right_open: true, tab: "slices" });
      typePosition(20);
    } else if (STEPS[event.key] && slicing?.shown) step(STEPS[event.key]);
    else if (/^[,.]$/.test(event.key) && slicing?.series?.length) call("step_volume", event.key === "." ? 1 : -1);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }, true);

  document.addEventListener("click", (event) => {
    if (event.target.closest?.("#pv-ask")) call("ask_label", ...place(event));
    const button = event.target.closest?.("[data-slice-step]");
    if (button) step([0, 0, Number(button.dataset.sliceStep)]);
  }, true);

  // A wheel over what lies over the picture goes through slices, too.
  document.addEventListener("wheel", (event) => {
    if (!event.target.closest?.("#pv-paint, #pv-ask") || !get("slicing")?.shown) return;
    event.preventDefault();
    at = place(event);
    step([0, 0, event.deltaY < 0 ? 1 : -1]);
  }, { capture: true, passive: false });
})();
