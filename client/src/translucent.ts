/**
 * What one looks through: lines as the engine's slices show them (pvfiblets/engine/fiblets/gather/gathering.py), surfaces and slices of
 * images, all mixed as VTK mixes them without depth peeling. Nothing of it is made while everything shown is opaque.
 */

import { Vec, apply, inverse, product } from "./camera";
import { ALL_ONES, GL, Program, framebuffer, target } from "./gl";
import type { Lines } from "./lines";
import type { Drawn } from "./surfaces";

const SLICES = 4, GROWTH = 2.5, MOST_OPAQUE = 0.999;
const EDGES = [1, 2, 3].map((k) => (GROWTH ** k - 1) / (GROWTH ** SLICES - 1));
const SHOULDER: Vec = [-1, 1, 1];   // whence light comes in view coordinates (shaders/frame/gentle_light.glsl)

/** The nearest lines of a layer, and the sums of those behind. */
interface Held {
  texels: WebGLTexture;
  depths: WebGLTexture;
  places: WebGLTexture | null;
  sums: WebGLTexture[];
  nearest: WebGLFramebuffer;
  behind: WebGLFramebuffer;
  summed: boolean;
}

/** Bits of floats that can be blended: 32, 16, or 0. */
export function floatBits(gl: GL): 0 | 16 | 32 {
  const whole = gl.getExtension("EXT_color_buffer_float"), half = whole ?? gl.getExtension("EXT_color_buffer_half_float");
  return whole && gl.getExtension("EXT_float_blend") ? 32 : half ? 16 : 0;
}

export class Translucent {
  private held = new Map<Lines, Held>();
  private mixed: WebGLTexture;
  private weights: WebGLTexture;
  private buffer: WebGLFramebuffer;

  constructor(private gl: GL, private bits: 16 | 32, private width: number, private height: number, private depths: WebGLTexture) {
    this.mixed = target(gl, gl.RGBA16F, width, height);
    this.weights = target(gl, gl.R16F, width, height);
    this.buffer = framebuffer(gl, this.mixed, depths);
    this.attach([this.weights]);
  }

