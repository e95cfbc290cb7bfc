/** Matrices, column by column as WebGL has them, and a camera that moves as VTK's trackball does. */

export type Vec = [number, number, number];
export type Mat = Float64Array;

export const sub = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const add = (a: Vec, b: Vec, by = 1): Vec => [a[0] + by * b[0], a[1] + by * b[1], a[2] + by * b[2]];
export const scaled = (a: Vec, by: number): Vec => [a[0] * by, a[1] * by, a[2] * by];
export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a: Vec): number => Math.hypot(a[0], a[1], a[2]);
export const unit = (a: Vec): Vec => scaled(a, 1 / (norm(a) || 1));

export function product(a: Mat, b: Mat): Mat {
  const c = new Float64Array(16);
  for (let j = 0; j < 4; ++j)
    for (let i = 0; i < 4; ++i) {
      let sum = 0;
      for (let k = 0; k < 4; ++k) sum += a[i + 4 * k] * b[k + 4 * j];
      c[i + 4 * j] = sum;
    }
  return c;
}

export function identity(): Mat {
  const m = new Float64Array(16);
  m[0] = m[5] = m[10] = m[15] = 1;
  return m;
}

export function moved(by: Vec): Mat {
  const m = identity();
  m.set(by, 12);
  return m;
}

/** Inverse by Gauss and Jordan; null for a matrix that flattens. */
export function inverse(m: Mat): Mat | null {
  const a = Array.from({ length: 4 }, (_, i) => Array.from({ length: 8 }, (_, j) => (j < 4 ? m[i + 4 * j] : j - 4 === i ? 1 : 0)));
  for (let k = 0; k < 4; ++k) {
    let best = k;
    for (let i = k + 1; i < 4; ++i) if (Math.abs(a[i][k]) > Math.abs(a[best][k])) best = i;
    if (!(Math.abs(a[best][k]) > 0)) return null;
    [a[k], a[best]] = [a[best], a[k]];
    const pivot = a[k][k];
    for (let j = 0; j < 8; ++j) a[k][j] /= pivot;
    for (let i = 0; i < 4; ++i) {
      if (i === k) continue;
      const by = a[i][k];
      for (let j = 0; j < 8; ++j) a[i][j] -= by * a[k][j];
    }
  }
  const out = new Float64Array(16);
  for (let i = 0; i < 4; ++i) for (let j = 0; j < 4; ++j) out[i + 4 * j] = a[i][j + 4];
  return out;
}

export function apply(m: Mat, p: Vec, w = 1): [number, number, number, number] {
  return [0, 1, 2, 3].map((i) => m[i] * p[0] + m[i + 4] * p[1] + m[i + 8] * p[2] + m[i + 12] * w) as [number, number, number, number];
}

/** The upper left 3 by 3 part. */
export function linear(m: Mat): number[] {
  return [m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]];
}

export const floats = (m: Mat): Float32Array => new Float32Array(m);

function turned(p: Vec, axis: Vec, degrees: number): Vec {
  const a = (degrees * Math.PI) / 180, c = Math.cos(a), s = Math.sin(a), u = unit(axis);
  return add(add(scaled(p, c), cross(u, p), s), u, dot(u, p) * (1 - c));
}

export interface CameraState {
  position: Vec;
  focal_point: Vec;
  up: Vec;
  view_angle: number;
  parallel: boolean;
  parallel_scale: number;
}

export type Bounds = [number, number, number, number, number, number];

const FRONT: CameraState = {
  position: [0, 0, 1], focal_point: [0, 0, 0], up: [0, 1, 0], view_angle: 30, parallel: false, parallel_scale: 1,
};

export class Camera {
  constructor(public state: CameraState = FRONT) {}

  get forward(): Vec {
    return unit(sub(this.state.focal_point, this.state.position));
  }

  get right(): Vec {
    return unit(cross(this.forward, this.state.up));
  }

  get distance(): number {
    return norm(sub(this.state.focal_point, this.state.position));
  }

  /** Data to view coordinates: the camera at the origin, looking along -z. */
  view(): Mat {
    const f = this.forward, r = this.right, u = cross(r, f), e = this.state.position;
    return new Float64Array([r[0], u[0], -f[0], 0, r[1], u[1], -f[1], 0, r[2], u[2], -f[2], 0, -dot(r, e), -dot(u, e), dot(f, e), 1]);
  }

