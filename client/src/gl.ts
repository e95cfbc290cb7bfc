/** WebGL 2: programs with the engine's switches, textures in rows, uniform blocks. */

import { blocks, shaders } from "./engine";

export type GL = WebGL2RenderingContext;

/** Texels in a row of a long array's texture: WebGL 2 promises half of them, and some browsers give no more, to be all alike. */
export const rowOf = (gl: GL): number => Math.min(4096, gl.getParameter(gl.MAX_TEXTURE_SIZE));

/** A word that names no streamline. */
export const ALL_ONES = 0xffffffff;

export class GraphicsError extends Error {}

/** A stage with some of its switches on, for rows as long as textures hold. */
function stage(gl: GL, name: string, features: readonly string[]): string {
  const row = Math.log2(rowOf(gl)), named = shaders[name].replace("ROW_BITS=12", `ROW_BITS=${row}`);
  const text = features.includes("SPRITES") ? named.replace("const bool SPRITES=false", "const bool SPRITES=true") : named;
  const region = features.find((one) => one.startsWith("REGION "));
  return (region ? text.replace(/#define REGION .*/, `#define ${region}`) : text).replace(
    /#define FEATURE_(\w+) [01]/g,
    (_, feature) => `#define FEATURE_${feature} ${features.includes(feature) ? 1 : 0}`,
  );
}

export class Program {
  readonly handle: WebGLProgram;
  private places = new Map<string, WebGLUniformLocation | null>();
  private units = new Map<string, number>();

  constructor(private gl: GL, vertex: string, fragment: string, features: readonly string[] = [], outputs: string[] = []) {
    this.handle = gl.createProgram()!;
    const made = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].map(([kind, name]) => {
      const shader = gl.createShader(kind as number)!;
      gl.shaderSource(shader, stage(gl, name as string, features));
      gl.compileShader(shader);
      gl.attachShader(this.handle, shader);
      return [name as string, shader] as const;
    });
    if (outputs.length) gl.transformFeedbackVaryings(this.handle, outputs, gl.INTERLEAVED_ATTRIBS);
    gl.linkProgram(this.handle);
    if (!gl.getProgramParameter(this.handle, gl.LINK_STATUS) && !gl.isContextLost()) {
      const said = made.map(([name, shader]) => `${name}: ${gl.getShaderInfoLog(shader)}`).join("; ");
      throw new GraphicsError(`This browser's graphics cannot run the page's programs: ${gl.getProgramInfoLog(this.handle)} ${said}`);
    }
    Object.keys(blocks).forEach((block, binding) => {
      const index = gl.getUniformBlockIndex(this.handle, block);
      if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(this.handle, index, binding);
    });
  }

  use(): this {
    this.gl.useProgram(this.handle);
    return this;
  }

  at(name: string): WebGLUniformLocation | null {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.handle, name));
    return this.places.get(name)!;
  }

  /** Set uniforms by the number of their components; the program is in use. */
  set(values: Record<string, number | readonly number[] | Float32Array>): this {
    const gl = this.gl;
    for (const [name, value] of Object.entries(values)) {
      const at = this.at(name);
      if (at === null) continue;
      if (typeof value === "number") gl.uniform1f(at, value);
      else if (value.length === 2) gl.uniform2fv(at, value);
      else if (value.length === 3) gl.uniform3fv(at, value);
      else if (value.length === 4) gl.uniform4fv(at, value);
      else if (value.length === 9) gl.uniformMatrix3fv(at, false, value);
      else gl.uniformMatrix4fv(at, false, value);
    }
    return this;
  }

  ints(values: Record<string, number>): this {
    for (const [name, value] of Object.entries(values)) {
      const at = this.at(name);
      if (at !== null) this.gl.uniform1i(at, value);
    }
    return this;
  }

  uints(values: Record<string, number>): this {
    for (const [name, value] of Object.entries(values)) {
      const at = this.at(name);
      if (at !== null) this.gl.uniform1ui(at, value);
    }
    return this;
  }

  textures(values: Record<string, WebGLTexture | null>): this {
    const gl = this.gl;
    for (const [name, texture] of Object.entries(values)) {
      const at = this.at(name);
      if (at === null) continue;
      if (!this.units.has(name)) this.units.set(name, this.units.size);
      const unit = this.units.get(name)!;
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(at, unit);
    }
    return this;
  }
}

/** The formats of textures of words: internal format, format, type, components and the array's type. */
const FORMATS = {
  r8ui: ["R8UI", "RED_INTEGER", "UNSIGNED_BYTE", 1, Uint8Array],
  r16ui: ["R16UI", "RED_INTEGER", "UNSIGNED_SHORT", 1, Uint16Array],
  r32ui: ["R32UI", "RED_INTEGER", "UNSIGNED_INT", 1, Uint32Array],
  rg32ui: ["RG32UI", "RG_INTEGER", "UNSIGNED_INT", 2, Uint32Array],
  rgba32ui: ["RGBA32UI", "RGBA_INTEGER", "UNSIGNED_INT", 4, Uint32Array],
  rgba8: ["RGBA8", "RGBA", "UNSIGNED_BYTE", 4, Uint8Array],
} as const;

