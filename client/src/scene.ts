/** The page's scene: the JSON that pvfiblets/page writes; its counterpart is pvfiblets/page/scene.py. */

import type { Bounds, CameraState, Vec } from "./camera";
import type { Cut } from "./cuts";

export interface Light {
  colour: Vec;          // times intensity
  view?: Vec;           // direction to a light that moves with the camera
  world?: Vec;          // direction to a light of the scene, or its place
  positional?: boolean;
}

export interface Colours {
  mode: string; // a file of shaders/colour (pvfiblets/colour_modes.py)
  colour?: Vec; // of "solid"
  data?: number; // of "streamline_rgba" and "point_packed": RGBA for each
  values?: string; // of "point_scalar": a stored array of points, or with `codes` the name of one
  // Of "point_scalar": codes of values that are not stored with the set.
  codes?: { data: number; table: number; bits: 8 | 16; lo: number; hi: number; reference: number };
  table?: string; // base64, RGBA: entries, then below, above, NaN
  clim?: [number, number];
  log?: boolean;
}

export interface Bar {
  title: string;
  table: string;        // base64, RGBA
  clim: [number, number];
  log: boolean;
  labels?: { name: string; colour: Vec }[]; // of categories: a list of them instead of a scale
}

export interface Control {
  name: string;
  values?: string;      // a stored array of points
  data?: number;        // float32 for each streamline
  range: [number, number];
}

interface Layer {
  name: string;
  visible: boolean;
  matrix?: number[];    // 16, column by column: data to world
  planes?: number[][];  // (a, b, c, d): kept where a x + b y + c z + d >= 0, in world coordinates
}

/** Translucency of lines. */
export interface Through {
  opacity: number;      // of all
  varied: boolean;      // whether colours or the fields below have opacities of their own, multiplied by `opacity`
  all: boolean;         // whether all lines show through the nearest, or the background of all lines
  opacities?: number;   // data: a byte for each streamline
  by_point?: boolean;   // whether values of points are opacities
}

export interface FibletLayer extends Layer {
  kind: "fiblets";
  data: number;
  colours: Colours;
  line_width: number;
  ends: boolean; // whether only the ends of streamlines are drawn, as discs of that width
  light: "none" | "line" | "illuminated";
  reflects: [number, number, number, number];
  sheen: Vec;
  through?: Through;
  kept?: number; // data: a byte for each streamline
  // A byte for each streamline; colours, and how much of them.
  chosen?: { data: number; colour: [number, number, number, number]; faded: [number, number, number, number] };
  cut?: Cut; // by a region, besides planes
  kept_points?: number; // data: a bit for each point
  groups?: { name: string; data: number }[]; // data: uint32, streamlines
  controls?: Control[];
}

export interface SurfaceLayer extends Layer {
  kind: "surface";
  places: number; // data: float32
  triangles: number; // data: uint32
  normals?: number; // data: float32
  colours?: number; // data: RGBA
  // Data: a byte for each corner, of triangles' own (shaders/page/surface.vert).
  edges?: { sides: number; colour: [number, number, number, number]; width: number };
  culled?: ("front" | "back")[]; // faces that are left out
  values?: number; // data: float32, through `table`
  table?: string; // base64, RGBA: entries, then below, above, NaN
  clim?: [number, number];
  log?: boolean;
  colour: Vec;
  opacity: number;
  lighting: boolean;
  reflects: [number, number, number, number];
  sheen: Vec;
  bounds: Bounds;
}

export interface ImageLayer extends Layer {
  kind: "image";
  corner: Vec;
  across: Vec;
  up: Vec;
  size: [number, number];
  pixels: number;       // data: RGBA
  smooth: boolean;      // colours between the centres of pixels are interpolated
  clear: boolean;       // some pixels are translucent
  opacity: number;
  bounds: Bounds;
}

export type AnyLayer = FibletLayer | SurfaceLayer | ImageLayer;

export interface Scene {
  title: string;
  background: [Vec, Vec];
  camera?: CameraState; // none: everything, fitted to the window
  bounds: Bounds;
  lights: Light[];
  layers: AnyLayer[];
  bars: Bar[];
  letters: boolean;     // of orientation
  antialias: boolean;
  data: { bytes: number; file?: string }[];
}
