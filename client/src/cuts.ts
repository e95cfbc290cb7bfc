/** Cuts of lines by regions: the program text for a region's form, and the numbers of shaders/regions/rays.glsl for a camera. */

import { Mat, Vec, apply, inverse } from "./camera";

/** A region of the world; pvfiblets/plotting/page/cuts.py makes it. */
export interface Cut {
  // Held where all planes are not below 0, or in the unit ball of what three rows map to; rows over (x, y, z, 1).
  leaves: { centre: Vec; planes?: number[][]; ball?: number[][] }[];
  program: number[]; // postfix: numbers of leaves; -1 both, -2 either, -3 not
}

const ROWS = 6;

/** Expression of the shapes, as GLSL. */
export function expression({ leaves, program }: Cut): string {
  const stack: string[] = [];
  for (const word of program) {
    if (word >= 0) stack.push(leaves[word].ball ? `sphere_holds(${word},z)` : `planes_hold(${word},${leaves[word].planes!.length},z)`);
    else if (word === -3) stack.push(`!${stack.pop()}`);
    else stack.push(`(${stack.pop()}${word === -1 ? "&&" : "||"}${stack.pop()})`);
  }
  return stack[0];
}

/**
 * The shapes as rows over window coordinates about each one's middle, as pvfiblets/engine/regions/convex_rays.py has
 * them; null where a view has no depth.
 */
export function raysOf({ leaves }: Cut, window: Mat, width: number, height: number): Record<string, Float64Array> | null {
  const back = inverse(window), span = [width, height, 1, 1], four = [0, 1, 2, 3];
  if (!back) return null;
  const rows = new Float64Array(4 * ROWS * leaves.length), centres = new Float64Array(4 * leaves.length);
  leaves.forEach(({ centre, planes, ball }, k) => {
    const [x, y, z, w] = apply(window, centre), place = [x / w, y / w, z / w];
    const about =
      w > 0 && place.every(isFinite)
        ? place.map((part, i) => Math.min(Math.max(part, 0), span[i]))
        : [width / 2, height / 2, 0];
    const seen = (row: number[]): number[] => {
      const found = four.map((j) => four.reduce((sum, i) => sum + row[i] * back[i + 4 * j], 0));
      found[3] += found[0] * about[0] + found[1] * about[1] + found[2] * about[2];
      return found;
    };
    const scaled = (row: number[]): number[] => {
      const largest = Math.max(...row.map((value, i) => Math.abs(value * span[i]))) || 1;
      return row.map((value, i) => (Math.abs(value * span[i]) < 1e-30 * largest ? 0 : value / largest));
    };
    centres.set(about, 4 * k);
    if (planes) planes.forEach((plane, i) => rows.set(scaled(seen(plane)), 4 * (ROWS * k + i)));
    if (!ball) return;
    const units = [...ball, [0, 0, 0, 1]].map(seen);
    const q = four.map((i) => four.map((j) => units.reduce((sum, unit, at) => sum + (at < 3 ? 1 : -1) * unit[i] * unit[j], 0)));
    const most = Math.max(...four.flatMap((i) => four.map((j) => Math.abs(q[i][j] * span[i] * span[j])))) || 1;
    rows.set(
      [q[0][0], q[1][1], 2 * q[0][1], q[3][3], 2 * q[0][3], 2 * q[1][3], q[0][2], q[1][2], q[2][2], q[2][3]].map(
        (value) => value / most,
      ),
      4 * ROWS * k,
    );
  });
  return { rays_rows: rows, rays_centres: centres };
}
