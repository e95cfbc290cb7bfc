// A connection that is lost: the last picture stays, dimmed, with what happens and when it is tried again. The front
// server says whether the session lives (/status in pvfiblets/web/server.py); the page comes back as soon as it answers.
(() => {
  "use strict";

  const LONGEST = 10; // seconds between two attempts
  const PATIENCE = 5000; // ms that the server has for an answer
  const PULSE = 6000; // ms between two looks at a quiet connection
  const watched = new WeakSet();
  let lost = null;

  const clock = (seconds) => `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;
  const part = (name, text) => {
    const made = document.createElement(name);
    if (text) made.textContent = text;
    return made;
  };

  // What is seen stays as a copy: trame takes its own page down.
  const frozen = () => {
    const app = document.querySelector("#app");
    const copy = app.cloneNode(true);
    const pairs = (what, act) => {
      const copies = copy.querySelectorAll(what);
      app.querySelectorAll(what).forEach((one, k) => act(one, copies[k]));
    };
    pairs("input", (one, other) => { other.value = one.value; });
    pairs("canvas:not(#pv-there)", (one, other) => one.width && one.height && other.getContext("2d").drawImage(one, 0, 0));
    const here = window.pvfibletsThere, canvas = copy.querySelector("#pv-there");
    if (here?.canvas.isConnected && canvas?.style.visibility === "visible") { // a copy of it is empty
      Object.assign(canvas, { width: here.width, height: here.height });
      canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(here.pixels()), here.width), 0, 0);
    }
    for (const one of [copy, ...copy.querySelectorAll("[id]")]) one.removeAttribute("id");
    // With its components trame takes away their style sheets.
    copy.append(...[...document.querySelectorAll("style")].map((sheet) => sheet.cloneNode(true)));
    copy.inert = true;
    copy.style.cssText = "position:absolute;inset:0;filter:brightness(.4) saturate(.5)";
    return [copy, () => pairs("*", (one, other) => one.scrollTop && other.scrollTo(one.scrollLeft, one.scrollTop))];
  };

  const show = () => {
    const over = part("div"), card = part("div"), title = part("div"), text = part("div"), buttons = part("div");
    over.id = "pv-lost";
    over.style.cssText = "position:fixed;inset:0;z-index:9000;background:#000;overflow:hidden";
    card.style.cssText = "position:absolute;left:50%;top:50%;transform:translate(-50%,-50%);width:min(400px,calc(100vw - 32px));"
      + "box-sizing:border-box;padding:20px;border-radius:8px;background:#212121;color:#fff;font:15px/1.5 Roboto,system-ui,sans-serif;"
      + "box-shadow:0 8px 40px #000";
    card.setAttribute("role", "alertdialog");
    card.setAttribute("aria-live", "polite");
    title.style.cssText = "font-size:18px;font-weight:600;margin-bottom:6px";
    buttons.style.cssText = "display:flex;gap:8px;margin-top:14px;justify-content:flex-end";
    card.append(title, text, buttons);
    const [copy, scroll] = frozen();
    over.append(copy, card);
    document.body.append(over);
    scroll();
    return { over, title, text, buttons };
  };

  const button = (label, act) => {
    const made = part("button", label);
    made.style.cssText = "font:inherit;padding:6px 14px;border:0;border-radius:6px;background:#1867c0;color:#fff;cursor:pointer";
    made.onclick = act;
    return made;
  };

  const tell = (title, text, ...buttons) => {
    lost.parts.title.textContent = title;
    lost.parts.text.textContent = text;
    if (lost.shown !== title) lost.parts.buttons.replaceChildren(...buttons);
    lost.shown = title;
  };

  const again = (query = "") => {
    const form = part("form");
    form.method = "post";
    form.action = `/new${query}`;
    document.body.append(form);
    form.submit();
  };

  const begin = () => {
    if (lost) return;
    lost = { since: Date.now(), next: 0, tries: 0, keep: window.trame?.state?.get("keep") || 300, parts: show() };
    lost.timer = setInterval(count, 250);
    attempt();
  };

  const count = () => {
    if (!lost || lost.over || lost.busy) return;
    const left = (lost.next - Date.now()) / 1000;
    if (left <= 0) return attempt();
    const kept = lost.keep - (Date.now() - lost.since) / 1000;
    const session = kept > 0 ? `The session is kept for ${clock(kept)} more.` : "The session may have ended by now.";
    tell("The connection is lost", `Trying again in ${Math.ceil(left)} s. ${session}`, button("Try now", attempt));
  };

  const attempt = async () => {
    if (!lost || lost.over || lost.busy) return;
    const one = lost;
    one.busy = true;
    one.tries += 1;
    tell("The connection is lost", "Trying to connect…", button("Try now", attempt));
    try {
      const answer = await fetch("/status", { cache: "no-store", signal: AbortSignal.timeout(PATIENCE) });
      const said = answer.ok ? await answer.json() : { state: answer.status === 401 ? "stranger" : "unknown" };
      if (said.state === "running") await resume(one);
      else if (said.state === "ended" || said.state === "none") over(said);
      else if (said.state === "stranger") {
        one.over = true;
        tell("The server was started again", "It does not know this browser any more.", button("Reload", () => location.replace("/")));
      }
    } catch { /* not reached: tried again */ }
    one.busy = false;
    one.next = Date.now() + 1000 * Math.min(LONGEST, 0.5 * 1.6 ** (one.tries - 1));
  };

  const over = (said) => {
    lost.over = true;
    const why = said.reason ? `It failed: ${said.reason}.` : said.state === "none" ? "No browser was there for too long, or the server was started again."
      : "It was closed.";
    const kept = said.restore ? " Its last state is kept for an hour." : "";
    const restore = said.restore ? [button("Restore", () => again("?restore=1"))] : [];
    tell("The session has ended", why + kept, ...restore, button("Open a new one", () => again()));
  };

  const resume = async (one) => {
    await window.trame.connect();
    const end = Date.now() + 20000;
    // The new page's picture takes the place of the old one's.
    const shown = "#app .pv-view img[src^=blob], #app #pv-there[style*=visible]";
    while (!document.querySelector(shown) && Date.now() < end) await new Promise((done) => setTimeout(done, 50));
    clearInterval(one.timer);
    one.parts.over.remove();
    lost = null;
  };

  const watch = () => {
    const client = window.trame?.client;
    if (!client || watched.has(client)) return;
    watched.add(client);
    client.onConnectionClose(begin);
    client.onConnectionError(begin);
  };

  // A connection can be dead without a word: after sleep, or where a network drops what passes. The front server tells
  // whether it has one, and a session that draws for long is not mistaken for a dead one.
  let asked = false, ticked = Date.now();
  const pulse = async () => {
    watch();
    const slept = Date.now() - ticked > 3 * PULSE;
    ticked = Date.now();
    if (lost || asked || !window.trame?.client?.isConnected()) return;
    asked = true;
    try {
      const said = await (await fetch("/status", { cache: "no-store", signal: AbortSignal.timeout(slept ? PATIENCE : 2 * PATIENCE) })).json();
      if (said.state !== "running" || said.connected === 0) begin();
    } catch {
      begin();
    }
    asked = false;
  };

  const soon = () => (lost ? attempt() : pulse());
  window.addEventListener("online", soon);
  document.addEventListener("visibilitychange", () => document.visibilityState === "visible" && soon());
  window.addEventListener("offline", begin);
  const start = () => (window.trame?.client ? watch() : setTimeout(start, 50));
  start();
  window.trame?.addConnectListener?.(watch);
  setInterval(pulse, PULSE);
})();
