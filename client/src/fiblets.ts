/**
 * A set of fiblets: compressed in textures, decoded on the graphics card block by block, drawn as instanced rectangles.
 *
 * Blocks are decoded once as long as memory for points suffices (`budget`), and else each time they are drawn.
 */

import type { Archive, NpyArray } from "./archive";
import { FileError } from "./archive";
import { Bounds, Mat, Vec, apply } from "./camera";
import { FarDepths, capsules, lookAt } from "./hiding";
import { Region, meets, within } from "./regions";
import { PAGE_BITS, field, rotationScales, rotations } from "./engine";
import { Format, GL, Program, UniformBlock, emptyRows, fillRows, rows } from "./gl";

const BLOCK = 1024, SLOT_BYTES = 16;
/** Items that are drawn with those on both sides of them, for a call less. */
const GAP = 16;
/** Share of a block's items that are drawn first where nothing is known of them. */
const FIRST = 0.1;
/** A texture that is filled as its array comes. */
interface Growing {
  texture: WebGLTexture;
  format: Format;
  data: Uint8Array | Uint16Array | Uint32Array;
}

/** Slots of a share; a set takes the number that leaves fewest of them empty. */
const SHARES = [4, 8, 11, 15];
const KIND_DIRECTION = 0, KIND_WIDE = 3, SPLINE = 5; // the last is the width of codes of splines, which are of kind 3

interface Parameters {
  origin: Vec;
  anchor_scale: Vec;
  anchor_bits: number;
  step: number;
  step_lo: number;
  step_hi: number;
  lattice: number;
  largest_radius: number;
}

export interface Block {
  firstItem: number;
  items: number;      // that are drawn; one more is decoded where the set goes on
  more: number;
  bounds: Bounds;     // data coordinates
  buffer: WebGLBuffer | null;
  used: number;
  shapes: Float32Array | null;  // of its items, for the occlusion test (hiding.ts)
  likely: Uint8Array | null;    // of each item, whether it is drawn before others, which it may hide
  likelies: number;             // how many are
}

/** Least and greatest value, and what the table's entries are less than the values. */
export interface ValueFacts {
  lo: number;
  hi: number;
  reference: number;
}

export interface PointValues {
  name: string;
  texture: WebGLTexture;
  table: WebGLTexture;         // what codes mean, less the reference
  range: [number, number];     // of the values
  reference: number;           // which shaders never see added
}

function words(array: NpyArray | undefined, name: string, columns: number, n: number): Uint32Array {
  if (!array || !(array.data instanceof Uint32Array) || array.data.length !== columns * n) {
    throw new FileError(`The file's ${name} do not fit its header. Copy or make it again.`);
  }
  return array.data;
}

/** An array as whole words of four bytes; bytes behind the end of the last one are never read. */
export function asWords(data: Uint8Array | Uint16Array): Uint32Array {
  const n = Math.ceil(data.byteLength / 4);
  if (data.byteOffset % 4 === 0 && data.byteOffset + 4 * n <= data.buffer.byteLength)
    return new Uint32Array(data.buffer as ArrayBuffer, data.byteOffset, n);
  const all = new Uint8Array(4 * n);
  all.set(new Uint8Array(data.buffer as ArrayBuffer, data.byteOffset, data.byteLength));
  return new Uint32Array(all.buffer);
}

/** An array of codes of 8 or 16 bits. */
export function asCodes(data: Uint8Array, bits: 8 | 16): Uint8Array | Uint16Array {
  return bits === 8 ? data : new Uint16Array(data.slice().buffer);
}

export class FibletSet {
  readonly blocks: Block[] = []; // that can be drawn
  readonly streamlines: number;
  readonly points: number;
  readonly bounds: Bounds;
  readonly reference: Vec; // anchor integers of local 0
  readonly toData: Mat; // local mm to data mm
  readonly coding: UniformBlock;
  budget = 256 << 20;

