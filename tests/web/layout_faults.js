// What is wrong with how parts of a page lie: cut off, over each other, or out of reach. Used by test_browser_layout.py.
// An expression that gives a function of selectors of the parts of the page to look at; it returns sentences.
(roots) => {
  const found = new Set();
  const TEXTS = "label, .v-btn, .pv-value, .pv-label, .pv-small, .pv-head, .v-select__selection-text, "
    + ".v-list-item-title, .v-list-item-subtitle, th, td";
  const CONTROLS = "button, input, label.v-btn, a.v-btn, .v-field, .v-slider, [role=tab], .v-list-item[tabindex]";
  const told = (part) => (part.innerText || part.ariaLabel || part.placeholder || part.outerHTML).trim().slice(0, 60)
    .replaceAll("\n", " ");
  const shown = (part) => part.checkVisibility({ opacityProperty: true, visibilityProperty: true }) &&
    part.getBoundingClientRect().width > 0 && !part.closest("[hidden]");

  // The part of a rectangle that nothing around it clips.
  const seen = (part) => {
    const box = part.getBoundingClientRect();
    let [left, right, top, bottom] = [Math.max(box.left, 0), Math.min(box.right, innerWidth), Math.max(box.top, 0),
      Math.min(box.bottom, innerHeight)];
    for (let around = part.parentElement; around; around = around.parentElement) {
      const style = getComputedStyle(around);
      if (style.overflowX === "visible" && style.overflowY === "visible") continue;
      const clip = around.getBoundingClientRect();
      left = Math.max(left, clip.left); right = Math.min(right, clip.right);
      top = Math.max(top, clip.top); bottom = Math.min(bottom, clip.bottom);
    }
    return { left, right, top, bottom, width: right - left, height: bottom - top };
  };
  const within = (one, other) => one.contains(other) || other.contains(one);

  for (const selector of roots) for (const root of document.querySelectorAll(selector)) {
    if (!shown(root)) continue;
    const where = selector;
    const inside = root.getBoundingClientRect();
    if (inside.left < -1 || inside.right > innerWidth + 1) 
      found.add(`${where} sticks out of the page: ${inside.left} to ${inside.right} of ${innerWidth}`);
    if (inside.top < -1 || inside.bottom > innerHeight + 1) found.add(`${where} is higher than the page`);
    const texts = [...root.querySelectorAll(TEXTS)].filter(shown);
    const controls = [...root.querySelectorAll(CONTROLS)].filter((part) => shown(part) && part.type !== "file");
    for (const part of texts) {
      const shortened = part.closest(".text-truncate, [title]") && (part.title || part.closest("[title]"));
      if (part.scrollWidth > part.clientWidth + 1 && getComputedStyle(part).overflowX !== "auto" && !shortened &&
          getComputedStyle(part).display !== "inline")
        found.add(`${told(part)} is cut off in ${where}`);
    }
    // Sideways, nothing but what says so scrolls.
    for (const part of [root, ...root.querySelectorAll("*")]) {
      const style = getComputedStyle(part);
      if (!shown(part) || part.scrollWidth <= part.clientWidth + 1 || !["auto", "scroll"].includes(style.overflowX)) continue;
      if (part.closest(".pv-code")) continue;
      const end = part.getBoundingClientRect().left + part.clientLeft + part.clientWidth;
      const wide = [...part.querySelectorAll("*")].filter((one) => one.getBoundingClientRect().right > end + 1).pop();
      found.add(`${part.className || part.tagName} scrolls sideways in ${where}, for ${wide?.outerHTML.slice(0, 120)}`);
    }
    // Each control can be brought to where a pointer hits it.
    for (const part of controls) {
      part.scrollIntoView({ block: "center", inline: "center" });
      const box = seen(part), whole = part.getBoundingClientRect();
      if (box.width < Math.min(whole.width, 24) - 1 || box.height < Math.min(whole.height, 12) - 1) {
        found.add(`${told(part)} cannot be reached in ${where}`);
        continue;
      }
      const hit = document.elementFromPoint((box.left + box.right) / 2, (box.top + box.bottom) / 2);
      if (hit && !within(hit, part) && !hit.closest("label")?.contains(part))
        found.add(`${told(part)} is covered by ${told(hit)} in ${where}`);
    }
    // Leaves of the page do not lie over each other.
    const leaves = [...new Set([...texts, ...controls])].map((part) => [part, seen(part)])
      .filter(([, box]) => box.width > 1 && box.height > 1);
    for (let i = 0; i < leaves.length; i++) for (let k = i + 1; k < leaves.length; k++) {
      const [one, a] = leaves[i], [other, b] = leaves[k];
      if (within(one, other) || one.closest("thead") || other.closest("thead")) continue; // heads stay over rows
      const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (across > 1 && down > 1 && !one.closest(".v-field, .v-slider")?.contains(other) &&
          !other.closest(".v-field, .v-slider")?.contains(one))
        found.add(`${told(one)} and ${told(other)} lie over each other in ${where}`);
    }
    root.querySelectorAll("*").forEach((part) => { if (part.scrollTop || part.scrollLeft) part.scrollTo(0, 0); });
  }
  if (document.documentElement.scrollWidth > innerWidth) found.add("the page scrolls sideways");
  if (document.documentElement.scrollHeight > innerHeight) found.add("the page scrolls");
  return [...found];
}
