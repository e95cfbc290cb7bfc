/** Surfaces with VTK's light, and slices of images. */

import { Mat, Vec, floats, inverse, linear, product } from "./camera";
import { fromBase64 } from "./engine";
import { GL, Program, lookUpTable } from "./gl";
import type { ImageLayer, SurfaceLayer } from "./scene";

export interface Drawn {
  view: Mat;
  projection: Mat;
  parallel: boolean;
  lights: (program: Program) => void;
  planes: number[][];
  ratio: number;        // pixels of the picture to one of the page
}

function planesOf(program: Program, planes: number[][], model: Mat): void {
  const local = planes
    .slice(0, 6)
    .map((p) =>
      [0, 1, 2, 3].map(
        (j) => p[0] * model[4 * j] + p[1] * model[4 * j + 1] + p[2] * model[4 * j + 2] + p[3] * model[4 * j + 3],
      ),
    );
  program.ints({ plane_count: local.length });
  local.forEach((plane, i) => program.set({ [`planes[${i}]`]: plane }));
}

export class Surface {
  private array: WebGLVertexArrayObject;
  private buffers: WebGLBuffer[] = [];
  private count: number;
  private table: WebGLTexture | null = null;
  private tableSize = 1;
  private tableRange = [0, 1, 1];
  readonly model: Mat;

  constructor(private gl: GL, readonly layer: SurfaceLayer, data: Uint8Array[]) {
    this.model = new Float64Array(layer.matrix ?? [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    this.array = gl.createVertexArray()!;
    gl.bindVertexArray(this.array);
    const attribute = (at: number, bytes: Uint8Array, components: number, type: number, normalised: boolean): void => {
      const buffer = gl.createBuffer()!;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, components, type, normalised, 0, 0);
      this.buffers.push(buffer);
    };
    attribute(0, data[layer.places], 3, gl.FLOAT, false);
    if (layer.normals !== undefined) attribute(1, data[layer.normals], 3, gl.FLOAT, false);
    if (layer.colours !== undefined) attribute(2, data[layer.colours], 4, gl.UNSIGNED_BYTE, true);
    if (layer.values !== undefined) {
      attribute(3, data[layer.values], 1, gl.FLOAT, false);
      [this.table, this.tableSize, this.tableRange] = lookUpTable(gl, fromBase64(layer.table!), layer.clim!, !!layer.log);
    }
    if (layer.edges) attribute(4, data[layer.edges.sides], 1, gl.UNSIGNED_BYTE, false);
    const index = gl.createBuffer()!;
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, index);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, data[layer.triangles], gl.STATIC_DRAW);
    this.buffers.push(index);
    this.count = data[layer.triangles].byteLength / 4;
    gl.bindVertexArray(null);
  }

  get translucent(): boolean {
    return this.layer.opacity < 1;
  }

  draw(program: Program, drawn: Drawn): void {
    const gl = this.gl, { layer } = this, view = product(drawn.view, this.model);
    const across = linear(view), back = inverse(view);
    const normals = back ? [back[0], back[4], back[8], back[1], back[5], back[9], back[2], back[6], back[10]] : across;
    program.use().set({
      clip_from_data: floats(product(drawn.projection, view)), view_from_data: floats(view), normal_to_view: normals,
      parallel: drawn.parallel ? 1 : 0, opacity: layer.opacity, reflects: layer.reflects, sheen: layer.sheen,
      edge_width: layer.edges ? layer.edges.width * drawn.ratio : 0, edge_colour: layer.edges?.colour ?? [0, 0, 0, 0],
    });
    program.ints({
      smooth_normals: layer.normals === undefined ? 0 : 1,
      lighting: layer.lighting ? 1 : 0,
      by_value: this.table ? 1 : 0,
      colour_entries: this.tableSize,
    });
    program.textures({ colour_table: this.table }).set({ colour_range: this.tableRange, colour_reference: 0 });
    drawn.lights(program);
    planesOf(program, [...(layer.planes ?? []), ...drawn.planes], this.model);
    gl.bindVertexArray(this.array);
    if (layer.normals === undefined) gl.vertexAttrib3f(1, 0, 0, 1);
    if (layer.colours === undefined) gl.vertexAttrib4f(2, layer.colour[0], layer.colour[1], layer.colour[2], 1);
    if (layer.culled) {
      gl.enable(gl.CULL_FACE);
      gl.cullFace(layer.culled.length > 1 ? gl.FRONT_AND_BACK : layer.culled[0] === "front" ? gl.FRONT : gl.BACK);
    }
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
    gl.disable(gl.CULL_FACE);
    gl.bindVertexArray(null);
  }

  release(): void {
    for (const buffer of this.buffers) this.gl.deleteBuffer(buffer);
    this.gl.deleteVertexArray(this.array);
    if (this.table) this.gl.deleteTexture(this.table);
  }

  /** Distance of its middle along the view, for the order of translucent ones. */
  depth(view: Mat): number {
    const b = this.layer.bounds, middle: Vec = [(b[0] + b[1]) / 2, (b[2] + b[3]) / 2, (b[4] + b[5]) / 2];
    return -(view[2] * middle[0] + view[6] * middle[1] + view[10] * middle[2] + view[14]);
  }
}

export class ImageSlice {
  private texture: WebGLTexture;

  constructor(private gl: GL, readonly layer: ImageLayer, data: Uint8Array[]) {
    const [width, height] = layer.size;
    this.texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, data[layer.pixels]);
    for (const name of ["TEXTURE_MIN_FILTER", "TEXTURE_MAG_FILTER"] as const)
      gl.texParameteri(gl.TEXTURE_2D, gl[name], layer.smooth ? gl.LINEAR : gl.NEAREST);
    for (const name of ["TEXTURE_WRAP_S", "TEXTURE_WRAP_T"] as const) gl.texParameteri(gl.TEXTURE_2D, gl[name], gl.CLAMP_TO_EDGE);
  }

  get translucent(): boolean {
    return this.layer.clear || this.layer.opacity < 1;
  }

  release(): void {
    this.gl.deleteTexture(this.texture);
  }

  draw(program: Program, drawn: Drawn): void {
    const { layer } = this;
    program
      .use()
      .set({
        clip_from_data: floats(product(drawn.projection, drawn.view)),
        corner: layer.corner,
        across: layer.across,
        up: layer.up,
        opacity: layer.opacity,
      });
    program.ints({ clear: layer.clear ? 1 : 0 }).textures({ pixels: this.texture });
    this.gl.bindVertexArray(null);
    this.gl.drawArrays(this.gl.TRIANGLE_STRIP, 0, 4);
  }
}
