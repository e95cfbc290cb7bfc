/** Data of the package for the page: shaders, blocks, and the table of rotations (scripts/page_shaders.py). */

import engine from "../build/engine.json";

interface Block {
  bytes: number;
  fields: Record<string, number>;
}

const lines = engine.lines.split("\n");

/** The text of a stage, from ranges of the lines that all stages share. */
function put(ranges: number[]): string {
  const text: string[] = [];
  for (let i = 0; i < ranges.length; i += 2) text.push(...lines.slice(ranges[i], ranges[i + 1]));
  return text.join("\n") + "\n";
}

export const shaders: Record<string, string> = {};
for (const [name, ranges] of Object.entries(engine.shaders)) shaders[name] = put(ranges);
export const blocks: Record<string, Block> = engine.blocks;
export const rotationScales: number[] = engine.rotation_scales;
export const PAGE_BITS: number = engine.page_bits;

export function fromBase64(text: string): Uint8Array {
  const binary = atob(text), bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

export const rotations = fromBase64(engine.rotations);

const FIELDS: Record<string, number[]> = engine.fields;

/** A field of a fiblet's record, of the word that holds it. */
export function field(name: string, word: number): number {
  const [, shift, width] = FIELDS[name];
  return width === 32 ? word : (word >>> shift) & ((1 << width) - 1);
}