  private parameters: Parameters;
  private decodeProgram: Program | null = null;
  private rotationBlock: UniformBlock;
  private frameForDecoding: UniformBlock;
  private textures: Record<string, WebGLTexture> = {};
  private itemBuffer!: WebGLBuffer;
  private toItems!: Uint32Array;
  private feedback: WebGLTransformFeedback;
  private scratch: WebGLBuffer | null = null;
  private scratchBytes = 0;
  private share = 15;
  private itemBytes = 15 * SLOT_BYTES;
  private kinds = new Set<number>();
  private table: number[];
  private done = 0; // fiblets that have come
  private shares = 0; // of them
  private before = 0; // points of the streamline before the next fiblet
  private open: Block | null = null; // that waits for the fiblet after it
  private growing: Record<string, Growing> = {};
  private values: Growing[] = [];
  private held = 0;
  private clock = 0;
  private fiblets: number;
  private decodeArray: WebGLVertexArrayObject;

  constructor(
    private gl: GL,
    private archive: Archive,
  ) {
    const { header, arrays } = archive;
    if (header.format !== "fiblets")
      throw new FileError("The file is no .fiblets file: its header says something else.");
    if (![2, 4, 5].includes(header.version))
      throw new FileError(
        `The file is of version ${header.version}; this page reads versions 2, 4 and 5. Make the page again with a newer pvfiblets.`,
      );
    const p = (this.parameters = header.parameters),
      n = (this.fiblets = header.n_fiblets);
    this.streamlines = header.n_streamlines;
    this.points = header.n_points;
    this.bounds = header.bounds;
    const anchors = words(arrays.get("anchors.npy"), "anchors", 2, n),
      decoding = words(arrays.get("decoding.npy"), "records", 3, n);
    const codes = arrays.get("codes.npy"),
      pages = arrays.get("pages.npy");
    if (!codes || !(codes.data instanceof Uint8Array) || !pages || !(pages.data instanceof BigInt64Array))
      throw new FileError("The file's codes or pages are missing. Copy or make it again.");
    const table = (this.table = Array.from(pages.data, Number)),
      pageCount = Math.ceil(n / (1 << PAGE_BITS));
    if (
      table.length !== 3 * (pageCount + 1) ||
      table[3 * pageCount + 1] !== codes.data.length ||
      table[3 * pageCount + 2] !== this.points
    ) {
      throw new FileError("The file's table of pages does not fit its records. Copy or make it again.");
    }
    const low = p.anchor_bits === 32 ? arrays.get("anchors_low.npy") : undefined;
    if (p.anchor_bits === 32 && !(low?.data instanceof Uint16Array && low.data.length === 3 * n))
      throw new FileError("The lower halves of the file's anchors are missing. Copy or make it again.");
    const top = p.anchor_bits === 32 ? 4294967295 : 65535;
    this.reference = [0, 1, 2].map((axis) => {
      const middle = (this.bounds[2 * axis] + this.bounds[2 * axis + 1]) / 2,
        scale = p.anchor_scale[axis];
      return scale > 0 && Number.isFinite(middle)
        ? Math.round(Math.min(Math.max((middle - p.origin[axis]) / scale, 0), top))
        : 0;
    }) as Vec;
    this.toData = new Float64Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    for (let axis = 0; axis < 3; ++axis)
      this.toData[12 + axis] = p.origin[axis] + p.anchor_scale[axis] * this.reference[axis];

    this.grow("anchor_texels", "rg32ui", anchors, "anchors");
    this.grow("decoding_texels", "r32ui", decoding, "records");
    this.grow("code_texels", "r32ui", asWords(codes.data), "codes");
    if (low) this.grow("anchor_low_texels", "r32ui", asWords(low.data as Uint16Array), "anchors");
    const starts = new Uint32Array(4 * Math.max(pageCount, 1));
    for (let i = 0; i < pageCount; ++i) for (let j = 0; j < 3; ++j) starts[4 * i + j] = table[3 * i + j];
    this.textures.page_texels = rows(gl, "rgba32ui", starts, "pages");
    this.coding = new UniformBlock(gl, "Coding");
    this.coding.write({
      anchor_scale: p.anchor_scale,
      radius_scale: 0,
      step_low: p.step_lo,
      step_span: p.step_hi - p.step_lo,
      lattice_edge: p.lattice,
      end_vector_scale: 0,
      rotation_scales: rotationScales,
    });
    this.rotationBlock = new UniformBlock(gl, "Rotations");
    this.rotationBlock.fill(rotations);
    this.frameForDecoding = new UniformBlock(gl, "Frame");
    this.frameForDecoding.write({ reference: this.reference }, ["reference"]);
    this.feedback = gl.createTransformFeedback()!;
    this.decodeArray = gl.createVertexArray()!;
    gl.bindVertexArray(this.decodeArray);
    gl.enableVertexAttribArray(0);
    gl.bindVertexArray(null);
  }

