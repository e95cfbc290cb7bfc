/**
 * A picture of the scene, made as the engine makes it: the nearest line of each pixel, then colours and light, then smooth edges.
 *
 * A picture is drawn in slices, each so long that the page stays responsive. While something moves one slice must do: it draws a
 * share of every block. At rest slices follow each other until all is drawn.
 */

import type { Archive } from "./archive";
import { Bounds, Camera, Mat, Vec, apply, identity, inverse, linear, product } from "./camera";
import { Cut, expression, raysOf } from "./cuts";
import type { Block, FibletSet } from "./fiblets";
import { ALL_ONES, GL, GraphicsError, Program, UniformBlock, framebuffer, target } from "./gl";
import type { FarDepths } from "./hiding";
import { Lines } from "./lines";
import type { Scene } from "./scene";
import { Drawn, ImageSlice, Surface } from "./surfaces";
import { Translucent, floatBits } from "./translucent";

const SLICE = 60;      // ms of drawing between looks at the user's hands
const MOVING = 45;     // ms of a picture while something moves
const REFRESH = 400;   // ms between pictures while slices come in, or
const LATER = 0.5;     // of the time that they have taken until then
const TILE = 16;       // pixels; shaders/page/tile_size.glsl
const FAR_TILE = 4;    // pixels; shaders/page/far_tile_size.glsl
const LONGEST_SPRITE = 40; // pixels; squares of more are not drawn by every device
const FARTHEST = 0x3f800000;  // 1.0
const OBLIQUE: Vec = [1, -0.8, -0.45]; // from the left, front and above: DIRECTIONS of pvfiblets/plotting/viewpoints.py
const LIGHTS = { none: 0, line: 1, illuminated: 2 };

/**
 * Whether words that were read of a texture with one component are as WebGL would have the other three. Browsers that do not
 * want users to be recognised by how their devices draw give noise instead, until a user allows more.
 */
const asDrawn = ([, g, b, a]: Uint32Array): boolean => g === 0 && b === 0 && a === 1;

/** A block to be drawn: all of it, its items that are likely to be seen, those others that these leave in sight, or all behind these. */
interface Job {
  lines: Lines;
  block: Block;
  what: "all" | "likely" | "others" | "behind";
}

interface Frame {
  jobs: Job[];
  next: number;
  share: number;
  drawn: number;
  begun: number;
  shownAt: number;
  matrices: Drawn;
  moving: boolean;
  through: Set<Lines>;   // whose nearest lines have begun
}

export class Renderer {
  readonly camera: Camera;
  readonly lines: Lines[] = [];
  readonly surfaces: Surface[] = [];
  readonly images: ImageSlice[] = [];
  planes: number[][] = [];               // of the reader's own, in world coordinates
  width = 0;
  height = 0;
  ratio = 1;
  frames = 0;                            // finished pictures
  few = 2e5;                             // segments, up to which all are drawn without a look at what hides them
  loading = false;                       // whether streamlines have yet to come
  failed: ((error: Error) => void) | null = null;
  drawnOnce: (() => void) | null = null;
  presented: (() => void) | null = null;
  grown: (() => void) | null = null;     // more streamlines are there
  finished: (() => void) | null = null;  // a picture at rest
  lacking: ((why: string) => void) | null = null;  // lines are drawn opaque that are translucent

  private gl: GL;
  private programs = new Map<string, Program>();
  private frameBlock!: UniformBlock;
  private clipBlock!: UniformBlock;
  private raysBlock: UniformBlock | null = null;  // of regions that cut
  private textures: Record<string, WebGLTexture> = {};
  private buffers: Record<string, WebGLFramebuffer> = {};
  private translucent: Translucent | null = null;
  private bits: 0 | 16 | 32 | null = null;   // of floats that can be blended, once tested
  private stale = false;                 // streamlines have come that the picture at work does not have
  private frame: Frame | null = null;
  private rest: Frame | null = null;     // the finished picture, which streamlines that come are added to
  private sync: WebGLSync | null = null;
  private sliceStarted = 0;
  private sliceSize = 0;
  private rate = 1000;                   // segments a ms, as measured
  private dirty = true;
  private moving = false;
  private asked = 0;
  private still = 0;
  private waiting: (() => void)[] = [];
  private looked: { direction: Vec; up: Vec; state: string } | null = null; // the last call of `look`, and its camera