  /** Give the framebuffer that is bound more colours than its first. */
  private attach(more: WebGLTexture[]): void {
    const { gl } = this;
    more.forEach((texture, i) => gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT1 + i, gl.TEXTURE_2D, texture, 0));
    gl.drawBuffers([gl.COLOR_ATTACHMENT0, ...more.map((_, i) => gl.COLOR_ATTACHMENT1 + i)]);
  }

  /** Begin with a layer's nearest lines: opaque things hide them. */
  begin(lines: Lines, wide: boolean, opaque: WebGLFramebuffer): void {
    const { gl, width, height } = this;
    let held = this.held.get(lines);
    if (held && !!held.places !== wide) {
      this.drop(held);
      held = undefined;
    }
    if (!held) {
      const texels = target(gl, gl.RGBA32UI, width, height), depths = target(gl, gl.DEPTH_COMPONENT32F, width, height);
      const places = wide ? target(gl, gl.R32UI, width, height) : null;
      const sums = lines.layer.through!.all
        ? EDGES.concat(1).map(() => target(gl, this.bits === 32 ? gl.RGBA32F : gl.RGBA16F, width, height))
        : [];
      const nearest = framebuffer(gl, texels, depths);
      if (places) this.attach([places]);
      const behind = sums.length ? framebuffer(gl, sums[0], this.depths) : nearest;
      if (sums.length) this.attach(sums.slice(1));
      this.held.set(lines, (held = { texels, depths, places, sums, nearest, behind, summed: false }));
    }
    held.summed = false;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, opaque);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, held.nearest);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.DEPTH_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, held.nearest);
    gl.clearBufferuiv(gl.COLOR, 0, [ALL_ONES, ALL_ONES, 0, 0]);
  }

  /** Draw into a layer's nearest lines. */
  nearest(lines: Lines): void {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, this.held.get(lines)!.nearest);
  }

  depthsOf(lines: Lines): WebGLTexture {
    return this.held.get(lines)!.depths;
  }

  /** Draw into a layer's sums, with a program that adds what lines show; from then on the first time they are empty. */
  behind(lines: Lines): void {
    const { gl } = this, held = this.held.get(lines)!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, held.behind);
    if (!held.summed) held.sums.forEach((_, i) => gl.clearBufferfv(gl.COLOR, i, [0, 0, 0, 0]));
    held.summed = true;
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
  }

  /** Tell a program what lines add to sums. */
  paint(program: Program, lines: Lines, drawn: Drawn): void {
    const { texels, depths, places } = this.held.get(lines)!, { layer } = lines, { through } = layer;
    const model = product(drawn.view, lines.model), across = new Float64Array(model), p = drawn.projection, b = lines.set.bounds;
    across.set([0, 0, 0], 12);
    const back = layer.light === "line" ? inverse(across) : null,
      light = back ? apply(back, SHOULDER, 0).slice(0, 3) : [0, 0, 0],
      size = Math.hypot(...light) || 1;
    let far = -Infinity;
    for (let i = 0; i < 8; ++i) far = Math.max(far, -apply(model, [b[i & 1], b[2 + ((i >> 1) & 1)], b[4 + (i >> 2)]])[2]);
    program
      .textures({ texels, depths, places })
      .set({
        slice_distances: drawn.parallel ? [(p[14] - 1) / p[10], 2 / p[10], 1, 0] : [p[14], 0, 1 + p[10], -2],
        slice_far: far,
        slice_edges: EDGES,
        paint_light: light.map((part) => part / size),
        paint_opacity: through!.opacity,
        paint_unit: 1 / Math.max(this.absorbance(lines), 1e-12),
        sum_unit: this.unit(lines),
      });
  }

  /** Of a weight of 1. */
  private absorbance(lines: Lines): number {
    const { opacity, varied } = lines.layer.through!;
    return varied ? -Math.log(1 - Math.min(opacity, MOST_OPAQUE)) / 255 : -Math.log(Math.max(1 - opacity, 1e-6));
  }

  /** What stands for a weight of 1 in the sums: half floats end at 65504. */
  private unit(lines: Lines): number {
    return this.bits === 32 ? 1 : lines.layer.through!.varied ? 2 ** -16 : 2 ** -8;
  }

  /** Textures of a layer's nearest lines; null where none are drawn. */
  of(lines: Lines): { texels: WebGLTexture; depths: WebGLTexture; nearest: WebGLFramebuffer } | null {
    return this.held.get(lines) ?? null;
  }

  /** Begin to mix. */
  start(): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffer);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 1]);
    gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE, gl.ZERO, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** Set the sums behind the nearest lines in a program, which has the nearest ones; `share`: of all lines, the added part. */
  show(program: Program, lines: Lines, share: number): void {
    const { sums, summed } = this.held.get(lines)!, unit = this.unit(lines);
    program.textures(Object.fromEntries([0, 1, 2, 3].map((k) => [`sums${k}`, summed ? sums[k] : null])));
    program.set({
      opacity: lines.layer.through!.opacity,
      absorbance: this.absorbance(lines) / unit / share,
      least: summed ? unit / 2 : Infinity,
    });
  }

  /** Blend the mixture over the opaque picture; a program that does so is in use. */
  finish(program: Program, into: WebGLFramebuffer): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, into);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(null);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    program.textures({ mixed: this.mixed, weights: this.weights });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
  }

  private drop(held: Held): void {
    const { gl } = this;
    for (const texture of [held.texels, held.depths, held.places, ...held.sums]) gl.deleteTexture(texture);
    for (const buffer of [held.nearest, held.behind]) gl.deleteFramebuffer(buffer);
  }

  /** Forget those layers that are no longer among these. */
  keep(shown: Lines[]): void {
    for (const [lines, held] of this.held) {
      if (shown.includes(lines)) continue;
      this.drop(held);
      this.held.delete(lines);
    }
  }

  release(): void {
    this.keep([]);
    for (const texture of [this.mixed, this.weights]) this.gl.deleteTexture(texture);
    this.gl.deleteFramebuffer(this.buffer);
  }
}
