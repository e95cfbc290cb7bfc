/** Balls and boxes in the world, which streamlines pass through or not. */

import { Vec, dot, sub } from "./camera";

export interface Region {
  ball: boolean;
  at: Vec;              // its middle, mm
  size: Vec;            // from there to its sides; of a ball three times its radius
  on: boolean;
  inverted: boolean;    // streamlines that do not pass through it
}

/** A place as the region has it: from its middle, in units of its size. */
export function within({ at, size }: Region, place: readonly number[]): Vec {
  return [0, 1, 2].map((axis) => (place[axis] - at[axis]) / Math.max(size[axis], 1e-9)) as Vec;
}

/** Whether a segment between two such places meets the ball or the cube of size 1. */
export function meets({ ball }: Region, a: Vec, b: Vec): boolean {
  const run = sub(b, a);
  if (ball) {
    const t = Math.min(1, Math.max(0, -dot(a, run) / (dot(run, run) || 1))),
      nearest: Vec = [a[0] + t * run[0], a[1] + t * run[1], a[2] + t * run[2]];
    return dot(nearest, nearest) <= 1;
  }
  let enter = 0, leave = 1;
  for (let axis = 0; axis < 3; ++axis) {
    if (run[axis] === 0) {
      if (Math.abs(a[axis]) > 1) return false;
      continue;
    }
    const s = (-1 - a[axis]) / run[axis], t = (1 - a[axis]) / run[axis];
    enter = Math.max(enter, Math.min(s, t));
    leave = Math.min(leave, Math.max(s, t));
  }
  return enter <= leave;
}

/** Lines around a region, in the world. */
export function outline({ ball, at, size }: Region): Vec[][] {
  const place = (x: number, y: number, z: number): Vec => [at[0] + x * size[0], at[1] + y * size[1], at[2] + z * size[2]];
  if (ball) {
    const turn = Array.from({ length: 49 }, (_, i) => [Math.cos((i * Math.PI) / 24), Math.sin((i * Math.PI) / 24)]);
    return [turn.map(([c, s]) => place(c, s, 0)), turn.map(([c, s]) => place(c, 0, s)), turn.map(([c, s]) => place(0, c, s))];
  }
  const ring = (z: number): Vec[] => [place(-1, -1, z), place(1, -1, z), place(1, 1, z), place(-1, 1, z), place(-1, -1, z)];
  return [ring(-1), ring(1), ...[[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => [place(x, y, -1), place(x, y, 1)])];
}
