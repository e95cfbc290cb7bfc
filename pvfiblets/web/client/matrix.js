// Cells of the matrix: see pvfiblets/web/matrix_panel.py. The one under the pointer is told, a click shows what is in it.
(() => {
  "use strict";

  const call = (name, ...args) => window.trame?.trigger(name, args);
  const cells = (event) => event.target.closest?.("#pv-cells");

  // Row and column under the pointer.
  const place = (element, event) => {
    const n = Number(element.dataset.n), box = element.getBoundingClientRect();
    const at = (share) => Math.max(0, Math.min(n - 1, Math.floor(share * n)));
    return [at((event.clientY - box.top) / box.height), at((event.clientX - box.left) / box.width), n];
  };

  const cross = (row, column, n) => {
    const mark = document.querySelector("#pv-cross");
    if (!mark) return;
    mark.hidden = false;
    Object.assign(mark.style, {
      left: `${100 * column / n}%`, top: `${100 * row / n}%`, width: `${100 / n}%`, height: `${100 / n}%`,
    });
  };

  // One question at a time is on its way; of those that come meanwhile the last is asked.
  let waiting = null, busy = false;
  const tell = async (row, column) => {
    waiting = [row, column];
    if (busy) return;
    busy = true;
    while (waiting) {
      const now = waiting;
      waiting = null;
      const said = await call("matrix_at", ...now);
      const line = document.querySelector("#pv-cell");
      if (line && said) line.textContent = said;
    }
    busy = false;
  };

  // Names of rows and columns, as many as there is room for.
  const LINE = 12; // pixels, of a name
  const watched = new WeakSet();
  const label = () => {
    const cells = document.querySelector("#pv-cells"), names = window.trame.state.get("matrix")?.names ?? [];
    if (!cells) return;
    if (!watched.has(cells)) {
      watched.add(cells);
      new ResizeObserver(label).observe(cells);
    }
    const step = Math.max(1, Math.ceil((LINE * names.length) / cells.clientWidth));
    for (const [side, edge] of [["rows", "top"], ["columns", "left"]])
      cells.querySelector(`#pv-${side}`).replaceChildren(...names.flatMap((name, i) => {
        if (i % step) return [];
        const made = document.createElement("span");
        made.textContent = name;
        made.style[edge] = `${(100 * (i + 0.5)) / names.length}%`;
        return [made];
      }));
  };
  const attach = () => {
    const state = window.trame?.state;
    if (state?.get("matrix") === undefined) return setTimeout(attach, 50);
    if (watched.has(state)) return;
    watched.add(state);
    state.watch(["matrix"], () => requestAnimationFrame(label));
  };
  attach();
  window.trame?.addConnectListener?.(() => setTimeout(attach, 0));

  let last = "";
  document.addEventListener("pointermove", (event) => {
    const element = cells(event);
    if (!element) {
      const mark = document.querySelector("#pv-cross");
      if (mark && !mark.hidden) mark.hidden = true;
      last = "";
      return;
    }
    const [row, column, n] = place(element, event);
    if (last === `${row} ${column}`) return;
    last = `${row} ${column}`;
    cross(row, column, n);
    tell(row, column);
  }, true);

  document.addEventListener("click", (event) => {
    const element = cells(event);
    if (!element) return;
    const [row, column, n] = place(element, event);
    cross(row, column, n);
    tell(row, column);
    call("matrix_show", row, column);
  }, true);
})();
