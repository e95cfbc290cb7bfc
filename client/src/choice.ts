/** The streamlines that the reader has chosen. */

import type { Region } from "./regions";
import type { Lines } from "./lines";
import type { Control } from "./scene";

/** Streamlines of one set that are in the figure and within all ranges, regions and groups of the reader. */
export class Choice {
  private ranges = new Map<string, { values: Float32Array; low: number; high: number; whole: [number, number] }>();
  readonly regions = new Map<Region, { through: Uint8Array; blocks: number }>();  // of the set's first blocks
  readonly hidden = new Set<Uint32Array>();  // groups
  groups: Uint32Array[] = [];

  constructor(private lines: Lines, private base: Uint8Array | null) {}

  /** How many streamlines are drawn. */
  get count(): number {
    const kept = this.chosen;
    return kept ? kept.reduce((sum, one) => sum + one, 0) : this.lines.set.streamlines;
  }

  set(control: Control, values: Float32Array, end: 0 | 1, value: number): void {
    const found = this.ranges.get(control.name) ?? { values, low: control.range[0], high: control.range[1], whole: control.range };
    if (end === 0) found.low = value;
    else found.high = value;
    this.ranges.set(control.name, found);
    this.apply();
  }

  /** Find which streamlines pass through a region; of one that was looked at, among those alone that have come since. */
  look(region: Region, again: boolean): void {
    const { set, model } = this.lines, known = again ? this.regions.get(region) : undefined;
    this.regions.set(region, { through: set.through(region, model, known?.blocks, known?.through), blocks: set.blocks.length });
  }

  apply(): void {
    const active = [...this.ranges.values()].filter((range) => range.low > range.whole[0] || range.high < range.whole[1]);
    const regions = [...this.regions].filter(([region]) => region.on);
    if (!active.length && !regions.length && !this.hidden.size) return this.keep(this.base);
    const n = this.lines.set.streamlines, kept = new Uint8Array(n), grouped = this.grouped(n);
    for (let i = 0; i < n; ++i) {
      let keep = this.base === null || this.base[i] !== 0;
      for (const range of active) {
        const eps = 1e-6 * (range.whole[1] - range.whole[0]);
        keep = keep && range.values[i] >= range.low - eps && range.values[i] <= range.high + eps;
      }
      for (const [region, { through }] of regions) keep = keep && (through[i] !== 0) !== region.inverted;
      kept[i] = keep && grouped[i] ? 1 : 0;
    }
    this.keep(kept);
  }

  private chosen: Uint8Array | null = null;

  private keep(kept: Uint8Array | null): void {
    this.chosen = kept;
    this.lines.keep(kept);
  }

  /** Of each streamline 1 but where all groups that it is in are hidden. */
  private grouped(n: number): Uint8Array {
    const shown = new Uint8Array(n).fill(1);
    for (const group of this.hidden) for (const id of group) shown[id] = 0;
    for (const group of this.hidden.size ? this.groups : []) if (!this.hidden.has(group)) for (const id of group) shown[id] = 1;
    return shown;
  }
}
