/** What lies over the picture: layers, views, cuts, ranges, colour bars, letters of orientation, and the word on what was picked. */

import { Vec, apply, scaled } from "./camera";
import { fromBase64 } from "./engine";
import type { Lines, Renderer } from "./renderer";
import type { Bar, Control } from "./scene";

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
  const input = make("input", { type: "range", min: String(low), max: String(high), step: String(step), value: String(value) }) as HTMLInputElement;
  input.addEventListener("input", () => {
    shown.textContent = number(input.valueAsNumber);
    changed(input.valueAsNumber);
  });
  return make("label", {}, make("span", {}, label), input, shown);
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
  const canvas = make("canvas", { width: String(n), height: "1", role: "img", "aria-label": `Colours from ${number(bar.clim[0])} to ${number(bar.clim[1])}` }) as HTMLCanvasElement;
  const context = canvas.getContext("2d")!, pixels = context.createImageData(n, 1);
  pixels.data.set(table);
  context.putImageData(pixels, 0, 0);
  const [low, high] = bar.clim, middle = bar.log ? Math.sqrt(low * high) : (low + high) / 2;
  return make("figure", { class: "bar" }, make("figcaption", {}, bar.title), canvas,
    make("div", { class: "ticks", "aria-hidden": "true" }, ...[low, middle, high].map((value) => make("span", {}, number(value)))));
}

/** Which streamlines are drawn: those of the figure, within all ranges that the reader has set. */
class Choice {
  private ranges = new Map<string, { values: Float32Array; low: number; high: number; whole: [number, number] }>();
  readonly regions = new Map<string, Uint8Array>();

  constructor(private lines: Lines, private base: Uint8Array | null) {}

  set(control: Control, values: Float32Array, end: 0 | 1, value: number): void {
    const found = this.ranges.get(control.name) ?? { values, low: control.range[0], high: control.range[1], whole: control.range };
    if (end === 0) found.low = value;
    else found.high = value;
    this.ranges.set(control.name, found);
    this.apply();
  }

  apply(): void {
    const active = [...this.ranges.values()].filter((range) => range.low > range.whole[0] || range.high < range.whole[1]);
    if (!active.length && !this.regions.size) return this.lines.keep(this.base);
    const n = this.lines.set.streamlines, kept = new Uint8Array(n);
    for (let i = 0; i < n; ++i) {
      let keep = this.base === null || this.base[i] !== 0;
      for (const range of active) {
        const eps = 1e-6 * (range.whole[1] - range.whole[0]);
        keep = keep && range.values[i] >= range.low - eps && range.values[i] <= range.high + eps;
      }
      for (const region of this.regions.values()) keep = keep && region[i] !== 0;
      kept[i] = keep ? 1 : 0;
    }
    this.lines.keep(kept);
  }
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
  private radius = 5;

  constructor(private renderer: Renderer, private data: Uint8Array[]) {
    const over = document.getElementById("over")!, { scene } = renderer;
    const panel = make("details", { id: "panel" }, make("summary", {}, "Scene"));
    panel.append(this.layers(), this.views(), this.cut(), ...this.ranges(), this.region());
    over.append(panel);
    if (scene.bars.length) over.append(make("div", { id: "bars" }, ...scene.bars.map(drawBar)));
    over.append(this.orientation());
    renderer.restored = () => { for (const choice of this.choices.values()) choice.apply(); };
    renderer.presented = () => this.turnAxes();
    this.turnAxes();
  }