  private grow(name: string, format: Format, data: Uint32Array, what: string): void {
    const texture = (this.textures[name] = emptyRows(
      this.gl,
      format,
      format === "rg32ui" ? data.length / 2 : data.length,
      what,
    ));
    this.growing[name] = { texture, format, data };
  }

  private fill(name: string, from: number, to: number): void {
    const found = this.growing[name];
    if (found) fillRows(this.gl, found.texture, found.format, found.data, from, to);
  }

  /** How many shares a fiblet has. */
  private sharesOf(f: number, share = this.share): number {
    const points = field("last", this.growing.decoding_texels.data[3 * f + 2]) + 1,
      end = this.growing.anchor_texels.data[2 * f + 1] >>> 31;
    return points % share === 0 && !end ? points / share : Math.ceil((points + (end ? 1 : 2)) / share);
  }

  /** Choose the size of shares by the first fiblets, and make room for all. */
  private begin(first: number): void {
    const gl = this.gl,
      counts = SHARES.map((share) => {
        // A slot costs its drawing; an item its walk from the fiblet's anchor, on average half of it.
        let cost = 0,
          total = 0;
        for (let f = 0; f < first; ++f) {
          const k = this.sharesOf(f, share);
          cost += k * share * (1 + 0.05 * k);
          total += k;
        }
        return { share, cost, total };
      });
    const best = counts.reduce((a, b) => (b.cost < a.cost ? b : a)),
      left = this.fiblets - first;
    this.share = best.share;
    this.itemBytes = this.share * SLOT_BYTES;
    let points = this.points;
    for (let f = 0; f < first; ++f) points -= field("last", this.growing.decoding_texels.data[3 * f + 2]) + 1;
    const most = Math.max(best.total + Math.floor((Math.max(points, 0) + (this.share + 1) * left) / this.share), 1);
    this.toItems = new Uint32Array(4 * most);
    this.textures.items = emptyRows(gl, "rgba32ui", most, "shares of fiblets");
    this.itemBuffer = gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.itemBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, 8 * most, gl.STATIC_DRAW);
  }

  /** Take in the fiblets that have come: `upto` in all, whole pages or everything. */
  advance(upto: number): void {
    const gl = this.gl,
      from = this.done,
      n = Math.min(upto, this.fiblets),
      p = this.parameters,
      { table } = this;
    if (n <= from && this.fiblets) return;
    if (!from) this.begin(n);
    const ids = this.archive.arrays.get("rank_to_id.npy")?.data as BigInt64Array | undefined,
      low = this.archive.arrays.get("anchors_low.npy")?.data as Uint16Array | undefined;
    const anchors = this.growing.anchor_texels.data,
      decoding = this.growing.decoding_texels.data,
      items = this.toItems;
    const codeBytes = table[table.length - 2],
      firstItem = this.shares,
      margin = 2 * p.largest_radius,
      kinds = this.kinds.size;
    let item = firstItem,
      block = this.open,
      more = 0;
    for (let f = from; f < n; ++f) more += this.sharesOf(f);
    const pairs = new Uint32Array(2 * more);
    const close = (): void => {
      if (!block) return;
      block.more = 1;
      this.blocks.push(block);
    };
    for (let f = from; f < n; ++f) {
      const page = 3 * (f >> PAGE_BITS),
        word = anchors[2 * f + 1],
        record = decoding[3 * f + 2];
      const rank = field("rank", word) + table[page],
        points = field("last", record) + 1;
      const id = ids ? Number(ids[rank]) : rank,
        begin = field("begin", word),
        end = field("end", word);
      const code = field("code", decoding[3 * f + 1]) + table[page + 1],
        point = field("point", record) + table[page + 2];
      const shares = this.sharesOf(f);
      if (
        points > 60 ||
        4 * (item + shares) > items.length ||
        !(id >= 0 && id < this.streamlines) ||
        code > codeBytes ||
        point + points > this.points
      ) {
        throw new FileError(`Record ${f} of the file is damaged. Copy or make it again.`);
      }
      const kind = field("kind", record),
        spline = kind === KIND_WIDE && (field("step", decoding[3 * f + 1]) & 7) === SPLINE;
      this.kinds.add(spline ? SPLINE : kind);
      if (f % BLOCK === 0) {
        close();
        block = {
          firstItem: item,
          items: 0,
          more: 0,
          bounds: [Infinity, -Infinity, Infinity, -Infinity, Infinity, -Infinity],
          buffer: null,
          used: 0,
          shapes: null,
          likely: null,
          likelies: 0,
        };
      }
      const grid = [anchors[2 * f] & 0xffff, anchors[2 * f] >>> 16, word & 0xffff];
      for (let axis = 0; axis < 3; ++axis) {
        const at = p.origin[axis] + p.anchor_scale[axis] * (low ? grid[axis] * 65536 + low[3 * f + axis] : grid[axis]);
        block!.bounds[2 * axis] = Math.min(block!.bounds[2 * axis], at - margin);
        block!.bounds[2 * axis + 1] = Math.max(block!.bounds[2 * axis + 1], at + margin);
      }
      if (begin) this.before = 0;
      for (let share = 0; share < shares; ++share, ++item) {
        items[4 * item] = id;
        items[4 * item + 1] = point;
        items[4 * item + 2] = points | (begin << 6) | (end << 7) | (share << 8);
        items[4 * item + 3] = this.before;
        pairs[2 * (item - firstItem)] = f;
        pairs[2 * (item - firstItem) + 1] = share;
      }
      this.before += points;
      block!.items += shares;
    }
    this.open = block;
    if (n === this.fiblets && block) this.blocks.push(block);
    this.shares = item;
    this.done = n;
    if (this.kinds.size > kinds) this.decodeProgram = null;
    fillRows(gl, this.textures.items, "rgba32ui", items, firstItem, item);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.itemBuffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 8 * firstItem, pairs);
    this.fill("anchor_texels", from, n);
    this.fill("decoding_texels", 3 * from, 3 * n);
    this.fill("anchor_low_texels", Math.floor(1.5 * from), Math.ceil(1.5 * n));
    this.fill("code_texels", this.countBefore(from, 1) >> 2, (this.countBefore(n, 1) + 3) >> 2);
    for (const { texture, format, data } of this.values)
      fillRows(gl, texture, format, data, this.countBefore(from, 2), this.countBefore(n, 2));
  }

  /** What a column of the table of pages counts before a fiblet, of whole pages or of all. */
  private countBefore(f: number, column: number): number {
    return this.table[3 * Math.ceil(f / (1 << PAGE_BITS)) + column];
  }

  /** A stored array of a value for each point. */
  pointValues(name: string): PointValues {
    const said = this.archive.header.per_point?.[name],
      array = said && this.archive.arrays.get(said.member);
    if (!array || array.data.length !== this.points)
      throw new FileError(`The file has no values ${name} for its points.`);
    const table = this.archive.arrays.get(said.table);
    if (!(table?.data instanceof Float32Array))
      throw new FileError(`The file does not say what the codes of ${name} mean. Make the page again.`);
    return this.codedValues(name, array.data as Uint8Array | Uint16Array, table.data, said);
  }

  /** Values for each point of the set, by their codes, what these mean, and what the least and the greatest one is. */
  codedValues(
    name: string,
    data: Uint8Array | Uint16Array,
    table: Float32Array,
    { lo, hi, reference }: ValueFacts,
  ): PointValues {
    if (data.length !== this.points) throw new FileError(`The file has ${this.points} points, but ${data.length} values ${name}.`);
    const wide = data instanceof Uint16Array,
      format = wide ? "r16ui" : "r8ui";
    const texture = emptyRows(this.gl, format, this.points, "values of points");
    this.values.push({ texture, format, data });
    fillRows(this.gl, texture, format, data, 0, this.countBefore(this.done, 2));
    const full = new Float32Array(wide ? 65536 : 256).fill(NaN); // a file has only the used ones
    full.set(table.subarray(0, full.length));
    const meant = new Uint32Array(full.buffer);
    return { name, texture, table: rows(this.gl, "r32ui", meant, "values of codes"), range: [lo, hi], reference };
  }

  forget({ texture, table }: PointValues): void {
    this.values = this.values.filter((one) => one.texture !== texture);
    this.gl.deleteTexture(texture);
    this.gl.deleteTexture(table);
  }

  private decoder(): Program {
    const features = ["DIRECTION"];
    if (this.textures.anchor_low_texels) features.push("ANCHORS_LOW");
    if ([...this.kinds].some((kind) => kind !== KIND_DIRECTION && kind !== SPLINE)) features.push("LATTICE");
    if (this.kinds.has(KIND_WIDE)) features.push("WIDE_LATTICE");
    if (this.kinds.has(SPLINE)) features.push("SPLINE");
    return (this.decodeProgram ??= new Program(
      this.gl,
      "page/decode.vert",
      "page/none.frag",
      features,
      Array.from({ length: this.share }, (_, i) => `o${i}`),
    ));
  }

  /** Decode a block into a buffer. */
  private decode(block: Block, buffer: WebGLBuffer): void {
    const gl = this.gl,
      n = block.items + block.more;
    this.coding.bind();
    this.rotationBlock.bind();
    this.frameForDecoding.bind();
    const { items: _, ...textures } = this.textures;
    this.decoder().use().textures(textures).uints({ chunk_fiblets: this.fiblets, share_size: this.share });
    gl.bindVertexArray(this.decodeArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.itemBuffer);
    gl.vertexAttribIPointer(0, 2, gl.UNSIGNED_INT, 8, 8 * block.firstItem);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    gl.enable(gl.RASTERIZER_DISCARD);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, this.feedback);
    gl.bindBufferRange(gl.TRANSFORM_FEEDBACK_BUFFER, 0, buffer, 0, n * this.itemBytes);
    gl.beginTransformFeedback(gl.POINTS);
    gl.drawArrays(gl.POINTS, 0, n);
    gl.endTransformFeedback();
    gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, null);
    gl.bindTransformFeedback(gl.TRANSFORM_FEEDBACK, null);
    gl.disable(gl.RASTERIZER_DISCARD);
    gl.bindVertexArray(null);
  }

  private size(block: Block): number {
    return (block.items + block.more) * this.itemBytes + 2 * SLOT_BYTES;
  }

  private newBuffer(bytes: number): WebGLBuffer {
    const gl = this.gl,
      buffer = gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, bytes, gl.DYNAMIC_COPY);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    return buffer;
  }

  /** The points of a block, decoded at the latest now. */
  pointsOf(block: Block): WebGLBuffer {
    block.used = ++this.clock;
    if (block.buffer) return block.buffer;
    const bytes = this.size(block);
    if (this.held + bytes <= this.budget) {
      this.held += bytes;
      block.buffer = this.newBuffer(bytes);
      this.decode(block, block.buffer);
      return block.buffer;
    }
    if (this.scratchBytes < bytes) {
      if (this.scratch) this.gl.deleteBuffer(this.scratch);
      this.scratch = this.newBuffer((this.scratchBytes = bytes));
    }
    this.decode(block, this.scratch!);
    return this.scratch!;
  }

  get items(): WebGLTexture {
    return this.textures.items;
  }

  /** How many segments at most some items have. */
  segments(items: number): number {
    return items * this.share;
  }

  /** The longest segment that there is, mm; infinite where only the codes tell. */
  get longestStep(): number {
    return this.kinds.size === 1 && this.kinds.has(KIND_DIRECTION) ? 2 * this.parameters.step_hi : Infinity;
  }

  /** Draw a block's items from its first on; the program is in use, all else is bound. */
  draw(block: Block, program: Program, items: number, sprites: boolean): number {
    return this.drawRun(block, program, 0, Math.max(1, Math.round(items)), sprites);
  }

  private drawRun(block: Block, program: Program, from: number, to: number, sprites: boolean): number {
    const gl = this.gl,
      n = (to - from) * this.share;
    this.aim(block, program, from, sprites);
    if (sprites) gl.drawArrays(gl.POINTS, 0, n);
    else gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, n);
    gl.bindVertexArray(null);
    return n;
  }

  private aim(block: Block, program: Program, from: number, sprites: boolean): void {
    const gl = this.gl,
      buffer = this.pointsOf(block);
    program.use().ints({ first_item: block.firstItem + from, share_size: this.share });
    gl.bindVertexArray(this.segmentArray(sprites));
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    for (let i = 0; i < 3; ++i)
      gl.vertexAttribIPointer(i, 4, gl.UNSIGNED_INT, SLOT_BYTES, from * this.itemBytes + i * SLOT_BYTES);
  }

  /** A block's items that are drawn before others: the last visible ones; of a new block a share. */
  likely(block: Block): Uint8Array {
    if (!block.likely)
      block.likely = new Uint8Array(block.items).fill(
        1,
        0,
        (block.likelies = Math.max(1, Math.round(FIRST * block.items))),
      );
    return block.likely;
  }

  /** Find which of a block's items may show, and return the ones that were not `likely`; all of them are from now on. */
  look(block: Block, window: Mat, brush: number, width: number, height: number, far: FarDepths): Uint8Array {
    const shows = new Uint8Array(block.items),
      before = this.likely(block),
      more = new Uint8Array(block.items);
    lookAt((block.shapes ??= this.shapesOf(block)), window, brush, width, height, far, shows);
    block.likelies = 0;
    for (let i = 0; i < more.length; ++i) {
      more[i] = shows[i] & ~before[i];
      block.likelies += shows[i];
    }
    block.likely = shows;
    return more;
  }

  private shapesOf(block: Block): Float32Array {
    const a = this.toItems,
      { share } = this;
    return capsules(this.slotsOf(block), block.items, share, (i) => {
      const word = a[4 * (block.firstItem + i) + 2],
        end = (word >>> 7) & 1,
        points = word & 63;
      return Math.min(points + 1 - end - share * (word >>> 8), share + 1);
    });
  }

  private slotsOf(block: Block): Float32Array {
    const gl = this.gl,
      slots = new Float32Array((block.items + block.more + 1) * this.share * 4);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.pointsOf(block));
    gl.getBufferSubData(gl.ARRAY_BUFFER, 0, slots, 0, (block.items + block.more) * this.share * 4);
    gl.bindBuffer(gl.ARRAY_BUFFER, null);
    return slots;
  }

  private indices: WebGLBuffer | null = null;

  /** Draw the chosen items of a block, `most` at most. */
  drawSome(block: Block, program: Program, chosen: Uint8Array, sprites: boolean, most = Infinity): number {
    const gl = this.gl,
      { share } = this;
    let n = 0;
    if (!sprites) {
      let drawn = 0,
        found = 0;
      for (let from = 0; from < chosen.length && found < most; ++from) {
        if (!chosen[from]) continue;
        let to = from + 1;
        ++found;
        for (let i = to; i < Math.min(chosen.length, to + GAP) && found < most; ++i) {
          if (!chosen[i]) continue;
          to = i + 1;
          ++found;
        }
        drawn += this.drawRun(block, program, from, to, sprites);
        from = to;
      }
      return drawn;
    }
    const left = Math.min(most, chosen.length),
      slots = new Uint32Array(left * share);
    for (let i = 0, found = 0; i < chosen.length && found < left; ++i) {
      if (!chosen[i]) continue;
      const word = this.toItems[4 * (block.firstItem + i) + 2],
        points = word & 63,
        segments = points - ((word & 128) !== 0 && points > 1 ? 1 : 0);
      for (let k = i * share, end = k + Math.min(segments - share * (word >>> 8), share); k < end; ++k) slots[n++] = k;
      ++found;
    }
    if (!n) return 0;
    this.aim(block, program, 0, sprites);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, (this.indices ??= gl.createBuffer()!));
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, slots.subarray(0, n), gl.STREAM_DRAW);
    gl.drawElements(gl.POINTS, n, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
    return n;
  }

  private arrays: (WebGLVertexArrayObject | null)[] = [null, null];

  private segmentArray(sprites: boolean): WebGLVertexArrayObject {
    const which = sprites ? 1 : 0;
    if (!this.arrays[which]) {
      const gl = this.gl;
      gl.bindVertexArray((this.arrays[which] = gl.createVertexArray()!));
      for (let i = 0; i < 3; ++i) {
        gl.enableVertexAttribArray(i);
        gl.vertexAttribDivisor(i, sprites ? 0 : 1);
      }
    }
    return this.arrays[which]!;
  }

  /** Go through decoded fiblets, from the graphics card: a streamline, and its points in local mm, and a word, four numbers each. */
  private *decoded(wanted: (block: Block) => boolean, from = 0): Generator<[number, Float32Array, boolean]> {
    const a = this.toItems;
    for (const block of this.blocks.slice(from)) {
      if (!wanted(block)) continue;
      const slots = this.slotsOf(block);
      for (let item = block.firstItem; item < block.firstItem + block.items; ++item) {
        if (a[4 * item + 2] >>> 8) continue;
        const points = a[4 * item + 2] & 63,
          end = (a[4 * item + 2] & 128) !== 0,
          at = 4 * this.share * (item - block.firstItem);
        yield [a[4 * item], slots.subarray(at, at + 4 * (points + (end ? 0 : 1))), (a[4 * item + 2] & 64) !== 0];
      }
    }
  }

  private blocksOf(streamline: number): (block: Block) => boolean {
    const a = this.toItems;
    return (block) => {
      for (let item = block.firstItem; item < block.firstItem + block.items; ++item)
        if (a[4 * item] === streamline) return true;
      return false;
    };
  }

  private world(local: Float32Array, i: number): Vec {
    return [0, 1, 2].map((axis) => this.toData[12 + axis] + local[4 * i + axis]) as Vec;
  }

  /** The points of a streamline in data coordinates. */
  pointsOfStreamline(streamline: number): Vec[] {
    const found: Vec[] = [];
    for (const [id, points] of this.decoded(this.blocksOf(streamline))) {
      if (id === streamline) for (let i = 0; 4 * i < points.length; ++i) found.push(this.world(points, i));
    }
    return found;
  }

  /**
   * Of each streamline 1 where some segment of it, moved by `model`, meets a region, else 0; of the blocks from `from`
   * on, added to `kept`.
   */
  through(region: Region, model: Mat, from = 0, kept: Uint8Array = new Uint8Array(this.streamlines)): Uint8Array {
    const { at, size } = region;
    const near = ({ bounds: b }: Block): boolean => {
      const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) =>
        apply(model, [b[i & 1], b[2 + ((i >> 1) & 1)], b[4 + (i >> 2)]]),
      );
      return [0, 1, 2].every(
        (axis) =>
          corners.some((c) => c[axis] >= at[axis] - size[axis]) &&
          corners.some((c) => c[axis] <= at[axis] + size[axis]),
      );
    };
    for (const [id, p] of this.decoded(near, from)) {
      if (kept[id]) continue;
      let from = within(region, apply(model, this.world(p, 0)));
      for (let i = 0; i < p.length && !kept[id]; i += 4) {
        const to = within(region, apply(model, this.world(p, Math.min(i + 4, p.length - 4) / 4)));
        if (meets(region, from, to)) kept[id] = 1;
        from = to;
      }
    }
    return kept;
  }

  release(): void {
    const gl = this.gl;
    for (const block of this.blocks) if (block.buffer) gl.deleteBuffer(block.buffer);
    for (const texture of Object.values(this.textures)) gl.deleteTexture(texture);
    for (const buffer of [this.scratch, this.indices, this.itemBuffer]) if (buffer) gl.deleteBuffer(buffer);
  }
}
