/**
 * Which shares of fiblets may show: shares in view that do not lie behind everything drawn at their place.
 *
 * A share lies within a capsule around the line from its first to its last point. The picture so far is known as the farthest
 * depth of each tile (shaders/page/far_tiles.frag): a share behind all tiles that it can touch is hidden, and
 * the picture is the same without it.
 */

import type { Mat } from "./camera";

/** Numbers of a capsule: both ends, mm, and its radius. */
const CAPSULE = 7;
const MOST_TILES = 256;

/** Farthest depths of a picture, a tile of `size` pixels each, from the lower left; every fourth number is one. */
export interface FarDepths {
  size: number;
  columns: number;
  rows: number;
  depths: Float32Array;
}

/** Capsules of shares of `share` slots; `used` returns how many a share's segments reach; four numbers a slot. */
export function capsules(slots: Float32Array, items: number, share: number, used: (item: number) => number): Float32Array {
  const found = new Float32Array(CAPSULE * items);
  for (let item = 0; item < items; ++item) {
    const a = 4 * share * item, n = used(item), b = a + 4 * (Math.min(n, share) - 1), into = CAPSULE * item;
    const ux = slots[b] - slots[a],
      uy = slots[b + 1] - slots[a + 1],
      uz = slots[b + 2] - slots[a + 2],
      square = ux * ux + uy * uy + uz * uz || 1;
    let most = 0;
    for (let p = a + 4; p < a + 4 * n; p += 4) {
      const x = slots[p] - slots[a], y = slots[p + 1] - slots[a + 1], z = slots[p + 2] - slots[a + 2];
      const t = Math.min(Math.max((x * ux + y * uy + z * uz) / square, 0), 1), dx = x - t * ux, dy = y - t * uy, dz = z - t * uz;
      most = Math.max(most, dx * dx + dy * dy + dz * dz);
    }
    for (let axis = 0; axis < 3; ++axis) {
      found[into + axis] = slots[a + axis];
      found[into + 3 + axis] = slots[b + axis];
    }
    found[into + 6] = 1.0001 * Math.sqrt(most) + 1e-4;
  }
  return found;
}

/**
 * Have `shows[i]` say whether capsule `i` may show; `window` leads from its coordinates to the window, lines reach
 * `brush` pixels to each side.
 */
export function lookAt(
  shapes: Float32Array,
  window: Mat,
  brush: number,
  width: number,
  height: number,
  far: FarDepths,
  shows: Uint8Array,
): void {
  const m = Float64Array.from(window),
    [gx, gy, gz, gw] = [0, 1, 2, 3].map((row) => Math.hypot(m[row], m[row + 4], m[row + 8]));
  const { size, columns, rows, depths } = far;
  for (let i = 0, p = 0; i < shows.length; ++i, p += CAPSULE) {
    const r = shapes[p + 6];
    let left = Infinity,
      right = -Infinity,
      low = Infinity,
      high = -Infinity,
      nearest = Infinity;
    for (let end = p; end < p + 6; end += 3) {
      const x = shapes[end],
        y = shapes[end + 1],
        z = shapes[end + 2];
      const w = m[3] * x + m[7] * y + m[11] * z + m[15],
        least = w - r * gw;
      if (!(least > 0)) {
        nearest = -Infinity;
        break;
      }
      // A ball's window: its middle, and how far its sides are away at most.
      const wx = (m[0] * x + m[4] * y + m[8] * z + m[12]) / w,
        wy = (m[1] * x + m[5] * y + m[9] * z + m[13]) / w;
      const rx = (r * (gx + Math.abs(wx) * gw)) / least + brush,
        ry = (r * (gy + Math.abs(wy) * gw)) / least + brush;
      if (wx - rx < left) left = wx - rx;
      if (wx + rx > right) right = wx + rx;
      if (wy - ry < low) low = wy - ry;
      if (wy + ry > high) high = wy + ry;
      nearest = Math.min(nearest, (m[2] * x + m[6] * y + m[10] * z + m[14] - r * gz) / least);
    }
    shows[i] = 1;
    if (nearest === -Infinity) continue;
    if (right < 0 || left > width || high < 0 || low > height) {
      shows[i] = 0;
      continue;
    }
    const x0 = Math.max(Math.floor(left / size), 0),
      x1 = Math.min(Math.floor(right / size), columns - 1);
    const y0 = Math.max(Math.floor(low / size), 0),
      y1 = Math.min(Math.floor(high / size), rows - 1);
    if ((x1 - x0 + 1) * (y1 - y0 + 1) > MOST_TILES) continue;
    nearest -= 1e-6;
    let hidden = true;
    for (let y = y0; y <= y1 && hidden; ++y)
      for (let x = x0; x <= x1; ++x)
        if (nearest <= depths[4 * (y * columns + x)]) {
          hidden = false;
          break;
        }
    if (hidden) shows[i] = 0;
  }
}