  /** Distances in front of the camera between which everything lies. */
  range(bounds: Bounds): [number, number] {
    const f = this.forward, e = this.state.position;
    let near = Infinity, far = -Infinity;
    for (let i = 0; i < 8; ++i) {
      const z = dot(f, sub([bounds[i & 1], bounds[2 + ((i >> 1) & 1)], bounds[4 + (i >> 2)]], e));
      near = Math.min(near, z);
      far = Math.max(far, z);
    }
    const margin = Math.max(0.005 * (far - near), 1e-6 * Math.abs(far));
    near -= margin;
    far += margin;
    if (this.state.parallel) return [near, Math.max(far, near + 1e-6)];
    far = Math.max(far, 1e-6);
    return [Math.max(near, 0.001 * far), far];
  }

  projection(aspect: number, bounds: Bounds): Mat {
    const [n, f] = this.range(bounds), m = new Float64Array(16), s = this.state;
    if (s.parallel) {
      m[0] = 1 / (s.parallel_scale * aspect);
      m[5] = 1 / s.parallel_scale;
      m[10] = -2 / (f - n);
      m[14] = -(f + n) / (f - n);
      m[15] = 1;
    } else {
      const t = 1 / Math.tan((s.view_angle * Math.PI) / 360);
      m[0] = t / aspect;
      m[5] = t;
      m[10] = -(f + n) / (f - n);
      m[11] = -1;
      m[14] = (-2 * f * n) / (f - n);
    }
    return m;
  }

  /** As a drag over shares of the window does, VTK's way: 200 degrees across. */
  rotate(dx: number, dy: number): void {
    const s = this.state;
    let arm = turned(sub(s.position, s.focal_point), s.up, -200 * dx);
    const right = unit(cross(scaled(arm, -1), s.up));
    arm = turned(arm, right, -200 * dy);
    s.position = add(s.focal_point, arm);
    s.up = unit(cross(right, unit(scaled(arm, -1))));
  }

  roll(degrees: number): void {
    this.state.up = turned(this.state.up, this.forward, degrees);
  }

  /** By shares of the window's height, so that the point under the hand stays there. */
  pan(dx: number, dy: number): void {
    const s = this.state, size = s.parallel ? 2 * s.parallel_scale : 2 * this.distance * Math.tan((s.view_angle * Math.PI) / 360);
    const up = cross(this.right, this.forward), by = add(scaled(this.right, -dx * size), up, -dy * size);
    s.position = add(s.position, by);
    s.focal_point = add(s.focal_point, by);
  }

  dolly(factor: number): void {
    const s = this.state;
    if (s.parallel) s.parallel_scale /= factor;
    else s.position = add(s.focal_point, sub(s.position, s.focal_point), 1 / factor);
  }

  /** Look along a direction at all there is, as near as the picture's edges allow: `point_camera` of plotting/viewpoints.py. */
  lookAlong(direction: Vec, up: Vec, bounds: Bounds, aspect: number): void {
    const s = this.state, [low, high] = [0, 1].map((end) => [0, 1, 2].map((axis) => bounds[2 * axis + end]));
    const radius = norm(sub(high as Vec, low as Vec)) / 2 || 1, narrow = Math.min(aspect, 1);
    s.view_angle = 30;
    s.up = up;
    s.focal_point = scaled(add(low as Vec, high as Vec), 0.5);
    s.position = add(s.focal_point, unit(direction), -radius / Math.sin(Math.atan(Math.tan(Math.PI / 12) * narrow)));
    s.parallel_scale = radius / narrow;
    const window = product(this.projection(aspect, bounds), this.view());
    let reach = 0;
    for (let i = 0; i < 27; ++i) {
      const part = [i % 3, Math.floor(i / 3) % 3, Math.floor(i / 9)];
      if (part.filter((one) => one === 1).length !== 1) continue; // the middle of an edge of the box
      const [x, y, , w] = apply(window, part.map((one, axis) => low[axis] + (one / 2) * (high[axis] - low[axis])) as Vec);
      reach = Math.max(reach, Math.abs(x / w), Math.abs(y / w));
    }
    if (!(reach > 0 && reach < Infinity)) return;
    if (s.parallel) s.parallel_scale *= reach / 0.92;
    else s.view_angle *= reach / 0.92;
  }
}