  constructor(readonly canvas: HTMLCanvasElement, public scene: Scene, private data: Uint8Array[], private archives: Map<number, Archive>) {
    this.camera = new Camera(structuredClone(scene.camera));
    if (!scene.camera) this.look();
    const gl = canvas.getContext("webgl2", {
      alpha: false,
      antialias: false,
      depth: false,
      preserveDrawingBuffer: false,
      powerPreference: "high-performance",
    });
    if (!gl)
      throw new GraphicsError(
        "This browser has no WebGL 2, which the page draws with. " +
          "Turn on graphics acceleration in its settings, or open the page in another browser.",
      );
    this.gl = gl;
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.frame = this.rest = null;
      this.sync = null;
    });
    canvas.addEventListener("webglcontextrestored", () => this.guarded(() => this.begin()));
    this.begin();
  }

  private guarded(what: () => void): void {
    try {
      what();
    } catch (error) {
      if (!this.gl.isContextLost()) this.failed?.(error as Error);
    }
  }

  /** Make all that lies on the graphics card, at first and when a lost context comes back. */
  private begin(): void {
    const { gl } = this, before = this.lines.splice(0);
    this.programs.clear();
    this.rest = this.translucent = this.bits = null;
    this.textures = {};
    this.buffers = {};
    this.width = this.height = 0;
    this.surfaces.length = this.images.length = 0;
    this.frameBlock = new UniformBlock(gl, "Frame");
    this.clipBlock = new UniformBlock(gl, "ClipPlanes");
    this.raysBlock = null;
    this.fill(new Map(), new Map());
    before.forEach((old, i) => {
      const now = this.lines[i];
      now.shownValues = old.shownValues;
      now.marked = old.marked;
    });
    this.restored?.();
    this.change();
  }

  private fill(sets: Map<Uint8Array, FibletSet>, kept: Map<string, Surface | ImageSlice>): void {
    const { gl, scene } = this;
    scene.layers.forEach((layer) => {
      if (layer.kind === "surface")
        this.surfaces.push((kept.get(JSON.stringify(layer)) as Surface) ?? new Surface(gl, layer, this.data));
      else if (layer.kind === "image")
        this.images.push((kept.get(JSON.stringify(layer)) as ImageSlice) ?? new ImageSlice(gl, layer, this.data));
      else
        this.lines.push(
          new Lines(
            gl,
            layer,
            this.lines.length,
            this.data,
            this.archives.get(layer.data)!,
            sets.get(this.data[layer.data]),
          ),
        );
    });
    const budget = Math.min(1024, 128 * ((navigator as { deviceMemory?: number }).deviceMemory ?? 4)) * 2 ** 20;
    for (const lines of this.lines) lines.set.budget = budget / this.lines.length;
  }

  /** Show another scene from where the camera is; unchanged data stay on the graphics card. */
  update(scene: Scene, data: Uint8Array[], archives: Map<number, Archive>): void {
    if (this.gl.isContextLost()) return;
    const { data: old } = this, lines = this.lines.splice(0), surfaces = this.surfaces.splice(0), images = this.images.splice(0);
    const sets = new Map(lines.map((one) => [old[one.layer.data], one.set] as const));
    const same = ({ layer }: Surface | ImageSlice): boolean =>
      (layer.kind === "image"
        ? [layer.pixels]
        : [layer.places, layer.triangles, layer.normals, layer.colours, layer.values, layer.edges?.sides]
      ).every((at) => at === undefined || old[at] === data[at]);
    this.frame = this.rest = null;
    this.scene = scene;
    this.data = data;
    this.archives = archives;
    this.fill(sets, new Map([...surfaces, ...images].filter(same).map((one) => [JSON.stringify(one.layer), one] as const)));
    for (const one of lines) one.release();
    for (const one of images) if (!this.images.includes(one)) one.release();
    for (const { set } of lines) if (!this.lines.some((one) => one.set === set)) set.release();
    for (const one of surfaces) if (!this.surfaces.includes(one)) one.release();
    this.change();
  }

  /** Called when a lost context has come back, for what the reader has chosen since. */
  restored: (() => void) | null = null;

  program(vertex: string, fragment: string, features: string[] = []): Program {
    const key = [vertex, fragment, ...features].join(" ");
    let found = this.programs.get(key);
    if (!found) this.programs.set(key, (found = new Program(this.gl, vertex, fragment, features)));
    return found;
  }

  /** Something is to be seen that was not: draw again. */
  change(moving = false): void {
    this.dirty = true;
    this.moving = moving;
    window.clearTimeout(this.still);
    if (moving) this.still = window.setTimeout(() => this.change(), 200);
    this.schedule();
  }

  /** More streamlines have come: add them to the picture. */
  grow(): void {
    this.guarded(() => {
      const frame = this.frame ?? this.rest;
      if (this.throughs().length) {
        // Sums begin behind the nearest lines: new streamlines make another picture.
        for (const { set, layer } of this.lines) set.advance(this.archives.get(layer.data)!.ready);
        if (this.frame) this.stale = true;
        else this.change();
        this.grown?.();
        return;
      }
      for (const lines of this.lines) {
        const { set } = lines, before = set.blocks.length;
        set.advance(this.archives.get(lines.layer.data)!.ready);
        if (!frame || !lines.layer.visible) continue;
        const held = frame.jobs.length;
        this.addJobs(frame, lines, set.blocks.slice(before));
        if (set.segments(set.blocks.reduce((sum, block) => sum + block.items, 0)) <= this.few) continue;
        const more = frame.jobs.splice(held);
        for (const what of ["likely", "others"] as const) frame.jobs.push(...more.map((job) => ({ ...job, what })));
      }
      if (!frame) this.change();
      else if (!this.dirty) this.frame = frame;
      this.grown?.();
    });
    this.schedule();
  }

  /** Lines that are shown, and that one looks through. */
  private throughs(): Lines[] {
    const found = this.lines.filter(({ layer }) => layer.visible && layer.through);
    if (found.length && this.bits === null && !(this.bits = floatBits(this.gl))) {
      this.lacking?.("its graphics cannot add up colours of lines that one looks through");
    }
    return this.bits === 0 ? [] : found;
  }

  private addJobs(frame: Frame, lines: Lines, blocks: Block[]): void {
    const matrix = product(frame.matrices.projection, product(frame.matrices.view, lines.model));
    for (const block of blocks) if (!this.outside(matrix, block.bounds)) frame.jobs.push({ lines, block, what: "all" });
  }

  /** Find the distance of the picture so far, tile by tile. */
  private findFarTiles(depths: WebGLTexture, drawn: boolean, read: boolean): FarDepths | null {
    const { gl } = this, columns = Math.ceil(this.width / FAR_TILE), rows = Math.ceil(this.height / FAR_TILE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.far);
    if (!drawn) {
      gl.clearBufferuiv(gl.COLOR, 0, [FARTHEST, 0, 0, 0]);
      return null;
    }
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(null);
    gl.viewport(0, 0, columns, rows);
    this.program("page/screen.vert", "page/far_tiles.frag").use().textures({ depths });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.viewport(0, 0, this.width, this.height);
    if (!read) return null;
    const words = new Uint32Array(4 * columns * rows);
    gl.readPixels(0, 0, columns, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, words);
    if (!asDrawn(words)) words.fill(FARTHEST);  // nothing is known to be hidden
    return { size: FAR_TILE, columns, rows, depths: new Float32Array(words.buffer) };
  }

  private schedule(): void {
    const tick = (): void => this.guarded(() => this.tick());
    if (this.asked) return;
    // A slice that is still drawn is looked at more often than the screen is: the next one follows at once.
    this.asked = this.sync && this.frame && !this.frame.moving ? window.setTimeout(tick, 1) : requestAnimationFrame(tick);
  }

  /** Resolves when a picture at rest is finished. */
  settled(): Promise<void> {
    if (!this.dirty && !this.frame && !this.moving && !this.loading) return Promise.resolve();
    return new Promise((resolve) => this.waiting.push(resolve));
  }

  private tick(): void {
    this.asked = 0;
    const { gl } = this;
    if (gl.isContextLost()) return;
    if (this.sync) {
      if (gl.getSyncParameter(this.sync, gl.SYNC_STATUS) !== gl.SIGNALED) return this.schedule();
      gl.deleteSync(this.sync);
      this.sync = null;
      const took = Math.max(performance.now() - this.sliceStarted, 0.5);
      if (this.sliceSize > 2000) this.rate += 0.5 * (Math.min(this.sliceSize / took, 8 * this.rate) - this.rate);
    }
    this.fit();
    if (this.dirty) this.start();
    const frame = this.frame;
    if (!frame) return;
    const quota = this.rate * SLICE;
    this.sliceStarted = performance.now();
    this.sliceSize = 0;
    do this.drawSlice(frame, frame.moving ? Infinity : quota);
    while (frame.next < frame.jobs.length && (frame.moving || (this.sliceSize < quota && frame.jobs[frame.next].what !== "others")));
    const finished = frame.next >= frame.jobs.length;
    if (finished || this.worthShowing(frame)) {
      frame.shownAt = performance.now();
      this.present(frame, finished);
      if (this.drawnOnce && (frame.jobs.length || !this.loading)) {
        this.drawnOnce();
        this.drawnOnce = null;
      }
    }
    this.sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    if (finished) {
      this.frame = null;
      this.rest = frame.moving ? null : frame;
      ++this.frames;
      if (this.stale) this.change();
      if (!frame.moving) this.finished?.();
      if (!frame.moving && !this.dirty && !this.loading) this.waiting.splice(0).forEach((resolve) => resolve());
    }
    this.schedule();
  }

  /** Whether a picture that is not finished has waited long enough, and will not be finished soon. */
  private worthShowing({ jobs, next, begun, shownAt }: Frame): boolean {
    const now = performance.now(), { what } = jobs[next], alike = (job: Job): boolean => job.what === what;
    const left = ((now - begun) * jobs.slice(next).filter(alike).length) / Math.max(jobs.slice(0, next).filter(alike).length, 1);
    return now - shownAt > Math.max(REFRESH, LATER * (shownAt - begun)) && (!this.frames || left > REFRESH);
  }

  /** Look along a direction at everything; in a window of another shape again, until the camera is moved. */
  look(direction: Vec = OBLIQUE, up: Vec = [0, 0, 1]): void {
    const { camera, canvas } = this;
    camera.lookAlong(direction, up, this.scene.bounds, canvas.clientWidth / canvas.clientHeight || 1);
    this.looked = { direction, up, state: JSON.stringify(camera.state) };
  }

  /** Have the canvas as large as it is shown. */
  private fit(): void {
    const { gl, canvas } = this, ratio = window.devicePixelRatio || 1, most = gl.getParameter(gl.MAX_TEXTURE_SIZE) - 2;
    const width = Math.min(most, Math.max(1, Math.round(canvas.clientWidth * ratio))),
      height = Math.min(most, Math.max(1, Math.round(canvas.clientHeight * ratio)));
    if (width === this.width && height === this.height) return;
    canvas.width = this.width = width;
    canvas.height = this.height = height;
    this.ratio = ratio;
    if (this.looked?.state === JSON.stringify(this.camera.state)) this.look(this.looked.direction, this.looked.up);
    for (const texture of Object.values(this.textures)) gl.deleteTexture(texture);
    for (const buffer of Object.values(this.buffers)) gl.deleteFramebuffer(buffer);
    this.translucent?.release();
    this.translucent = null;
    const t = (this.textures = {
      texels: target(gl, gl.RGBA32UI, width, height),
      depths: target(gl, gl.DEPTH_COMPONENT32F, width, height),
      drawn: target(gl, gl.RGBA8, width, height),
      shown: target(gl, gl.RGBA32UI, width + 2, height + 2),
      tiles: target(gl, gl.R8UI, Math.ceil(width / TILE), Math.ceil(height / TILE)),
      far: target(gl, gl.R32UI, Math.ceil(width / FAR_TILE), Math.ceil(height / FAR_TILE)),
    });
    this.buffers = {
      texels: framebuffer(gl, t.texels, t.depths),
      scene: framebuffer(gl, t.drawn, t.depths),
      drawn: framebuffer(gl, t.drawn, null),
      shown: framebuffer(gl, t.shown, null),
      tiles: framebuffer(gl, t.tiles, null),
      far: framebuffer(gl, t.far, null),
    };
    this.dirty = true;
  }

  /** Begin a picture: background, surfaces and slices that hide lines. */
  private start(): void {
    const { gl, camera, scene } = this, moving = this.moving;
    this.dirty = false;
    const view = camera.view(), projection = camera.projection(this.width / this.height, scene.bounds);
    const drawn: Drawn = {
      view,
      projection,
      parallel: camera.state.parallel,
      lights: (program) => this.setLights(program, view),
      planes: this.planes,
      ratio: this.ratio,
    };
    const frame: Frame = (this.frame = {
      jobs: [],
      next: 0,
      share: 1,
      drawn: 0,
      begun: performance.now(),
      shownAt: performance.now(),
      matrices: drawn,
      moving,
      through: new Set(),
    });
    this.rest = null;
    this.stale = false;
    const throughs = this.throughs(), visible = this.lines.filter(({ layer }) => layer.visible);
    const sum = (jobs: Job[], count: (job: Job) => number): number =>
      jobs.reduce((all, job) => all + job.lines.set.segments(count(job)), 0);
    const jobsOf = (some: Lines[]): Job[] => {
      frame.jobs = [];
      for (const lines of some) this.addJobs(frame, lines, lines.set.blocks);
      return frame.jobs;
    };
    const many = sum(jobsOf(visible), ({ block }) => block.items) > this.few;
    const ordered = (jobs: Job[]): Job[] => {
      if (!many) return jobs;
      const depth = ({ lines, block: { bounds: b } }: Job): number =>
        apply(product(view, lines.model), [b[0] + b[1], b[2] + b[3], b[4] + b[5]].map((part) => part / 2) as Vec)[2];
      const order = new Map(jobs.map((job) => [job, depth(job)]));
      const likely = jobs.sort((a, b) => order.get(b)! - order.get(a)!).map((job): Job => ({ ...job, what: "likely" }));
      return moving ? likely : [...likely, ...likely.map((job): Job => ({ ...job, what: "others" }))];
    };
    const jobs = ordered(jobsOf(visible.filter((lines) => !throughs.includes(lines))));
    for (const lines of throughs) {
      const own = jobsOf([lines]);
      jobs.push(...ordered([...own]));
      if (lines.layer.through!.all) jobs.push(...own.map((job): Job => ({ ...job, what: "behind" })));
    }
    frame.jobs = jobs;
    if (moving)
      frame.share = Math.min(
        1,
        (this.rate * MOVING) /
          Math.max(
            sum(jobs, ({ lines, block, what }) =>
              what === "likely" ? (lines.set.likely(block), block.likelies) : block.items,
            ),
            1,
          ),
      );
    if (!this.mixes()) {
      this.translucent?.release();
      this.translucent = null;
    } else (this.translucent ??= new Translucent(gl, this.bits as 16 | 32, this.width, this.height, this.textures.depths)).keep(throughs);
    if (!this.frames) frame.shownAt = 0;
    gl.viewport(0, 0, this.width, this.height);
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.texels);
    gl.clearBufferuiv(gl.COLOR, 0, [ALL_ONES, ALL_ONES, 0, 0]);
    gl.depthMask(true);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    this.drawBackdrop(drawn);
  }

  private drawBackdrop(drawn: Drawn): void {
    const { gl, scene } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.scene);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(null);
    this.program("page/screen.vert", "page/background.frag")
      .use()
      .set({ bottom: scene.background[0], top: scene.background[1], height: this.height });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    for (const surface of this.surfaces)
      if (surface.layer.visible && !surface.translucent) surface.draw(this.surfaceProgram(surface), drawn);
    const flat = this.program("page/image.vert", "page/image.frag");
    for (const image of this.images) if (image.layer.visible && !image.translucent) image.draw(flat, drawn);
  }

  private surfaceProgram({ layer }: Surface): Program {
    return this.program("page/surface.vert", "page/surface.frag", layer.log ? ["TABLE_LOGARITHM"] : []);
  }

  private outside(matrix: Mat, b: Bounds): boolean {
    const counts = [0, 0, 0, 0, 0, 0];
    for (let i = 0; i < 8; ++i) {
      const [x, y, z, w] = apply(matrix, [b[i & 1], b[2 + ((i >> 1) & 1)], b[4 + (i >> 2)]]);
      [x < -w, x > w, y < -w, y > w, z < -w, z > w].forEach((out, side) => (counts[side] += out ? 1 : 0));
    }
    return counts.some((count) => count === 8);
  }

  private setLights(program: Program, view: Mat): void {
    const sum: Vec = [0, 0, 0];
    let standing = 0;
    this.scene.lights.slice(0, 8).forEach((light, i) => {
      let place = [0, 0, 1, 0];
      if (light.view) place = [...light.view, 0];
      else if (light.world) {
        standing = 1;
        place = apply(view, light.world, light.positional ? 1 : 0);
        place[3] = light.positional ? 1 : 0;
      }
      program.set({ [`light_colour[${i}]`]: light.colour, [`light_place[${i}]`]: place });
      light.colour.forEach((part, channel) => (sum[channel] += part));
    });
    program.ints({ light_count: Math.min(this.scene.lights.length, 8) }).set({ light_sum: sum, light_standing: standing });
  }

  /** Local coordinates of lines to the window, and the planes in them; returns how wide lines are drawn. */
  private aim(lines: Lines, drawn: Drawn): { wide: boolean; clipped: boolean; window: Mat } {
    const width = lines.layer.line_width * this.ratio, wide = this.wide(lines);
    const local = product(drawn.view, product(lines.model, lines.set.toData)), clip = product(drawn.projection, local);
    const largest = clip.reduce((most, value) => Math.max(most, Math.abs(value)), 0) || 1, window = new Float64Array(16);
    for (let j = 0; j < 4; ++j) {
      const [x, y, z, w] = [0, 1, 2, 3].map((i) => clip[i + 4 * j] / largest);
      window.set([(this.width / 2) * (x + w), (this.height / 2) * (y + w), (z + w) / 2, w], 4 * j);
    }
    this.frameBlock.write(
      {
        window_from_local: window,
        reference: lines.set.reference,
        half_line_width: wide ? width / 2 : 0,
        viewport: [this.width, this.height],
      },
      ["reference"],
    );
    this.frameBlock.bind();
    const planes = [...(lines.layer.planes ?? []), ...this.planes].slice(0, 8);
    if (planes.length) {
      const toWorld = product(lines.model, lines.set.toData), back = inverse(clip);
      const place = new Float64Array(32), tilts = new Float64Array(32);
      planes.forEach((plane, i) => {
        const p = [0, 1, 2, 3].map(
          (j) =>
            plane[0] * toWorld[4 * j] +
            plane[1] * toWorld[4 * j + 1] +
            plane[2] * toWorld[4 * j + 2] +
            plane[3] * toWorld[4 * j + 3],
        );
        const size = Math.hypot(p[0], p[1], p[2]) || 1;
        p.forEach((value, j) => (place[4 * i + j] = value / size));
        if (back) for (let j = 0; j < 2; ++j) {
          const moved = [0, 1, 2, 3].reduce((sum, k) => sum + place[4 * i + k] * back[k + 4 * j], 0);
          // The window's W is that of the matrix divided by its largest entry.
          tilts[4 * i + j] = moved * largest * (2 / (j === 0 ? this.width : this.height));
        }
      });
      this.clipBlock.write({ clip_planes: place, clip_tilts: tilts, clip_plane_count: 0, clip_rounding: 0 });
      this.clipBlock.write({ clip_plane_count: planes.length }, ["clip_plane_count"]);
      this.clipBlock.bind();
    }
    return { wide, clipped: planes.length > 0, window };
  }

  /** Have the shapes of a region as this camera sees them; false where it cuts nothing. */
  private cut(cut: Cut, drawn: Drawn): boolean {
    const { width, height } = this;
    const window = new Float64Array([width / 2, 0, 0, 0, 0, height / 2, 0, 0, 0, 0, 0.5, 0, width / 2, height / 2, 0.5, 1]);
    const rays = raysOf(cut, product(window, product(drawn.projection, drawn.view)), width, height);
    if (!rays) return false;
    (this.raysBlock ??= new UniformBlock(this.gl, "Rays")).write(rays);
    this.raysBlock.bind();
    return true;
  }

  /** How many pixels a length (mm) takes at most. */
  private pixelsOf(lines: Lines, drawn: Drawn, length: number): number {
    const matrix = product(drawn.projection, product(drawn.view, lines.model)),
      b = lines.set.bounds,
      stretch = Math.hypot(...linear(lines.model));
    let nearest = Infinity;
    for (let i = 0; i < 8; ++i) nearest = Math.min(nearest, apply(matrix, [b[i & 1], b[2 + ((i >> 1) & 1)], b[4 + (i >> 2)]])[3]);
    return nearest > 0 ? (length * stretch * (this.height / 2) * drawn.projection[5]) / nearest : Infinity;
  }

  private drawSlice(frame: Frame, quota: number): void {
    const { gl } = this;
    let aimed: Lines | null = null, program: Program | null = null, sprites = false, window: Mat = identity(), brush = 1;
    const first = frame.jobs[frame.next],
      phase = first && this.phase(first),
      behind = first?.what === "behind",
      translucent = phase ? this.translucent : null;
    if (translucent && !frame.through.has(first.lines)) {
      frame.through.add(first.lines);
      translucent.begin(first.lines, this.wide(first.lines) && first.lines.layer.through!.all, this.buffers.texels);
    }
    const hiding = first?.what === "others", depths = translucent && !behind ? translucent.depthsOf(first.lines) : this.textures.depths;
    const far = this.findFarTiles(depths, frame.next > 0, hiding);
    while (frame.next < frame.jobs.length && this.sliceSize < quota) {
      const { lines, block, what } = frame.jobs[frame.next];
      if (this.phase(frame.jobs[frame.next]) !== phase || ((what === "others") !== hiding && this.sliceSize)) break;
      ++frame.next;
      lines.set.pointsOf(block);
      if (aimed !== lines) {
        aimed = lines;
        const aim = this.aim(lines, frame.matrices), { wide, clipped } = aim;
        window = aim.window;
        brush = 1 + (wide ? (lines.layer.line_width * this.ratio) / 2 : 0);
        const features = ["CLIPPING", "CLIPPING_DEPTH", "EDGES"];
        if (wide) features.push("WIDE_LINES");
        if (lines.layer.ends) features.push("LINE_ENDS");
        if (clipped) features.push("CLIP_PLANES");
        if (lines.layer.cut && this.cut(lines.layer.cut, frame.matrices))
          features.push("CLIP_REGION", `REGION ${expression(lines.layer.cut)}`);
        sprites = !wide && this.pixelsOf(lines, frame.matrices, lines.set.longestStep) <= LONGEST_SPRITE;
        if (sprites) features.push("SPRITES");
        if (lines.values) features.push("VALUES_STORED");
        if (lines.byPoint) features.push("VALUES_COLOUR");
        if (lines.kept) features.push("STREAMLINE_MASK");
        if (lines.keptPoints) features.push("POINT_MASK");
        if (wide && translucent && lines.layer.through!.all) features.push("GATHER_SLICES");
        if (behind) features.push(...lines.colouring);
        program = this.program("page/segment.vert", behind ? "page/sum.frag" : "page/segment.frag", features).use();
        if (lines.values) program.set({ shown_values: lines.shownValues.map((end) => end - lines.values!.reference) });
        program.uints({ layer: lines.index * 2 ** 28 });
      }
      const chosen =
        what === "others" && far
          ? lines.set.look(block, window, brush, this.width, this.height, far)
          : lines.set.likely(block);
      if (behind) translucent!.behind(lines);
      else if (translucent) translucent.nearest(lines);
      else gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.texels);
      gl.enable(gl.DEPTH_TEST);
      gl.depthFunc(translucent ? gl.LEQUAL : gl.LESS);  // opaque things hide nothing at their own depth
      this.frameBlock.bind();
      if (behind) {
        this.colour(program!.use(), lines);
        translucent!.paint(program!, lines, frame.matrices);
      }
      program!
        .use()
        .textures({
          far_tiles: this.textures.far,
          items: lines.set.items,
          kept: lines.kept,
          kept_points: lines.keptPoints,
          value_texels: lines.values && lines.values.texture,
          value_table: lines.values && lines.values.table,
          point_colours: lines.byPoint ? lines.colours : null,
        });
      if (what === "all" || behind)
        this.sliceSize += lines.set.draw(block, program!, frame.share * block.items, sprites);
      else
        this.sliceSize +=
          block.items +
          lines.set.drawSome(
            block,
            program!,
            chosen,
            sprites,
            Math.ceil(frame.share * (what === "likely" ? block.likelies : block.items)),
          );
    }
    gl.disable(gl.BLEND);
    gl.depthMask(true);
  }

  /** What is drawn together: opaque lines are. */
  private phase({ lines, what }: Job): string {
    return lines.layer.through && this.bits ? `${lines.index} ${what === "behind"}` : "";
  }

  private wide(lines: Lines): boolean {
    return lines.layer.ends || lines.layer.line_width * this.ratio > 1;
  }

  /** Tell a program what colours lines. */
  private colour(program: Program, lines: Lines): void {
    const { colours, through } = lines.layer, { texels } = this.textures;
    program.textures({
      colour_list: lines.byPoint ? null : lines.colours,
      colour_table: lines.table,
      opacities: lines.opacities ?? texels,
    });
    program.ints({
      colour_entries: lines.tableSize,
      by_streamline: lines.opacities ? 1 : 0,
      by_point: through?.by_point ? 1 : 0,
    });
    program.set({ colour_solid: colours.colour ?? [1, 1, 1], colour_range: lines.tableRange, colour_reference: 0 });
  }

  /** Tell a program how the nearest lines look that some textures hold. */
  private light(program: Program, lines: Lines, drawn: Drawn, texels: WebGLTexture, depths: WebGLTexture): void {
    const { layer } = lines, back = inverse(drawn.projection) ?? identity();
    this.colour(program, lines);
    program.textures({ texels, depths, chosen: lines.chosen ?? texels }).uints({ layer: lines.index * 2 ** 28, marked: lines.marked });
    program.ints({ light: LIGHTS[layer.light] }).set({
      reflects: layer.reflects, sheen: layer.sheen,
      chosen_colour: layer.chosen?.colour ?? [0, 0, 0, 0], faded: layer.chosen?.faded ?? [0, 0, 0, 0],
      data_to_view: linear(product(drawn.view, lines.model)), pixel_to_view: new Float32Array(back), picture: [this.width, this.height],
    });
    this.setLights(program, drawn.view);
  }

  /** From the nearest lines to the canvas. */
  private present(frame: Frame, finished: boolean): void {
    const { gl, textures: t, buffers: b } = this, drawn = frame.matrices, through = [...frame.through];
    this.repaint(drawn);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(null);
    this.findTiles(through);
    gl.bindFramebuffer(gl.FRAMEBUFFER, b.drawn);
    for (const lines of this.lines) {
      if (!lines.layer.visible || frame.through.has(lines)) continue;
      const resolve = this.program("page/tiles.vert", "page/resolve.frag", lines.colouring).use();
      this.light(resolve, lines, drawn, t.texels, t.depths);
      this.drawTiles(resolve);
    }
    this.drawTranslucent(frame);
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(null);
    if (finished && this.scene.antialias && this.lines.length) {
      const narrower = (some: Lines[]): number =>
        Math.max(0, ...some.map(({ layer }) => 1 - Math.min(1, layer.visible ? layer.line_width * this.ratio : 1)));
      gl.bindFramebuffer(gl.FRAMEBUFFER, b.shown);
      gl.viewport(0, 0, this.width + 2, this.height + 2);
      const edges = this.program("page/screen.vert", "page/visible_edges.frag")
        .use()
        .textures({ texels: t.texels, depths: t.depths, drawn: t.drawn });
      edges.ints({ first: 1 }).set({ narrower: narrower(this.lines.filter((lines) => !frame.through.has(lines))) });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      for (const lines of through) {
        const { texels, depths } = this.translucent!.of(lines)!;
        edges.textures({ texels, depths }).ints({ first: 0 }).set({ narrower: narrower([lines]) });
        gl.drawArrays(gl.TRIANGLES, 0, 3);
      }
      gl.viewport(0, 0, this.width, this.height);
      gl.bindFramebuffer(gl.FRAMEBUFFER, b.drawn);
      const smooth = this.program("page/tiles.vert", "effects/picture/antialias_coverage.frag").use().textures({ shown: t.shown });
      gl.uniform2i(smooth.at("shift"), 1, 1);
      this.drawTiles(smooth);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.program("page/screen.vert", "page/copy.frag").use().textures({ drawn: t.drawn });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.presented?.();
  }

  /** Find which tiles of the picture have lines. */
  private findTiles(through: Lines[]): void {
    const { gl, textures: t } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.tiles);
    gl.viewport(0, 0, Math.ceil(this.width / TILE), Math.ceil(this.height / TILE));
    const mask = this.program("page/screen.vert", "page/tile_mask.frag").use();
    [t.texels, ...through.map((lines) => this.translucent!.of(lines)!.texels)].forEach((texels, i) => {
      mask.textures({ texels }).ints({ first: i ? 0 : 1 });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    });
    gl.viewport(0, 0, this.width, this.height);
  }

  /** Run a pass over those tiles; its program is in use. */
  private drawTiles(program: Program): void {
    const { gl } = this;
    program.textures({ tiles: this.textures.tiles }).set({ whole: [this.width, this.height] });
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, Math.ceil(this.width / TILE) * Math.ceil(this.height / TILE));
  }

  /** Edges were mixed into an earlier frame of this picture: draw the background of the lines afresh. */
  private repaint(drawn: Drawn): void {
    if (this.frame && this.frame.drawn++ > 0) this.drawBackdrop(drawn);
  }

  /** Whether anything is shown that one looks through. */
  private mixes(): boolean {
    const some =
      this.throughs().length ||
      [...this.surfaces, ...this.images].some(({ layer, translucent }) => layer.visible && translucent);
    return !!some && !!(this.bits ??= floatBits(this.gl));
  }

  private drawTranslucent(frame: Frame): void {
    const { gl, translucent } = this,
      drawn = frame.matrices,
      some = this.surfaces.filter((surface) => surface.layer.visible && surface.translucent);
    const images = this.images.filter((image) => image.layer.visible && image.translucent);
    if (!some.length && !images.length && !frame.through.size) return;
    if (translucent) translucent.start();
    else {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.scene);
      gl.depthMask(false);
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    }
    for (const lines of frame.through) {
      const program = this.program("page/tiles.vert", "page/through.frag", lines.colouring).use(),
        { texels, depths } = translucent!.of(lines)!;
      this.light(program, lines, drawn, texels, depths);
      translucent!.show(program, lines, frame.share);
      this.drawTiles(program);
    }
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    some.sort((a, b) => b.depth(drawn.view) - a.depth(drawn.view));
    for (const surface of some) surface.draw(this.surfaceProgram(surface), drawn);
    if (images.length) {
      const flat = this.program("page/image.vert", "page/image.frag");
      images.forEach((image) => image.draw(flat, drawn));
    }
    if (translucent) translucent.finish(this.program("page/screen.vert", "page/mixed.frag").use(), this.buffers.drawn);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
  }

  /** Whether pixels read from pictures equal the drawn ones. */
  reads(): boolean {
    const { gl } = this, word = new Uint32Array(4);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.far);
    gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, word);
    return asDrawn(word);
  }

  /** What a pixel of the canvas shows, counted from its upper left corner in pixels of the page. */
  pick(x: number, y: number): { lines: Lines; streamline: number; value: number | null } | null {
    const { gl } = this, px = Math.floor(x * this.ratio), py = this.height - 1 - Math.floor(y * this.ratio), word = new Uint32Array(4);
    const near: [number, number][] = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1], [2, 0], [-2, 0], [0, 2], [0, -2]];
    for (const [dx, dy] of near) {
      if (px + dx < 0 || py + dy < 0 || px + dx >= this.width || py + dy >= this.height) continue;
      for (const buffer of [...this.throughs().map((lines) => this.translucent?.of(lines)?.nearest), this.buffers.texels]) {
        if (!buffer) continue;
        gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
        gl.readPixels(px + dx, py + dy, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, word);
        if (word[0] !== ALL_ONES || word[1] !== ALL_ONES) break;
      }
      if (word[0] === ALL_ONES && word[1] === ALL_ONES) continue;
      const lines = this.lines[word[0] >>> 28];
      if (!lines) continue;
      const value = lines.values ? new Float32Array(new Uint32Array([word[3]]).buffer)[0] : null;
      return { lines, streamline: word[0] & 0x0fffffff, value };
    }
    return null;
  }

  /** The point of a streamline that is shown nearest to a place of the page, in data coordinates. */
  placeOf(lines: Lines, streamline: number, x: number, y: number): Vec {
    const { camera, scene, canvas } = this, width = canvas.clientWidth, height = canvas.clientHeight;
    const matrix = product(camera.projection(this.width / this.height, scene.bounds), product(camera.view(), lines.model));
    let best: Vec = [0, 0, 0], least = Infinity;
    for (const point of lines.set.pointsOfStreamline(streamline)) {
      const [cx, cy, , w] = apply(matrix, point), away = Math.hypot((cx / w + 1) * width / 2 - x, (1 - cy / w) * height / 2 - y);
      if (w > 0 && away < least) [best, least] = [point, away];
    }
    return best;
  }

  /** The picture as it is, rows from the top: RGBA. */
  pixels(): Uint8Array {
    const { gl, width, height } = this, all = new Uint8Array(4 * width * height), out = new Uint8Array(all.length);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.buffers.drawn);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, all);
    for (let row = 0; row < height; ++row) out.set(all.subarray(4 * width * row, 4 * width * (row + 1)), 4 * width * (height - 1 - row));
    return out;
  }
}
