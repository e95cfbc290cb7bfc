// Between a kernel and the frame of a page in the notebook (client/src/notebook.ts): camera, and what was picked.
// It has no picture of its own: `initialize` runs where the notebook makes the model, also after a reload.
export default {
  initialize({ model }) {
    let from = null;
    const names = ["camera", "picked"];
    const frames = () => [...document.getElementsByName(model.get("name"))];
    const tell = (frame, said) => frame.contentWindow && frame.contentWindow.postMessage({ pvfiblets: said }, "*");
    const hear = (event) => {
      const said = event.data && event.data.pvfiblets, frame = said && frames().find((one) => one.contentWindow === event.source);
      if (!frame) return;
      if (said.ready) return tell(frame, Object.fromEntries(names.map((name) => [name, model.get(name)])));
      from = frame;
      for (const name of names) if (name in said) model.set(name, said[name]);
      from = null;
      model.save_changes();
    };
    const change = (name) => () => {
      for (const frame of frames()) if (frame !== from) tell(frame, { [name]: model.get(name) });
    };
    window.addEventListener("message", hear);
    for (const name of names) model.on(`change:${name}`, change(name));
    return () => window.removeEventListener("message", hear);
  },
};