  private layers(): HTMLElement {
    const { renderer } = this, rows: HTMLElement[] = [];
    renderer.scene.layers.forEach((layer) => {
      const box = make("input", { type: "checkbox" }) as HTMLInputElement;
      box.checked = layer.visible;
      box.addEventListener("change", () => {
        layer.visible = box.checked;
        renderer.change();
      });
      rows.push(make("label", {}, box, make("span", {}, layer.name)));
      if (layer.kind === "fiblets") {
        rows.push(slider("Line width", 0.5, 10, layer.line_width, (width) => {
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
    return group("Shown", ...rows);
  }

  private views(): HTMLElement {
    const { renderer } = this, start = structuredClone(renderer.camera.state);
    const buttons = VIEWS.map(([name, direction, up]) => button(name, () => {
      renderer.camera.lookAlong(direction, up, renderer.scene.bounds);
      renderer.change();
    }));
    buttons.push(button("As at first", () => {
      Object.assign(renderer.camera.state, structuredClone(start));
      renderer.change();
    }));
    buttons.push(button("Save picture", () => this.save()));
    return group("View", make("div", { class: "buttons" }, ...buttons));
  }

  private save(): void {
    const { renderer } = this;
    void renderer.settled().then(() => {
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
      const axis = choice.selectedIndex - 1, plane = (sign: number): number[] => [0, 1, 2].map((i) => (i === axis ? sign : 0)).concat(-sign * at + thickness / 2);
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
        sliders.append(slider("Middle", low, high, at, (value) => { at = value; apply(); }), slider("Thickness", (high - low) / 200, high - low, thickness, (value) => { thickness = value; apply(); }));
      }
      apply();
    });
    return group("Slab across", choice, sliders);
  }

  private choiceOf(lines: Lines): Choice {
    let found = this.choices.get(lines.index);
    if (!found) this.choices.set(lines.index, (found = new Choice(lines, lines.layer.kept === undefined ? null : this.data[lines.layer.kept])));
    return found;
  }

  private ranges(): HTMLElement[] {
    const { renderer } = this, made: HTMLElement[] = [];
    for (const lines of renderer.lines) {
      const { values, layer } = lines;
      if (values) {
        const low = values.code[0], high = low + values.code[1] * (values.code[2] - 1), now: [number, number] = [low, high];
        const apply = (): void => {
          renderer.lines[lines.index].shownValues = now[0] > low || now[1] < high ? [now[0], now[1]] : [1, 0];
          renderer.change(true);
        };
        made.push(group(values.name, slider("From", low, high, low, (value) => { now[0] = value; apply(); }), slider("To", low, high, high, (value) => { now[1] = value; apply(); })));
      }
      for (const control of layer.controls ?? []) {
        if (control.data === undefined) continue;
        const bytes = this.data[control.data], numbers = new Float32Array(bytes.slice().buffer), [low, high] = control.range;
        const changed = (end: 0 | 1) => (value: number): void => {
          this.choiceOf(renderer.lines[lines.index]).set(control, numbers, end, value);
          renderer.change(true);
        };
        made.push(group(control.name, slider("From", low, high, low, changed(0)), slider("To", low, high, high, changed(1))));
      }
    }
    return made;
  }

  /** Streamlines through a ball around the place that was picked. */
  private region(): HTMLElement {
    const { renderer } = this, b = renderer.scene.bounds, size = Math.hypot(b[1] - b[0], b[3] - b[2], b[5] - b[4]);
    this.radius = size / 40;
    const keep = (): void => {
      if (!this.picked) {
        this.status.textContent = "Click on a streamline first.";
        return;
      }
      const { lines, place } = this.picked, through = lines.set.through(place, this.radius), choice = this.choiceOf(lines);
      choice.regions.set("ball", through);
      choice.apply();
      renderer.change();
      this.status.textContent = `${through.reduce((sum, one) => sum + one, 0)} streamlines pass within ${number(this.radius)} mm of the place`;
    };
    const all = (): void => {
      for (const choice of this.choices.values()) {
        choice.regions.clear();
        choice.apply();
      }
      renderer.change();
      this.status.textContent = "";
    };
    return group("Region", slider("Radius, mm", size / 1000, size / 5, this.radius, (value) => { this.radius = value; }),
      make("div", { class: "buttons" }, button("Those through the picked place", keep), button("All", all)));
  }

  /** Say what lies at a place of the page, and mark it. */
  pick(x: number, y: number): void {
    const { renderer } = this, found = renderer.pick(x, y);
    this.unmark();
    if (found) {
      const { lines, streamline, value } = found, place = renderer.placeOf(lines, streamline, x, y), world = apply(lines.model, place).slice(0, 3);
      this.say(lines, streamline, value, world);
      this.picked = { lines, streamline, place };
      this.told?.({ layer: renderer.scene.layers.indexOf(lines.layer), streamline, place: world });
    } else this.told?.(null);
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
    for (const lines of this.renderer.lines) lines.marked = 0xffffffff;
    this.picked = null;
    this.status.textContent = "";
  }

  private say(lines: Lines, streamline: number, value: number | null, world: number[]): void {
    lines.marked = streamline;
    const said = [`Streamline ${streamline} of ${lines.layer.name}`];
    if (value !== null && lines.values) said.push(`${lines.values.name} ${number(value)}`);
    for (const control of lines.layer.controls ?? []) {
      if (control.data !== undefined) said.push(`${control.name} ${number(new Float32Array(this.data[control.data].slice().buffer)[streamline])}`);
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

  private turnAxes(): void {
    const view = this.renderer.camera.view();
    this.axes.forEach((name, i) => {
      const way = scaled([0, 1, 2].map((axis) => (axis === i >> 1 ? 1 : 0)) as Vec, i & 1 ? 1 : -1), [x, y, z] = apply(view, way, 0);
      name.style.transform = `translate(${(x * 32).toFixed(1)}px, ${(-y * 32).toFixed(1)}px)`;
      name.style.opacity = String(0.35 + 0.65 * (0.5 + z / 2));
    });
  }
}
