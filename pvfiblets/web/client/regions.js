// Handles of regions over the picture. The server says where a handle is, and what a region becomes when it is dragged:
// see pvfiblets/web/region_marks.py. One place at a time is on its way; of those that come meanwhile only the newest is.
(() => {
  "use strict";

  const call = (name, ...args) => window.trame?.trigger(name, args);
  let held = null;

  const send = async (one) => {
    if (one.busy || !one.place) return;
    const place = one.place;
    one.place = null;
    one.busy = true;
    await call("slide", "handle", one.row, one.name, place);
    one.busy = false;
    if (one.place) send(one);
    else if (one.left) call("release");
  };

  document.addEventListener("pointerdown", (event) => {
    const handle = event.target.closest?.(".pv-handle");
    if (!handle || event.button > 0) return;
    event.preventDefault();
    event.stopPropagation();
    handle.setPointerCapture(event.pointerId);
    const box = handle.getBoundingClientRect();
    held = {
      handle, id: event.pointerId, row: Number(handle.dataset.row), name: handle.dataset.handle, busy: false,
      // Where the pointer took it, so that it does not jump.
      off: [box.left + box.width / 2 - event.clientX, box.top + box.height / 2 - event.clientY],
    };
  }, true);

  document.addEventListener("pointermove", (event) => {
    if (!held || event.pointerId !== held.id) return;
    event.stopPropagation();
    const view = document.querySelector("#pv-marks")?.getBoundingClientRect();
    if (!view) return;
    const x = (event.clientX + held.off[0] - view.left) / view.width;
    const y = (event.clientY + held.off[1] - view.top) / view.height;
    held.place = [x, y].map((share) => Math.min(Math.max(share, -0.9), 1.9));
    send(held);
  }, true);

  const letGo = (event) => {
    if (!held || event.pointerId !== held.id) return;
    event.stopPropagation();
    held.left = true;
    if (!held.busy && !held.place) call("release");
    held = null;
  };
  document.addEventListener("pointerup", letGo, true);
  document.addEventListener("pointercancel", letGo, true);
})();
