// A field keeps what is typed into it until it is left: Vue writes the server's value into it whenever the page is drawn
// again, which any reply may cause. Of bound fields Vue remembers the server's newest value as _value; v-model has none.
(() => {
  "use strict";

  const TEXT = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value");
  const OTHERS = ["checkbox", "color", "file", "radio", "range"];
  const typed = new WeakMap(); // field: "typing", "sent" until the reply, "given back" by Escape

  const ours = (field) => field instanceof HTMLInputElement && "_value" in field && !OTHERS.includes(field.type)
    && !field.closest(".v-input") // Vuetify's own keep their text themselves
    && !field.hasAttribute("data-read-later"); // nothing is sent when these are left: a button reads them

  const hold = (field) => Object.defineProperty(field, "value", {
    configurable: true,
    get() { return TEXT.get.call(this); },
    set() { /* Vue: it has set _value, which showServers() shows later */ },
  });

  const showServers = (field) => {
    delete field.value;
    if (field.value !== String(field._value ?? "")) field.value = field._value ?? "";
  };

  document.addEventListener("input", ({ target }) => {
    if (!ours(target)) return;
    typed.set(target, "typing");
    hold(target);
  }, true);

  // What was sent is shown until the server answers: with the same, with another value, or by refusing it.
  const settle = (field, before) => setTimeout(() => {
    if (typed.get(field) !== "sent" || !field.isConnected) return;
    if (field._value === before && window.trame?.state.get("trame__busy")) return settle(field, before);
    typed.delete(field);
    showServers(field);
  }, 50);

  document.addEventListener("change", (event) => {
    const field = event.target;
    if (typed.get(field) === "given back") event.stopImmediatePropagation();
    if (typed.get(field) !== "typing") return;
    typed.set(field, "sent");
    settle(field, field._value);
  }, true);

  document.addEventListener("blur", ({ target }) => {
    if (!typed.has(target) || typed.get(target) === "sent") return;
    typed.delete(target);
    showServers(target);
  }, true);

  document.addEventListener("keydown", ({ key, target }) => {
    if (key !== "Escape" || typed.get(target) !== "typing") return;
    typed.set(target, "given back");
    showServers(target);
  }, true);
})();