export type Format = keyof typeof FORMATS;

function plain(gl: GL): void {
  for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"] as const) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.NEAREST);
  for (const name of ["TEXTURE_WRAP_S", "TEXTURE_WRAP_T"] as const) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.CLAMP_TO_EDGE);
}

/** Place for a long array, as rows of texels. */
export function emptyRows(gl: GL, format: Format, texels: number, what: string): WebGLTexture {
  const [internal] = FORMATS[format],
    row = rowOf(gl),
    height = Math.max(1, Math.ceil(texels / row)),
    most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
  if (height > most)
    throw new GraphicsError(
      `The ${what} have ${texels} texels; this device's textures hold ${most * row}. Make a page of fewer streamlines.`,
    );
  const texture = gl.createTexture()!;
  gl.bindTexture(gl.TEXTURE_2D, texture);
  plain(gl);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl[internal], row, height);
  return texture;
}

/** Put texels of an array into such rows, and what else is in them. What does not fill the last row is copied; the rest is not. */
export function fillRows(
  gl: GL,
  texture: WebGLTexture,
  format: Format,
  data: Uint8Array | Uint16Array | Uint32Array,
  from: number,
  to: number,
): void {
  const [, layout, type, components, Kind] = FORMATS[format],
    width = rowOf(gl),
    step = width * components;
  const whole = Math.floor(data.length / step),
    last = Math.ceil(to / width);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  for (let row = Math.floor(from / width); row < Math.min(whole, last); row += 256) {
    const n = Math.min(256, whole - row, last - row);
    gl.texSubImage2D(
      gl.TEXTURE_2D,
      0,
      0,
      row,
      width,
      n,
      gl[layout],
      gl[type],
      data.subarray(row * step, (row + n) * step),
    );
  }
  if (last > whole) {
    const rest = new Kind(step);
    rest.set(data.subarray(whole * step));
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, whole, width, 1, gl[layout], gl[type], rest);
  }
}

/** A long array as rows of texels. */
export function rows(gl: GL, format: Format, data: Uint8Array | Uint16Array | Uint32Array, what: string): WebGLTexture {
  const texels = Math.ceil(data.length / FORMATS[format][3]), texture = emptyRows(gl, format, texels, what);
  fillRows(gl, texture, format, data, 0, texels);
  return texture;
}

/** A look-up table as shaders/colour/table.glsl has it: its texture, entries and range. */
export function lookUpTable(gl: GL, table: Uint8Array, clim: readonly number[], log: boolean): [WebGLTexture, number, number[]] {
  const n = table.length / 4 - 3, [low, high] = log ? clim.map((end) => Math.log10(end)) : clim;
  return [rows(gl, "rgba8", table, "colours"), n, [low, high, n / Math.max(high - low, 1e-30)]];
}

/** A texture that is drawn into. */
export function target(gl: GL, internal: number, width: number, height: number): WebGLTexture {
  const texture = gl.createTexture()!;
  gl.bindTexture(gl.TEXTURE_2D, texture);
  plain(gl);
  gl.texStorage2D(gl.TEXTURE_2D, 1, internal, width, height);
  return texture;
}

export function framebuffer(gl: GL, colour: WebGLTexture, depth: WebGLTexture | null): WebGLFramebuffer {
  const made = gl.createFramebuffer()!;
  gl.bindFramebuffer(gl.FRAMEBUFFER, made);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
  if (depth) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
  return made;
}

/** A uniform block by the names of its fields, with a buffer of its own. */
export class UniformBlock {
  private bytes: ArrayBuffer;
  private floats: Float32Array;
  private words: Uint32Array;
  private buffer: WebGLBuffer;
  private binding: number;

  constructor(private gl: GL, private name: string) {
    this.bytes = new ArrayBuffer(blocks[name].bytes);
    this.floats = new Float32Array(this.bytes);
    this.words = new Uint32Array(this.bytes);
    this.buffer = gl.createBuffer()!;
    this.binding = Object.keys(blocks).indexOf(name);
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.buffer);
    gl.bufferData(gl.UNIFORM_BUFFER, this.bytes.byteLength, gl.DYNAMIC_DRAW);
  }

  write(values: Record<string, number | readonly number[] | Float64Array>, whole: string[] = []): void {
    for (const [name, value] of Object.entries(values)) {
      const at = blocks[this.name].fields[name] / 4, into = whole.includes(name) ? this.words : this.floats;
      if (typeof value === "number") into[at] = value;
      else into.set(value, at);
    }
    this.upload();
  }

  fill(bytes: Uint8Array): void {
    new Uint8Array(this.bytes).set(bytes);
    this.upload();
  }

  private upload(): void {
    this.gl.bindBuffer(this.gl.UNIFORM_BUFFER, this.buffer);
    this.gl.bufferSubData(this.gl.UNIFORM_BUFFER, 0, new Uint8Array(this.bytes));
  }

  bind(): void {
    this.gl.bindBufferBase(this.gl.UNIFORM_BUFFER, this.binding, this.buffer);
  }
}
