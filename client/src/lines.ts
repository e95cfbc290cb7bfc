/** Fiblets of a scene, with what colours and hides them. */

import type { Archive } from "./archive";
import { Mat, identity } from "./camera";
import { fromBase64 } from "./engine";
import { FibletSet, PointValues, asCodes, asWords } from "./fiblets";
import { ALL_ONES, GL, lookUpTable, rows } from "./gl";
import type { FibletLayer } from "./scene";

export class Lines {
  readonly set: FibletSet;
  readonly model: Mat;
  values: PointValues | null = null;      // that the G-buffer holds
  colours: WebGLTexture | null = null;   // by streamline, or by point
  table: WebGLTexture | null = null;
  tableSize = 1;
  tableRange: number[] = [0, 1, 1];
  kept: WebGLTexture | null = null;
  chosen: WebGLTexture | null = null;
  opacities: WebGLTexture | null = null;
  keptPoints: WebGLTexture | null = null;
  shownValues: [number, number] = [1, 0];
  marked = ALL_ONES;

  constructor(private gl: GL, readonly layer: FibletLayer, readonly index: number, data: Uint8Array[], archive: Archive, set?: FibletSet) {
    this.set = set ?? new FibletSet(gl, archive);
    this.set.advance(archive.ready);
    this.model = new Float64Array(layer.matrix ?? identity());
    const { colours } = layer;
    if (colours.codes) {
      const { codes } = colours;
      this.values = this.set.codedValues(
        colours.values!,
        asCodes(data[codes.data], codes.bits),
        new Float32Array(data[codes.table].slice().buffer),
        codes,
      );
    }
    else if (colours.values !== undefined) this.values = this.set.pointValues(colours.values);
    if (colours.data !== undefined) this.colours = rows(gl, "rgba8", data[colours.data], "colours");
    if (colours.table !== undefined) {
      const clim = colours.clim!.map((end) => end - (this.values?.reference ?? 0));
      [this.table, this.tableSize, this.tableRange] = lookUpTable(gl, fromBase64(colours.table), clim, !!colours.log);
    }
    if (layer.kept !== undefined) this.keep(data[layer.kept]);
    if (layer.chosen) this.chosen = rows(gl, "r8ui", data[layer.chosen.data], "streamlines");
    if (layer.through?.opacities !== undefined) this.opacities = rows(gl, "r8ui", data[layer.through.opacities], "streamlines");
    if (layer.kept_points !== undefined) this.keptPoints = rows(gl, "r32ui", asWords(data[layer.kept_points]), "points");
  }

  /** Give back all but the set. */
  release(): void {
    if (this.values) this.set.forget(this.values);
    for (const texture of [this.colours, this.table, this.kept, this.chosen, this.opacities, this.keptPoints])
      if (texture) this.gl.deleteTexture(texture);
  }

  get byPoint(): boolean {
    return this.layer.colours.mode === "point_packed";
  }

  /** Switches of shaders/colour. */
  get colouring(): string[] {
    const { mode, log } = this.layer.colours;
    return [`COLOUR_${mode.toUpperCase()}`, ...(log ? ["TABLE_LOGARITHM"] : [])];
  }

  /** Draw those streamlines alone whose byte is not 0; null: all. */
  keep(bytes: Uint8Array | null): void {
    if (this.kept) this.gl.deleteTexture(this.kept);
    this.kept = bytes && rows(this.gl, "r8ui", bytes, "streamlines");
  }
}
