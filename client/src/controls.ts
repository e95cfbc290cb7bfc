/** The controls over the picture: layers, views, cuts, ranges, colour bars, letters of orientation, and the picked streamline. */

import { Vec, apply, product, scaled } from "./camera";
import { Choice } from "./choice";
import { fromBase64 } from "./engine";
import { asWords } from "./fiblets";
import { ALL_ONES } from "./gl";
import type { Lines } from "./lines";
import { Region, outline } from "./regions";
import type { Renderer } from "./renderer";
import type { Bar } from "./scene";

const SVG = "http://www.w3.org/2000/svg";
const UNREAD = "Your browser does not let this page read its image; allow that to";

type Child = Node | string;

/** An element with attributes and children; text is text, never HTML. */
function make(tag: string, attributes: Record<string, string> = {}, ...children: Child[]): HTMLElement {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

const number = (value: number): string => (Number.isFinite(value) ? String(Number(value.toPrecision(4))) : "no value");

function slider(label: string, low: number, high: number, value: number, changed: (value: number) => void): HTMLElement {
  const step = (high - low) / 200 || 1, shown = make("output", {}, number(value));
  const input = make("input", {
    type: "range",
    min: String(low),
    max: String(high),
    step: String(step),
    value: String(value),
  }) as HTMLInputElement;
  input.addEventListener("input", () => {
    shown.textContent = number(input.valueAsNumber);
    changed(input.valueAsNumber);
  });
  return make("label", {}, make("span", {}, label), input, shown);
}

function check(label: string, on: boolean, changed: (on: boolean) => void): HTMLElement {
  const box = make("input", { type: "checkbox" }) as HTMLInputElement;
  box.checked = on;
  box.addEventListener("change", () => changed(box.checked));
  return make("label", {}, box, make("span", {}, label));
}

function button(text: string, pressed: () => void): HTMLElement {
  const made = make("button", { type: "button" }, text);
  made.addEventListener("click", pressed);
  return made;
}

function group(title: string, ...children: Child[]): HTMLElement {
  return make("fieldset", {}, make("legend", {}, title), ...children);
}

const VIEWS: [string, Vec, Vec][] = [
  ["Left", [1, 0, 0], [0, 0, 1]], ["Right", [-1, 0, 0], [0, 0, 1]], ["Front", [0, -1, 0], [0, 0, 1]], ["Back", [0, 1, 0], [0, 0, 1]],
  ["Top", [0, 0, -1], [0, 1, 0]], ["Bottom", [0, 0, 1], [0, 1, 0]],
];

function drawBar(bar: Bar): HTMLElement {
  const table = fromBase64(bar.table), n = table.length / 4;
  const canvas = make("canvas", {
    width: String(n),
    height: "1",
    role: "img",
    "aria-label": `Colours from ${number(bar.clim[0])} to ${number(bar.clim[1])}`,
  }) as HTMLCanvasElement;
  const context = canvas.getContext("2d")!, pixels = context.createImageData(n, 1);
  pixels.data.set(table);
  context.putImageData(pixels, 0, 0);
  if (bar.labels) {
    const names = bar.labels.map(({ name, colour }) => {
      const swatch = make("i", { "aria-hidden": "true" });
      swatch.style.background = `rgb(${colour.join(",")})`;
      return make("li", {}, swatch, name);
    });
    return make(
      "figure",
      { class: "bar" },
      make("figcaption", {}, bar.title),
      make("ul", { tabindex: "0", "aria-label": bar.title }, ...names),
    );
  }
  const [low, high] = bar.clim, middle = bar.log ? Math.sqrt(low * high) : (low + high) / 2;
  return make("figure", { class: "bar" }, make("figcaption", {}, bar.title), canvas,
    make("div", { class: "ticks", "aria-hidden": "true" }, ...[low, middle, high].map((value) => make("span", {}, number(value)))));
}

/** A streamline of a layer, by their numbers, and where it was picked, world mm. */
export interface Pick {
  layer: number;
  streamline: number;
  place?: number[];
}

export class Controls {
  told: ((picked: Pick | null) => void) | null = null;
  private status = document.getElementById("status")!;
  private axes: HTMLElement[] = [];
  private choices = new Map<number, Choice>();
  private picked: { lines: Lines; streamline: number; place: Vec } | null = null;
  private regions: Region[] = [];
  private outlines = document.createElementNS(SVG, "svg");

  constructor(private renderer: Renderer, private data: Uint8Array[]) {
    const over = document.getElementById("over")!, { scene } = renderer;
    const panel = make("details", { id: "panel" }, make("summary", {}, "Scene"));
    panel.append(this.layers(), ...this.groups(), this.views(), this.cut(), ...this.ranges(), this.regionList());
    over.append(this.outlines, panel);
    if (scene.bars.length) over.append(make("div", { id: "bars" }, ...scene.bars.map(drawBar)));
    over.append(this.orientation());
    renderer.restored = () => { for (const choice of this.choices.values()) choice.apply(); };
    renderer.presented = () => this.follow();
    renderer.grown = () => this.grown();
    this.follow();
  }

  private layers(): HTMLElement {
    const { renderer } = this, rows: HTMLElement[] = [];
    renderer.scene.layers.forEach((layer) => {
      rows.push(check(layer.name, layer.visible, (on) => {
        layer.visible = on;
        renderer.change();
      }));
      if (layer.kind === "fiblets") {
        rows.push(slider(layer.ends ? "Point size" : "Line width", 0.5, layer.ends ? 20 : 10, layer.line_width, (width) => {
          layer.line_width = width;
          renderer.change(true);
        }));
      } else {
        rows.push(slider("Opacity", 0, 1, layer.opacity, (opacity) => {
          layer.opacity = opacity;
          renderer.change(true);
        }));
      }
    });
    return group("Layers", ...rows);
  }

  private views(): HTMLElement {
    const { renderer } = this;
    const buttons = VIEWS.map(([name, direction, up]) => button(name, () => {
      renderer.look(direction, up);
      renderer.change();
    }));
    buttons.push(button("Reset", () => {
      const { camera } = renderer.scene;
      if (camera) Object.assign(renderer.camera.state, structuredClone(camera));
      else renderer.look();
      renderer.change();
    }));
    buttons.push(button("Save image", () => this.save()));
    return group("View", make("div", { class: "buttons" }, ...buttons));
  }

  private save(): void {
    const { renderer } = this;
    void renderer.settled().then(() => {
      if (!renderer.reads()) return void (this.status.textContent = `${UNREAD} save images.`);
      const canvas = make("canvas", { width: String(renderer.width), height: String(renderer.height) }) as HTMLCanvasElement;
      const context = canvas.getContext("2d")!, pixels = context.createImageData(renderer.width, renderer.height);
      pixels.data.set(renderer.pixels());
      context.putImageData(pixels, 0, 0);
      canvas.toBlob((blob) => {
        const link = make("a", { href: URL.createObjectURL(blob!), download: "picture.png" }) as HTMLAnchorElement;
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 60000);
      });
    });
  }

  /** A slab across an axis: nothing beside it is drawn. */
  private cut(): HTMLElement {
    const { renderer } = this, b = renderer.scene.bounds, choice = make("select", { "aria-label": "Cut across" }) as HTMLSelectElement;
    for (const name of ["nothing", "left to right", "back to front", "bottom to top"]) choice.append(make("option", {}, name));
    const sliders = make("div");
    let at = 0, thickness = 0;
    const apply = (): void => {
      const axis = choice.selectedIndex - 1,
        plane = (sign: number): number[] =>
          [0, 1, 2].map((i) => (i === axis ? sign : 0)).concat(-sign * at + thickness / 2);
      renderer.planes = axis < 0 ? [] : [plane(1), plane(-1)];
      renderer.change(true);
    };
    choice.addEventListener("change", () => {
      const axis = choice.selectedIndex - 1;
      sliders.replaceChildren();
      if (axis >= 0) {
        const low = b[2 * axis], high = b[2 * axis + 1];
        at = (low + high) / 2;
        thickness = (high - low) / 8;
        sliders.append(
          slider("Position", low, high, at, (value) => {
            at = value;
            apply();
          }),
          slider("Thickness", (high - low) / 200, high - low, thickness, (value) => {
            thickness = value;
            apply();
          }),
        );
      }
      apply();
    });
    return group("Slab across", choice, sliders);
  }

  private choiceOf(lines: Lines): Choice {
    let found = this.choices.get(lines.index);
    if (!found)
      this.choices.set(
        lines.index,
        (found = new Choice(lines, lines.layer.kept === undefined ? null : this.data[lines.layer.kept])),
      );
    return found;
  }

  private ranges(): HTMLElement[] {
    const { renderer } = this, made: HTMLElement[] = [];
    for (const lines of renderer.lines) {
      const { values, layer } = lines;
      if (values) {
        const [low, high] = values.range, now: [number, number] = [low, high];
        const apply = (): void => {
          renderer.lines[lines.index].shownValues = now[0] > low || now[1] < high ? [now[0], now[1]] : [1, 0];
          renderer.change(true);
        };
        made.push(
          group(
            values.name,
            slider("Minimum", low, high, low, (value) => {
              now[0] = value;
              apply();
            }),
            slider("Maximum", low, high, high, (value) => {
              now[1] = value;
              apply();
            }),
          ),
        );
      }
      for (const control of layer.controls ?? []) {
        if (control.data === undefined) continue;
        const bytes = this.data[control.data], numbers = new Float32Array(bytes.slice().buffer), [low, high] = control.range;
        const changed = (end: 0 | 1) => (value: number): void => {
          this.choiceOf(renderer.lines[lines.index]).set(control, numbers, end, value);
          renderer.change(true);
        };
        made.push(group(control.name, slider("Minimum", low, high, low, changed(0)), slider("Maximum", low, high, high, changed(1))));
      }
    }
    return made;
  }

  /** Groups of streamlines, on or off. */
  private groups(): HTMLElement[] {
    return this.renderer.lines.filter(({ layer }) => layer.groups?.length).map((lines) => {
      const choice = this.choiceOf(lines), rows = lines.layer.groups!.map(({ name, data }) => {
        const ids = asWords(this.data[data]);
        choice.groups.push(ids);
        return check(name, true, (on) => {
          if (on) choice.hidden.delete(ids);
          else choice.hidden.add(ids);
          choice.apply();
          this.renderer.change();
        });
      });
      return group(`Groups of ${lines.layer.name}`, ...rows);
    });
  }

  /** Balls and boxes: streamlines that pass through all active ones, and through none of the inverted ones. */
  private regionList(): HTMLElement {
    const list = make("div"), { renderer } = this, b = renderer.scene.bounds, size = Math.hypot(b[1] - b[0], b[3] - b[2], b[5] - b[4]);
    const add = (ball: boolean) => (): void => {
      const place = this.picked
        ? (apply(this.picked.lines.model, this.picked.place).slice(0, 3) as Vec)
        : ([0, 1, 2].map((axis) => (b[2 * axis] + b[2 * axis + 1]) / 2) as Vec);
      const region: Region = { ball, at: place, size: [size / 40, size / 40, size / 40], on: true, inverted: false };
      this.regions.push(region);
      list.append(this.regionRow(region, size));
      this.update(region);
    };
    return group("Regions", make("div", { class: "buttons" }, button("Add a ball", add(true)), button("Add a box", add(false))), list);
  }

  private regionRow(region: Region, most: number): HTMLElement {
    const { renderer } = this, b = renderer.scene.bounds, name = `${region.ball ? "Ball" : "Box"} ${this.regions.length}`;
    const later = (): void => {
      window.clearTimeout(this.later);
      this.later = window.setTimeout(() => this.update(region), 120);
      this.drawOutlines();
    };
    const sized = (label: string, axes: number[]): HTMLElement => slider(label, most / 1000, most / 4, region.size[axes[0]], (value) => {
      for (const axis of axes) region.size[axis] = value;
      later();
    });
    const row = make(
      "details",
      {},
      make("summary", {}, name),
      check("On", true, (on) => {
        region.on = on;
        this.choose();
      }),
      check("Exclude", false, (inverted) => {
        region.inverted = inverted;
        this.choose();
      }),
      ...["x", "y", "z"].map((axis, i) =>
        slider(`${axis}, mm`, b[2 * i], b[2 * i + 1], region.at[i], (value) => {
          region.at[i] = value;
          later();
        }),
      ),
      ...(region.ball
        ? [sized("Radius, mm", [0, 1, 2])]
        : ["x", "y", "z"].map((axis, i) => sized(`Half-width ${axis}, mm`, [i]))),
      make(
        "div",
        { class: "buttons" },
        button(`Remove ${name.toLowerCase()}`, () => {
          row.remove();
          this.regions.splice(this.regions.indexOf(region), 1);
          for (const choice of this.choices.values()) choice.regions.delete(region);
          this.choose();
        }),
      ),
    );
    (row as HTMLDetailsElement).open = true;
    return row;
  }

  private later = 0;

  /** Find which streamlines pass through a region, where it is on and was not there before. */
  private update(region: Region): void {
    if (!this.regions.includes(region)) return;
    for (const lines of this.renderer.lines) this.choiceOf(lines).look(region, false);
    this.choose();
  }

  /** Streamlines have arrived: find which of them pass through regions. */
  private grown(): void {
    if (!this.regions.length) return;
    for (const choice of this.choices.values()) for (const region of this.regions) choice.look(region, true);
    this.choose();
  }

  private choose(): void {
    let sum = 0;
    this.drawOutlines();
    for (const choice of this.choices.values()) {
      choice.apply();
      sum += choice.count;
    }
    this.status.textContent = this.regions.some((region) => region.on) ? `${sum} streamlines are shown` : "";
    this.renderer.change();
  }

  /** Describe the streamline at a place of the page, and mark it. */
  pick(x: number, y: number): void {
    const { renderer } = this, found = renderer.reads() ? renderer.pick(x, y) : null;
    this.unmark();
    if (found) {
      const { lines, streamline, value } = found,
        place = renderer.placeOf(lines, streamline, x, y),
        world = apply(lines.model, place).slice(0, 3);
      this.say(lines, streamline, value, world);
      this.picked = { lines, streamline, place };
      this.told?.({ layer: renderer.scene.layers.indexOf(lines.layer), streamline, place: world });
    } else this.told?.(null);
    if (!renderer.reads()) this.status.textContent = `${UNREAD} pick streamlines.`;
    renderer.change();
  }

  /** Mark a streamline that somebody else has chosen, or none. */
  mark(picked: Pick | null): void {
    this.unmark();
    const lines = picked && this.renderer.lines.find(({ layer }) => layer === this.renderer.scene.layers[picked.layer]);
    if (picked && lines && picked.streamline >= 0 && picked.streamline < lines.set.streamlines) {
      const { streamline } = picked, points = lines.set.pointsOfStreamline(streamline), place = points[points.length >> 1];
      this.say(lines, streamline, null, picked.place ?? []);
      if (place) this.picked = { lines, streamline, place };
    }
    this.renderer.change();
  }

  private unmark(): void {
    for (const lines of this.renderer.lines) lines.marked = ALL_ONES;
    this.picked = null;
    this.status.textContent = "";
  }

  private say(lines: Lines, streamline: number, value: number | null, world: number[]): void {
    lines.marked = streamline;
    const said = [`Streamline ${streamline} of ${lines.layer.name}`];
    if (value !== null && lines.values) said.push(`${lines.values.name} ${number(value)}`);
    for (const control of lines.layer.controls ?? []) {
      if (control.data !== undefined)
        said.push(`${control.name} ${number(new Float32Array(this.data[control.data].slice().buffer)[streamline])}`);
    }
    if (world.length) said.push(`at ${world.map(number).join(", ")} mm`);
    this.status.textContent = said.join("; ");
  }

  private orientation(): HTMLElement {
    const letters = this.renderer.scene.letters ? [["L", "R"], ["P", "A"], ["I", "S"]] : [["", "x"], ["", "y"], ["", "z"]];
    const names = letters.flat().map((letter, i) => make("span", { class: `axis a${i >> 1}` }, letter));
    this.axes = names;
    return make("div", { id: "axes", "aria-hidden": "true" }, ...names);
  }

  private follow(): void {
    this.turnAxes();
    this.drawOutlines();
  }

  /** Draw lines around regions over the picture. */
  private drawOutlines(): void {
    const { renderer, outlines } = this, { camera, canvas } = renderer, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!this.regions.length) return outlines.replaceChildren();
    const matrix = product(camera.projection(width / height, renderer.scene.bounds), camera.view());
    outlines.replaceChildren(...this.regions.map((region) => {
      const path = document.createElementNS(SVG, "path"), parts: string[] = [];
      for (const line of outline(region)) {
        let pen = "M";
        for (const place of line) {
          const [x, y, , w] = apply(matrix, place);
          if (w > 0) parts.push(`${pen}${(((x / w + 1) * width) / 2).toFixed(1)} ${(((1 - y / w) * height) / 2).toFixed(1)}`);
          pen = w > 0 ? "L" : "M";
        }
      }
      path.setAttribute("d", parts.join(""));
      path.setAttribute("opacity", region.on ? "1" : ".3");
      return path;
    }));
  }

  private turnAxes(): void {
    const view = this.renderer.camera.view();
    this.axes.forEach((name, i) => {
      const way = scaled([0, 1, 2].map((axis) => (axis === i >> 1 ? 1 : 0)) as Vec, i & 1 ? 1 : -1), [x, y, z] = apply(view, way, 0);
      name.style.transform = `translate(${(x * 32).toFixed(1)}px, ${(-y * 32).toFixed(1)}px)`;
      name.style.zIndex = String(Math.round(100 * z)); // the nearer ones lie over the others
    });
  }
}
